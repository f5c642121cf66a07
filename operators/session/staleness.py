# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether stored numbers are out of date.

Transform and settings are compared by their digests in the fingerprint. A digest of the geometry
would need measuring, so a handler notes, in memory only, which objects' geometry Blender
re-evaluated after their numbers were stored: a note is the pair of the object's session uid and the
fingerprint that it then carried. Nothing is written to any data, until a file is saved: then the geometry's
digest in the fingerprints of noted objects becomes EDITED, so that the file knows when it is opened.

Blender re-evaluates more than what was changed: an object that is copied, shown again or gets a material slot. So
what small meshes showed when their numbers were stored is kept, as a digest, and a note is made, or taken back, by
comparing what they show now.

Undo re-evaluates what it brings back, which is no edit: of what cannot be compared, the one update that follows it is
not noted. An edit that undo brings back again was noted when it was made, and notes are kept: undo may
bring back the numbers of before, too. In Edit Mode and Sculpt Mode it brings back the shape alone, and is an edit.
Reading a file reports no updates.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy
from bpy.app.handlers import persistent
from bpy.types import Collection, Context, Depsgraph, Object, Scene

from ..read.fingerprint import VERSION, matrix_hash, scale_hash, settings_hash, shape_digest
from ..read.quiet import paused
from ..write import section

EDITED_REASON = "edited"

_settings: dict[int, str] = {}  # session uid → digest of the settings at the last update
_edited: dict[int, set[str]] = {}  # session uid → the fingerprints that were current when the geometry changed
_changes: dict[int, int] = {}  # session uid → how often its geometry changed
_shapes: dict[str, bytes] = {}  # fingerprint → digest of what was shown when it was stored, where there is one
_undo_pending = False
_generation = 0


def mark_up_to_date(context: Context, objects: list[Object]) -> None:
    """Call after results were stored: evaluates what storing itself has tagged, then takes the
    objects as up to date.
    """
    depsgraph = context.evaluated_depsgraph_get()
    for obj in objects:
        mark_object(obj)
        _remember_shape(obj, str(obj.get("body_fingerprint", "")), depsgraph)


def mark_fingerprints(context: Context, marks: Iterable[tuple[Object, str]]) -> None:
    """Call after other things were stored with these fingerprints, and nothing else was changed: takes those as up to
    date.
    """
    with paused():
        depsgraph = context.evaluated_depsgraph_get()
    for obj, mark in marks:
        _clear_mark(obj, mark)
        _remember_shape(obj, mark, depsgraph)


def mark_object(obj: Object) -> None:
    """The object's stored numbers are those of its geometry as it is now."""
    _clear_mark(obj, str(obj.get("body_fingerprint", "")))
    _settings.pop(obj.session_uid, None)


def _clear_mark(obj: Object, mark: str) -> None:
    global _generation
    _generation += 1
    _edited.get(obj.session_uid, set()).discard(mark)


def _remember_shape(obj: Object, mark: str, depsgraph: Depsgraph) -> None:
    shape = _shape(obj, depsgraph)
    if shape is not None:  # else what another object with these very numbers showed still holds
        _shapes[mark] = shape


def _shape(obj: Object, depsgraph: Depsgraph) -> bytes | None:
    """A digest of all that the numbers come from beside settings and transform; None where there is none."""
    if obj.body_moments.density_from in {"MATERIALS", "ATTRIBUTE", "VOLUME"}:
        return None
    return shape_digest(obj, depsgraph)


def mark_from_setting_update(obj: Object) -> None:
    """As `mark_object`, from within the update of a setting: what Blender reports next is that update."""
    mark_object(obj)
    _settings[obj.session_uid] = ""


def mark_axes_changed(objects: Iterable[Object]) -> None:
    """The objects have other axes than before: directions that are stored in these no longer hold."""
    for obj in objects:
        if mark := _symmetry_mark(obj):
            _edited.setdefault(obj.session_uid, set()).add(mark)


def generation() -> int:
    """Grows with every change that Blender reports; what was cached under an older one may be
    wrong.
    """
    return _generation


def geometry_changes(obj: Object) -> int:
    """How often Blender has reported a change of the object's geometry; some settings count as such."""
    return _changes.get(obj.session_uid, 0)


def is_edited(obj: Object) -> bool:
    """Whether geometry or transform have changed since the numbers were stored, whatever the settings are."""
    stored = str(obj.get("body_fingerprint", ""))
    parts = stored.split(":")
    return (
        len(parts) != 4
        or parts[1] == EDITED_REASON
        or stored in _edited.get(obj.session_uid, ())
        or parts[2] != matrix_hash(obj)
    )


def stale_reason(obj: Object, scene: Scene) -> str | None:
    """The code of why the stored numbers are out of date, None where they are not or there are none."""
    stored = str(obj.get("body_fingerprint", ""))
    parts = stored.split(":")
    if len(parts) != 4 or parts[0] != VERSION:
        return "stale_fingerprint" if "body_mass" in obj else None
    if parts[3] != settings_hash(obj, scene):
        return "stale_settings"
    if parts[1] == EDITED_REASON or stored in _edited.get(obj.session_uid, ()):
        return "stale_geometry"
    return "stale_transform" if parts[2] != matrix_hash(obj) else None


def section_stale_reason(obj: Object) -> str | None:
    """The code of why the stored section is out of date, None where it is not or there is none."""
    parts = section.fingerprint(obj).split(":")
    if len(parts) != 4:
        return None
    if parts[1] == EDITED_REASON or section.fingerprint(obj) in _edited.get(obj.session_uid, ()):
        return "stale_geometry"
    return "stale_transform" if parts[2] != matrix_hash(obj) else None


def symmetry_stale_reason(obj: Object) -> str | None:
    """The code of why the symmetry that was found is out of date, None where it is not or there is none."""
    stored = _symmetry_mark(obj)
    parts = stored.split(":")
    if len(parts) != 4:
        return None
    if parts[1] == EDITED_REASON or stored in _edited.get(obj.session_uid, ()):
        return "stale_geometry"
    return "stale_scale" if parts[2] != scale_hash(obj) else None


def _symmetry_mark(obj: Object) -> str:
    # Asked first: reading a group that is not there makes one.
    return obj.body_moments_symmetry.fingerprint if obj.is_property_set("body_moments_symmetry") else ""


def _is_settings_update(obj: Object, fingerprint: str, scene: Scene) -> bool:
    """Whether this update is one of the object's settings: Blender reports those as changes of its geometry."""
    now = settings_hash(obj, scene)
    before = _settings.get(obj.session_uid, fingerprint.rpartition(":")[2])
    _settings[obj.session_uid] = now
    return now != before


def _volume_filled_objects(updated: Iterable[Object]) -> Iterator[Object]:
    """Those with stored numbers whose density comes from one of these objects' voxels."""
    sources = {obj for obj in updated if obj.type == "VOLUME"}
    if not sources:
        return
    for obj in bpy.data.objects:
        if "body_fingerprint" in obj:
            settings = obj.body_moments
            if settings.density_from == "VOLUME" and settings.density_volume in sources:
                yield obj


def _instancing_objects(updated: list[Object], collections: set[Collection]) -> Iterator[Object]:
    """Those that show what was updated as instances, which Blender reports of collections only."""
    above: set[Object] = set()
    for obj in updated:
        while (obj := obj.parent) is not None and obj not in above:
            above.add(obj)
            if obj.instance_type in {"VERTS", "FACES"}:
                yield obj
    emitted = {
        settings
        for settings in bpy.data.particles
        if settings.instance_object in updated or settings.instance_collection in collections
    }
    for obj in bpy.data.objects if collections or emitted else ():
        if (
            obj.instance_type == "COLLECTION"
            and obj.instance_collection in collections
            or emitted
            and any(system.settings in emitted for system in obj.particle_systems)
        ):
            yield obj


@persistent
def _on_depsgraph_update(scene: Scene, depsgraph: Depsgraph | None = None) -> None:
    global _generation, _undo_pending
    _generation += 1
    if paused.depth or depsgraph is None or depsgraph.mode != "VIEWPORT":
        return
    undone, _undo_pending = _undo_pending, False
    updated: dict[Object, None] = {}
    moved: list[Object] = []
    collections: set[Collection] = set()
    for update in depsgraph.updates:
        data, reshaped = update.id, update.is_updated_geometry
        if isinstance(data, Object):
            if reshaped:
                updated[data.original] = None
            elif update.is_updated_transform:
                moved.append(data.original)
        elif reshaped and isinstance(data, Collection):
            collections.add(data.original)
    updated |= dict.fromkeys(_instancing_objects([*updated, *moved], collections))
    for obj in updated:
        _changes[obj.session_uid] = _changes.get(obj.session_uid, 0) + 1
    for obj in updated | dict.fromkeys(_volume_filled_objects(updated)):
        marks = [
            str(mark) for mark in (obj.get("body_fingerprint"), section.fingerprint(obj), _symmetry_mark(obj)) if mark
        ]
        if marks:
            came_back = undone and not (obj.mode == "SCULPT" or getattr(obj.data, "is_editmode", False))
            _update_staleness(
                obj, marks, depsgraph, undone, heard=not came_back and not _is_settings_update(obj, marks[0], scene)
            )


def _update_staleness(obj: Object, marks: list[str], depsgraph: Depsgraph, undone: bool, heard: bool) -> None:
    """Note a change of the object's geometry, or that there is none any more. undone: whether undo or redo evaluated
    it, heard: whether what could never be compared has changed."""
    noted = _edited.setdefault(obj.session_uid, set())
    shape = _shape(obj, depsgraph) if any(mark in _shapes for mark in marks) else None
    for mark in marks:
        if shape is not None and mark in _shapes:
            (noted.discard if shape == _shapes[mark] else noted.add)(mark)
        elif heard or undone and mark in _shapes:  # the note of an edit that redo brings back may have been taken back
            noted.add(mark)


@persistent
def _on_undo(*_args) -> None:
    global _generation, _undo_pending
    _generation += 1
    _undo_pending = True


@persistent
def _on_load(*_args) -> None:
    global _generation, _undo_pending
    _generation += 1
    _undo_pending = False
    _edited.clear()
    _shapes.clear()
    _settings.clear()
    _changes.clear()


@persistent
def _on_save(*_args) -> None:
    for obj in bpy.data.objects:
        edited = _edited.get(obj.session_uid, ())
        if not edited or not obj.is_editable:
            continue
        for stored, group, key in (
            (str(obj.get("body_fingerprint", "")), obj, "body_fingerprint"),
            (section.fingerprint(obj), obj.get(section.KEY), "fingerprint"),
        ):
            parts = stored.split(":")
            if len(parts) == 4 and stored in edited:
                group[key] = ":".join([parts[0], EDITED_REASON, *parts[2:]])
        parts = _symmetry_mark(obj).split(":")
        if len(parts) == 4 and _symmetry_mark(obj) in edited:
            obj.body_moments_symmetry.fingerprint = ":".join([parts[0], EDITED_REASON, *parts[2:]])


HANDLERS = (
    ("depsgraph_update_post", _on_depsgraph_update),
    ("frame_change_post", _on_depsgraph_update),
    ("undo_post", _on_undo),
    ("redo_post", _on_undo),
    ("load_post", _on_load),
    ("save_pre", _on_save),
)


def register() -> None:
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister() -> None:
    _on_save()  # whoever enables the add-on again has the same file
    for name, function in reversed(HANDLERS):
        getattr(bpy.app.handlers, name).remove(function)
    _on_load()
