# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel: the object's name and a verdict, warnings and their remedies, mass, volume and center.

The rest is in sub-panels, in the order of CAD's mass property dialogs (`places.ORDER`).
"""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from ..blender.session.displayed import Displayed, Trust, displayed, failure
from ..blender.session.live.following import Lag, current_numbers, is_live
from ..blender.session.tracking import armatures
from ..blender.settings.links import draw_links
from ..blender.write import properties
from ..blender.write.translations import localized
from ..blender.write.units import Units
from ..core.verdict.method import Source
from ..core.verdict.sentences import METHODS, method_key
from ..core.wall.findings import WALL_MEASURED
from . import remedies, rows
from .density import material_row
from .overlay.draw import header_switch
from .places import in_both_places

CENTER_HEADINGS = {"WORLD": "Center of Mass (World)", "OBJECT": "Center of Mass (Object)"}  # by the frame
RESTING_HEADINGS = {"WORLD": "Center of Mass at Rest (World)", "OBJECT": "Center of Mass at Rest (Object)"}  # for rigs

ICONS = {
    "exact": "CHECKMARK",
    "grid exact": "VOLUME_DATA",
    "shell": "MOD_SOLIDIFY",
    "wall": "MOD_SOLIDIFY",
    "wire": "CURVE_DATA",
    "capped": "ERROR",
    "open": "CANCEL",
    "given": "EMPTY_AXIS",
    "assembly": "OUTLINER_COLLECTION",
}
SOURCES = {Source.NURBS: "NURBS: {:s}", Source.GRID: "Grid: {:s}"}  # prefix for the measured data, before a verdict

LIVE = {
    Lag.NONE: "Live ({milliseconds:.0f} ms). Press Measure to store",
    Lag.FIRST_ORDER: (
        "Live: mass, volume and center of this frame; inertia follows when it stops ({milliseconds:.0f} ms)"
    ),
    Lag.BEHIND: "Live lags: measuring takes {milliseconds:.0f} ms, and waits until the edit stops",
}


class BodyPanel:
    """Mass properties"""

    bl_label = "Body Moments"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.object is not None

    def draw_header_preset(self, context: Context) -> None:
        header_switch(self.layout, context)
        draw_links(self.layout, icons_only=True)

    def draw(self, context: Context) -> None:
        obj, scene = context.object, context.scene
        layout = self.layout
        layout.use_property_decorate = False
        shown = displayed(obj, scene)
        _verdict(layout, context, obj, shown)
        findings = shown.findings if shown is not None else ()
        remedies.last_action(layout, context)
        remedies.warnings(layout, context, "body_moments_warnings", findings)
        material_row(layout, context, obj)
        narrow = rows.is_narrow(context)
        buttons = layout.column(align=True) if narrow else layout.row(align=True)
        buttons.scale_y = 1.4
        rows.button(buttons, context, "object.body_moments_measure", "PHYSICS")
        row = buttons.row(align=True)
        followed = any(is_live(subject) for subject in armatures.subjects([obj]))
        rows.button(row, context, "object.body_moments_live", "REC", depress=followed)
        row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")
        if shown is not None:
            remedies.unit_question(layout, context, shown.world)
            _numbers(layout, context, shown)
            row = layout.column(align=True) if narrow else layout.row(align=True)
            row.menu("VIEW3D_MT_body_moments_copy", icon="COPYDOWN")
            rows.button(row, context, "object.body_moments_clear", "TRASH")
            remedies.notes(layout, context, "body_moments_notes", findings)


def _verdict(layout: UILayout, context: Context, obj: Object, shown: Displayed | None) -> None:
    """Draw the object's name, and the state and method of its measurement."""
    column = layout.column(align=True)
    column.label(text=obj.name, icon="OBJECT_DATA", translate=False)
    refusal = failure(obj)
    if refusal is not None or shown is None:
        text = "Not Measured Again" if shown is not None else "Not Measured"
        column.label(text=text, icon="RADIOBUT_OFF" if refusal is None else "CANCEL")
    if refusal is not None:
        rows.message(column, context, refusal, icon="BLANK1")
        remedies.remedies(column, context, refusal)
    if shown is None:
        return
    if armatures.stands_for_meshes(obj):
        _posed(column, context, obj)
        return
    _headline(column, context, obj, shown)
    if shown.live is not None and shown.reason is None:
        rows.remark(column, context, LIVE[shown.lag], icon="REC", milliseconds=1e3 * shown.live.seconds)
    now = current_numbers(obj)
    if now is not None and now.refusal is not None and now.refusal != refusal:
        rows.message(column, context, now.refusal)
    rows.stale_row(column, context, shown.reason)


def _posed(column: UILayout, context: Context, armature: Object) -> None:
    """Draw the number of meshes that an armature deforms, and warnings about missing and outdated numbers."""
    meshes = armatures.deformed_meshes(armature)
    texts = "Sum of {count} mesh of the armature", "Sum of {count} meshes of the armature"
    rows.remark(column, context, *texts, icon="POSE_HLT", count=len(meshes))
    numbers = {mesh.name: displayed(mesh, context.scene) for mesh in meshes}
    lacking = [name for name, shown in numbers.items() if shown is None]
    stale = [name for name, shown in numbers.items() if shown is not None and shown.trust == Trust.OUT_OF_DATE]
    for text, names in (("Not measured: {objects}", lacking), ("Out of date: {objects}", stale)):
        if names:
            rows.remark(column, context, text, icon="ERROR", objects=names)


def _headline(column: UILayout, context: Context, obj: Object, shown: Displayed) -> None:
    """Draw the method in two lines; show an unknown method, of another version of the add-on, by its stored text."""
    key = method_key(shown.method, any(found.code == WALL_MEASURED for found in shown.findings))
    source = Source.POLYGONS if shown.method is None or key == str(shown.method) else shown.method.source
    headline, explanation = METHODS.get(key, (properties.method_text(obj).title(), ""))
    title = localized(SOURCES.get(source, "{:s}")).format(localized(headline))
    rows.sentence(column, context, title, icon=ICONS.get(key, "INFO"))
    if explanation:
        rows.sentence(column, context, localized(explanation), icon="BLANK1")


def _numbers(layout: UILayout, context: Context, displayed: Displayed) -> None:
    """Draw mass, volume, area, density and center of the measurement."""
    column = layout.column(align=True)
    frame = context.scene.body_moments.frame
    shown, units = displayed.in_frame(frame), Units.from_settings(context.scene.unit_settings)
    entries = [("Mass", "mass", shown.mass)]
    length = properties.optional(context.object, "body_length")
    if length is None:
        entries.append(("Volume", "volume", shown.volume))
        if shown.area:  # a grid of densities has no surface
            entries.append(("Area", "area", shown.area))
        entries.append(("Density", "density", shown.density))
    else:
        entries.append(("Length", "length", length))
    rows.quantities(column, units, entries)
    source = properties.density_from(context.object)
    if source:
        rows.remark(column, context, "Mean density, from {cause}", icon="BLANK1", cause=source)
    is_rig = context.object.type == "ARMATURE" and not displayed.is_posed
    headings = RESTING_HEADINGS if is_rig else CENTER_HEADINGS
    rows.center(layout, units, headings[frame], shown)


class ApplyPanel:
    """Use the center of mass and the principal axes in the scene"""

    bl_label = "Apply to Object"

    def draw(self, context: Context) -> None:
        layout, obj = self.layout, context.object
        column = layout.column(align=True)
        rows.button(column, context, "object.body_moments_origin_to_center", "OBJECT_ORIGIN")
        rows.button(column, context, "object.body_moments_axes_to_principal", "EMPTY_AXIS")
        rows.button(column, context, "object.body_moments_align_to_world", "ORIENTATION_GLOBAL")
        column = layout.column(align=True)
        rows.button(column, context, "object.body_moments_add_empty", "OUTLINER_OB_EMPTY")
        rows.button(column, context, "view3d.body_moments_cursor_to_center", "PIVOT_CURSOR")
        rows.button(column, context, "object.body_moments_create_orientation", "ORIENTATION_LOCAL")
        rows.button(column, context, "object.body_moments_rigid_bodies", "RIGID_BODY")
        button = rows.button(column, context, "object.body_moments_set_rigid_body_mass", "RIGID_BODY")
        button.add = not obj.rigid_body
        rows.button(layout, context, "object.body_moments_add_nodes", "GEOMETRY_NODES")
        rows.button(layout, context, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")


VIEW3D_PT_body_moments, OBJECT_PT_body_moments = in_both_places(BodyPanel)
CLASSES = (VIEW3D_PT_body_moments, OBJECT_PT_body_moments, *in_both_places(ApplyPanel, "apply"))
