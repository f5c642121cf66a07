# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of all operators: choice of objects, polls with reasons, refusals, progress, one
report a run.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Sequence
from functools import wraps
from os.path import basename, splitext
from pathlib import Path
from typing import Any

import bpy
from bpy.types import Context, Object, Operator

from .. import core
from ..blender import read, scene, settings, write
from ..blender.session import stored, tracking
from ..blender.write import reports
from ..core.verdict import FileError, Finding, MeasureError, Severity, system_reason

NO_FILE = "No file is named. Choose one."
MAX_OBJECTS_WITHOUT_REDRAW = (
    4  # limit of objects that are measured before the window is drawn again
)


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
    return context.mode == "OBJECT" or reports.unavailable(cls, "Switch to Object Mode")


class InObjectMode:
    """Base of operators that need Object Mode."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_object_mode(cls, context)


class OnSelection:
    """Base of operators that need selected objects, in any mode."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return bool(context.view_layer.objects.selected) or reports.unavailable(
            cls, "Select objects"
        )


class OnSelectionInObjectMode(OnSelection):
    """Base of operators that need selected objects in Object Mode."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_object_mode(cls, context) and super().poll(context)


def select_only(context: Context, objects: Collection[Object], active: Object) -> None:
    """Select these objects and no others, and make one active."""
    for obj in context.view_layer.objects:
        obj.select_set(obj in objects)
    context.view_layer.objects.active = active


def redraw(context: Context) -> None:
    """Redraw the window, if there is one: stored results show in several of its areas."""
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


def report(operator: Operator, *parts: Finding | str, level: Severity = Severity.NOTE) -> set[str]:
    """Report all parts in one message, redraw, and return the result of `execute`.

    Refusals and warnings stay in the panel until the next action.
    """
    stored.outcome.remember(
        operator.bl_label, [part for part in parts if isinstance(part, Finding)]
    )
    redraw(bpy.context)
    return reports.report(operator, *parts, level=level)


def refuse(operator: Operator, reason: MeasureError | Finding | str, **values: Any) -> set[str]:
    """Report why an operator does nothing, and return what its `execute` has to return. values: of
    an English text.
    """
    if isinstance(reason, str):
        report(operator, reports.phrase(reason, **values), level=Severity.ERROR)
    else:
        report(operator, reports.refusal(reason) if isinstance(reason, MeasureError) else reason)
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
    except reports.Refused as error:
        return refuse(operator, error.text, **error.values)


def summarize(
    operator: Operator,
    changed: int,
    total: int,
    done: str,
    failures: Sequence[Finding] = (),
    findings: Sequence[Finding | str] = (),
    idle: str | None = None,
    nothing: str = "Nothing selected can be measured",
) -> set[str]:
    """Report the run once, redraw, and return the result of `execute`.

    All failures and warnings stay in the panel until the next action.

    done: the action on `changed` of `total` objects. failures: the reasons for objects left
    unchanged. findings: other observations. idle: the reason if nothing had to be done. `done` and
    `idle` are translated already. nothing: the English text if there are no objects.
    """
    if not total:
        done = reports.phrase(nothing)
    elif not changed and not failures and idle is not None:
        done = reports.phrase("Nothing to do: {cause}", cause=idle)
    parts = [done] if changed or not failures else []
    if failures:
        parts.append(
            reports.phrase("{count} of {total} left unchanged:", count=len(failures), total=total)
        )
    return finish(operator, parts, failures, findings, is_changed=bool(changed))


def finish(
    operator: Operator,
    texts: Sequence[str],
    failures: Sequence[Finding],
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
    reports.report(
        operator, *texts, *reports.first(failures), *reports.first(findings), level=level
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
    for done, obj in enumerate(objects, 1):
        try:
            for share in action(obj) or ():
                yield done - 1 + share
        except Exception as error:
            # objects of two libraries may have one name
            failures.append(reports.failure(obj.name_full, error))
        yield done


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

    with reports.progress(len(objects)) as step:
        for done in iterate_objects(objects, run, failures):
            step(done)
    return changed, failures


def write_file(path: Path, pieces: Iterable[str | bytes]) -> None:
    """Write a file, whole or not at all. FileError if it cannot be written."""
    try:
        with core.files.whole_file.whole_file(path) as file:
            file.writelines(
                piece if isinstance(piece, bytes) else piece.encode() for piece in pieces
            )
    except OSError as error:
        raise FileError(
            write.findings.FILE_NOT_WRITTEN, file=path.name, error=system_reason(error)
        ) from error


def ask_for_table(operator: Operator, context: Context) -> set[str]:
    """Open the file browser, by default for a .csv file beside the .blend file and with its
    name.
    """
    if not operator.filepath:
        operator.filepath = bpy.path.ensure_ext(
            bpy.data.filepath.removesuffix(".blend") or "masses", ".csv"
        )
    context.window_manager.fileselect_add(operator)
    return {"RUNNING_MODAL"}


def ensure_suffix(operator: Operator, suffix: str, others: Collection[str] = ()) -> bool:
    """Give the path the suffix, unless it has one of the others or no name at all.

    Return whether the path was changed, as `check` does.
    """
    path = operator.filepath
    name = basename(operator.filepath)
    if name and splitext(name)[1].lower() not in others:
        operator.filepath = bpy.path.ensure_ext(path, suffix)
    return operator.filepath != path
