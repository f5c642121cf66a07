# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work in steps: between two of them Blender handles events and shows the progress, and Esc
cancels.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from time import perf_counter

from bpy.types import Context, Event

from ..blender import settings, write
from .selection import reporting

# Seconds of work between two of the window's events: the time that the window itself takes, within
# these limits, to spend half of the time on work if a scene is slow to draw.
STEP_SECONDS, MAX_STEP_SECONDS = 0.1, 1.0


class ModalSteps:
    """Base of operators that work in steps.

    `_begin` chooses the work, sets the generator `_steps` and returns its last value; `_steps` does
    the work and yields the completed amount; only `_finish` changes anything. Each may raise
    MeasureError or Refused, which are reported.

    PROGRESS: text in the status bar, filled with `share`, the completed share. CANCELED: the report
    after Esc. MAX_AT_ONCE: largest count of steps that are run at once, without redrawing the
    window.
    """

    PROGRESS = "Measuring: {share:.0%}. Esc to cancel"
    CANCELED = "Measuring canceled; nothing was changed"
    MAX_AT_ONCE = 0
    _begin: Callable[[Context], float]
    _steps: Generator[float, None, None]
    _finish: Callable[[Context], set[str]]
    _returned_at = 0.0  # time at which the last step returned control to the window

    def execute(self, context: Context) -> set[str]:
        return reporting(self, self._run, context, False)

    def invoke(self, context: Context, _event: Event) -> set[str]:
        return reporting(self, self._run, context, context.window is not None)

    def modal(self, context: Context, event: Event) -> set[str]:
        return reporting(self, self._advance, context, event)

    def _run(self, context: Context, in_window: bool) -> set[str]:
        """Run all steps in this call, or start a timer of the window that runs them."""
        self._count = self._begin(context)
        if in_window and self._count > self.MAX_AT_ONCE:
            manager = context.window_manager
            self._timer = manager.event_timer_add(0.0, window=context.window)
            manager.modal_handler_add(self)
            manager.progress_begin(0, self._count)
            self._show_progress(context, 0)
            self._returned_at = perf_counter()
            return {"RUNNING_MODAL"}
        with write.reports.progress(self._count) as step:
            for completed in self._steps:
                step(completed)
        return self._finish(context)

    def _advance(self, context: Context, event: Event) -> set[str]:
        if event.type == "ESC":
            self._stop_modal(context)
            write.reports.report(self, write.reports.phrase(self.CANCELED))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            now = perf_counter()
            # as long as the window took since the last step, within the limits
            until = now + max(STEP_SECONDS, min(now - self._returned_at, MAX_STEP_SECONDS))
            for completed in self._steps:
                if perf_counter() >= until:
                    self._show_progress(context, completed)
                    self._returned_at = perf_counter()
                    return {"RUNNING_MODAL"}
        except BaseException:
            self._stop_modal(context)
            raise
        self._stop_modal(context)
        return self._finish(context)

    def _show_progress(self, context: Context, completed: float) -> None:
        context.window_manager.progress_update(completed)
        share = completed / self._count if self._count else 1.0
        context.workspace.status_text_set(write.reports.phrase(self.PROGRESS, share=share))

    def _stop_modal(self, context: Context) -> None:
        self._steps.close()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)


class ModalDialog(ModalSteps):
    """Base of operators that work in steps after a dialog of their properties."""

    # True from the opening of the dialog to its confirmation; False in a script and the redo panel
    _is_interactive = False

    def invoke(self, context: Context, _event: Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        self._is_interactive = True
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: Context) -> set[str]:
        settings.preferences.copy_defaults(context.scene)
        # The redo panel executes this instance again, which must not become modal.
        in_window = self._is_interactive
        self._is_interactive = False
        return reporting(self, self._run, context, in_window)
