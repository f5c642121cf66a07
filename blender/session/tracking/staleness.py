# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Staleness of stored numbers.

Compared: transform and settings, by the digests in the marks that results, section and symmetry carry.

Noted: a digest of the geometry would need measuring, so an edit is noted instead, in memory only: the marks that the
object carried when Blender evaluated its geometry anew. When a file is saved, the notes become part of the marks
(`marks.write_edited`), so that the file knows when it is opened; reading a file reports no updates.

Times: Blender evaluates more than the changed objects, such as an object that is copied, shown again or gets a material
slot. So the surfaces of small meshes are kept as digests when their numbers are stored, and a note is made, or taken
back, by comparing the current surfaces. For all other objects every update is an edit, but for

- the update of a setting, which Blender reports as one of the geometry;
- the update that follows undo, which brings back numbers and shape together. An edit that undo brings back again was
  noted when it was made, and notes are kept: undo may bring back the numbers of before, too. In Edit Mode and Sculpt
  Mode it brings back the shape alone, and is an edit.

Means: a handler only writes down which objects were updated, for a frame of an animation may have thousands. The
meaning of updates is found on request (`note_edits`), or before it could not be found any more: before results are
replaced, before undo, and before the file is saved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

import bpy
from bpy.types import Context, Depsgraph, Object, Scene

from ....core.verdict.method import Verdict
from ...read.fingerprint import VERSION, has_transform, matrix_hash, scale_hash, settings_hash, shape_digest
from ...read.tracking import tracking_paused
from ...write import properties
from ..findings import STALE_FINGERPRINT, STALE_GEOMETRY, STALE_SCALE, STALE_SETTINGS, STALE_TRANSFORM
from . import handlers, marks, updates
from .cache import SessionCache

NO_SHAPES: Mapping[Object, bytes | None] = MappingProxyType({})
_edited: SessionCache[frozenset[str]] = SessionCache()  # the marks that an object carried when its geometry changed
_shapes: dict[str, bytes] = {}  # mark → digest of what was shown when it was stored: copies of an object share both
_resolved: dict[int, int] = {}  # session uid → up to which update is noted what it means
# Results of several objects, by the object's type: a function that compares them with the current state.
reasons_by_type: dict[str, Callable[[Object], str | None]] = {}


# ---------------------------------------------------------------- What was stored just now


def mark_up_to_date(
    context: Context, objects: Iterable[Object], shapes: Mapping[Object, bytes | None] = NO_SHAPES
) -> None:
    """Take objects as up to date, after results were stored; evaluate the data that storing itself has tagged.

    objects: objects of the context's view layer with results stored or removed.
    shapes: the `surface_digest` of freshly read objects.
    """
    depsgraph = context.evaluated_depsgraph_get()
    for obj in objects:
        note_edits(obj)  # for its other marks
        mark_object(obj)
        mark = properties.fingerprint(obj)
        shape = shapes.get(obj)
        if shape is not None and obj.mode == "OBJECT" and not _varies(obj):
            _shapes[mark] = shape
        else:
            _remember_shape(obj, mark, depsgraph)


def mark_fingerprints(context: Context, stored: Iterable[tuple[Object, str]]) -> None:
    """Take other things than results as up to date, after they were stored and nothing else was changed.

    stored: objects of the context's view layer, and the marks of the stored data.
    """
    with tracking_paused():
        depsgraph = context.evaluated_depsgraph_get()
    for obj, mark in stored:
        note_edits(obj)
        _set_edited(obj, mark, False)
        _remember_shape(obj, mark, depsgraph)


def mark_object(obj: Object) -> None:
    """Take the stored results as up to date with an original object's current geometry."""
    _resolved[obj.session_uid] = updates.count()
    _set_edited(obj, properties.fingerprint(obj), False)
    handlers.count_change()


def replace_mark(obj: Object, before: str) -> None:
    """Take over the notes on the results, after numbers and settings were changed together and the shape was not.

    before: the mark of the results that were replaced.
    """
    mark = properties.fingerprint(obj)
    _set_edited(obj, mark, before in _edited_marks(obj))
    if before in _shapes:
        _shapes[mark] = _shapes[before]


def pin(obj: Object) -> None:
    """Take the results of an object as valid in its current place, after results that depend on it were stored.

    obj: an original object that can hold results.
    """
    mark = marks.parse(before := properties.fingerprint(obj))
    if mark is not None and has_transform(obj, mark.transform):
        obj["body_fingerprint"] = ":".join(mark._replace(transform=matrix_hash(obj)))
        replace_mark(obj, before)


def mark_axes_changed(objects: Iterable[Object]) -> None:
    """Note that objects have other axes than before: directions that are stored in these no longer hold."""
    for obj in objects:
        if mark := marks.of_symmetry(obj):
            _set_edited(obj, mark, True)


# ---------------------------------------------------------------- What is out of date


def is_edited(obj: Object) -> bool:
    """Return whether geometry or transform have changed since the results were stored, whatever the settings are."""
    mark = marks.parse(properties.fingerprint(obj))
    return mark is None or _has_new_geometry(obj, mark) or not has_transform(obj, mark.transform)


def stale_reason(obj: Object, scene: Scene) -> str | None:
    """Return the code of the reason why an original object's stored results are out of date.

    None if they are up to date, or there are none. scene: sets the unit scale.
    """
    mark = marks.parse(properties.fingerprint(obj))
    if mark is None or mark.version != VERSION:
        return STALE_FINGERPRINT if "body_mass" in obj else None
    if obj.get("body_method") == Verdict.ASSEMBLY and obj.type in reasons_by_type:
        return reasons_by_type[obj.type](obj)
    if mark.settings != settings_hash(obj, scene):
        return STALE_SETTINGS
    if _has_new_geometry(obj, mark):
        return STALE_GEOMETRY
    return None if has_transform(obj, mark.transform) else STALE_TRANSFORM


def has_transform_of_results(obj: Object) -> bool:
    """Return whether an object has the scale of its stored results, and a place that they hold in."""
    mark = marks.parse(properties.fingerprint(obj))
    return mark is not None and has_transform(obj, mark.transform)


def section_stale_reason(obj: Object) -> str | None:
    """Return the code of the reason why an original object's stored section is out of date.

    None if it is up to date, or there is none.
    """
    mark = marks.parse(marks.of_section(obj))
    if mark is None:
        return None
    if _has_new_geometry(obj, mark):
        return STALE_GEOMETRY
    return STALE_TRANSFORM if mark.transform != matrix_hash(obj) else None


def symmetry_stale_reason(obj: Object) -> str | None:
    """Return the code of the reason why an original object's stored symmetry is out of date.

    None if it is up to date, or there is none.
    """
    mark = marks.parse(marks.of_symmetry(obj))
    if mark is None:
        return None
    if _has_new_geometry(obj, mark):
        return STALE_GEOMETRY
    return STALE_SCALE if mark.transform != scale_hash(obj) else None


def _edited_marks(obj: Object) -> frozenset[str]:
    return _edited.get(obj) or frozenset()


def _has_new_geometry(obj: Object, mark: marks.Mark) -> bool:
    note_edits(obj)
    return mark.geometry == marks.EDITED or ":".join(mark) in _edited_marks(obj)


# ---------------------------------------------------------------- What is noted


def _set_edited(obj: Object, mark: str, is_edited: bool) -> None:
    """Note that the geometry behind this mark has changed, or that it has not."""
    noted = _edited_marks(obj)
    if is_edited != (mark in noted):
        handlers.count_change()
        _edited[obj] = noted | {mark} if is_edited else noted - {mark}


def note_edits(obj: Object) -> None:
    """Note the effects of all updates since the last call on the marks of an original object.

    Call it before its marks are replaced: later nobody could say whether the geometry has changed since.
    """
    uid, newest = obj.session_uid, updates.count()
    seen = _resolved.get(uid, 0)
    if seen >= newest:
        return
    _resolved[uid] = newest
    edit, returned = updates.last_edit(obj, seen), updates.last_return(obj)
    last = max(edit, returned)
    if last.number <= seen:
        return
    carried = marks.of_object(obj)
    shape = _shape(obj, updates.depsgraph_of(last)) if any([mark in _shapes for mark in carried]) else None
    for mark in carried:
        if shape is not None and mark in _shapes:
            _set_edited(obj, mark, shape != _shapes[mark])
        elif edit.number or mark in _shapes:  # redo brings back an edit whose note may have been taken back
            _set_edited(obj, mark, True)


def _remember_shape(obj: Object, mark: str, depsgraph: Depsgraph) -> None:
    shape = _shape(obj, depsgraph)
    if shape is not None:  # else what another object with these very numbers showed still holds
        _shapes[mark] = shape


def _shape(obj: Object, depsgraph: Depsgraph | None) -> bytes | None:
    """Return a digest of all inputs of the numbers beside settings and transform; None if there is none."""
    return None if depsgraph is None or _varies(obj) else shape_digest(obj, depsgraph)


def _varies(obj: Object) -> bool:
    """Return whether the numbers may have further inputs."""
    return obj.body_moments.density_from in {"MATERIALS", "ATTRIBUTE", "VOLUME"}


def _note_all_edits() -> None:
    for obj in bpy.data.objects if updates.count() else ():  # while the add-on is enabled Blender gives no data
        note_edits(obj)


def _forget_file() -> None:
    _resolved.clear()
    _shapes.clear()


def _write_notes() -> None:
    _note_all_edits()
    for obj in bpy.data.objects if len(_edited) else ():
        edited = _edited.get(obj)
        if edited and obj.is_editable:
            marks.write_edited(obj, edited)


SUBSCRIPTIONS = (
    (handlers.before_undo, _note_all_edits),
    (handlers.on_load, _forget_file),
    (handlers.on_save, _write_notes),
)


def register() -> None:
    """Note edits from now on."""
    for subscribers, function in SUBSCRIPTIONS:
        subscribers.append(function)


def unregister() -> None:
    """Stop noting edits, but write the existing notes first, for the file may outlive the add-on."""
    _write_notes()
    for subscribers, function in reversed(SUBSCRIPTIONS):
        subscribers.remove(function)
    _forget_file()
