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

How: a handler only writes down which objects were updated, for a frame of an animation may have thousands. What that
means is found when somebody asks (`_resolve`), or before it could not be found any more: before results are replaced,
before undo, and before the file is saved.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import bpy
from bpy.types import Context, Depsgraph, Object, PropertyGroup, Scene

from ..read.fingerprint import VERSION, has_transform, matrix_hash, scale_hash, settings_hash, shape_digest
from ..read.quiet import paused
from ..settings import hooks
from . import handlers, marks
from .affected import density_source, shown_by
from .cache import SessionCache


class _Stamp(NamedTuple):
    """An update: its number, and the scene and view layer that were evaluated."""

    number: int
    scene: int
    view_layer: str


_NEVER = _Stamp(0, 0, "")
# session uid → the last update of a data-block
_edits: dict[int, _Stamp] = {}  # of its geometry, which may be an edit
_returns: dict[int, _Stamp] = {}  # of its geometry, which is none: of a setting, or after undo
_moves: dict[int, _Stamp] = {}  # of its transform alone
_touches: dict[int, _Stamp] = {}  # of anything else
_last_update = 0  # number
_resolved: dict[int, int] = {}  # session uid → up to which update is noted what it means
_set_since: set[int] = set()  # objects of which a setting was changed since the last update
_undo_pending = False  # whether the next update is that of undo or redo

_edited: SessionCache[frozenset[str]] = SessionCache()  # the marks that an object carried when its geometry changed
_shapes: dict[str, bytes] = {}  # mark → digest of what was shown when it was stored: copies of an object share both


# ---------------------------------------------------------------- What was stored just now


def mark_up_to_date(context: Context, objects: list[Object]) -> None:
    """Take objects as up to date, after results were stored; evaluates what storing itself has tagged.

    Parameters
    ----------
    context : bpy.types.Context
        Its view layer has the objects.
    objects : list of bpy.types.Object
        Those whose results were stored or removed.
    """
    depsgraph = context.evaluated_depsgraph_get()
    for obj in objects:
        note_edits(obj)  # of its other marks
        mark_object(obj)
        _remember_shape(obj, marks.of_results(obj), depsgraph)


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
        note_edits(obj)
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
    handlers.count_change()


def replace_mark(obj: Object, before: str) -> None:
    """Take over what is noted of the results, after numbers and settings were changed together and the shape was not.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    before : str
        The mark of the results that were replaced.
    """
    mark = marks.of_results(obj)
    _set_edited(obj, mark, before in _edited.get(obj, ()))
    if before in _shapes:
        _shapes[mark] = _shapes[before]


def note_edits(obj: Object) -> None:
    """Note what Blender has reported of an object, before its marks are replaced: nobody could say later whether the
    geometry has changed since those.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    """
    _resolve(obj)


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
    """Return a number that grows with every change of the object's geometry that Blender reports; some settings count
    as such.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Returns
    -------
    int
    """
    return max(_last_edit(obj).number, _returns.get(obj.session_uid, _NEVER).number)


def last_update(obj: Object) -> int:
    """Return a number that grows with whatever Blender reports of the object or of what it shows.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Returns
    -------
    int
    """
    uid = obj.session_uid
    return max(geometry_changes(obj), _moves.get(uid, _NEVER).number, _touches.get(uid, _NEVER).number)


def is_edited(obj: Object) -> bool:
    """Return whether geometry or transform have changed since the results were stored, whatever the settings are."""
    mark = marks.parse(marks.of_results(obj))
    return mark is None or _has_new_geometry(obj, mark) or not has_transform(obj, mark.transform)


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
    if mark.settings != settings_hash(obj, scene):
        return "stale_settings"
    if _has_new_geometry(obj, mark):
        return "stale_geometry"
    return None if has_transform(obj, mark.transform) else "stale_transform"


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
    _resolve(obj)
    return mark.geometry == marks.EDITED or ":".join(mark) in _edited.get(obj, ())


# ---------------------------------------------------------------- What is noted


def _set_edited(obj: Object, mark: str, is_edited: bool) -> None:
    """Note that the geometry of what carries this mark has changed, or that it has not."""
    noted = _edited.get(obj, frozenset())
    if is_edited != (mark in noted) or obj not in _edited:
        handlers.count_change()
        _edited[obj] = noted | {mark} if is_edited else noted - {mark}


def _note_updates(updates: handlers.Updates) -> None:
    global _last_update, _undo_pending, _set_since
    if paused.depth:
        return
    undone, _undo_pending = _undo_pending, False
    changed_settings, _set_since = _set_since, set()
    _last_update += 1
    stamp = _Stamp(_last_update, updates.scene.session_uid, updates.depsgraph.view_layer.name)
    if undone:
        edits = _edited_by_undo(updates)
        _returns.update(dict.fromkeys([uid for uid in updates.reshaped if uid not in edits], stamp))
        _edits.update(dict.fromkeys(edits, stamp))
        _touches.update(dict.fromkeys((*updates.moved, *updates.others), stamp))
        return
    reshaped: Iterable[int] = updates.reshaped
    if changed_settings and not updates.frame_changed:
        of_settings = changed_settings.intersection(reshaped) - _with_new_data(updates)
        _returns.update(dict.fromkeys(of_settings, stamp))
        reshaped = [uid for uid in reshaped if uid not in of_settings]
    _edits.update(dict.fromkeys(reshaped, stamp))
    _edits.update(dict.fromkeys(updates.collections, stamp))
    _moves.update(dict.fromkeys(updates.moved, stamp))
    _touches.update(dict.fromkeys(updates.others, stamp))


def _edited_by_undo(updates: handlers.Updates) -> set[int]:
    """The updated objects of which undo brings back the shape alone."""
    objects = [update.id.original for update in updates.depsgraph.updates if isinstance(update.id, Object)]
    return {
        obj.session_uid for obj in objects if obj.mode == "SCULPT" or getattr(obj.data, "is_editmode", False)
    } & set(updates.reshaped)


def _with_new_data(updates: handlers.Updates) -> set[int]:
    """The updated objects whose mesh, curve or shape keys are updated too: that is no setting."""
    evaluated = [update.id for update in updates.depsgraph.updates if update.is_updated_geometry]
    data = {changed.original for changed in evaluated if not isinstance(changed, Object)}
    objects = [changed.original for changed in evaluated if isinstance(changed, Object)]
    return {
        obj.session_uid for obj in objects if obj.data in data or getattr(obj.data, "shape_keys", None) in data
    }


def _last_edit(obj: Object, since: int = 0) -> _Stamp:
    """The last update of the object, or of what it shows, that may be an edit, `_NEVER` where none came after the
    update `since`."""
    last = _edits.get(obj.session_uid, _NEVER)
    for shown in shown_by(obj):
        last = max(last, *[stamps.get(shown.session_uid, _NEVER) for stamps in (_edits, _moves)])
    if (source := density_source(obj)) is not None:
        last = max(last, _edits.get(source.session_uid, _NEVER))
    return last if last.number > since else _NEVER


def _resolve(obj: Object) -> None:
    """Note what the updates since the last call mean for the marks of an object."""
    uid = obj.session_uid
    seen = _resolved.get(uid, 0)
    if seen >= _last_update:
        return
    _resolved[uid] = _last_update
    edit, returned = _last_edit(obj, seen), _returns.get(uid, _NEVER)
    last = max(edit, returned)
    if last.number <= seen:
        return
    carried = marks.of_object(obj)
    shape = _shape(obj, _depsgraph(last)) if any([mark in _shapes for mark in carried]) else None
    for mark in carried:
        if shape is not None and mark in _shapes:
            _set_edited(obj, mark, shape != _shapes[mark])
        elif edit.number or mark in _shapes:  # redo brings back an edit whose note may have been taken back
            _set_edited(obj, mark, True)


def _depsgraph(stamp: _Stamp) -> Depsgraph | None:
    """The dependency graph that an update was of, as it was evaluated last."""
    for scene in bpy.data.scenes:
        if scene.session_uid == stamp.scene:
            layer = scene.view_layers.get(stamp.view_layer)
            return None if layer is None else layer.depsgraph
    return None


def _remember_shape(obj: Object, mark: str, depsgraph: Depsgraph) -> None:
    shape = _shape(obj, depsgraph)
    if shape is not None:  # else what another object with these very numbers showed still holds
        _shapes[mark] = shape


def _shape(obj: Object, depsgraph: Depsgraph | None) -> bytes | None:
    """A digest of all that the numbers come from beside settings and transform; None where there is none."""
    if depsgraph is None or obj.body_moments.density_from in {"MATERIALS", "ATTRIBUTE", "VOLUME"}:
        return None
    return shape_digest(obj, depsgraph)


def _note_setting(settings: PropertyGroup, _context: Context) -> None:
    _set_since.add(settings.id_data.session_uid)


def _before_undo() -> None:
    for obj in bpy.data.objects if _last_update else ():
        _resolve(obj)


def _note_undo() -> None:
    global _undo_pending
    _undo_pending = True


def _forget_file() -> None:
    global _undo_pending, _last_update
    _undo_pending, _last_update = False, 0
    for remembered in (_edits, _returns, _moves, _touches, _resolved, _set_since, _shapes):
        remembered.clear()


def _write_notes() -> None:
    for obj in bpy.data.objects if _last_update or len(_edited) else ():
        _resolve(obj)
        edited = _edited.get(obj)
        if edited and obj.is_editable:
            marks.write_edited(obj, edited)


SUBSCRIPTIONS = (
    (handlers.on_update, _note_updates),
    (handlers.before_undo, _before_undo),
    (handlers.on_undo, _note_undo),
    (handlers.on_load, _forget_file),
    (handlers.on_save, _write_notes),
    (hooks.on_change, _note_setting),
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
