# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of all operators on the selection: choice of objects, polls with reasons, progress, one report a run."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence

from bpy.types import Context, Object, Operator

from ..blender.read.visibility import measurable
from ..blender.scene.transforms import ancestors
from ..blender.session.stored import outcome
from ..blender.settings.preferences import copy_defaults
from ..blender.write import reports
from ..core.verdict.finding import Finding, finding
from .findings import LEFT_UNCHANGED, NOTHING_MEASURABLE, NOTHING_TO_DO
from .modal import progress


def selected_measurable(context: Context) -> list[Object]:
    """Return the measurable selected objects, parents before children.

    Works in background too. A scene that is used for the first time gets its defaults.
    """
    copy_defaults(context.scene)
    objects = [obj for obj in context.view_layer.objects.selected if measurable(obj)]
    return sorted(objects, key=lambda obj: len([*ancestors(obj)]))


def poll_selection(cls: type[Operator], context: Context, any_mode: bool = False) -> bool:
    """Return whether something is selected, in Object Mode unless any mode will do; report why not."""
    if not any_mode and context.mode != "OBJECT":
        return reports.unavailable(cls, "Switch to Object Mode")
    if not context.view_layer.objects.selected:
        return reports.unavailable(cls, "Select objects")
    return True


def report(operator: Operator, *findings: Finding) -> None:
    """Report once; refusals and warnings stay in the panel until the next action."""
    outcome.remember(operator.bl_label, findings)
    reports.report(operator, *findings)


def summarize(
    operator: Operator,
    changed: int,
    total: int,
    done: Finding,
    failures: Sequence[Finding] = (),
    findings: Sequence[Finding] = (),
    idle: Finding | None = None,
) -> set[str]:
    """Report the run once, and return the result of `execute`.

    All failures and warnings stay in the panel until the next action.

    done: the action on `changed` of `total` objects. failures: the reasons for objects left unchanged. findings: other
    observations. idle: the reason if nothing had to be done.
    """
    if not changed and not failures and idle is not None:
        done = finding(NOTHING_TO_DO, cause=idle.as_record()) if total else finding(NOTHING_MEASURABLE)
    sentences = [done] if changed or not failures else []
    if failures:
        causes = [failure.as_record() for failure in reports.first(failures)]
        sentences.append(finding(LEFT_UNCHANGED, count=len(failures), total=total, causes=causes))
    outcome.remember(operator.bl_label, [*failures, *findings])
    reports.report(operator, *sentences, *reports.first(findings))
    return {"FINISHED"} if changed else {"CANCELLED"}


def iterate_objects(
    objects: Iterable[Object], action: Callable[[Object], Iterator[float] | None], failures: list[Finding]
) -> Generator[float, None, None]:
    """Run `action` on one object after the other, and yield the number of completed objects.

    `action` does the work, or returns an iterator that does it in steps and yields its completed share. Refusals and
    failures are added to `failures`: none of them ends the work on the other objects.
    """
    for done, obj in enumerate(objects, 1):
        try:
            for share in action(obj) or ():
                yield done - 1 + share
        except Exception as error:
            failures.append(reports.failure(obj.name_full, error))  # objects of two libraries may have one name
        yield done


def apply_to_all(
    objects: Sequence[Object], action: Callable[[Object], bool | None]
) -> tuple[list[Object], list[Finding]]:
    """Run `action` on each object.

    Return the objects for which it returned True or None, and the reasons for refusals and failures.
    """
    changed: list[Object] = []
    failures: list[Finding] = []

    def run(obj: Object) -> None:
        is_changed = action(obj)
        if is_changed is None or is_changed:
            changed.append(obj)

    with progress(len(objects)) as step:
        for done in iterate_objects(objects, run, failures):
            step(done)
    return changed, failures
