# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings as lines, each with the button of its remedy; the refusals of the last action; the
question of units.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import bpy
from bpy.types import Context, Object, UILayout

from ..blender import write
from ..blender.session import selected, stored
from ..core import inertia, verdict
from . import rows, texts

ICONS = {write.remedies.DEFECTS: "ZOOM_SELECTED", write.remedies.SELECT: "RESTRICT_SELECT_OFF"}
LINE_SHARE = 0.6  # share of a row for the text of a line and its button, beside the icons
MIN_QUESTIONED_LENGTH = 5.0  # m: longer bodies may be meant in millimeters
MIN_QUESTIONED_MASS = 1e5  # kg
QUESTION_DIGITS = 3  # digits of the length and mass in the question


def lines(
    layout: UILayout, context: Context, groups: Sequence[verdict.Group], can_accept: bool = True
) -> None:
    """Draw a line for each group of errors and warnings, with its first remedy; its sentence opens
    on click.
    """
    warnings = [
        group for group in groups if verdict.severity(group.finding) != verdict.Severity.NOTE
    ]
    for group in warnings:
        header, body = layout.panel("body_moments_" + group.finding.code, default_closed=True)
        _line(header, context, group, can_accept)
        if body is None:
            continue
        column = body.column(align=True)
        texts.message(column, _of_objects(group), icon="BLANK1")
        for remedy in _remedies(context, group)[1:]:
            _remedy(column, group, remedy)
    if can_accept and sum(map(_is_acceptable, warnings)) > 1:
        _accept(layout, "", "CHECKMARK", text="Accept All")


def summary(layout: UILayout, context: Context, groups: Sequence[verdict.Group]) -> None:
    """Draw one row, always: the worst of errors and warnings with its first remedy, and the number
    of the others.
    """
    ranks = tuple(texts.ICONS)
    warnings = [
        group for group in groups if verdict.severity(group.finding) != verdict.Severity.NOTE
    ]
    worst = max(
        warnings, key=lambda group: ranks.index(verdict.severity(group.finding)), default=None
    )
    if worst is None:
        texts.state(layout, "")
    else:
        _line(layout.row(align=True), context, worst, further_count=len(warnings) - 1)


def _line(
    row: UILayout,
    context: Context,
    group: verdict.Group,
    can_accept: bool = True,
    further_count: int = 0,
) -> None:
    """Draw the headline of a finding with its first remedy; further_count: of other findings."""
    remedies = _remedies(context, group)
    text = _headline(context, group) + (" (+{:d})".format(further_count) if further_count else "")
    row.label(text=text, icon=texts.ICONS[verdict.severity(group.finding)], translate=False)
    buttons = row.row(align=True)
    buttons.alignment = "RIGHT"
    if remedies:
        _remedy(
            buttons, group, remedies[0], with_text=texts.fits(LINE_SHARE, text + _name(remedies[0]))
        )
    if can_accept and _is_acceptable(group):
        _accept(buttons, group.finding.code, "CHECKMARK")


def _is_acceptable(group: verdict.Group) -> bool:
    return verdict.severity(group.finding) == verdict.Severity.WARNING


def _of_objects(group: verdict.Group) -> verdict.Finding:
    return group.finding.of_sources(group.objects) if group.objects else group.finding


def notes(layout: UILayout, idname: str, groups: Sequence[verdict.Group]) -> None:
    """Draw a sub-panel, closed at first, of notes and accepted warnings.

    It is there without any, so that nothing moves when one comes.
    """
    shown_notes = verdict.of_severity(map(_of_objects, groups), verdict.Severity.NOTE)
    header, body = layout.panel(idname, default_closed=True)
    texts.filled(header, "Notes ({:d})", len(shown_notes))
    for note in shown_notes if body is not None else ():
        row = body.row(align=True)
        texts.message(row, note)
        if note.values.get("accepted"):
            _accept(row, note.code, "LOOP_BACK", accepted=False)


def _headline(context: Context, group: verdict.Group) -> str:
    """Return the first clause of a group's sentence; of several objects, their number and the words
    before a number.
    """
    finding = replace(group.finding, elements=())  # without the indices of elements
    clause = re.split(
        r"\.$|[.;,] | \(",
        write.translations.localized_sentence(finding, context.scene.unit_settings),
    )[0]
    if not group.objects:
        # A sentence may list names after a colon: without them if there is no room.
        return clause if texts.fits(1.0, clause) else clause.partition(": “")[0]
    # In other languages, nouns keep their capitals.
    if bpy.app.translations.locale[:2] in ("", "en"):
        clause = clause[0].lower() + clause[1:]
    if len(group.objects) == 1:
        return "{:s}: {:s}".format(group.objects[0], clause)
    return write.translations.localized("{:d} objects: {:s}").format(
        len(group.objects), clause.partition(":")[0]
    )


def _remedies(context: Context, group: verdict.Group) -> tuple[str, ...]:
    """Return the remedies of a group: those of the shown object, else the selection of the objects
    that the group is about.
    """
    if group.finding.values.get("objects"):
        return (write.remedies.SELECT,)  # a caveat about a total or an assembly
    obj = selected.subject(context)  # a collection may be shown without an object
    if group.objects and (obj is None or group.objects != (obj.name_full,)):
        return (write.remedies.SELECT,)
    return write.remedies.remedies_of(group.finding.code, "" if obj is None else obj.type)


def _name(remedy: str) -> str:
    return write.translations.localized(
        write.remedies.REMEDIES[remedy].name if remedy in write.remedies.REMEDIES else "Select"
    )


def _remedy(layout: UILayout, group: verdict.Group, remedy: str, with_text: bool = True) -> None:
    """Draw the button of a remedy: one of `REMEDIES`, or the idname of an operator."""
    text = _name(remedy) if with_text else ""
    if remedy in write.remedies.REMEDIES:
        button = layout.operator(
            write.remedies.REPAIR,
            text=text,
            icon=write.remedies.REMEDIES[remedy].icon,
            translate=False,
        )
        button.remedy = remedy
        return
    button = layout.operator(remedy, text=text, icon=ICONS[remedy], translate=False)
    if remedy == write.remedies.SELECT:
        button.code = group.finding.code
        listed = group.finding.values.get("objects", ())
        button.listed = "\n".join(
            name if isinstance(name, str) else name[0]  # an operand is listed with its object
            for name in listed
        )


def _accept(layout: UILayout, code: str, icon: str, text: str = "", accepted: bool = True) -> None:
    button = layout.operator("object.body_moments_accept", text=text, icon=icon)
    button.code = code
    button.accepted = accepted


def last_action(layout: UILayout, context: Context) -> None:
    """Draw the refusals of the last action, equal ones of several objects once."""
    last = stored.outcome.last()
    if last is None:
        return
    box = layout.box()
    header = box.row(align=True)
    icon = "NONE" if texts.is_narrow() else "CANCEL"
    texts.sentence(header, write.translations.localized(last.action), icon=icon, boxed=True)
    header.operator("wm.body_moments_dismiss", text="", icon="X", emboss=False)
    column = box.column(align=True)
    for group in last.groups:
        texts.message(column, _of_objects(group), icon="NONE", boxed=True)
        for remedy in _remedies(context, group):
            _remedy(column, group, remedy)


def is_unit_questioned(context: Context, obj: Object, body: inertia.PlainBody) -> bool:
    """Return whether to ask if a unit is a millimeter: until it is answered, of large and heavy
    bodies.
    """
    return (
        not context.scene.body_moments.units_answered
        and context.scene.unit_settings.scale_length == 1.0
        and max(obj.dimensions) >= MIN_QUESTIONED_LENGTH
        and body.mass >= MIN_QUESTIONED_MASS
    )


def unit_question(layout: UILayout, context: Context, obj: Object, body: inertia.PlainBody) -> None:
    """Ask whether a unit of the scene is a millimeter."""
    box = layout.box()
    units = texts.scene_units()._replace(mass="TONNES", digits=QUESTION_DIGITS)
    texts.remark(
        box,
        "{length} long and {mass}: is a unit of this scene a millimeter?",
        icon="QUESTION",
        boxed=True,
        length=units.text("length", max(obj.dimensions)),
        mass=units.text("mass", body.mass),
    )
    column = box.column(align=True)
    rows.button(column, "scene.body_moments_set_millimeters", "DRIVER_DISTANCE")
    column.prop(context.scene.body_moments, "units_answered", toggle=True, icon="X")
