# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work in steps: between two of them Blender handles events and shows the progress, and Esc cancels."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from time import perf_counter

import bpy
from bpy.types import Context, Event

from ..blender.write import reports
from ..core.verdict.finding import Finding

# seconds of work between two of the window's events: as long as the window takes in between, within these limits, so
# that half of the time is work where a scene is slow to draw
STEP_SECONDS, MAX_STEP_SECONDS = 0.1, 1.0

MAX_OBJECTS_WITHOUT_REDRAW = 4  # up to so many objects are measured before the window is drawn again


def redraw(context: Context) -> None:
    """Have the window drawn again, where there is one: what was stored shows in several of its areas."""
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


@contextmanager
def progress(count: float) -> Iterator[Callable[[float], None]]:
    """What to call with how much of `count` is done; shown at the cursor where there are many."""
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


class ModalSteps:
    """Of an operator, whose `_steps` is a generator that does the work and yields how much is done, and whose `_finish`
    alone changes anything.

    PROGRESS: for the status bar; it gets the value `share`, that is done. CANCELED: the report after Esc.
    """

    PROGRESS: Finding
    CANCELED: Finding
    _steps: Generator[float, None, None]
    _finish: Callable[[Context], set[str]]
    _returned_at = 0.0  # when the last step gave control back to the window

    def run_all_steps(self, context: Context, count: float) -> set[str]:
        """Every step, in one call of the operator. count: what the last step yields."""
        with progress(count) as step:
            for done in self._steps:
                step(done)
        return self._finish(context)

    def start_modal(self, context: Context, count: float) -> set[str]:
        """The steps as the window's timer calls for them."""
        self._count = count
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.0, window=context.window)
        manager.modal_handler_add(self)
        manager.progress_begin(0, count)
        self._show_progress(context, 0)
        self._returned_at = perf_counter()
        return {"RUNNING_MODAL"}

    def modal(self, context: Context, event: Event) -> set[str]:
        if event.type == "ESC":
            self._stop_modal(context)
            reports.report(self, self.CANCELED)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            now = perf_counter()
            until = now + max(STEP_SECONDS, min(now - self._returned_at, MAX_STEP_SECONDS))
            for done in self._steps:
                if perf_counter() >= until:
                    self._show_progress(context, done)
                    self._returned_at = perf_counter()
                    return {"RUNNING_MODAL"}
        except BaseException:
            self._stop_modal(context)
            raise
        self._stop_modal(context)
        return self._finish(context)

    def _show_progress(self, context: Context, done: float) -> None:
        context.window_manager.progress_update(done)
        share = done / self._count if self._count else 1.0
        context.workspace.status_text_set(reports.text(replace(self.PROGRESS, values={"share": share})))

    def _stop_modal(self, context: Context) -> None:
        self._steps.close()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
