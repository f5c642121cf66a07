# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""New origins and axes of many meshes at once, for objects that show their unmodified mesh and have
no users.

The new places of their points are known, so that no trial is needed. Objects that share a mesh and
want the same change of it go on sharing; for different changes, or if other objects use the mesh,
too, it is copied. Objects that miss their plan, and after an error all objects, are put back and
left to `reframe`, which changes each by itself.
"""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.types import Context, Mesh, Object
from mathutils import Matrix

from ...core.numerics import Array, Index, Mask, NDArray, PerBody
from ...core.verdict import Finding, finding, internal_error
from .changes import ancestors
from .dependents import SAME_SHAPE_RTOL
from .findings import DATA_COPIED
from .transforms import (
    FLOAT32,
    MAX_SHEAR,
    Matrix4,
    TransformChannels,
    euler_angles,
    rotation_and_scale,
    world,
)

UNCHANGED = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


@dataclass
class Plan:
    """The wanted place of one object.

    target: the (4, 4) matrix_world. size: of the body, in Blender units. move_only: keep the axes
    to the bit. findings: added while the plan is carried out. mesh: shown afterwards instead of the
    changed data; order: the numbers of its (n,) vertices in the object's own mesh.
    """

    obj: Object
    target: Matrix4
    size: float
    move_only: bool
    findings: list[Finding] = field(default_factory=list)
    mesh: Mesh | None = None
    order: Index | None = None


def location_tolerance(obj: Object, size: float) -> float:
    """Return the tolerance of an origin's location, by float32 rounding of the size and of all
    ancestors' locations.
    """
    return rounding_of_locations(
        size, max(np.abs(world(ancestor)[:3, 3]).max() for ancestor in ancestors(obj))
    )


def rounding_of_locations(size: PerBody, reach: PerBody) -> PerBody:
    """Return the tolerance of origins, for locations up to `reach` and bodies of a size: a few
    roundings in float32, chosen with a margin.
    """
    return 4e-7 * size + 4.0 * FLOAT32 * reach


def largest_move(difference: NDArray, reach: float) -> Array:
    """Return (...,) bounds of the moves of points up to `reach` by (..., 4, 4) differences of maps:
    the sum of all entries is no less than that of any row.
    """
    off = np.abs(difference)
    return off[..., :3, :3].sum(axis=(-2, -1)) * reach + off[..., :3, 3].max(axis=-1)


def data_change(was: NDArray, now: NDArray, move_only: bool) -> Array:
    """Return (..., 4, 4) maps that keep points in place while their objects' matrices go from `was`
    to `now`.
    """
    change = np.linalg.solve(now, was)
    if move_only:
        change[..., :3, :3] = np.eye(3)
        off = was[..., :3, 3:] - now[..., :3, 3:]
        change[..., :3, 3:] = np.linalg.solve(was[..., :3, :3], off)
    change[..., 3, :] = (0.0, 0.0, 0.0, 1.0)
    return change


def shows_own_mesh(obj: Object, users: dict[Object, set[Object]]) -> bool:
    """Return whether an object shows just its unmodified mesh, has no users, and its own channels
    alone place it.
    """
    data = obj.data
    return (
        obj.type == "MESH"
        and not users.get(obj)
        and not obj.modifiers
        and not obj.constraints
        and obj.parent is None
        and obj.animation_data is None
        and obj.mode == "OBJECT"
        and obj.instance_type == "NONE"
        and obj.rotation_mode not in {"QUATERNION", "AXIS_ANGLE"}
        and data.shape_keys is None
        and data.animation_data is None
        and (tuple(obj.delta_location), tuple(obj.delta_rotation_euler), tuple(obj.delta_scale))
        == UNCHANGED
        and not (any(obj.lock_location) or any(obj.lock_rotation) or any(obj.lock_scale))
    )


def reframe_own_meshes(context: Context, plans: Sequence[Plan]) -> list[Object]:
    """Carry out plans for objects that pass `shows_own_mesh`; return the finished ones and leave
    the others.
    """
    done: list[Object] = []
    for move_only in (True, False):
        some = [plan for plan in plans if plan.move_only == move_only]
        if some:
            done += _reframe_or_put_back(context, some, move_only)
    return done


def _reframe_or_put_back(context: Context, plans: Sequence[Plan], move_only: bool) -> list[Object]:
    """Carry out plans and return the finished objects; after an error none, with all put back."""
    before = [(TransformChannels(plan.obj), plan.obj.data) for plan in plans]
    try:
        return _reframe_alike(context, plans, [channels for channels, _ in before], move_only)
    except BaseException as error:
        copies = {plan.obj.data for plan in plans}.difference(mesh for _, mesh in before)
        for plan, (channels, mesh) in zip(plans, before):
            channels.restore()
            plan.obj.data = mesh
            plan.findings.clear()
        bpy.data.batch_remove(copies)
        context.view_layer.update()
        if not isinstance(error, Exception):
            raise
        internal_error.finding_of(error)  # each is tried by itself
        return []


def _reframe_alike(
    context: Context, plans: Sequence[Plan], channels: Sequence[TransformChannels], move_only: bool
) -> list[Object]:
    """Carry out the plans that can be met, restore the channels of the other objects, and return
    the finished objects.
    """
    objects = [plan.obj for plan in plans]
    targets = np.array([plan.target for plan in plans])
    was = _worlds(objects)
    is_met = np.ones(len(plans), bool)
    for obj, location in zip(objects, targets[:, :3, 3].tolist()):
        obj.location = location
    if not move_only:
        is_met = _set_rotations_and_scales(objects, targets[:, :3, :3])
    context.view_layer.update()
    now = _worlds(objects)
    change = data_change(was, now, move_only)
    size = np.array([plan.size for plan in plans])
    off = np.abs(now - targets)
    location_reach = np.abs(now[:, :3, 3]).max(axis=1)
    is_met &= off[:, :3, 3].max(axis=1) <= rounding_of_locations(size, location_reach)
    largest_entry = np.abs(targets[:, :3, :3]).max(axis=(1, 2))
    is_met &= off[:, :3, :3].max(axis=(1, 2)) <= MAX_SHEAR * largest_entry
    # Points far from their new origin are rounded by more than a small body bears.
    boxes = (
        np.array([obj.bound_box for obj in objects]) @ change[:, :3, :3].swapaxes(1, 2)
        + change[:, None, :3, 3]
    )
    reach = np.abs(boxes).max(axis=(1, 2))
    stretch = np.abs(now[:, :3, :3]).sum(axis=2).max(axis=1)
    is_met &= FLOAT32 * reach * stretch <= SAME_SHAPE_RTOL * size
    for i in np.flatnonzero(~is_met).tolist():
        channels[i].restore()
    met = np.flatnonzero(is_met)
    # Changes are compared without the rounding of places far from the origin.
    wanted = data_change(was, targets, move_only)
    owners = met[_give_meshes([plans[i] for i in met.tolist()], wanted[met], reach[met])]
    transform_meshes([objects[i].data for i in owners.tolist()], change[owners])
    context.view_layer.update()
    return [objects[i] for i in met.tolist()]


def _give_meshes(plans: Sequence[Plan], changes: NDArray, reach: NDArray) -> list[int]:
    """Copy meshes that are shared but to be changed differently; return the index of the first plan
    of each mesh. changes, reach: of each plan's data, and how far its points are from the origin.
    """
    sharing: dict[Mesh, list[int]] = {}
    for i, plan in enumerate(plans):
        sharing.setdefault(plan.obj.data, []).append(i)
    owners: list[int] = []
    for mesh, members in sharing.items():
        has_other_users = mesh.users - mesh.use_fake_user != len(members)
        groups = _group_changes(
            changes[members], reach[members], [SAME_SHAPE_RTOL * plans[i].size for i in members]
        )
        for number, group in enumerate(groups):
            owners.append(members[group[0]])
            if number or has_other_users:
                copy = mesh.copy()
                for plan in [plans[members[i]] for i in group]:
                    plan.obj.data = copy
                    plan.findings.append(finding(DATA_COPIED))
    return owners


def _group_changes(changes: NDArray, reach: NDArray, within: Sequence[float]) -> list[list[int]]:
    """Return groups of indices of changes that move any point within `reach` to almost the same
    place, to `within`.
    """
    groups = []
    remaining = np.arange(len(changes))
    while len(remaining):
        first = remaining[0]
        moves = largest_move(changes[remaining] - changes[first], float(reach[first]))
        is_near = moves <= within[first]
        is_near[0] = True  # NaN, too, is a group, so that the loop ends
        groups.append(remaining[is_near].tolist())
        remaining = remaining[~is_near]
    return groups


def _worlds(objects: Sequence[Object]) -> Array:
    return np.array([obj.matrix_world for obj in objects], np.float64).reshape(-1, 4, 4)


def _set_rotations_and_scales(objects: Sequence[Object], linear: NDArray) -> Mask:
    """Set objects' rotations and scales to (n, 3, 3) matrices; return a mask of matrices that have
    no shear.
    """
    previous_scales = np.array([obj.scale for obj in objects], np.float64)
    rotations, scales, is_unsheared = rotation_and_scale(linear, previous_scales)
    rows_by_mode: dict[str, list[int]] = {}
    for row, obj in enumerate(objects):
        rows_by_mode.setdefault(obj.rotation_mode, []).append(row)
    near = np.array([obj.rotation_euler for obj in objects], np.float64)
    angles = near.copy()
    for mode, rows in rows_by_mode.items():
        angles[rows] = euler_angles(rotations[rows], mode, near[rows])
    for obj, euler, scale in zip(objects, angles.tolist(), scales.tolist()):
        obj.rotation_euler = euler
        obj.scale = scale
    return is_unsheared


def transform_meshes(meshes: Sequence[Mesh], changes: NDArray) -> None:
    """Map the points of each mesh, p → change · p, in float64."""
    is_mirrored = np.linalg.det(changes[:, :3, :3]) < 0.0
    counts = [len(mesh.vertices) for mesh in meshes]
    ends = np.cumsum([0, *counts]).tolist()
    points = np.empty((ends[-1], 3), np.float32)
    for mesh, start, end in zip(meshes, ends, ends[1:]):
        mesh.attributes["position"].data.foreach_get("vector", points[start:end].reshape(-1))
    mesh_of_point = np.repeat(np.arange(len(meshes)), counts)
    moved = changes[mesh_of_point, :3, 3]
    for axis in range(3):
        moved += changes[mesh_of_point, :3, axis] * points[:, axis, None].astype(np.float64)
    moved_points = moved.astype(np.float32)
    with ExitStack() as put_back:
        for mesh, start, end, change, is_flipped in zip(
            meshes, ends, ends[1:], changes, is_mirrored.tolist()
        ):
            put_back.callback(mesh.update)
            put_back.callback(_set_points, mesh, points[start:end])
            _change_mesh(mesh, change, moved_points[start:end], is_flipped, put_back)
        put_back.pop_all()


def _change_mesh(
    mesh: Mesh, change: NDArray, points: NDArray[np.float32], is_flipped: bool, put_back: ExitStack
) -> None:
    """Give a mesh its mapped points; `put_back` gets functions that undo all but the points."""
    if mesh.has_custom_normals:
        mesh.transform(Matrix(change))  # turns them, too
        put_back.callback(mesh.transform, Matrix(np.linalg.inv(change)))
    _set_points(mesh, points)
    if is_flipped:
        mesh.flip_normals()
        put_back.callback(mesh.flip_normals)
    mesh.update()


def _set_points(mesh: Mesh, points: NDArray[np.float32]) -> None:
    mesh.attributes["position"].data.foreach_set("vector", points.reshape(-1))
