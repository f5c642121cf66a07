# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's reports while a file is open, heard once, and passed on to the functions in the lists
below.

A subscriber never writes data while Blender evaluates: that would be another change. Before a file
is saved it may.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import NamedTuple

import bpy
from bpy.app.handlers import persistent
from bpy.types import ID, Collection, Depsgraph, Object, Scene

from .. import memory


class Updates(NamedTuple):
    """Session uids of data-blocks that the window's dependency graph has evaluated again; there may
    be thousands.

    depsgraph: its `updates` are valid until the handlers return.
    reshaped, moved, others: objects with new geometry, with a new transform only, and with neither.
    collections: collections with new geometry, such as that of their members.
    frame_changed: whether another frame was evaluated.
    """

    scene: Scene
    depsgraph: Depsgraph
    reshaped: list[int]
    moved: list[int]
    others: list[int]
    collections: list[int]
    frame_changed: bool


on_update: list[Callable[[Updates], None]] = []
on_note: list[Callable[[ID | None], None]] = []  # a counted change of one object, or of any
before_undo: list[Callable[[], None]] = []
on_undo: list[Callable[[], None]] = []  # undo and redo: before the update that follows them
on_load: list[Callable[[], None]] = []  # after the last file was forgotten
on_save: list[Callable[[], None]] = []
LISTS = on_update, on_note, before_undo, on_undo, on_load, on_save


def count_change(data: ID | None = None) -> None:
    """Count a change that Blender does not report, such as a new note about an object; by default
    of any object.
    """
    memory.state.generation += 1
    _call(on_note, data)


def _call(subscribers: Sequence[Callable[..., None]], *args: Updates | ID | None) -> None:
    """Call all subscribers in order, even if one fails: its error is raised at the end."""
    with ExitStack() as calls:  # calls the last callback first
        for subscriber in reversed(subscribers):
            calls.callback(subscriber, *args)


def _updates(scene: Scene, depsgraph: Depsgraph, frame_changed: bool) -> Updates:
    updates = Updates(scene, depsgraph, [], [], [], [], frame_changed)
    for update in depsgraph.updates:  # without needless calls and attributes, for speed
        data = update.id
        is_object = isinstance(data, Object)
        if not is_object and not isinstance(data, Collection):
            continue
        uid = data.original.session_uid
        if update.is_updated_geometry:
            (updates.reshaped if is_object else updates.collections).append(uid)
        elif update.is_updated_transform:
            updates.moved.append(uid)
        else:
            updates.others.append(uid)
    return updates


@persistent
def _on_update(scene: Scene, depsgraph: Depsgraph | None = None) -> None:
    _note_update(scene, depsgraph, frame_changed=False)


@persistent
def _on_frame(scene: Scene, depsgraph: Depsgraph | None = None) -> None:
    _note_update(scene, depsgraph, frame_changed=True)


def _note_update(scene: Scene, depsgraph: Depsgraph | None, frame_changed: bool) -> None:
    """Count a change, and tell it to the subscribers, unless it is one of a render."""
    memory.state.generation += 1
    if depsgraph is not None and depsgraph.mode == "VIEWPORT":
        _call(on_update, _updates(scene, depsgraph, frame_changed))


@persistent
def _before_undo(*_args) -> None:
    _call(before_undo)


@persistent
def _on_undo(*_args) -> None:
    memory.state.generation += 1  # the update that follows names the restored objects
    _call(on_undo)


@persistent
def _on_load(*_args) -> None:
    count_change()
    memory.forget_file()
    _call(on_load)


@persistent
def _on_save(*_args) -> None:
    _call(on_save)


HANDLERS = (
    ("depsgraph_update_post", _on_update),
    ("frame_change_post", _on_frame),
    ("undo_pre", _before_undo),
    ("redo_pre", _before_undo),
    ("undo_post", _on_undo),
    ("redo_post", _on_undo),
    ("load_post", _on_load),
    ("save_pre", _on_save),
)


def register() -> None:
    """Add the handlers to Blender's lists."""
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister() -> None:
    """Remove the handlers and forget the file."""
    for name, function in reversed(HANDLERS):
        functions = getattr(bpy.app.handlers, name)
        if function in functions:  # scripts and other add-ons may empty these lists
            functions.remove(function)
    memory.forget_file()
