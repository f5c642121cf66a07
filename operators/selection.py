# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of all operators: choice of objects, polls with reasons, refusals, progress, one
report a run.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Sequence
from functools import wraps
from pathlib import Path
from typing import Any

import bpy
from bpy.types import Context, Object, Operator, UILayout

from .. import core
from ..blender import read, scene, settings, write
from ..blender.session import selected, stored, tracking
from ..core.verdict import FileError, Finding, MeasureError, Severity, system_reason

NO_FILE = "No file is named. Choose one."
NO_RESULTS = "The selected objects have no results"
MAX_OBJECTS_WITHOUT_REDRAW = 4  # so many objects are measured before the window is drawn again


def selected_measurable(context: Context) -> list[Object]:
    """Return the measurable selected objects, parents before children; the meshes of posed
    armatures in their place.

    Works in background too. A scene that is used for the first time gets its defaults.
    """
    settings.preferences.copy_defaults(context.scene)
    objects = [
        obj
        for obj in tracking.armatures.subjects(context.view_layer.objects.selected)
        if read.visibility.measurable(obj)
    ]
    return sorted(objects, key=lambda obj: len([*scene.changes.ancestors(obj)]))


def poll_object_mode(cls: type[Operator], context: Context) -> bool:
    """Return whether Blender is in Object Mode; if not, set the reason that the disabled button
    shows.
    """
    return context.mode == "OBJECT" or write.reports.unavailable(cls, "Switch to Object Mode")


class InObjectMode:
    """Base of operators that need Object Mode."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_object_mode(cls, context)


class OnSelection:
    """Base of operators that need selected objects, in any mode."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        return bool(context.view_layer.objects.selected) or write.reports.unavailable(
            cls, "Select objects"
        )


class OnSelectionInObjectMode(OnSelection):
    """Base of operators that need selected objects in Object Mode."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_object_mode(cls, context) and super().poll(context)


class OnSubject:
    """Base of operators on the object that the panel is about.

    `_change` does the work; its refusals are reported with the object's name. NEEDED: the reason of
    a disabled button.
    """

    NEEDED = "Make a measurable object active"
    _change: Callable[[Context, Object], set[str]]

    @classmethod
    def suits(cls, obj: Object) -> bool:
        """Return whether the operator works on an object."""
        return read.visibility.measurable(obj)

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = selected.subject(context)
        return obj is not None and cls.suits(obj) or write.reports.unavailable(cls, cls.NEEDED)

    def execute(self, context: Context) -> set[str]:
        obj = selected.subject(context)
        assert obj is not None  # by `poll`
        try:
            return self._change(context, obj)
        except MeasureError as refusal:
            return refuse(self, write.reports.failure(obj.name_full, refusal))


def draw_properties(operator: Operator, *names: str) -> UILayout:
    """Draw properties of an operator, one below the other, and return their column."""
    column = operator.layout.column()
    column.use_property_split = True
    for name in names:
        column.prop(operator, name)
    return column


def select_only(context: Context, objects: Collection[Object], active: Object) -> None:
    """Select these objects and no others, and make one active."""
    for obj in context.view_layer.objects:
        obj.select_set(obj in objects)
    context.view_layer.objects.active = active


def redraw(context: Context) -> None:
    """Let Blender redraw the window, if there is one: stored results show in several of its
    areas.
    """
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


def report(operator: Operator, *parts: Finding | str, level: Severity = Severity.NOTE) -> set[str]:
    """Report all parts in one message, redraw, and return the result of `execute`.

    Refusals and warnings stay in the panel until the next action.
    """
    texts = [part for part in parts if isinstance(part, str)]
    findings = [part for part in parts if not isinstance(part, str)]
    return finish(operator, texts, findings=findings, level=level)


def refuse(operator: Operator, reason: MeasureError | Finding | str, **values: Any) -> set[str]:
    """Report why an operator does nothing, and return the result of `execute`. values: fill a
    reason that is an English text.
    """
    if isinstance(reason, str):
        report(operator, write.reports.phrase(reason, **values), level=Severity.ERROR)
    else:
        report(
            operator, write.reports.refusal(reason) if isinstance(reason, MeasureError) else reason
        )
    return {"CANCELLED"}


def report_refusals(
    execute: Callable[[Operator, Context], set[str]],
) -> Callable[[Operator, Context], set[str]]:
    """Decorate `execute`: a refusal is reported, and cancels the operator."""

    @wraps(execute)
    def run(self: Operator, context: Context) -> set[str]:
        return reporting(self, execute, self, context)

    return run


def reporting(operator: Operator, run: Callable[..., set[str]], *arguments: object) -> set[str]:
    """Return the result of a part of an operator; a refusal is reported, and cancels the
    operator.
    """
    try:
        return run(*arguments)
    except MeasureError as error:
        return refuse(operator, error)
    except write.reports.Refused as error:
        return refuse(operator, error.text, **error.values)


def summarize(
    operator: Operator,
    changed: int,
    total: int,
    summary: str,
    failures: Sequence[Finding] = (),
    findings: Sequence[Finding | str] = (),
    idle: str | None = None,
    nothing: str = "Nothing selected can be measured",
) -> set[str]:
    """Report the run once, redraw, and return the result of `execute`.

    All failures and warnings stay in the panel until the next action.

    summary: the report on the action, which changed `changed` of `total` objects. failures: the
    reasons for objects left unchanged. findings: other observations. idle: the reason if nothing
    had to be done. `summary` and `idle` are translated already. nothing: the English text if there
    are no objects.
    """
    if not total:
        summary = write.reports.phrase(nothing)
    elif not changed and not failures and idle is not None:
        summary = write.reports.phrase("Nothing to do: {cause}", cause=idle)
    parts = [summary] if changed or not failures else []
    if failures:
        parts.append(
            write.reports.phrase(
                "{count} of {total} left unchanged:", count=len(failures), total=total
            )
        )
    return finish(operator, parts, failures, findings, is_changed=bool(changed))


def finish(
    operator: Operator,
    texts: Sequence[str],
    failures: Sequence[Finding] = (),
    findings: Sequence[Finding | str] = (),
    level: Severity = Severity.NOTE,
    is_changed: bool = True,
) -> set[str]:
    """Report texts, and the first of the failures and findings, redraw, and return the result of
    `execute`.
    """
    stored.outcome.remember(
        operator.bl_label, [part for part in (*failures, *findings) if isinstance(part, Finding)]
    )
    redraw(bpy.context)
    write.reports.report(
        operator,
        *texts,
        *write.reports.first(failures),
        *write.reports.first(findings),
        level=level,
    )
    return {"FINISHED"} if is_changed else {"CANCELLED"}


def iterate_objects(
    objects: Iterable[Object],
    action: Callable[[Object], Iterator[float] | None],
    failures: list[Finding],
) -> Generator[float, None, None]:
    """Run `action` on one object after the other, and yield the number of completed objects.

    `action` does the work, or returns an iterator that does it in steps and yields its completed
    share. Refusals and failures are added to `failures`: none of them ends the work on the other
    objects.
    """
    for completed, obj in enumerate(objects, 1):
        try:
            for share in action(obj) or ():
                yield completed - 1 + share
        except Exception as error:
            # objects of two libraries may have one name
            failures.append(write.reports.failure(obj.name_full, error))
        yield completed


def name_warned(names: Sequence[str]) -> list[str]:
    """Return a list of one text, which names the objects with warnings; [] if there are none."""
    return (
        [write.reports.phrase("{count} with warnings: {objects}", count=len(names), objects=names)]
        if names
        else []
    )


def change_all(
    operator: Operator,
    objects: Sequence[Object],
    action: Callable[[Object], bool | None],
    summary_texts: tuple[str, str],
    idle: str | None = None,
    findings: Sequence[Finding | str] = (),
    nothing: str = "Nothing selected can be measured",
    then: Callable[[list[Object]], None] = lambda changed: None,
    **values: Any,
) -> set[str]:
    """Run `action` on each object, report the run once, and return the result of `execute`.

    summary_texts: the English report, for one object and for `count` objects. idle: the English
    reason if nothing had to be done. findings: other observations, to which `action` may add.
    then: gets the changed objects. values: of the texts.
    """
    changed, failures = apply_to_all(objects, action)
    then(changed)
    text = write.reports.phrase(*summary_texts, count=len(changed), **values)
    reason = idle and write.reports.phrase(idle, **values)
    return summarize(
        operator, len(changed), len(objects), text, failures, findings, reason, nothing
    )


def apply_to_all(
    objects: Sequence[Object], action: Callable[[Object], bool | None]
) -> tuple[list[Object], list[Finding]]:
    """Run `action` on each object.

    Return the objects for which it returned True or None, and the reasons for refusals and
    failures.
    """
    changed: list[Object] = []
    failures: list[Finding] = []

    def run(obj: Object) -> None:
        is_changed = action(obj)
        if is_changed is None or is_changed:
            changed.append(obj)

    with write.reports.progress(len(objects)) as step:
        for completed in iterate_objects(objects, run, failures):
            step(completed)
    return changed, failures


def write_file(path: Path, pieces: Iterable[str | bytes]) -> None:
    """Write a file, whole or not at all. Raise FileError if it cannot be written."""
    try:
        with core.files.whole_file.whole_file(path) as file:
            file.writelines(
                piece if isinstance(piece, bytes) else piece.encode() for piece in pieces
            )
    except OSError as error:
        raise FileError(
            write.findings.FILE_NOT_WRITTEN, file=path.name, error=system_reason(error)
        ) from error
