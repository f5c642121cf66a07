# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reactions of the session to Blender's reports and to changed settings, in one table; sliders add
theirs when used.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..settings import hooks
from . import displayed, live, memory, stored
from .tracking import armatures, handlers, staleness, updates

SUBSCRIPTIONS: tuple[tuple[list[Any], Callable[..., None]], ...] = (
    (handlers.on_update, updates.note_updates),
    (handlers.on_update, armatures.note_updates),
    (handlers.on_update, armatures.redraw_weights),
    (handlers.on_update, displayed.note_updates),
    (
        handlers.on_update,
        lambda events: live.measuring.note_updates(events) if len(memory.followed) else None,
    ),
    (handlers.on_note, displayed.forget_drawn),
    (handlers.before_undo, staleness.note_all_edits),
    (handlers.on_undo, updates.note_undo),
    (handlers.on_undo, stored.outcome.forget),
    (handlers.on_undo, armatures.watch_all),  # undo makes Python's references to objects invalid
    (handlers.on_load, armatures.watch_all),
    (handlers.on_save, staleness.write_notes),
    (hooks.on_change, updates.note_setting),
    (hooks.on_part_change, lambda settings, _context: handlers.count_change(settings.id_data)),
    # the engine is loaded by the first change
    (
        hooks.on_density_change,
        lambda settings, context: stored.density.on_density(settings, context),
    ),
    (
        hooks.on_default_density_change,
        lambda settings, context: stored.density.on_default_density(settings, context),
    ),
)


def register() -> None:
    """Subscribe the functions of the table."""
    for subscribers, function in SUBSCRIPTIONS:
        subscribers.append(function)


def unregister() -> None:
    """Write the notes of edits, because the file may outlive the add-on; then drop them and all
    subscriptions.
    """
    staleness.write_notes()
    memory.forget_file()
    for subscribers in (*handlers.LISTS, *hooks.LISTS):
        subscribers.clear()
