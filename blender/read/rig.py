# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A skinned character: the meshes that an armature deforms, and the objects parented to bones.

Loads no numpy.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from bpy.types import Context, Depsgraph, Object, Scene

from ...core.measurement import digest
from ...core.verdict import ReadError
from .findings import ARMATURE_UNAVAILABLE
from .fingerprint import matrix_bytes, settings_hash
from .tracking import tracking_paused
from .visibility import measurable

# constraints that put objects into a hand
HOLDING = {"CHILD_OF", "COPY_TRANSFORMS", "COPY_LOCATION", "ARMATURE"}


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
    """Return whether an armature deforms an object, by an enabled modifier or as its parent."""
    if obj.parent == armature and obj.parent_type == "ARMATURE":
        return True
    return any(
        modifier.type == "ARMATURE" and modifier.object == armature and modifier.show_viewport
        for modifier in obj.modifiers
    )


def skinned_objects(armature: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the mesh objects that an armature deforms, sorted by name."""
    return sorted(
        (obj for obj in objects if obj.type == "MESH" and is_skin_of(obj, armature)),
        key=lambda obj: obj.name,
    )


def hanging_objects(armature: Object, skinned: Iterable[Object]) -> list[tuple[Object, str]]:
    """Return (object, bone) of measurable objects below bones, except those in `skinned`."""
    skinned = set(skinned)
    return [
        (obj, child.parent_bone)
        for child in sorted(armature.children, key=lambda obj: obj.name)
        if child.parent_type == "BONE" and child.parent_bone
        for obj in (child, *child.children_recursive)
        if obj not in skinned and measurable(obj)
    ]


def held_objects(armature: Object, depsgraph: Depsgraph) -> list[tuple[Object, str]]:
    """Return (object, bone) of measurable objects that a constraint holds to a bone as evaluated,
    and their children.

    Objects that the armature deforms, and those parented to its bones, are parts of the character
    already.
    """
    bones: dict[Object, str] = {}
    for obj in depsgraph.view_layer.objects:
        bone = _holding_bone(obj, armature, depsgraph) if len(obj.constraints) else ""
        if bone and not obj.hide_render:
            held = [each for each in (obj, *obj.children_recursive) if measurable(each)]
            bones.update(dict.fromkeys(held, bone))
    parts = rig_objects(armature, depsgraph.view_layer.objects) if bones else ()
    return [(obj, bone) for obj, bone in bones.items() if obj not in parts]


def _holding_bone(obj: Object, armature: Object, depsgraph: Depsgraph) -> str:
    """Return the bone that a constraint holds an object to, or "" if there is none."""
    for constraint in obj.evaluated_get(depsgraph).constraints:
        if constraint.type not in HOLDING or constraint.mute or not constraint.influence > 0.0:
            continue
        for target in constraint.targets if constraint.type == "ARMATURE" else (constraint,):
            holder = target.target
            if holder is not None and holder.original == armature and target.subtarget:
                return target.subtarget
    return ""


def rig_hash(armature: Object, objects: Iterable[Object], scene: Scene) -> str:
    """Return a digest of the bones, the armature's scale and the objects' settings, but not of the
    meshes.
    """
    keys: list[object] = []
    for bone in armature.data.bones:
        settings = armature.pose.bones[bone.name].body_moments
        kind = settings.mass_from
        given = {"MESH": None, "DENSITY": settings.density, "MASS": settings.mass}[kind]
        rest = matrix_bytes(bone.matrix_local).hex()
        keys.append((bone.name, bone.use_deform, round(bone.length, 7), rest, kind, given))
    keys += [
        (obj.name, obj.hide_render, settings_hash(obj, scene), len(obj.vertex_groups))
        for obj in objects
    ]
    keys.append(list(armature.matrix_world.to_scale()))
    return digest("\n".join(map(repr, keys)).encode())


def rig_objects(armature: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the objects that a character consists of: skinned objects, then objects parented to
    bones.
    """
    skinned = skinned_objects(armature, objects)
    return skinned + [obj for obj, _ in hanging_objects(armature, skinned)]


def require_armature(obj: Object | None) -> Object:
    """Return the armature object; ReadError for any other object, and for an armature in Edit
    Mode.
    """
    if obj is None or obj.type != "ARMATURE":
        raise ReadError(ARMATURE_UNAVAILABLE, cause="none is selected, or several are. Select one")
    if obj.mode == "EDIT":
        raise ReadError(
            ARMATURE_UNAVAILABLE, cause="it is in Edit Mode. Leave it", subject=obj.name
        )
    return obj
