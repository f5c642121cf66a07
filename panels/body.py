# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel: the answer (a verdict, mass, volume and center of mass), the buttons, and then
the findings.

It always has the same rows, so that no button moves: one row shows the first warning; all findings
and the refusals of the last action are below all sub-panels. The rest is in sub-panels, in the
order of CAD's mass property dialogs (`places.ORDER`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from bpy.types import Context, Object, UILayout

from ..blender import read, session, settings, write
from ..blender.session.displayed import Displayed, Verdict, displayed, shown_objects, total
from ..blender.session.live.following import Lag
from ..core import inertia, wall
from ..core.verdict import METHODS, Group, Source, method_key, truncate_list
from . import places, remedies, rows, texts
from .density import material_row
from .overlay.draw import header_switch

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


class Answer(NamedTuple):
    """The displayed numbers of one object, or of the selected objects as one body.

    size: label, quantity and SI value of a volume, or of the length of a wire. state: the row about
    the state of the numbers, and its icon. groups: of findings.
    """

    name: str
    icon: str
    verdict: Verdict | None
    numbers: inertia.PlainBody | None
    heading: str
    density: str
    size: tuple[str, str, float | None]
    state: tuple[str, str]
    method: str
    groups: Sequence[Group]


class BodyPanel:
    """Mass properties"""

    bl_label = "Body Moments"

    def draw_header_preset(self, context: Context) -> None:
        row = self.layout.row(align=True)
        header_switch(row, context)
        if not texts.is_narrow():  # the links would cover the panel's name
            settings.preferences.draw_links(row, icons_only=True)

    def draw(self, context: Context) -> None:
        layout = self.layout
        answer = _answer(context)
        row = layout.row(align=True)
        row.label(text=answer.name, icon=answer.icon, translate=False)
        icon, word = rows.VERDICTS[answer.verdict]
        rows.right(row).label(text=word, icon=icon)
        _quantities(layout, answer)
        material_row(layout, context)
        _buttons(layout, context)
        column = layout.column(align=True)
        state = answer.state
        if not state[0] and _questioned(context) is not None:
            state = (
                write.translations.localized("Is a unit of this scene a millimeter?"),
                "QUESTION",
            )
        texts.state(column, *state)
        remedies.summary(column, context, answer.groups)
        area = None
        density = None
        if answer.numbers is not None:
            area = answer.numbers.area or None  # neither a wire nor a grid has a surface
            _label, quantity, _si = answer.size
            density = None if quantity == "length" else answer.numbers.density
        column = layout.column(align=True)
        rows.quantities(column, [("Area", "area", area), ("Density", "density", density)])
        rows.table(column, [("Method", answer.method or "–", "", "")])
        row = layout.column(align=True) if texts.is_narrow() else layout.row(align=True)
        row.menu("VIEW3D_MT_body_moments_copy", icon="COPYDOWN")
        rows.button(row, "object.body_moments_clear", "TRASH")


def _answer(context: Context) -> Answer:
    objects = shown_objects(context)
    obj = context.object
    is_sum = (
        len(objects) > 1 or obj is not None and session.tracking.armatures.stands_for_meshes(obj)
    )
    return _of_several(context) if is_sum else _of_one(context, objects[0])


def _of_one(context: Context, obj: Object) -> Answer:
    displayed_body = displayed(obj, context.scene)
    frame = context.scene.body_moments.frame
    length = write.properties.optional(obj, "body_length")
    numbers = None if displayed_body is None else displayed_body.in_frame(frame)
    is_rig = obj.type == "ARMATURE" and displayed_body is not None and not displayed_body.is_posed
    size = ("Volume", "volume", None if numbers is None else numbers.volume)
    density = ""
    if numbers is not None and numbers.mass > 0.0:
        density = _density(
            numbers, length, "at {:s}, not set" if displayed_body.is_assumed else "at {:s}"
        )
    state = ("", "")
    if displayed_body is not None and displayed_body.reason is not None:
        state = texts.outdated(displayed_body.reason), "FILE_REFRESH"
    elif displayed_body is not None and displayed_body.live is not None:
        live = write.translations.localized(LIVE[displayed_body.lag]).format(
            milliseconds=1e3 * displayed_body.live.seconds
        )
        state = live, "REC"
    findings = () if displayed_body is None else displayed_body.findings
    followed = session.memory.followed.get(obj)
    is_refused = followed is not None and followed.refusal is not None
    if is_refused and session.stored.outcome.last() is None:  # else the last action names it
        findings = followed.refusal, *findings
    return Answer(
        name=obj.name,
        icon="OBJECT_DATA",
        verdict=None if displayed_body is None else displayed_body.verdict,
        numbers=numbers,
        heading=(RESTING_HEADINGS if is_rig else CENTER_HEADINGS)[frame],
        density=density,
        size=size if length is None else ("Length", "length", length),
        state=state,
        method="" if displayed_body is None else _method(obj, displayed_body),
        groups=[Group(finding) for finding in findings],
    )


def _of_several(context: Context) -> Answer:
    # The objects may be the meshes of a posed armature.
    displayed_total = total(context)
    active = context.object
    count = displayed_total.count + len(displayed_total.missing)
    posed = None
    if active is not None and session.tracking.armatures.stands_for_meshes(active):
        posed = displayed(active, context.scene)
        name = write.translations.localized(
            "{:s}: {:d} Mesh" if count == 1 else "{:s}: {:d} Meshes"
        )
        name = name.format(active.name, count)
    else:
        name = write.translations.localized("{:d} Objects").format(count)
    is_rest = posed is not None and write.properties.optional(active, "body_mass") is not None
    numbers = displayed_total.numbers if posed is None else posed.world
    density = ""
    if numbers is not None:
        template = "at {:s} on average"
        if displayed_total.assumed:
            is_all = displayed_total.assumed == displayed_total.count
            template = "at {:s}, not set" if is_all else "at {:s}, not set: {:d} of {:d}"
        density = _density(numbers, None, template, displayed_total.assumed, count)
    volume = None if numbers is None else numbers.volume
    if is_rest:
        state = (
            texts.outdated(posed.reason)
            if posed.reason
            else write.translations.localized("The mass is that of the rest pose")
        )
        icon = "FILE_REFRESH" if posed.reason else "INFO"
    else:
        volume = displayed_total.volume if displayed_total.count else volume
        # If no object is measured, the verdict says so.
        missing = displayed_total.missing if displayed_total.count else ()
        outstanding = [
            _outstanding(text, names, count)
            for names, text in (
                (missing, "Not measured: {:s}"),
                (displayed_total.stale, "Out of date: {:s}"),
            )
            if names
        ]
        state = "; ".join(outstanding)
        icon = "FILE_REFRESH" if outstanding else ""
    return Answer(
        name=name,
        icon="GROUP",
        verdict=posed.verdict if is_rest else displayed_total.verdict,
        numbers=numbers,
        heading=CENTER_HEADINGS["WORLD"],
        density=density,
        size=("Volume", "volume", volume),
        state=(state, icon),
        method="",
        groups=[*map(Group, posed.findings)]
        if is_rest
        else [*map(Group, displayed_total.findings), *displayed_total.groups],
    )


def _outstanding(template: str, names: Sequence[str], count: int) -> str:
    """Return a text with names, or with how many of `count` they are if they do not fit a row."""
    text = write.translations.localized(template).format(
        truncate_list(names, translate=write.translations.localized)
    )
    if texts.fits(1.0, text):
        return text
    return write.translations.localized(template).format(
        write.translations.localized("{} of {}").format(len(names), count)
    )


def _density(numbers: inertia.PlainBody, length: float | None, template: str, *counts: int) -> str:
    """Return a template filled with the mean density, or with mass per length, and then `counts`.

    length: in m, of a wire.
    """
    if length:
        text = "{:.4g} kg/m".format(numbers.mass / length)
    else:
        text = texts.scene_units().texts("density", (numbers.density,))[0]
    return write.translations.localized(template).format(text, *counts)


def _quantities(layout: UILayout, answer: Answer) -> None:
    """Draw mass, its density, volume and center, in as many rows before they are known."""
    column = layout.column(align=True)
    mass = None if answer.numbers is None else answer.numbers.mass
    rows.quantities(column, [("Mass", "mass", mass)])
    rows.right(column, answer.density)
    rows.quantities(column, [answer.size])
    rows.center(layout, answer.heading, answer.numbers)


def _buttons(layout: UILayout, context: Context) -> None:
    narrow = texts.is_narrow()
    buttons = layout.column(align=True) if narrow else layout.row(align=True)
    buttons.scale_y = 1.4
    objects = shown_objects(context)
    selected = context.view_layer.objects.selected
    subjects = [
        obj
        for obj in session.tracking.armatures.subjects(selected)
        if read.visibility.measurable(obj)
    ]
    text = (
        "Measure" if not subjects or len(objects) == 1 and subjects == objects else "Measure {:s}"
    )
    name = (
        subjects[0].name
        if len(subjects) == 1
        else write.translations.localized("{:d} Objects").format(len(subjects))
    )
    measure = {"text": write.translations.localized(text).format(name), "translate": False}
    rows.button(buttons, "object.body_moments_measure", "PHYSICS", **measure)
    row = buttons.row(align=True)
    short = {"text": ""} if text != "Measure" else {}  # the longer text needs the room
    is_live = any(obj in session.memory.followed for obj in objects)
    rows.button(row, "object.body_moments_live", "REC", depress=is_live, **short)
    row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")


def _method(obj: Object, displayed_body: Displayed) -> str:
    """Return the method; an unknown one, of another version of the add-on, by its stored text."""
    key = method_key(
        displayed_body.method,
        any(finding.code == wall.WALL_MEASURED for finding in displayed_body.findings),
    )
    # The name of a method with a key of its own says what was measured.
    origin = (
        Source.POLYGONS
        if displayed_body.method is None or key == str(displayed_body.method)
        else displayed_body.method.source
    )
    name = METHODS[key][0] if key in METHODS else write.properties.method_text(obj).title()
    return write.translations.localized(SOURCES.get(origin, "{:s}")).format(
        write.translations.localized(name)
    )


class FindingsPanel:
    """Warnings, notes and questions, below everything that they could move"""

    bl_label = "Findings"

    def draw(self, context: Context) -> None:
        layout = self.layout
        groups = _answer(context).groups
        remedies.lines(layout, context, groups)
        if questioned := _questioned(context):
            remedies.unit_question(layout, context, *questioned)
        remedies.notes(layout, "body_moments_notes", groups)
        objects = shown_objects(context)
        source = write.properties.density_from(objects[0]) if len(objects) == 1 else ""
        if source:
            texts.remark(layout, "Mean density, from {cause}", icon="BLANK1", cause=source)


def _questioned(context: Context) -> tuple[Object, inertia.PlainBody] | None:
    """Return the object and its numbers if they raise the question of units."""
    objects = shown_objects(context)
    displayed_body = displayed(objects[0], context.scene) if len(objects) == 1 else None
    if displayed_body is None or not remedies.is_unit_questioned(
        context, objects[0], displayed_body.world
    ):
        return None
    return objects[0], displayed_body.world


class RefusedPanel:
    """Refusals of the last action, below everything that they could move"""

    bl_label = "Refused"

    @classmethod
    def poll(cls, _context: Context) -> bool:
        return session.stored.outcome.last() is not None

    def draw(self, context: Context) -> None:
        remedies.last_action(self.layout, context)


class ApplyPanel:
    """Use the center of mass and the principal axes in the scene"""

    bl_label = "Apply to Object"

    def draw(self, context: Context) -> None:
        layout = self.layout
        rows.buttons(
            layout,
            ("object.body_moments_origin_to_center", "OBJECT_ORIGIN"),
            ("object.body_moments_axes_to_principal", "EMPTY_AXIS"),
            ("object.body_moments_align_to_world", "ORIENTATION_GLOBAL"),
        )
        column = rows.buttons(
            layout,
            ("object.body_moments_add_empty", "OUTLINER_OB_EMPTY"),
            ("view3d.body_moments_cursor_to_center", "PIVOT_CURSOR"),
            ("object.body_moments_create_orientation", "ORIENTATION_LOCAL"),
        )
        row = column.split(factor=0.7, align=True)
        rows.button(row, "object.body_moments_rigid_bodies", "RIGID_BODY").type = "ACTIVE"
        passive = row.operator("object.body_moments_rigid_bodies", text="Passive")
        passive.type = "PASSIVE"
        button = rows.button(column, "object.body_moments_set_rigid_body_mass", "RIGID_BODY")
        button.add = not any(obj.rigid_body for obj in settings.chosen.chosen_objects(context))
        rows.button(layout, "object.body_moments_add_nodes", "GEOMETRY_NODES")
        rows.button(layout, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")


VIEW3D_PT_body_moments, OBJECT_PT_body_moments = places.in_both_places(
    BodyPanel, shown_for=lambda obj: True, for_any=True
)
CLASSES = (
    *places.in_both_places(ApplyPanel, "apply", shown_for=read.visibility.measurable, for_any=True),
    *places.in_both_places(
        FindingsPanel, "findings", options=frozenset(), shown_for=lambda obj: True, for_any=True
    ),
    *places.in_both_places(RefusedPanel, "refused", options={"HIDE_HEADER"}),
)
