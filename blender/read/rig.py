# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A skinned character: the meshes that an armature deforms, and the objects parented to bones.

Panels and handlers ask for them, so numpy is not loaded.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from bpy.types import Context, Depsgraph, Object, Scene

from ...core.measurement.settings import digest
from ...core.verdict.finding import ReadError
from .findings import ARMATURE_IN_EDIT_MODE, NO_ACTIVE_ARMATURE
from .fingerprint import matrix_bytes, settings_hash
from .tracking import tracking_paused
from .visibility import measurable


@contextmanager
def rest_pose(context: Context, armature: Object) -> Iterator[Depsgraph]:
    """Evaluate the scene with the armature at rest, yield the depsgraph, and restore the pose."""
    data = armature.data
    before = data.pose_position
    with tracking_paused():
        data.pose_position = "REST"
        try:
            context.view_layer.update()
            yield context.evaluated_depsgraph_get()
        finally:
            data.pose_position = before
            context.view_layer.update()


def is_skin_of(obj: Object, armature: Object) -> bool:
    """Return whether an armature deforms an object, by a modifier that is shown or as its parent."""
    if obj.parent == armature and obj.parent_type == "ARMATURE":
        return True
    return any(
        modifier.type == "ARMATURE" and modifier.object == armature and modifier.show_viewport
        for modifier in obj.modifiers
    )


def skinned_objects(armature: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the mesh objects that an armature deforms, sorted by name."""
    meshes = [obj for obj in objects if obj.type == "MESH" and is_skin_of(obj, armature)]
    return sorted(meshes, key=lambda obj: obj.name)


def hanging_objects(armature: Object, skinned: Iterable[Object]) -> list[tuple[Object, str]]:
    """Return (object, bone) of measurable objects parented to bones, and of their children, without `skinned`."""
    skinned, found = set(skinned), []
    for child in sorted(armature.children, key=lambda obj: obj.name):
        if child.parent_type == "BONE" and child.parent_bone:
            for obj in (child, *child.children_recursive):
                if obj not in skinned and measurable(obj):
                    found.append((obj, child.parent_bone))
    return found


def rig_hash(armature: Object, objects: Iterable[Object], scene: Scene) -> str:
    """Return a digest of the bones, the armature's scale and the objects' settings, without the shapes of meshes."""
    keys = []
    for bone in armature.data.bones:
        settings = armature.pose.bones[bone.name].body_moments
        given = {"MESH": None, "DENSITY": settings.density, "MASS": settings.mass}[settings.mass_from]
        rest = matrix_bytes(bone.matrix_local).hex()
        keys.append(repr((bone.name, bone.use_deform, round(bone.length, 7), rest, settings.mass_from, given)))
    for obj in objects:
        keys.append(repr((obj.name, obj.hide_render, settings_hash(obj, scene), len(obj.vertex_groups))))
    keys.append(repr(list(armature.matrix_world.to_scale())))
    return digest("\n".join(keys).encode())


def rig_objects(armature: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the objects that a character consists of: skinned objects, then objects parented to bones."""
    skinned = skinned_objects(armature, objects)
    return skinned + [obj for obj, _ in hanging_objects(armature, skinned)]


def require_armature(obj: Object | None) -> Object:
    """Return the armature object, or raise ReadError for anything else, or if it is in Edit Mode."""
    if obj is None or obj.type != "ARMATURE":
        raise ReadError(NO_ACTIVE_ARMATURE)
    if obj.mode == "EDIT":
        raise ReadError(ARMATURE_IN_EDIT_MODE, subject=obj.name)
    return obj
