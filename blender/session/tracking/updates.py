# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Updates: data-blocks that Blender has evaluated anew, written down with the number of their last
update.

An update of an object's geometry may be an edit, but not if it follows a changed setting or undo.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import bpy
from bpy.types import ID, Context, Depsgraph, Object, PropertyGroup

from ...read.tracking import tracking_paused
from . import handlers


class Update(NamedTuple):
    """An update of a scene's view layer.

    number: grows from update to update; 0 if there was none. scene: session uid of the evaluated
    scene. view_layer: its name.
    """

    number: int
    scene: int
    view_layer: str


NEVER = Update(0, 0, "")
# session uid → the last update of a data-block
_edits: dict[int, Update] = {}  # updates of geometry that may be edits
_returns: dict[int, Update] = {}  # updates of geometry that are no edits
_moves: dict[int, Update] = {}  # updates of the transform alone
_count = 0  # updates
_set_since: set[int] = set()  # session uids of objects with settings changed since the last update
_undo_pending = False  # true if the next update is that of undo or redo


def count() -> int:
    """Return the number of updates since the file was loaded."""
    return _count


def shown_by(obj: Object) -> Iterator[ID]:
    """Yield objects and collections that an original object shows as instances, and whose changes
    change its result.
    """
    kind = obj.instance_type
    if kind == "COLLECTION":
        if obj.instance_collection is not None:
            yield obj.instance_collection
    elif kind != "NONE":
        yield from obj.children_recursive
    for system in obj.particle_systems:
        settings = system.settings
        if settings.instance_object is not None:
            yield settings.instance_object
        if settings.instance_collection is not None:
            yield settings.instance_collection


def last_edit(obj: Object) -> Update:
    """Return the last update of an object, its instances, or the shape of its density's Volume,
    that may be an edit.
    """
    last = _edits.get(obj.session_uid, NEVER)
    for shown in shown_by(obj):
        last = max(last, *[stamps.get(shown.session_uid, NEVER) for stamps in (_edits, _moves)])
    settings = obj.body_moments
    if settings.density_from == "VOLUME" and settings.density_volume is not None:
        last = max(last, _edits.get(settings.density_volume.session_uid, NEVER))
    return last


def last_since(obj: Object, since: int) -> tuple[Update, Update]:
    """Return the last update after `since` that may be an edit, `NEVER` if none, and the last one
    of the geometry.
    """
    edit = last_edit(obj)
    return edit if edit.number > since else NEVER, max(edit, _returns.get(obj.session_uid, NEVER))


def last_change_of_geometry(obj: Object) -> int:
    """Return the number of the last geometry update of an object or its instances, edit or not."""
    return last_since(obj, 0)[1].number


def depsgraph_of(stamp: Update) -> Depsgraph | None:
    """Return the dependency graph of an update's view layer, as last evaluated; None if the layer
    is gone.
    """
    for scene in bpy.data.scenes:
        if scene.session_uid == stamp.scene:
            layer = scene.view_layers.get(stamp.view_layer)
            return None if layer is None else layer.depsgraph
    return None


def note_updates(updates: handlers.Updates) -> None:
    """Record updates as possible edits, non-edits, moves or others; none while tracking is
    paused.
    """
    global _count, _undo_pending, _set_since
    if tracking_paused.depth:
        return
    undone, _undo_pending = _undo_pending, False
    changed_settings = _set_since
    _set_since = set()
    _count += 1
    stamp = Update(_count, updates.scene.session_uid, updates.depsgraph.view_layer.name)
    if undone:
        edits = _edited_by_undo(updates)
        _edits.update(dict.fromkeys(edits, stamp))
        _returns.update(dict.fromkeys([uid for uid in updates.reshaped if uid not in edits], stamp))
        return
    reshaped: Iterable[int] = updates.reshaped
    if changed_settings and not updates.frame_changed:
        of_settings = changed_settings.intersection(reshaped)
        _returns.update(dict.fromkeys(of_settings, stamp))
        reshaped = [uid for uid in reshaped if uid not in of_settings]
    _edits.update(dict.fromkeys([*reshaped, *updates.collections], stamp))
    _moves.update(dict.fromkeys(updates.moved, stamp))


def _edited_by_undo(updates: handlers.Updates) -> set[int]:
    """Return the session uids of updated objects in Edit or Sculpt Mode, where undo only restores
    the shape.
    """
    evaluated = [update.id for update in updates.depsgraph.updates]
    objects = [data.original for data in evaluated if isinstance(data, Object)]
    edited = {
        obj.session_uid
        for obj in objects
        if obj.mode == "SCULPT" or getattr(obj.data, "is_editmode", False)
    }
    return edited.intersection(updates.reshaped)


def note_setting(settings: PropertyGroup, _context: Context) -> None:
    """Record the object of a changed setting, because its next update is no edit."""
    _set_since.add(settings.id_data.session_uid)


def note_undo() -> None:
    """Expect the next update to be that of undo or redo."""
    global _undo_pending
    _undo_pending = True


def forget_file() -> None:
    """Forget all updates."""
    global _undo_pending, _count
    _undo_pending, _count = False, 0
    for remembered in (_edits, _returns, _moves, _set_since):
        remembered.clear()
