# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reactions of the session to Blender's reports and to changed settings, in one table.

Modules with sliders subscribe by themselves once they have cached something (`stored.walls`, `stored.threshold`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from bpy.types import Context, PropertyGroup

from ..settings import hooks
from . import displayed, live, stored
from .live.following import followed
from .stored import outcome
from .tracking import armatures, handlers, staleness, updates


def _follow_live(events: handlers.Updates) -> None:
    if len(followed):
        live.live.note_updates(events)


def _follow_density(settings: PropertyGroup, context: Context) -> None:
    stored.density.on_density(settings, context)


def _follow_default_density(settings: PropertyGroup, context: Context) -> None:
    stored.density.on_default_density(settings, context)


def _count_change(settings: PropertyGroup, _context: Context) -> None:
    handlers.count_change(settings.id_data)


SUBSCRIPTIONS: tuple[tuple[list[Any], Callable[..., None]], ...] = (
    (handlers.on_update, updates.note_updates),
    (handlers.on_update, armatures.note_updates),
    (handlers.on_update, displayed.note_updates),
    (handlers.on_update, _follow_live),
    (handlers.on_note, displayed.forget_drawn),
    (handlers.before_undo, staleness.note_all_edits),
    (handlers.on_undo, updates.note_undo),
    (handlers.on_undo, outcome.forget),
    (handlers.on_undo, armatures.watch_all),  # undo makes Python's references to objects invalid
    (handlers.on_load, updates.forget_file),
    (handlers.on_load, staleness.forget_file),
    (handlers.on_load, outcome.forget),
    (handlers.on_load, armatures.watch_all),
    (handlers.on_save, staleness.write_notes),
    (hooks.on_change, updates.note_setting),
    (hooks.on_part_change, _count_change),
    (hooks.on_density_change, _follow_density),
    (hooks.on_default_density_change, _follow_default_density),
)


def register() -> None:
    """Subscribe the functions of the table."""
    for subscribers, function in SUBSCRIPTIONS:
        subscribers.append(function)


def unregister() -> None:
    """Write the notes of edits, as the file may outlive the add-on; then forget them and clear all subscriptions."""
    staleness.write_notes()
    for forget in (updates.forget_file, staleness.forget_file, outcome.forget, displayed.forget_drawn):
        forget()
    for subscribers in (*handlers.LISTS, *hooks.LISTS):
        subscribers.clear()
