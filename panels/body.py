# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel: the answer (a verdict, mass, volume and center of mass), the buttons, and then
the findings.

Nothing that comes and goes stands above a button of this panel: warnings are below them, refusals
of the last action below all sub-panels. The rest is in sub-panels, in the order of CAD's mass
property dialogs (`places.ORDER`).
"""

from __future__ import annotations

from collections.abc import Sequence

from bpy.types import Context, Object, UILayout

from ..blender.read.visibility import measurable
from ..blender.session.displayed import Displayed, Verdict, displayed, shown_objects, total
from ..blender.session.live.following import Lag, current_numbers, is_live
from ..blender.session.stored import outcome
from ..blender.session.tracking import armatures
from ..blender.settings.chosen import chosen_objects
from ..blender.settings.preferences import draw_links
from ..blender.write import properties
from ..blender.write.translations import localized
from ..core.inertia import PlainBody
from ..core.verdict import METHODS, Group, Source, method_key, truncate_list
from ..core.wall import WALL_MEASURED
from . import remedies, rows
from .density import material_row
from .overlay.draw import header_switch
from .places import in_both_places

# by the frame
CENTER_HEADINGS = {
    "WORLD": "Center of Mass (World)",
    "OBJECT": "Center of Mass (Object)",
}
# for rigs
RESTING_HEADINGS = {
    "WORLD": "Center of Mass at Rest (World)",
    "OBJECT": "Center of Mass at Rest (Object)",
}

# prefix for the measured data, before a method
SOURCES = {
    Source.NURBS: "NURBS: {:s}",
    Source.GRID: "Grid: {:s}",
}

LIVE = {
    Lag.NONE: "Live: {milliseconds:.0f} ms, not stored",
    Lag.FIRST_ORDER: "Live: inertia follows when it stops",
    Lag.BEHIND: "Live lags: measuring takes {milliseconds:.0f} ms",
}


class BodyPanel:
    """Mass properties"""

    bl_label = "Body Moments"

    def draw_header_preset(self, context: Context) -> None:
        row = self.layout.row(align=True)
        header_switch(row, context)
        if not rows.is_narrow():  # the name would be below them
            draw_links(row, icons_only=True)

    def draw(self, context: Context) -> None:
        objects = shown_objects(context)
        obj = context.object
        if obj is not None and armatures.stands_for_meshes(obj) or len(objects) > 1:
            _several_objects(self.layout, context)
        else:
            _one_object(self.layout, context, objects[0])


def _one_object(layout: UILayout, context: Context, obj: Object) -> None:
    shown = displayed(obj, context.scene)
    frame = context.scene.body_moments.frame
    _verdict(layout, obj.name, "OBJECT_DATA", None if shown is None else shown.verdict)
    length = properties.optional(obj, "body_length")
    numbers = None if shown is None else shown.in_frame(frame)
    is_rig = obj.type == "ARMATURE" and shown is not None and not shown.is_posed
    density = ""
    if shown is not None and numbers is not None and numbers.mass > 0.0:
        density = _density(numbers, length, "at {:s}, not set" if shown.is_assumed else "at {:s}")
    heading = (RESTING_HEADINGS if is_rig else CENTER_HEADINGS)[frame]
    _answer(layout, numbers, heading, density, length)
    material_row(layout, context)
    _buttons(layout, context)
    state = ""
    icon = ""
    now = current_numbers(obj)
    if shown is not None and shown.reason is not None:
        state = rows.outdated(shown.reason)
        icon = "FILE_REFRESH"
    elif shown is not None and shown.live is not None:
        state = localized(LIVE[shown.lag]).format(milliseconds=1e3 * shown.live.seconds)
        icon = "REC"
    rows.state(layout, state, icon)
    if now is not None and now.refusal is not None and outcome.last() is None:
        rows.message(layout, now.refusal)
    _details(layout, obj, shown, numbers)
    row = layout.column(align=True) if rows.is_narrow() else layout.row(align=True)
    row.menu("VIEW3D_MT_body_moments_copy", icon="COPYDOWN")
    rows.button(row, "object.body_moments_clear", "TRASH")
    findings = () if shown is None else shown.findings
    remedies.notes(layout, "body_moments_notes", findings)
    remedies.lines(layout, context, [Group(found) for found in findings])
    if shown is not None:
        remedies.unit_question(layout, context, obj, shown.world)


def _several_objects(layout: UILayout, context: Context) -> None:
    """Draw the selected objects, or the meshes of a posed armature, as one body."""
    shown = total(context)
    active = context.object
    count = shown.count + len(shown.missing)
    posed = None
    if active is not None and armatures.stands_for_meshes(active):
        posed = displayed(active, context.scene)
        text = localized("{:s}: {:d} Mesh" if count == 1 else "{:s}: {:d} Meshes")
        text = text.format(active.name, count)
    else:
        text = localized("{:d} Objects").format(count)
    is_rest = posed is not None and properties.optional(active, "body_mass") is not None
    _verdict(layout, text, "GROUP", posed.verdict if is_rest else shown.verdict)
    numbers = shown.numbers if posed is None else posed.world
    density = ""
    if numbers is not None:
        template = "at {:s} on average"
        if shown.assumed:
            is_all = shown.assumed == shown.count
            template = "at {:s}, not set" if is_all else "at {:s}, not set: {:d} of {:d}"
        density = _density(numbers, None, template, shown.assumed, count)
    volume = shown.volume if shown.count and not is_rest else None
    _answer(layout, numbers, CENTER_HEADINGS["WORLD"], density, volume=volume)
    material_row(layout, context)
    _buttons(layout, context)
    if is_rest:
        reason = posed.reason
        text = "The mass is that of the rest pose"
        rows.state(
            layout,
            localized(text) if reason is None else rows.outdated(reason),
            "INFO" if reason is None else "FILE_REFRESH",
        )
    else:
        missing = shown.missing if shown.count else ()  # of none the verdict says it
        texts = [
            _outstanding(text, names, count)
            for names, text in ((missing, "Not measured: {:s}"), (shown.stale, "Out of date: {:s}"))
            if names
        ]
        rows.state(layout, "; ".join(texts), "FILE_REFRESH" if texts else "")
    findings, groups = (posed.findings, ()) if is_rest else (shown.findings, shown.groups)
    remedies.lines(layout, context, [*map(Group, findings), *groups])


def _outstanding(template: str, names: Sequence[str], count: int) -> str:
    """Return a text with names, or with how many of `count` they are if they do not fit a row."""
    text = localized(template).format(truncate_list(names, translate=localized))
    if rows.fits(1.0, text):
        return text
    return localized(template).format(localized("{} of {}").format(len(names), count))


def _verdict(layout: UILayout, text: str, icon: str, verdict: Verdict | None) -> None:
    """Draw a translated name, and the verdict on its numbers at the right end."""
    row = layout.row(align=True)
    row.label(text=text, icon=icon, translate=False)
    end = row.row(align=True)
    end.alignment = "RIGHT"
    icon, word = rows.VERDICTS[verdict]
    end.label(text=word, icon=icon)


def _density(numbers: PlainBody, length: float | None, template: str, *counts: int) -> str:
    """Return the density behind a mass, or that nobody has set it."""
    if length:
        text = "{:.4g} kg/m".format(numbers.mass / length)
    else:
        text = rows.scene_units().texts("density", (numbers.density,))[0]
    return localized(template).format(text, *counts)


def _answer(
    layout: UILayout,
    numbers: PlainBody | None,
    heading: str,
    density: str,
    length: float | None = None,
    volume: float | None = None,
) -> None:
    """Draw mass, its density, volume and center, in as many rows before they are known.

    length: of a wire, in place of the volume. volume: of several objects, which is known if they
    have no mass.
    """
    column = layout.column(align=True)
    size = ("Volume", "volume", volume) if length is None else ("Length", "length", length)
    mass = ("Mass", "–", "", "")
    if numbers is not None:
        mass = rows.quantity_cell("Mass", "mass", numbers.mass)
        if length is None and volume is None:
            size = ("Volume", "volume", numbers.volume)
    rows.table(column, [mass])
    rows.right(column, density)
    rows.table(
        column,
        [("Volume", "–", "", "") if numbers is None else rows.quantity_cell(*size)],
    )
    if numbers is not None:
        rows.center(layout, heading, numbers)
        return
    column = layout.column(align=True)
    rows.title(column.row(align=True), heading)
    rows.table(column, [(label, "–", "", "") for label in rows.AXIS_LABELS])


def _buttons(layout: UILayout, context: Context) -> None:
    narrow = rows.is_narrow()
    buttons = layout.column(align=True) if narrow else layout.row(align=True)
    buttons.scale_y = 1.4
    shown = shown_objects(context)
    selected = context.view_layer.objects.selected
    subjects = [obj for obj in armatures.subjects(selected) if measurable(obj)]
    text = "Measure" if not subjects or len(shown) == 1 and subjects == shown else "Measure {:s}"
    name = (
        subjects[0].name if len(subjects) == 1 else localized("{:d} Objects").format(len(subjects))
    )
    measure = {"text": localized(text).format(name), "translate": False}
    rows.button(buttons, "object.body_moments_measure", "PHYSICS", **measure)
    row = buttons.row(align=True)
    short = {"text": ""} if text != "Measure" else {}  # the longer text needs the room
    rows.button(row, "object.body_moments_live", "REC", depress=any(map(is_live, shown)), **short)
    row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")


def _details(
    layout: UILayout, obj: Object, shown: Displayed | None, numbers: PlainBody | None
) -> None:
    """Draw area, density and method; an unknown method, of another version of the add-on, by its
    stored text.
    """
    column = layout.column(align=True)
    if shown is None or numbers is None:
        rows.table(column, [(name, "–", "", "") for name in ("Area", "Density", "Method")])
        return
    if numbers.area:  # neither a wire nor a grid of densities has a surface
        rows.quantities(column, [("Area", "area", numbers.area)])
    if properties.optional(obj, "body_length") is None:
        rows.quantities(column, [("Density", "density", numbers.density)])
    source = properties.density_from(obj)
    if source:
        rows.remark(column, "Mean density, from {cause}", icon="BLANK1", cause=source)
    key = method_key(shown.method, any(found.code == WALL_MEASURED for found in shown.findings))
    origin = (
        Source.POLYGONS if shown.method is None or key == str(shown.method) else shown.method.source
    )
    name = METHODS[key][0] if key in METHODS else properties.method_text(obj).title()
    method = localized(SOURCES.get(origin, "{:s}")).format(localized(name))
    rows.table(column, [("Method", method, "", "")])


class RefusedPanel:
    """Refusals of the last action, below everything that they could move"""

    bl_label = "Refused"

    @classmethod
    def poll(cls, _context: Context) -> bool:
        return outcome.last() is not None

    def draw(self, context: Context) -> None:
        remedies.last_action(self.layout, context)


class ApplyPanel:
    """Use the center of mass and the principal axes in the scene"""

    bl_label = "Apply to Object"

    def draw(self, context: Context) -> None:
        layout = self.layout
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_origin_to_center", "OBJECT_ORIGIN")
        rows.button(column, "object.body_moments_axes_to_principal", "EMPTY_AXIS")
        rows.button(column, "object.body_moments_align_to_world", "ORIENTATION_GLOBAL")
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_add_empty", "OUTLINER_OB_EMPTY")
        rows.button(column, "view3d.body_moments_cursor_to_center", "PIVOT_CURSOR")
        rows.button(column, "object.body_moments_create_orientation", "ORIENTATION_LOCAL")
        row = column.split(factor=0.7, align=True)
        rows.button(row, "object.body_moments_rigid_bodies", "RIGID_BODY").type = "ACTIVE"
        passive = row.operator("object.body_moments_rigid_bodies", text="Passive")
        passive.type = "PASSIVE"
        button = rows.button(column, "object.body_moments_set_rigid_body_mass", "RIGID_BODY")
        button.add = not any(obj.rigid_body for obj in chosen_objects(context))
        rows.button(layout, "object.body_moments_add_nodes", "GEOMETRY_NODES")
        if context.mode == "EDIT_MESH":
            rows.button(layout, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")


VIEW3D_PT_body_moments, OBJECT_PT_body_moments = in_both_places(
    BodyPanel, shown_for=lambda obj: True, of_all=True
)
CLASSES = (
    *(VIEW3D_PT_body_moments, OBJECT_PT_body_moments),
    *in_both_places(ApplyPanel, "apply", shown_for=measurable, of_all=True),
    *in_both_places(RefusedPanel, "refused", options={"HIDE_HEADER"}),
)
