# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether stored numbers are out of date.

What is compared: transform and settings, by the digests in the marks that results, section and symmetry carry.

What is noted: a digest of the geometry would need measuring, so an edit is noted instead, in memory only: the marks
that the object carried when Blender evaluated its geometry anew. When a file is saved, the notes become part of the
marks (`marks.write_edited`), so that the file knows when it is opened; reading a file reports no updates.

When: Blender evaluates more than what was changed, as an object that is copied, shown again or gets a material slot.
So what small meshes showed when their numbers were stored is kept, as a digest, and a note is made, or taken back, by
comparing what they show now. Of what cannot be compared, every update is an edit, but for

- the update of a setting, which Blender reports as one of the geometry;
- the update that follows undo, which brings back numbers and shape together. An edit that undo brings back again was
  noted when it was made, and notes are kept: undo may bring back the numbers of before, too. In Edit Mode and Sculpt
  Mode it brings back the shape alone, and is an edit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

import bpy
from bpy.types import Context, Depsgraph, Object, Scene

from ..read.fingerprint import VERSION, matrix_hash, scale_hash, settings_hash, shape_digest
from ..read.quiet import paused
from . import handlers, marks
from .affected import instancing_objects, volume_filled_objects
from .cache import SessionCache

NO_SHAPES: Mapping[Object, bytes | None] = MappingProxyType({})
_edited: SessionCache[frozenset[str]] = SessionCache()  # the marks that an object carried when its geometry changed
_settings: SessionCache[str] = SessionCache()  # digest of the settings at the last update
_changes: SessionCache[int] = SessionCache()  # how often the geometry changed, of objects for which this is asked
_shapes: dict[str, bytes] = {}  # mark → digest of what was shown when it was stored: copies of an object share both
# of what is no object's own body, by method: what compares its results with an object
reasons_by_method: dict[str, Callable[[Object], str | None]] = {}
_undo_pending = False  # whether the next update is that of undo or redo


# ---------------------------------------------------------------- What was stored just now


def mark_up_to_date(
    context: Context, objects: Iterable[Object], shapes: Mapping[Object, bytes | None] = NO_SHAPES
) -> None:
    """Take objects as up to date, after results were stored; evaluates what storing itself has tagged.

    Parameters
    ----------
    context : bpy.types.Context
        Its view layer has the objects.
    objects : list of bpy.types.Object
        Those whose results were stored or removed.
    shapes : mapping of bpy.types.Object to bytes or None
        Of objects that have just been read, the `surface_digest` of what they show.
    """
    depsgraph = context.evaluated_depsgraph_get()
    for obj in objects:
        mark_object(obj)
        mark = marks.of_results(obj)
        shape = shapes.get(obj)
        if shape is not None and obj.mode == "OBJECT" and not _varies(obj):
            _shapes[mark] = shape
        else:
            _remember_shape(obj, mark, depsgraph)


def mark_fingerprints(context: Context, stored: Iterable[tuple[Object, str]]) -> None:
    """Take other things than results as up to date, after they were stored and nothing else was changed.

    Parameters
    ----------
    context : bpy.types.Context
        Its view layer has the objects.
    stored : iterable of (bpy.types.Object, str)
        The objects, and the marks of what was stored with them.
    """
    with paused():
        depsgraph = context.evaluated_depsgraph_get()
    for obj, mark in stored:
        _set_edited(obj, mark, False)
        _remember_shape(obj, mark, depsgraph)


def mark_object(obj: Object) -> None:
    """Take the stored results as those of the object's geometry as it is now.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    """
    _set_edited(obj, marks.of_results(obj), False)
    _settings.forget(obj)


def mark_from_setting_update(obj: Object) -> None:
    """Do as `mark_object`, from within the update of a setting: what Blender reports next is that update.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    """
    mark_object(obj)
    _settings[obj] = ""


def mark_axes_changed(objects: Iterable[Object]) -> None:
    """Note that objects have other axes than before: directions that are stored in these no longer hold.

    Parameters
    ----------
    objects : iterable of bpy.types.Object
        Original objects.
    """
    for obj in objects:
        if mark := marks.of_symmetry(obj):
            _set_edited(obj, mark, True)


# ---------------------------------------------------------------- What is out of date


def geometry_changes(obj: Object) -> int:
    """Count how often Blender reports a change of the object's geometry; some settings count as such.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Returns
    -------
    int
        How often that was since the first call for this object, or since the file was loaded.
    """
    if obj not in _changes:
        _changes[obj] = 0
    return _changes.get(obj, 0)


def is_edited(obj: Object) -> bool:
    """Return whether geometry or transform have changed since the results were stored, whatever the settings are."""
    mark = marks.parse(marks.of_results(obj))
    return mark is None or _has_new_geometry(obj, mark) or mark.transform != matrix_hash(obj)


def stale_reason(obj: Object, scene: Scene) -> str | None:
    """Compare the stored results with the object.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    scene : bpy.types.Scene
        The scene whose unit scale counts.

    Returns
    -------
    str or None
        The code of why they are out of date; None where they are not, or there are none.
    """
    mark = marks.parse(marks.of_results(obj))
    if mark is None or mark.version != VERSION:
        return "stale_fingerprint" if "body_mass" in obj else None
    reason_of = reasons_by_method.get(str(obj.get("body_method", "")))
    if reason_of is not None:
        return reason_of(obj)
    if mark.settings != settings_hash(obj, scene):
        return "stale_settings"
    if _has_new_geometry(obj, mark):
        return "stale_geometry"
    return "stale_transform" if mark.transform != matrix_hash(obj) else None


def section_stale_reason(obj: Object) -> str | None:
    """Compare the stored section with the object.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Returns
    -------
    str or None
        The code of why it is out of date; None where it is not, or there is none.
    """
    mark = marks.parse(marks.of_section(obj))
    if mark is None:
        return None
    if _has_new_geometry(obj, mark):
        return "stale_geometry"
    return "stale_transform" if mark.transform != matrix_hash(obj) else None


def symmetry_stale_reason(obj: Object) -> str | None:
    """Compare the symmetry that was found with the object.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Returns
    -------
    str or None
        The code of why it is out of date; None where it is not, or there is none.
    """
    mark = marks.parse(marks.of_symmetry(obj))
    if mark is None:
        return None
    if _has_new_geometry(obj, mark):
        return "stale_geometry"
    return "stale_scale" if mark.transform != scale_hash(obj) else None


def _has_new_geometry(obj: Object, mark: marks.Mark) -> bool:
    return mark.geometry == marks.EDITED or ":".join(mark) in _edited.get(obj, ())


# ---------------------------------------------------------------- What is noted


def _set_edited(obj: Object, mark: str, is_edited: bool) -> None:
    """Note that the geometry of what carries this mark has changed, or that it has not."""
    handlers.count_change()
    noted = _edited.get(obj, frozenset())
    _edited[obj] = noted | {mark} if is_edited else noted - {mark}


def _note_updates(updates: handlers.Updates) -> None:
    global _undo_pending
    if paused.depth:
        return
    undone, _undo_pending = _undo_pending, False
    if not (updates.reshaped or updates.moved or updates.collections):
        return
    instancing = instancing_objects((*updates.reshaped, *updates.moved), updates.collections)
    reshaped = dict.fromkeys((*updates.reshaped, *instancing))
    for obj in reshaped if len(_changes) else ():
        if obj in _changes:
            _changes[obj] = geometry_changes(obj) + 1
    for obj in reshaped | dict.fromkeys(volume_filled_objects(reshaped)):
        if carried := marks.of_object(obj):
            _note_update(obj, carried, updates, undone)


def _note_update(obj: Object, carried: list[str], updates: handlers.Updates, undone: bool) -> None:
    """Note a change of the object's geometry, or that there is none any more. undone: whether undo or redo evaluated
    it."""
    came_back = undone and not (obj.mode == "SCULPT" or getattr(obj.data, "is_editmode", False))
    changed = not came_back and not _is_settings_update(obj, carried[0], updates.scene)
    shape = _shape(obj, updates.depsgraph) if any(mark in _shapes for mark in carried) else None
    for mark in carried:
        if shape is not None and mark in _shapes:
            _set_edited(obj, mark, shape != _shapes[mark])
        elif changed or undone and mark in _shapes:  # redo brings back an edit whose note may have been taken back
            _set_edited(obj, mark, True)


def _is_settings_update(obj: Object, mark: str, scene: Scene) -> bool:
    """Whether this update is one of the object's settings: Blender reports those as changes of its geometry."""
    now = settings_hash(obj, scene)
    before = _settings.get(obj, mark.rpartition(":")[2])
    _settings[obj] = now
    return now != before


def _remember_shape(obj: Object, mark: str, depsgraph: Depsgraph) -> None:
    shape = _shape(obj, depsgraph)
    if shape is not None:  # else what another object with these very numbers showed still holds
        _shapes[mark] = shape


def _shape(obj: Object, depsgraph: Depsgraph) -> bytes | None:
    """A digest of all that the numbers come from beside settings and transform; None where there is none."""
    return None if _varies(obj) else shape_digest(obj, depsgraph)


def _varies(obj: Object) -> bool:
    """Whether the numbers may come from more than that."""
    return obj.body_moments.density_from in {"MATERIALS", "ATTRIBUTE", "VOLUME"}


def _note_undo() -> None:
    global _undo_pending
    _undo_pending = True


def _forget_file() -> None:
    global _undo_pending
    _undo_pending = False
    _shapes.clear()


def _write_notes() -> None:
    if not len(_edited):
        return
    for obj in bpy.data.objects:
        edited = _edited.get(obj)
        if edited and obj.is_editable:
            marks.write_edited(obj, edited)


SUBSCRIPTIONS = (
    (handlers.on_update, _note_updates),
    (handlers.on_undo, _note_undo),
    (handlers.on_load, _forget_file),
    (handlers.on_save, _write_notes),
)


def register() -> None:
    """Note edits from now on."""
    for subscribers, function in SUBSCRIPTIONS:
        subscribers.append(function)


def unregister() -> None:
    """Note no more edits; what was noted is written first, for whoever enables the add-on again has the same file."""
    _write_notes()
    for subscribers, function in reversed(SUBSCRIPTIONS):
        subscribers.remove(function)
    _forget_file()
