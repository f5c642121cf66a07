# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all operators on the selection share: which objects, polls that say why, progress, and
one report a run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager

import bpy
from bpy.types import Context, Object, Operator

from ...core.verdict import internal_error
from ..read import measurable
from ..scene.transforms import lineage
from ..write.text import LISTED, counted, in_a_row, listed, one_line


def selected(context: Context) -> list[Object]:
    """The selected objects that could be measured, parents before children. Works in background
    too.
    """
    objects = [obj for obj in context.view_layer.objects.selected if measurable(obj)]
    return sorted(objects, key=lambda obj: sum(1 for _ in lineage(obj)))


def poll_selected(cls: type[Operator], context: Context, any_mode: bool = False) -> bool:
    """Whether something is selected, in Object Mode unless any mode will do; says why not."""
    if not any_mode and context.mode != "OBJECT":
        cls.poll_message_set("Switch to Object Mode first")
        return False
    if not context.view_layer.objects.selected:
        cls.poll_message_set("Select the objects first")
        return False
    return True


def redraw(context: Context) -> None:
    """Have the window drawn again, where there is one: what was stored shows in several of its areas."""
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


@contextmanager
def progress(count: float) -> Iterator[Callable[[float], None]]:
    """What to tell how much of `count` is done; shown at the cursor where there are many."""
    manager = bpy.context.window_manager
    shown = count > 1

    def step(done: float) -> None:
        if shown:
            manager.progress_update(done)

    if shown:
        manager.progress_begin(0, count)
    try:
        yield step
    finally:
        if shown:
            manager.progress_end()


def summarise(
    operator: Operator,
    done: int,
    total: int,
    text: str,
    failures: Iterable[tuple[str, str]] = (),
    notes: Iterable[str] = (),
    idle: str = "",
) -> set[str]:
    """One report for the run, and what `execute` returns.

    text: what happened to `done` objects, with {count} for "3 objects". failures: (name, reason)
        each. notes: sentences. idle: where nothing had to be done, why.
    """
    failures, notes = list(failures), list(notes)
    if not done and not failures and idle:
        text = "Nothing to do: " + idle if total else "Nothing selected can be measured"
    sentences = []
    if done or not failures:
        sentences.append(text.replace("{count}", counted(done), 1))  # names in it may have braces too
    if failures:
        told = in_a_row(listed("{:s}: {:s}".format(*failure) for failure in failures))
        sentences.append("{:d} of {:s} left unchanged. {:s}".format(len(failures), counted(total), told))
    sentences += notes[:LISTED]
    operator.report({"WARNING"} if failures or notes else {"INFO"}, one_line(sentences))
    return {"FINISHED"} if done else {"CANCELLED"}


def one_by_one(
    objects: Iterable[Object],
    action: Callable[[Object], Iterator[float] | None],
    refusals: tuple[type[Exception], ...],
    failures: list[tuple[str, str]],
) -> Iterator[float]:
    """Run `action` on one object after the other: it does the work, or returns an iterator that does it in steps and
    yields its share that is done. Yields how many objects are done. (name, reason) of those that it refused are added
    to `failures`, and of those where it failed otherwise: none of them ends the others.
    """
    for done, obj in enumerate(objects, 1):
        try:
            for share in action(obj) or ():
                yield done - 1 + share
        except Exception as error:
            # Objects of two libraries may have one name.
            failures.append((obj.name_full, internal_error.reason(error, refusals)))
        yield done


def each(
    objects: Sequence[Object],
    action: Callable[[Object], bool],
    refusals: tuple[type[Exception], ...],
) -> tuple[int, list[tuple[str, str]]]:
    """Run `action` on each object; how many it changed, and (name, reason) of those that it
    refused, or where it failed.
    """
    changed: list[Object] = []
    failures: list[tuple[str, str]] = []

    def run(obj: Object) -> None:
        if action(obj):
            changed.append(obj)

    with progress(len(objects)) as step:
        for done in one_by_one(objects, run, refusals, failures):
            step(done)
    return len(changed), failures
