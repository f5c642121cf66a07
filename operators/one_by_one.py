# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work on many objects: between two of them the window lives and tells how far it is, and Esc ends it."""

from __future__ import annotations

from bpy.types import Context, Event

from . import selection


class OneByOne:
    """Of an operator, whose `_steps` does one object at a step, and whose `_finish` alone changes anything.

    DOING: the status text, with two places for numbers. CANCELLED: the report after Esc.
    """

    def all_at_once(self, context: Context, count: int) -> set[str]:
        """Every step, in one call of the operator."""
        with selection.progress(count) as step:
            for _ in self._steps:
                step()
        return self._finish(context)

    def begin_modal(self, context: Context, count: int) -> set[str]:
        """The steps as the window's timer calls for them."""
        self._count, self._done = count, 0
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.0, window=context.window)
        manager.modal_handler_add(self)
        manager.progress_begin(0, count)
        return {"RUNNING_MODAL"}

    def modal(self, context: Context, event: Event) -> set[str]:
        if event.type == "ESC":
            self._end(context)
            self.report({"INFO"}, self.CANCELLED)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if next(self._steps, None) is None:
            self._end(context)
            return self._finish(context)
        self._done += 1
        context.window_manager.progress_update(self._done)
        context.workspace.status_text_set(self.DOING.format(self._done, self._count))
        return {"RUNNING_MODAL"}

    def _end(self, context: Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
