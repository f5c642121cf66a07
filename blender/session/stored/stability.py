# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability of objects: their convex hulls are remembered, so that the support polygon follows every move.

A hull is computed on request, and holds until the geometry changes; support and poses follow its place and center.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Depsgraph, Object, Scene
from numpy.typing import NDArray

from ....core.mesh.hulls import ConvexHull
from ....core.numerics.rotations import rotation_matrix
from ....core.statics.resting import RestingPoses, resting_poses
from ....core.statics.support import CONTACT_RTOL, Support, find_support
from ....core.verdict.finding import Finding, MeasureError
from ...bodies.mesh.hull import object_hull
from ..displayed import drawn
from ..tracking import handlers, staleness, stamps, updates
from ..tracking.cache import SessionCache
from ..tracking.stamps import Kind, Stamp

SAME_SHAPE_RTOL = 1e-5  # relative to scales and centers: a turned object's float32 matrices change as much


@dataclass(eq=False)
class _Remembered:
    """An object's hull, with its support and poses.

    hull: in the object's coordinates. shape: the (4, 3) scale and center for which `poses` hold. support_key: the
    generation and the scene for which `support` holds.
    """

    hull: ConvexHull
    shape: NDArray | None = None
    poses: RestingPoses | Finding | None = None
    support_key: tuple = ()
    support: Support | None = None


_remembered: SessionCache[_Remembered] = SessionCache()


def down(scene: Scene) -> NDArray[np.float64]:
    """Return the direction of gravity, (3,); -Z if the scene has none."""
    gravity = np.array(scene.gravity, np.float64) if scene.use_gravity else np.zeros(3)
    length = np.linalg.norm(gravity)
    return gravity / length if length > 0.0 else np.array((0.0, 0.0, -1.0))


def compute(obj: Object, depsgraph: Depsgraph) -> ConvexHull:
    """Compute and cache the hull of an evaluated object, or raise MeasureError if it has none."""
    hull = object_hull(obj, depsgraph)
    _remembered[obj] = _Remembered(hull)
    staleness.mark_stamp(obj, stamps.carry(obj, Kind.HULL, updates.count()), depsgraph)
    handlers.count_change(obj)
    return hull


def is_known(obj: Object) -> bool:
    """Return whether a hull of the object is cached, because its stability was checked."""
    return obj in _remembered


def stamp_of(obj: Object) -> Stamp | None:
    """Return the stamp of the cached hull."""
    return stamps.carried(obj, Kind.HULL)


def support(obj: Object, scene: Scene = None) -> Support | None:
    """Return an object's current support, in Blender's units and the world; None if unchecked or out of date."""
    scene = scene or bpy.context.scene
    remembered = _remembered.get(obj)
    if remembered is None or staleness.stale_reason(obj, scene, stamp_of):
        return None
    key = (handlers.generation(), scene.session_uid)
    if remembered.support_key != key:
        remembered.support_key, remembered.support = key, None
        body = drawn(obj, scene)
        if body is not None:
            matrix = np.array(obj.matrix_world, np.float64)
            points = remembered.hull.points @ matrix[:3, :3].T + matrix[:3, 3]
            center = np.array(body.world.center) / body.unit
            remembered.support = find_support(points, center, down(scene), _tolerance(points, remembered.hull, matrix))
    return remembered.support


def _tolerance(points: NDArray, hull: ConvexHull, matrix: NDArray) -> float:
    """Return the height, relative to the extent, up to which points touch the ground; it exceeds the hull's gap."""
    gap = hull.gap * float(np.linalg.norm(matrix[:3, :3], 2))
    return max(CONTACT_RTOL, 2.0 * gap / float(np.ptp(points, axis=0).max()))


def poses(obj: Object, scene: Scene | None = None) -> RestingPoses | Finding | None:
    """Return stable resting poses (Blender's units, object frame), the reason if there are none, or None."""
    scene = scene or bpy.context.scene
    remembered = _remembered.get(obj)
    if remembered is None or staleness.stale_reason(obj, scene, stamp_of):
        return None
    body = drawn(obj, scene)
    if body is None:
        return None
    location, rotation = frame(obj)
    scale = rotation.T @ np.array(obj.matrix_world.to_3x3(), np.float64)
    center = np.array(body.world.center) / body.unit
    shape = np.concatenate([scale, [rotation.T @ (center - location)]])
    size = np.abs(np.ptp(remembered.hull.points, axis=0)) @ np.abs(scale).T
    tolerance = SAME_SHAPE_RTOL * np.r_[np.full(3, np.abs(scale).max()), size.max()]
    if remembered.shape is None or (np.abs(shape - remembered.shape).max(axis=1) > tolerance).any():
        remembered.shape = shape
        try:
            remembered.poses = resting_poses(remembered.hull.transform(scale), shape[3])
        except MeasureError as error:
            remembered.poses = error.finding
    return remembered.poses


def frame(obj: Object) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return location, (3,), and rotation, (3, 3), of an object: the frame of `poses`."""
    location, rotation, _scale = obj.matrix_world.decompose()
    return np.array(location, np.float64), rotation_matrix(rotation)
