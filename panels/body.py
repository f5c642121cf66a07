# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel: the answer (a verdict, mass, volume and center of mass), the buttons, and then
the findings.

Nothing that comes and goes stands above a button: refusals of the last action are below all
sub-panels. The rest is in sub-panels, in the order of CAD's mass property dialogs (`places.ORDER`).
"""

from __future__ import annotations

from bpy.types import Context, UILayout

from ..blender.read.visibility import measurable
from ..blender.session.displayed import Displayed, Total, Verdict, displayed, shown_objects, total
from ..blender.session.live.following import Lag, current_numbers, is_live
from ..blender.session.stored import outcome
from ..blender.session.tracking import armatures
from ..blender.settings.preferences import draw_links
from ..blender.write import properties
from ..blender.write.translations import localized
from ..core.inertia.plain_body import PlainBody
from ..core.verdict.method import Source
from ..core.verdict.sentences import METHODS, Group, method_key
from ..core.wall.findings import WALL_MEASURED
from . import remedies, rows
from .density import material_row
from .overlay.draw import header_switch
from .places import in_both_places

CENTER_HEADINGS = {
    "WORLD": "Center of Mass (World)",
    "OBJECT": "Center of Mass (Object)",
}  # by the frame
RESTING_HEADINGS = {
    "WORLD": "Center of Mass at Rest (World)",
    "OBJECT": "Center of Mass at Rest (Object)",
}  # for rigs

SOURCES = {
    Source.NURBS: "NURBS: {:s}",
    Source.GRID: "Grid: {:s}",
}  # prefix for the measured data, before a method

LIVE = {
    Lag.NONE: "Live ({milliseconds:.0f} ms). Press Measure to store",
    Lag.FIRST_ORDER: (
        "Live: mass, volume and center of this frame; inertia follows when it stops "
        "({milliseconds:.0f} ms)"
    ),
    Lag.BEHIND: "Live lags: measuring takes {milliseconds:.0f} ms, and waits until the edit stops",
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
        if shown_objects(context) == [context.object]:
            _one_object(self.layout, context, displayed(context.object, context.scene))
        else:
            _several_objects(self.layout, context, total(context))


def _one_object(layout: UILayout, context: Context, shown: Displayed | None) -> None:
    obj = context.object
    frame = context.scene.body_moments.frame
    _verdict(layout, obj.name, "OBJECT_DATA", None if shown is None else shown.verdict)
    length = properties.optional(obj, "body_length")
    numbers = None if shown is None else shown.in_frame(frame)
    is_rig = obj.type == "ARMATURE" and shown is not None and not shown.is_posed
    _answer(layout, numbers, (RESTING_HEADINGS if is_rig else CENTER_HEADINGS)[frame], length)
    material_row(layout, context, obj)
    _buttons(layout, context)
    now = current_numbers(obj)
    if now is not None and now.refusal is not None and outcome.last() is None:
        rows.message(layout, now.refusal)
    if shown is None or numbers is None:
        return
    if shown.live is not None and shown.reason is None:
        rows.remark(layout, LIVE[shown.lag], icon="REC", milliseconds=1e3 * shown.live.seconds)
    rows.stale_row(layout, shown.reason)
    remedies.unit_question(layout, context, shown.world)
    remedies.lines(layout, context, [Group(found) for found in shown.findings])
    _details(layout, context, shown, numbers)
    row = layout.column(align=True) if rows.is_narrow() else layout.row(align=True)
    row.menu("VIEW3D_MT_body_moments_copy", icon="COPYDOWN")
    rows.button(row, "object.body_moments_clear", "TRASH")
    remedies.notes(layout, "body_moments_notes", shown.findings)


def _several_objects(layout: UILayout, context: Context, shown: Total) -> None:
    """Draw the selected objects, or the meshes of a posed armature, as one body."""
    count = shown.count + len(shown.missing)
    if armatures.stands_for_meshes(context.object):
        text = localized("{:s}: {:d} Mesh" if count == 1 else "{:s}: {:d} Meshes").format(
            context.object.name, count
        )
    else:
        text = localized("1 Object" if count == 1 else "{:d} Objects").format(count)
    posed = (
        displayed(context.object, context.scene)
        if armatures.stands_for_meshes(context.object)
        else None
    )
    is_rest = posed is not None and properties.optional(context.object, "body_mass") is not None
    _verdict(layout, text, "GROUP", posed.verdict if is_rest else shown.verdict)
    numbers = shown.numbers if posed is None else posed.world
    _answer(
        layout,
        numbers,
        CENTER_HEADINGS["WORLD"],
        volume=shown.volume if shown.count and not is_rest else None,
    )
    material_row(layout, context, context.object)
    _buttons(layout, context)
    if is_rest:
        rows.remark(layout, "The mass is that of the rest pose")
        rows.stale_row(layout, posed.reason)
    unmeasured = shown.missing if shown.count else ()  # of none the verdict says it
    for names, text in (
        (unmeasured, "Not measured: {objects}"),
        (shown.stale, "Out of date: {objects}"),
    ):
        if names and not is_rest:
            rows.remark(layout, text, icon="FILE_REFRESH", objects=names)
    findings, groups = (posed.findings, ()) if is_rest else (shown.findings, shown.groups)
    remedies.lines(layout, context, [*map(Group, findings), *groups])


def _verdict(layout: UILayout, text: str, icon: str, verdict: Verdict | None) -> None:
    """Draw a translated name, and the verdict on its numbers at the right end."""
    row = layout.row(align=True)
    row.label(text=text, icon=icon, translate=False)
    end = row.row(align=True)
    end.alignment = "RIGHT"
    icon, word = rows.VERDICTS[verdict]
    end.label(text=word, icon=icon)


def _answer(
    layout: UILayout,
    numbers: PlainBody | None,
    heading: str,
    length: float | None = None,
    volume: float | None = None,
) -> None:
    """Draw mass, volume and center, in as many rows before they are known. length: of a wire, in
    place of the volume.

    volume: of several objects, which is known if they have no mass.
    """
    column = layout.column(align=True)
    if numbers is None:
        rows.table(column, [("Mass", "–", "", ""), ("Volume", "–", "", "")])
        column = layout.column(align=True)
        rows.title(column.row(align=True), heading)
        rows.table(column, [(label, "–", "", "") for label in rows.AXIS_LABELS])
        return
    size = ("Volume", "volume", numbers.volume if volume is None else volume)
    rows.quantities(
        column,
        [("Mass", "mass", numbers.mass), size if length is None else ("Length", "length", length)],
    )
    rows.center(layout, heading, numbers)


def _buttons(layout: UILayout, context: Context) -> None:
    narrow = rows.is_narrow()
    buttons = layout.column(align=True) if narrow else layout.row(align=True)
    buttons.scale_y = 1.4
    subjects = [obj for obj in armatures.subjects(context.selected_objects) if measurable(obj)]
    text = "Measure" if subjects == [context.object] or not subjects else "Measure {:s}"
    name = (
        subjects[0].name if len(subjects) == 1 else localized("{:d} Objects").format(len(subjects))
    )
    measure = {"text": localized(text).format(name), "translate": False}
    rows.button(buttons, "object.body_moments_measure", "PHYSICS", **measure)
    row = buttons.row(align=True)
    followed = any(is_live(subject) for subject in armatures.subjects([context.object]))
    short = {"text": ""} if text != "Measure" else {}  # the longer text needs the room
    rows.button(row, "object.body_moments_live", "REC", depress=followed, **short)
    row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")


def _details(layout: UILayout, context: Context, shown: Displayed, numbers: PlainBody) -> None:
    """Draw area, density and method; an unknown method, of another version of the add-on, by its
    stored text.
    """
    obj = context.object
    column = layout.column(align=True)
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
        layout, obj = self.layout, context.object
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_origin_to_center", "OBJECT_ORIGIN")
        rows.button(column, "object.body_moments_axes_to_principal", "EMPTY_AXIS")
        rows.button(column, "object.body_moments_align_to_world", "ORIENTATION_GLOBAL")
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_add_empty", "OUTLINER_OB_EMPTY")
        rows.button(column, "view3d.body_moments_cursor_to_center", "PIVOT_CURSOR")
        rows.button(column, "object.body_moments_create_orientation", "ORIENTATION_LOCAL")
        rows.button(column, "object.body_moments_rigid_bodies", "RIGID_BODY")
        button = rows.button(column, "object.body_moments_set_rigid_body_mass", "RIGID_BODY")
        button.add = not obj.rigid_body
        rows.button(layout, "object.body_moments_add_nodes", "GEOMETRY_NODES")
        if context.mode == "EDIT_MESH":
            rows.button(layout, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")


VIEW3D_PT_body_moments, OBJECT_PT_body_moments = in_both_places(
    BodyPanel, shown_for=lambda obj: True
)
CLASSES = (
    *(VIEW3D_PT_body_moments, OBJECT_PT_body_moments),
    *in_both_places(ApplyPanel, "apply", shown_for=measurable),
    *in_both_places(RefusedPanel, "refused", options={"HIDE_HEADER"}),
)
