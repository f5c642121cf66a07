# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Staleness of stored numbers: transform and settings are compared by the digests in stamps; edits
are noted.

A note is a stamp that the object carried when Blender evaluated its geometry anew. When a file is
saved, the notes become part of the stamps (`stamps.write_edited`), because opening the file again
reports no updates.

Not every update is an edit: Blender also evaluates an object that is copied, shown again or gets a
material slot. So the surfaces of small meshes are kept as digests, which are compared. For all
other objects every update is an edit, except that of a setting and the one after undo, which
restores numbers and shape together (in Edit Mode and Sculpt Mode the shape alone). Notes are kept,
because undo may restore the numbers before the edit, too.

A handler only writes down the updated objects; their effects are noted on request (`note_edits`),
and at the latest before results are replaced, before undo, and before the file is saved.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import bpy
from bpy.types import Collection, Context, Depsgraph, Object, Scene

from ....core import measurement
from ... import read, scale, settings, write
from .. import memory
from . import handlers, stamps, updates
from .stamps import EDITED, Kind, Stale, Stamp

NO_SHAPES: Mapping[Object, bytes | None] = MappingProxyType({})


# ---------------------------------------------------------------- Comparison


def stale_reason(
    owner: Object | Collection, scene: Scene, kind: Kind = Kind.RESULTS
) -> Stale | None:
    """Return the reason why results, or other data of a kind, are out of date, or None."""
    stamp = stamps.stamp_of(owner, kind)
    if stamp is None:
        return None
    if stamp.version != measurement.settings.VERSION:
        return Stale.FINGERPRINT
    for reason, holds in CHECKS[stamp.kind]:
        if not holds(owner, stamp, scene):
            return reason
    return None


# The functions of CHECKS return whether a part of a stamp is that of the present scene.


def _has_settings(obj: Object, stamp: Stamp, scene: Scene) -> bool:
    return stamp.settings == read.fingerprint.settings_hash(obj, scene)


def _has_geometry(obj: Object, stamp: Stamp, _scene: Scene | None = None) -> bool:
    note_edits(obj)
    return _is_unedited(obj, stamp)


def _is_unedited(obj: Object, stamp: Stamp, _scene: Scene | None = None) -> bool:
    edited = _edited_stamps(obj)
    return stamp.geometry != EDITED and not (edited and stamp.text in edited)


def _has_matrix(owner: Object | Collection, stamp: Stamp, _scene: Scene) -> bool:
    return not isinstance(owner, Object) or stamp.transform == read.fingerprint.matrix_hash(owner)


def _has_structure(root: Object | Collection, stamp: Stamp, scene: Scene) -> bool:
    digests = _cached_member_digests(root, scene)
    return digests is None or stamp.settings == digests.structure


def _has_members(root: Object | Collection, stamp: Stamp, scene: Scene) -> bool:
    digests = _cached_member_digests(root, scene)
    return digests is None or stamp.geometry == digests.results


def was_current(root: Object | Collection, scene: Scene) -> bool:
    """Return whether a total was up to date before the settings of members changed. Blender reports
    that later, so no cached digests are used, and such members count as up to date.
    """
    stamp = stamps.stamp_of(root)
    digests = _member_digests(root, scene, (None, Stale.SETTINGS))
    if (
        stamp is None
        or stamp.version != measurement.settings.VERSION
        or not _has_matrix(root, stamp, scene)
    ):
        return False
    return digests is None or digests == (stamp.settings, stamp.geometry)


class _MemberDigests(NamedTuple):
    """Digests of an assembly's or character's structure, and of its members' stored results; ""
    for these if one is out of date, and for characters.
    """

    structure: str
    results: str


def _member_digests(
    root: Object | Collection, scene: Scene, current: tuple[Stale | None, ...] = (None,)
) -> _MemberDigests | None:
    """Return the present digests, None if nothing is evaluated. current: the reasons with which a
    member counts as up to date.
    """
    if isinstance(root, Object) and root.type == "ARMATURE":
        return _MemberDigests(
            read.rig.rig_hash(root, read.rig.rig_objects(root, scene.objects), scene), ""
        )
    depsgraph = bpy.context.view_layer.depsgraph
    if depsgraph is None:
        return None
    assembly = read.assembly
    member = assembly.members_of(root, depsgraph)
    measured = [
        part.data
        for part in member.walk()
        if part.kind == assembly.MemberKind.OBJECT and part.is_measured
    ]
    texts = {obj: write.properties.fingerprint(obj) for obj in measured}
    is_stale = any(stale_reason(obj, scene) not in current for obj in measured)
    results = (
        ""
        if is_stale
        else measurement.settings.digest(assembly.members_key(member, texts).encode())
    )
    return _MemberDigests(assembly.structure_hash(member), results)


_cached_member_digests = memory.until_change(_member_digests)

# Undo brings none of these back.
IN_MEMORY = (Kind.MOMENTS, Kind.HULL, Kind.FLOATING, Kind.LEVEL, Kind.CUT_FILL)
CHECKS = {
    Kind.RESULTS: (
        (Stale.SETTINGS, _has_settings),
        (Stale.GEOMETRY, _has_geometry),
        (
            Stale.TRANSFORM,
            lambda obj, stamp, _scene: read.fingerprint.has_transform(obj, stamp.transform),
        ),
    ),
    **dict.fromkeys(
        (Kind.SECTION, Kind.CUT_FILL),
        (
            (
                Stale.UNIT_SCALE,
                lambda _obj, stamp, scene: stamp.extra == scale.meters_per_unit(scene),
            ),
            (Stale.GEOMETRY, _has_geometry),
            (Stale.TRANSFORM, _has_matrix),
        ),
    ),
    Kind.SYMMETRY: (
        (Stale.GEOMETRY, _has_geometry),
        (
            Stale.SCALE,
            lambda obj, stamp, _scene: stamp.transform == read.fingerprint.scale_hash(obj),
        ),
    ),
    Kind.ASSEMBLY: (
        (Stale.MEMBERS, _has_structure),
        (Stale.MEMBER, _has_members),
        (Stale.TRANSFORM, _has_matrix),
    ),
    Kind.BONES: ((Stale.GEOMETRY, _is_unedited), (Stale.BONES, _has_structure)),
    **dict.fromkeys(
        (Kind.MOMENTS, Kind.LEVEL),
        (
            (Stale.SETTINGS, _has_settings),
            (Stale.GEOMETRY, _has_geometry),
            (Stale.TRANSFORM, _has_matrix),
        ),
    ),
    Kind.HULL: ((Stale.GEOMETRY, _has_geometry),),
    Kind.FLOATING: ((Stale.SETTINGS, _has_settings), (Stale.GEOMETRY, _has_geometry)),
    Kind.LIVE: ((Stale.SETTINGS, _has_settings),),
    Kind.COLLIDERS: (
        (Stale.SETTINGS, _has_settings),
        (Stale.GEOMETRY, _has_geometry),
        (
            Stale.TRANSFORM,
            lambda obj, stamp, _scene: read.fingerprint.has_scale(
                obj, stamp.transform, [*obj[settings.given.COLLIDERS].get("scale", ())]
            ),
        ),
        (
            Stale.COLLIDERS,
            lambda obj, _stamp, _scene: (
                obj[settings.given.COLLIDERS].get("digest")
                == read.fingerprint.colliders_digest(obj)
            ),
        ),
    ),
}


def is_edited(obj: Object) -> bool:
    """Return whether geometry or transform changed since the results were stored, or there are no
    results.
    """
    stamp = stamps.stamp_of(obj)
    return stamp is None or not (
        _has_geometry(obj, stamp) and read.fingerprint.has_transform(obj, stamp.transform)
    )


# ---------------------------------------------------------------- Marks after storing


def mark_up_to_date(
    context: Context, objects: Iterable[Object], shapes: Mapping[Object, bytes | None] = NO_SHAPES
) -> None:
    """Mark freshly stored results of objects as up to date, after evaluating what storing has
    tagged.

    objects: with results stored or removed. shapes: the `Surface.digest` of freshly read ones.
    """
    depsgraph = context.evaluated_depsgraph_get()
    for obj in objects:
        note_edits(obj)  # for its other stamps
        mark_object(obj)
        if (stamp := stamps.stamp_of(obj)) is not None:
            _remember_shape(obj, stamp, depsgraph, shapes.get(obj))


def mark_stored(context: Context, objects: Iterable[Object], kind: Kind) -> None:
    """Mark fresh stored data of a kind, such as sections, as up to date, if nothing else was
    changed.
    """
    with read.tracking.tracking_paused():
        depsgraph = context.evaluated_depsgraph_get()
    for obj in objects:
        if (stamp := stamps.stamp_of(obj, kind)) is not None:
            _mark_stamp(obj, stamp, depsgraph)


def carry(obj: Object, kind: Kind, depsgraph: Depsgraph) -> None:
    """Mark data in memory of a kind as those of an original object as it is now.

    The geometry's part of the stamp only has to differ from those of other data and updates.
    """
    stamp = Stamp(
        kind,
        measurement.settings.VERSION,
        "{:s} {:d} {:d}".format(kind.value, obj.session_uid, memory.state.updates),
        read.fingerprint.matrix_hash(obj),
        read.fingerprint.settings_hash(obj, depsgraph.scene),
        scale.meters_per_unit(depsgraph.scene),
    )
    memory.carried[obj] = {**(memory.carried.get(obj) or {}), kind: stamp}
    _mark_stamp(obj, stamp, depsgraph)
    handlers.count_change(obj)


def _mark_stamp(obj: Object, stamp: Stamp, depsgraph: Depsgraph) -> None:
    """Mark a stamp as that of the present geometry, after noting what came before."""
    note_edits(obj)
    set_edited(obj, stamp.text, False)
    _remember_shape(obj, stamp, depsgraph)


def mark_object(obj: Object) -> None:
    """Mark the stored results as up to date with an original object's current geometry. Edits that
    are not noted yet are dropped for all its stamps, so call `note_edits` first if it has others.
    """
    memory.resolved[obj.session_uid] = memory.state.updates
    set_edited(obj, write.properties.fingerprint(obj), False)
    handlers.count_change(obj)


def replace_stamp(obj: Object, before: str) -> None:
    """Carry the notes on results over to those that replace them, of the same shape. before: the
    text of the replaced stamp.
    """
    text = write.properties.fingerprint(obj)
    set_edited(obj, text, before in _edited_stamps(obj))
    if before in memory.shapes:
        memory.shapes[text] = memory.shapes[before]


def pin(obj: Object) -> None:
    """Bind an object's results to its current place, after data that depend on the place were
    stored with them.
    """
    stamp = stamps.stamp_of(obj)
    if stamp is not None and stamp.version and read.fingerprint.has_transform(obj, stamp.transform):
        obj["body_fingerprint"] = stamp._replace(transform=read.fingerprint.matrix_hash(obj)).text
        replace_stamp(obj, stamp.text)


def mark_axes_changed(objects: Iterable[Object]) -> None:
    """Note that objects have new axes, so that stored directions are wrong."""
    for obj in objects:
        if (stamp := stamps.stamp_of(obj, Kind.SYMMETRY)) is not None:
            set_edited(obj, stamp.text, True)


# ---------------------------------------------------------------- Notes of edits


def _edited_stamps(obj: Object) -> frozenset[str]:
    """Return the texts of an object's stamps whose geometry has changed since."""
    return memory.edited.get(obj) or frozenset()


def set_edited(obj: Object, text: str, is_edited: bool) -> None:
    """Note whether the geometry behind the stamp with this text has changed."""
    noted = _edited_stamps(obj)
    if is_edited != (text in noted):
        handlers.count_change(obj)
        memory.edited[obj] = noted | {text} if is_edited else noted - {text}


def note_edits(obj: Object, shape: bytes | None = None) -> None:
    """Note the effects of all updates since the last call on the stamps of an original object.

    Call it before its stamps are replaced: later nobody could say whether the geometry has changed
    since. shape: the `Surface.digest` of an object that was read just now.
    """
    uid = obj.session_uid
    newest = memory.state.updates
    resolved_until = memory.resolved.get(uid, 0)
    if resolved_until >= newest:
        return
    memory.resolved[uid] = newest
    edit, last = updates.last_since(obj, resolved_until)
    if last.number <= resolved_until:
        return
    kinds_by_text = stamps.with_geometry(obj)
    if (
        shape is None
        and any(text in memory.shapes for text in kinds_by_text)
        and (depsgraph := updates.depsgraph_of(last))
    ):
        shape = read.mesh.shape_digest(obj, depsgraph)
    for text, kind in kinds_by_text.items():
        if shape is not None and text in memory.shapes:
            set_edited(obj, text, shape != memory.shapes[text])
        elif edit.number or text in memory.shapes or kind in IN_MEMORY:
            # Without an edit, the update follows undo or redo. Redo brings back an edit whose note
            # was taken back by comparing shapes; undo brings back no data in memory.
            set_edited(obj, text, True)


def _remember_shape(
    obj: Object, stamp: Stamp, depsgraph: Depsgraph, shape: bytes | None = None
) -> None:
    """Keep the digest of the surface behind a stamp, unless the data depend on materials,
    attributes or a Volume, too. shape: the digest, if it was computed just now.
    """
    varies = obj.body_moments.density_from in {"MATERIALS", "ATTRIBUTE", "VOLUME"}
    if varies and stamp.kind in (Kind.RESULTS, Kind.MOMENTS):
        return
    shape = shape or read.mesh.shape_digest(obj, depsgraph)
    if shape is not None:  # else the digest of an equal object with the same stamp still holds
        memory.shapes[stamp.text] = shape


def note_all_edits() -> None:
    """Note the effects of all updates on all objects."""
    # while Blender enables the add-on, it gives no data
    for obj in bpy.data.objects if memory.state.updates else ():
        note_edits(obj)


def write_notes() -> None:
    """Write the noted edits into the stamps stored on the objects."""
    note_all_edits()
    for obj in bpy.data.objects if len(memory.edited) else ():
        if (edited := memory.edited.get(obj)) and obj.is_editable:
            stamps.write_edited(obj, edited)
