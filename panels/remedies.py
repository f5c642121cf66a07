# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Warnings right under the verdict, each with the buttons that apply its remedy or accept it.

The refusals of the last action, and the question whether a unit is a millimeter, are here too.
"""

from __future__ import annotations

from collections.abc import Sequence

from bpy.types import Context, UILayout

from ..blender.session.stored import outcome
from ..blender.write.remedies import DEFECTS, OUTSIDE, SHELL, UNION, remedies_of
from ..blender.write.translations import localized
from ..blender.write.units import Units
from ..core.inertia.plain_body import PlainBody
from ..core.verdict.finding import Finding, Severity, truncate
from ..core.verdict.sentences import of_severity, severity
from ..operators.findings import RIGID_BODY_CENTER_ELSEWHERE
from . import rows

AXES = "object.body_moments_axes_to_principal"
ICONS = {
    UNION: "MOD_BOOLEAN",
    OUTSIDE: "NORMALS_FACE",
    DEFECTS: "ZOOM_SELECTED",
    SHELL: "MOD_SOLIDIFY",
    AXES: "EMPTY_AXIS",
}
MAX_SHOWN = 8  # limit for refusals of the last action
MIN_QUESTIONED_LENGTH = 5.0  # m: longer bodies may be meant in millimeters
MIN_QUESTIONED_MASS = 1e5  # kg
QUESTION_DIGITS = 3


def warnings(
    layout: UILayout, context: Context, idname: str, findings: Sequence[Finding], can_accept: bool = True
) -> None:
    """Draw a sub-panel, open at first, of any errors and warnings; errors first."""
    alarming = [*of_severity(findings, Severity.ERROR), *of_severity(findings, Severity.WARNING)]
    if not alarming:
        return
    header, body = layout.panel(idname)
    rows.filled(header, "Warnings ({:d})", len(alarming))
    for shown in alarming if body is not None else ():
        column = body.column(align=True)
        rows.message(column, context, shown)
        remedies(column, context, shown)
        if can_accept and severity(shown) == Severity.WARNING:
            _accept(column, context, shown, accepted=True)


def notes(layout: UILayout, context: Context, idname: str, findings: Sequence[Finding]) -> None:
    """Draw a sub-panel, closed at first, of notes and accepted warnings."""
    shown_notes = of_severity(findings, Severity.NOTE)
    if not shown_notes:
        return
    header, body = layout.panel(idname, default_closed=True)
    rows.filled(header, "Notes ({:d})", len(shown_notes))
    for shown in shown_notes if body is not None else ():
        row = body.row(align=True)
        rows.message(row, context, shown)
        if shown.values.get("accepted"):
            _accept(row, context, shown, accepted=False)


def remedies(layout: UILayout, context: Context, shown: Finding) -> None:
    """Draw the buttons that carry out the advice of a finding."""
    kind = "" if context.object is None else context.object.type  # a collection may be shown without an object
    idnames = (AXES,) if shown.code == RIGID_BODY_CENTER_ELSEWHERE else remedies_of(shown.code, kind)
    for idname in idnames:
        rows.button(layout, context, idname, ICONS[idname])


def _accept(layout: UILayout, context: Context, shown: Finding, accepted: bool) -> None:
    if accepted:
        button = rows.button(layout, context, "object.body_moments_accept", "CHECKMARK", text="Accept")
    else:
        button = layout.operator("object.body_moments_accept", text="", icon="LOOP_BACK")
    button.code = shown.code
    button.accepted = accepted


def last_action(layout: UILayout, context: Context) -> None:
    """Draw the refusals and warnings of the last action, until the next one."""
    last = outcome.last()
    if last is None:
        return
    box = layout.box()
    header = box.row(align=True)
    icon = "NONE" if rows.is_narrow(context) else "ERROR"
    rows.sentence(header, context, localized(last.action), icon=icon, boxed=True)
    header.operator("wm.body_moments_dismiss", text="", icon="X", emboss=False)
    column = box.column(align=True)
    shown, more = truncate(last.findings, MAX_SHOWN)
    for refused in shown:
        rows.message(column, context, refused, icon="NONE", boxed=True)
        remedies(column, context, refused)
    if more:
        rows.filled(column, "And {:d} more", more)
    if len(last.objects) > 1 or last.objects and last.objects[0] != context.object.name_full:
        rows.button(box, context, "object.body_moments_select_refused", "RESTRICT_SELECT_OFF")


def unit_question(layout: UILayout, context: Context, shown: PlainBody) -> None:
    """Ask, until it is answered for the scene, whether a unit is a millimeter, if the body is large and heavy."""
    scene, length = context.scene, max(context.object.dimensions)
    if (
        scene.body_moments.units_answered
        or scene.unit_settings.scale_length != 1.0
        or length < MIN_QUESTIONED_LENGTH
        or shown.mass < MIN_QUESTIONED_MASS
    ):
        return
    box = layout.box()
    units = Units.from_settings(scene.unit_settings)._replace(mass="TONNES", digits=QUESTION_DIGITS)
    texts = {"length": units.text("length", length), "mass": units.text("mass", shown.mass)}
    question = "{length} long and {mass}: is a unit of this scene a millimeter?"
    rows.remark(box, context, question, icon="QUESTION", boxed=True, **texts)
    column = box.column(align=True)
    rows.button(column, context, "scene.body_moments_set_millimeters", "DRIVER_DISTANCE")
    rows.button(column, context, "scene.body_moments_keep_units", "X")
