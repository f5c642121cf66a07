# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of objects in double precision, as the file states them that they were imported from.

Blender's own matrices are in single precision, and an object has one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from bpy.types import Object, PoseBone

from ...core.bodies import float64_matrix
from ...core.numerics import Array

if TYPE_CHECKING:
    from .assembly import Member

_HALF_STEP = 2.0**-24  # relative rounding of a number in single precision
_ROUNDINGS = 8.0  # of the product of two matrices, and of the numbers in a rotation
KEY = "body_file_places"  # a property of objects: the numbers of their matrices


def set_places(obj: Object, matrices: Array) -> None:
    """Give an object its (k, 4, 4) places in the world, or in the collection that is instanced."""
    obj[KEY] = np.asarray(matrices, np.float64).ravel().tolist()


def has_places(obj: Object) -> bool:
    return KEY in obj


def world_matrices(obj: Object) -> Array:
    """Return the (k, 4, 4) places of an object: the file's, else Blender's one."""
    if KEY in obj:
        return np.array(obj[KEY], np.float64).reshape(-1, 4, 4)
    return float64_matrix(obj.matrix_world)[None]


def place_error(obj: Object, reach: float | None = None) -> float:
    """Return how far rounding to single precision may have moved a point of an object, in Blender
    units: 0 if its file states the place.

    The bound follows locations, rotations and scales along the chain of parents, bones among them.
    reach: of the point from the origin, in the object's own coordinates; by default that of the
    farthest corner of its box.
    """
    return 0.0 if KEY in obj else _object_error(obj, _reach(obj) if reach is None else reach, ())


def _reach(obj: Object) -> float:
    return float(np.linalg.norm(np.array(obj.bound_box, np.float64), axis=1).max())


def member_error(member: Member) -> tuple[float, float]:
    """Return how far rounding may have moved the center of an assembly, at most as far as any of
    its objects, and how far they are from the origin, in Blender units.
    """
    errors_and_reaches = [(0.0, 0.0), *map(member_error, member.members)]
    if isinstance(member.data, Object) and member.is_measured:
        world = float64_matrix(member.data.matrix_world)
        reach = _length(world) + _norm(world) * _reach(member.data)
        errors_and_reaches.append((place_error(member.data), reach))
    error, reach = map(max, zip(*errors_and_reaches))
    if member.matrix is None:
        return error, reach
    place = np.array(member.matrix)
    collection = member.data.instance_collection
    offset = 0.0 if collection is None else collection.instance_offset.length
    error = _norm(place) * error + place_error(member.data, reach + offset)
    return error, _norm(place) * reach + _length(place)


def _object_error(obj: Object, reach: float, followers: tuple[Object, ...]) -> float:
    """Return a bound of the move, by rounding to single precision, of points within `reach` of an
    object's origin. followers: objects whose places depend on this one; they end circles.
    """
    basis = float64_matrix(obj.matrix_basis)
    angles = sum(map(abs, (*obj.rotation_euler, *obj.delta_rotation_euler)))
    if obj.rotation_mode == "AXIS_ANGLE":
        angles += abs(obj.rotation_axis_angle[0])
    distance = obj.location.length + obj.delta_location.length
    stretched = _norm(basis) * reach
    # Points turn with rounded angles, and move with a rounded location.
    is_turned = not np.array_equal(basis[:3, :3], np.eye(3))
    error = _HALF_STEP * (is_turned * (_ROUNDINGS + angles) * stretched + distance)
    if obj.parent is not None:
        inverse = float64_matrix(obj.matrix_parent_inverse)
        stretch = _norm(inverse)
        radius = stretch * (stretched + _length(basis)) + _length(
            inverse
        )  # from the parent's origin
        above = float64_matrix(obj.parent.matrix_world)
        error = _norm(above) * (stretch * error + _HALF_STEP * (1.0 + _ROUNDINGS) * radius)
        error += _HALF_STEP * _ROUNDINGS * _length(above)
        bone = obj.parent.pose and obj.parent.pose.bones.get(obj.parent_bone)
        if obj.parent_type == "BONE" and bone:
            # Children of a bone start at its tail, so its length is added.
            radius, bone_error = _bone_radius_and_error(bone, radius + bone.bone.length)
            error += _norm(above) * bone_error
        elif obj.parent_type != "OBJECT":
            radius = max(radius, _reach(obj.parent))
        error += _object_error(obj.parent, radius, followers)
    world = float64_matrix(obj.matrix_world)
    for constraint in obj.constraints:
        target = getattr(constraint, "target", None)
        error += _HALF_STEP * _ROUNDINGS * (_norm(world) * reach + _length(world))
        if target is not None and target not in followers:
            error += _object_error(target, _norm(world) * reach, (*followers, obj))
    return error


def _bone_radius_and_error(bone: PoseBone, reach: float) -> tuple[float, float]:
    """Return how far points within `reach` of a bone may be from its armature's origin, and how far
    rounding may have moved them.
    """
    matrix = float64_matrix(bone.matrix)
    radius = _norm(matrix) * reach + _length(matrix)
    error = 0.0
    for link in (bone, *bone.parent_recursive):
        size = radius + _length(float64_matrix(link.matrix)) + link.bone.head_local.length
        error += _HALF_STEP * (2.0 * _ROUNDINGS + sum(map(abs, link.rotation_euler))) * size
    return radius, error


def _norm(matrix: Array) -> float:
    """Return the largest factor by which a (4, 4) matrix lengthens a vector."""
    return float(np.linalg.norm(matrix[:3, :3], 2))


def _length(matrix: Array) -> float:
    """Return the distance by which a (4, 4) matrix moves the origin."""
    return float(np.linalg.norm(matrix[:3, 3]))
