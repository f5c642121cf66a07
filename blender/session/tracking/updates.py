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
from .. import memory
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
    last = memory.edits.get(obj.session_uid, NEVER)
    for instance in shown_by(obj):
        last = max(
            last,
            memory.edits.get(instance.session_uid, NEVER),
            memory.moves.get(instance.session_uid, NEVER),
        )
    settings = obj.body_moments
    if settings.density_from == "VOLUME" and settings.density_volume is not None:
        last = max(last, memory.edits.get(settings.density_volume.session_uid, NEVER))
    return last


def last_since(obj: Object, since: int) -> tuple[Update, Update]:
    """Return the last update after `since` that may be an edit, `NEVER` if none, and the last one
    of the geometry.
    """
    edit = last_edit(obj)
    last = max(edit, memory.returns.get(obj.session_uid, NEVER))  # by number
    return (edit if edit.number > since else NEVER), last


def last_change_of_geometry(obj: Object) -> int:
    """Return the number of the last geometry update of an object or its instances, edit or not."""
    _edit, last = last_since(obj, 0)
    return last.number


def depsgraph_of(update: Update) -> Depsgraph | None:
    """Return the dependency graph of an update's view layer, as last evaluated; None if the layer
    is gone.
    """
    for scene in bpy.data.scenes:
        if scene.session_uid == update.scene:
            layer = scene.view_layers.get(update.view_layer)
            return None if layer is None else layer.depsgraph
    return None


def note_updates(updates: handlers.Updates) -> None:
    """Record updates of geometry as possible edits, or as returns after undo and changed settings,
    and those of transforms as moves; none while tracking is paused.
    """
    if tracking_paused.depth:
        return
    state = memory.state
    is_undo = state.is_undo_pending
    state.is_undo_pending = False
    changed_settings = set(memory.changed_settings)
    memory.changed_settings.clear()
    state.updates += 1
    update = Update(state.updates, updates.scene.session_uid, updates.depsgraph.view_layer.name)
    if is_undo:
        edits = _edited_by_undo(updates)
        memory.edits.update(dict.fromkeys(edits, update))
        memory.returns.update(
            dict.fromkeys([uid for uid in updates.reshaped if uid not in edits], update)
        )
        return
    reshaped: Iterable[int] = updates.reshaped
    if changed_settings and not updates.frame_changed:
        changed_by_settings = changed_settings.intersection(reshaped)
        memory.returns.update(dict.fromkeys(changed_by_settings, update))
        reshaped = [uid for uid in reshaped if uid not in changed_by_settings]
    memory.edits.update(dict.fromkeys([*reshaped, *updates.collections], update))
    memory.moves.update(dict.fromkeys(updates.moved, update))


def _edited_by_undo(updates: handlers.Updates) -> set[int]:
    """Return the session uids of updated objects in Edit or Sculpt Mode, where undo restores the
    shape but not the stored numbers, so that it counts as an edit.
    """
    objects = [
        update.id.original for update in updates.depsgraph.updates if isinstance(update.id, Object)
    ]
    edited = {
        obj.session_uid
        for obj in objects
        if obj.mode == "SCULPT" or getattr(obj.data, "is_editmode", False)
    }
    return edited.intersection(updates.reshaped)


def note_setting(settings: PropertyGroup, _context: Context) -> None:
    """Record the object of a changed setting, because its next update is no edit."""
    memory.changed_settings.add(settings.id_data.session_uid)


def note_undo() -> None:
    """Expect the next update to be that of undo or redo."""
    memory.state.is_undo_pending = True
