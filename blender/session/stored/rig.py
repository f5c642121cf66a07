# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored results of a character's bones, and their staleness.

A skinned mesh is evaluated anew whenever its armature moves, which changes nothing here: its rest pose is measured. So
an edit is noted if Blender reports a new shape of a mesh and nothing new of its armature.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import bpy
from bpy.types import Object, Scene

from ....core.verdict import internal_error
from ....core.verdict.finding import Finding
from ...bodies.rig import Rig, rig_hash, rig_objects
from ...read.fingerprint import VERSION
from ...read.rig import skinned_objects
from ...read.tracking import tracking_paused
from ...settings import hooks
from ...write import properties
from ..findings import STALE_FINGERPRINT, STALE_GEOMETRY, STALE_RIG
from ..tracking import handlers, marks, staleness
from ..tracking.cache import SessionCache

_reasons: SessionCache[tuple[int, str | None]] = SessionCache()  # by armature: the generation, and the reason then
_edited: SessionCache[bool] = SessionCache()  # armatures whose meshes have changed since they were measured
_watched: dict[int, Object] = {}  # by the session uids of skinned meshes, the armatures that deform them


def store(rig: Rig) -> list[tuple[str, Finding]]:
    """Store the results of all bones and of the whole; return names of bones without results, and the reasons.

    Raise EditRefusedError if the armature object cannot hold results.
    """
    armature = rig.armature
    properties.store(armature, rig.measurement)
    parts = {part.name: part for part in rig.parts}
    failures: list[tuple[str, Finding]] = []
    for bone in armature.pose.bones:
        part = parts.get(bone.name)
        if part is None or part.measurement is None:
            properties.clear(bone)
            if part is not None and part.refusal is not None:
                failures.append((bone.name, part.refusal))
            continue
        try:
            properties.store(bone, part.measurement)
        except Exception as error:
            failures.append((bone.name, internal_error.finding_of(error)))
    _edited.forget(armature)
    _watch(armature, rig.objects)
    handlers.count_change()
    return failures


def clear(armature: Object) -> bool:
    """Remove the results of all bones and of the whole; return whether there were any.

    Raises EditRefusedError if the results cannot be changed.
    """
    properties.require_storable(armature)
    cleared = [properties.clear(owner) for owner in (armature, *armature.pose.bones)]
    return any(cleared)


def stale_reason(armature: Object, scene: Scene) -> str | None:
    """Return the code of the reason why a character's stored results are out of date, or None."""
    known = _reasons.get(armature)
    if known is None or known[0] != handlers.generation():
        known = _reasons[armature] = (handlers.generation(), _stale_reason(armature, scene))
    return known[1]


def _stale_reason(armature: Object, scene: Scene) -> str | None:
    mark = marks.parse(properties.fingerprint(armature))
    if mark is None or mark.version != VERSION:
        return STALE_FINGERPRINT if "body_mass" in armature else None
    if mark.geometry == marks.EDITED or _edited.get(armature):
        return STALE_GEOMETRY
    if mark.settings != rig_hash(armature, rig_objects(armature, scene.objects), scene):
        return STALE_RIG
    return None


def _watch(armature: Object, objects: Iterable[Object]) -> None:
    """Note edits of the meshes that an armature deforms from now on."""
    for obj in skinned_objects(armature, objects):
        handlers.subscribe(handlers.on_update, _note_updates)
        _watched[obj.session_uid] = armature


def _note_updates(updates: handlers.Updates) -> None:
    if not _watched:
        handlers.unsubscribe(handlers.on_update, _note_updates)
        return
    if tracking_paused.depth:
        return
    touched = {*updates.reshaped, *updates.moved, *updates.others}
    for uid in _watched.keys() & updates.reshaped:
        armature = _watched[uid]
        if armature.session_uid not in touched:
            handlers.count_change()
            _edited[armature] = True


def _watch_all() -> None:
    _watched.clear()
    for obj in bpy.data.objects:
        if obj.type == "ARMATURE" and "body_mass" in obj:
            _watch(obj, bpy.data.objects)


def _count_change(*_args: object) -> None:
    handlers.count_change()


def _write_notes() -> None:
    if len(_edited):
        for obj in bpy.data.objects:
            if _edited.get(obj) and obj.is_editable:
                marks.write_edited(obj, [properties.fingerprint(obj)])


SUBSCRIPTIONS: tuple[tuple[list[Any], Callable[..., None]], ...] = (
    (handlers.on_undo, _watch_all),  # undo makes Python's references to objects invalid
    (handlers.on_load, _watch_all),
    (handlers.on_save, _write_notes),
    (hooks.on_part_change, _count_change),
)


def register() -> None:
    """Note edits from now on."""
    staleness.reasons_by_type["ARMATURE"] = lambda obj: stale_reason(obj, bpy.context.scene)
    for subscribers, function in SUBSCRIPTIONS:
        subscribers.append(function)


def unregister() -> None:
    """Note no more edits."""
    for subscribers, function in reversed(SUBSCRIPTIONS):
        subscribers.remove(function)
    del staleness.reasons_by_type["ARMATURE"]
    handlers.unsubscribe(handlers.on_update, _note_updates)
    _watched.clear()
