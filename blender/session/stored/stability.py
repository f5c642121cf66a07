# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability of objects on the ground: their support, their resting poses, and how they are laid on
it.

A convex hull is computed on request, and holds until the geometry changes; support and poses follow
its place and center.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.types import Context, Depsgraph, Object, Scene

from ....core import inertia, mesh, numerics, statics, verdict
from ... import bodies, read, write
from ...scene import findings, reframe, rigid_world, transforms
from .. import displayed, memory
from ..tracking import staleness
from ..tracking.stamps import Kind
from . import results

# Relative to scales and centers: float32 matrices of a turned object change by some 1e-7.
SAME_SHAPE_RTOL = 1e-5


@dataclass(eq=False)
class KnownHull:
    """An object's hull, with its support and poses.

    hull: in the object's coordinates. digest: of its shape, if shapes can be compared. earlier: the
    hulls of earlier shapes, to which undo may return; sought_at: the generation at which the
    present shape was last sought among them. scale_and_center: (4, 3) for which `poses` hold, the
    object's scale and shear as three rows, and its center in its frame, both in Blender units.
    """

    hull: mesh.ConvexHull
    digest: bytes | None = None
    earlier: tuple[KnownHull, ...] = ()
    sought_at: int = -1
    scale_and_center: numerics.NDArray | None = None
    poses: statics.RestingPoses | verdict.Finding | None = None


MAX_EARLIER = 8  # hulls of earlier shapes that are kept


def compute(obj: Object, depsgraph: Depsgraph) -> mesh.ConvexHull:
    """Compute and cache the hull of an evaluated object, or raise MeasureError if it has none."""
    hull = bodies.mesh.object_hull(obj, depsgraph)
    last = memory.hulls.get(obj)
    earlier = () if last is None else (*last.earlier, last)[-MAX_EARLIER:]
    memory.hulls[obj] = KnownHull(hull, read.mesh.shape_digest(obj, depsgraph), earlier)
    staleness.carry(obj, Kind.HULL, depsgraph)
    return hull


def _up_to_date(obj: Object, scene: Scene) -> KnownHull | None:
    """Return what is cached for the object's present shape, also if undo brought the shape back."""
    last = memory.hulls.get(obj)
    if last is None or not staleness.stale_reason(obj, scene, Kind.HULL):
        return last
    depsgraph = bpy.context.view_layer.depsgraph
    if not last.earlier or last.sought_at == memory.state.generation or depsgraph is None:
        return None
    last.sought_at = memory.state.generation
    digest = read.mesh.shape_digest(obj, depsgraph)
    matches = [cached for cached in last.earlier if digest is not None and cached.digest == digest]
    if not matches:
        return None
    remaining = tuple(cached for cached in (*last.earlier, last) if cached is not matches[-1])
    memory.hulls[obj] = replace(matches[-1], earlier=remaining)
    staleness.carry(obj, Kind.HULL, depsgraph)
    return memory.hulls[obj]


@memory.until_change
def support(obj: Object, scene: Scene) -> statics.Support | None:
    """Return an object's current support, in Blender's units and the world; None if unchecked or
    out of date.
    """
    remembered = _up_to_date(obj, scene)
    body = displayed.drawn(obj, scene)
    if remembered is None or body is None:
        return None
    matrix = np.array(obj.matrix_world, np.float64)
    points = remembered.hull.points @ matrix[:3, :3].T + matrix[:3, 3]
    center = np.array(body.world.center) / body.unit
    # The height up to which points touch the ground, relative to the extent. A hull of fewer
    # corners may be off by its gap at each of two points, so twice the gap counts as contact.
    gap = remembered.hull.gap * float(np.linalg.norm(matrix[:3, :3], 2))
    tolerance = max(statics.CONTACT_RTOL, 2.0 * gap / float(np.ptp(points, axis=0).max()))
    return statics.find_support(points, center, rigid_world.down(scene), tolerance)


def poses(obj: Object, scene: Scene) -> statics.RestingPoses | verdict.Finding | None:
    """Return stable resting poses (Blender's units, object frame), the reason if there are none, or
    None if the hull or the results are unknown or out of date. Computed anew only if the scale or
    the center has changed.
    """
    remembered = _up_to_date(obj, scene)
    body = displayed.drawn(obj, scene)
    if remembered is None or body is None:
        return None
    location, rotation = frame(obj)
    scale = rotation.T @ np.array(obj.matrix_world.to_3x3(), np.float64)
    center = np.array(body.world.center) / body.unit
    own_center = rotation.T @ (center - location)
    present = np.concatenate([scale, [own_center]])
    known = remembered.scale_and_center
    size = np.ptp(remembered.hull.points, axis=0) @ np.abs(scale).T
    # of the three rows of the scale, and of the center
    tolerance = SAME_SHAPE_RTOL * np.r_[np.full(3, np.abs(scale).max()), size.max()]
    if known is None or (np.abs(present - known).max(axis=1) > tolerance).any():
        remembered.scale_and_center = present
        try:
            remembered.poses = statics.resting_poses(remembered.hull.transform(scale), own_center)
        except verdict.MeasureError as error:
            remembered.poses = error.finding
    return remembered.poses


def frame(obj: Object) -> tuple[numerics.Array, numerics.Array]:
    """Return location, (3,), and rotation, (3, 3), of an object: the frame of `poses`."""
    location, rotation, _scale = obj.matrix_world.decompose()
    return np.array(location, np.float64), numerics.rotation_matrix(rotation)


def check_stability(context: Context, obj: Object, measured: list[Object]) -> list[str]:
    """Compute and remember an object's convex hull; return texts about decisions.

    An object without valid results is measured, and appended to `measured`, for the caller to mark
    as up to date.
    """
    depsgraph = context.evaluated_depsgraph_get()
    if write.properties.stored(obj) is None or staleness.stale_reason(obj, context.scene):
        result = bodies.measure_object.measured_in_turn([obj], depsgraph)(obj)
        if result.measurement.method.procedure == verdict.Procedure.OPEN:
            raise verdict.EditRefusedError(findings.OPEN_OBJECT)
        for _, refusal in results.store_many([(obj, result)], context.scene):
            if refusal is not None:
                raise refusal
        measured.append(obj)
    hull = compute(obj, depsgraph)
    if len(hull.points) >= bodies.mesh.MAX_CORNERS:
        text = (
            "“{object}” is finely divided: its convex hull is taken with {corners} corners, to "
            "{share:percent} of its "
            "size"
        )
        return [
            write.reports.phrase(
                text,
                object=obj.name,
                corners=len(hull.points),
                share=hull.gap / float(np.ptp(hull.points, axis=0).max()),
            )
        ]
    return []


def lay_on_ground(context: Context, obj: Object, pose: int, ground: str, notes: list[str]) -> bool:
    """Lay the object on the ground; return whether it had to move.

    pose: the number of a pose, the likeliest first, from 1 on, or 0 for the nearest. ground:
    "LOWEST" for its present lowest point, "CURSOR", or the world's origin. notes: texts about
    decisions are appended.
    """
    reframe.check_movable(obj)
    measured: list[Object] = []
    notes += check_stability(context, obj, measured)
    staleness.mark_up_to_date(context, measured)
    resting = poses(obj, context.scene)
    body = displayed.drawn(obj, context.scene)
    if resting is None:  # its stored numbers are damaged
        raise verdict.EditRefusedError(statics.NO_STABLE_POSE)
    if isinstance(resting, verdict.Finding):
        raise verdict.EditRefusedError(resting.code, **resting.values)
    assert body is not None  # the poses belong to it
    gravity = rigid_world.down(context.scene)
    _, rotation = frame(obj)
    # (p, 3) outward normals of the sides on which it rests, in the world
    normals = resting.normals @ rotation.T
    index = (pose - 1) % len(normals) if pose else int((normals @ gravity).argmax())
    turn = _shortest_turn(normals[index], gravity)
    center = np.array(body.world.center) / body.unit
    size = max(body.world.gyration) / body.unit
    target = transforms.world(obj)
    target[:3, :3] = turn @ target[:3, :3]
    target[:3, 3] = center + turn @ (target[:3, 3] - center)
    target[:3, 3] += (
        _ground(context, obj, ground, center, gravity) - resting.heights[index]
    ) * gravity
    off = np.abs(target - transforms.world(obj))
    # 1e-6 is over 10 times the rounding of float32 matrices.
    is_turned = off[:, :3].max() > 1e-6 * np.abs(target[:, :3]).max()
    is_moved = is_turned or off[:, 3].max() > reframe.location_tolerance(obj, size)
    if is_moved:
        reframe.move(context, reframe.Plan(obj, target, size, move_only=False))
    return bool(is_moved)


def _ground(
    context: Context, obj: Object, ground: str, center: numerics.NDArray, gravity: numerics.NDArray
) -> float:
    """Return the distance from the center down to the ground, in Blender's units."""
    if ground == "LOWEST":
        present_support = support(obj, context.scene)
        assert present_support is not None  # poses are known, and need the same hull and results
        return present_support.height
    point = (
        np.array(context.scene.cursor.location, np.float64) if ground == "CURSOR" else np.zeros(3)
    )
    return float((point - center) @ gravity)


def _shortest_turn(start: numerics.Array, end: numerics.Array) -> numerics.Array:
    """Return the (3, 3) rotation by the smallest angle from a unit vector to another one."""
    middle = start + end
    length = np.linalg.norm(middle)
    # Opposite vectors: a half turn about any direction across. Below 1e-8, the rounding 1e-16 of
    # the sum would turn `middle` by more than 1e-8.
    if length < 1e-8:
        middle = np.array(inertia.frame_about(start.tolist())[0])
        return 2.0 * np.outer(middle, middle) - np.eye(3)
    middle /= length
    # Two half turns: about `start`, then about the direction between the two.
    return (2.0 * np.outer(middle, middle) - np.eye(3)) @ (2.0 * np.outer(start, start) - np.eye(3))
