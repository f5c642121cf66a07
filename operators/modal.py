# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work in steps: between two of them Blender handles events and shows the progress, and Esc cancels."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from time import perf_counter

import bpy
from bpy.types import Context, Event

from ..blender.write import reports

# Seconds of work between two of the window's events: the time that the window itself takes, within these limits,
# to spend half of the time on work if a scene is slow to draw.
STEP_SECONDS, MAX_STEP_SECONDS = 0.1, 1.0

MAX_OBJECTS_WITHOUT_REDRAW = 4  # up to so many objects are measured before the window is drawn again


def redraw(context: Context) -> None:
    """Redraw the window, if there is one: stored results show in several of its areas."""
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


@contextmanager
def progress(count: float) -> Iterator[Callable[[float], None]]:
    """Yield a function to call with the completed part of `count`; shown at the cursor if `count` is more than 1."""
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
    """Base of operators that work in steps.

    The generator `_steps` does the work and yields the completed part; `_finish` alone changes anything.

    PROGRESS: for the status bar; it gets the value `share`, the completed share. CANCELED: the report after Esc.
    """

    PROGRESS: str
    CANCELED: str
    _steps: Generator[float, None, None]
    _finish: Callable[[Context], set[str]]
    _returned_at = 0.0  # time at which the last step returned control to the window

    def run_all_steps(self, context: Context, count: float) -> set[str]:
        """Run every step, in one call of the operator. count: the last value that the steps yield."""
        with progress(count) as step:
            for done in self._steps:
                step(done)
        return self._finish(context)

    def start_modal(self, context: Context, count: float) -> set[str]:
        """Run the steps as the window's timer calls for them."""
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
            reports.report(self, reports.phrase(self.CANCELED))
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
        context.workspace.status_text_set(reports.phrase(self.PROGRESS, share=share))

    def _stop_modal(self, context: Context) -> None:
        self._steps.close()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
