# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability of objects on the ground below them, and the poses in which they rest on it."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object
from numpy.typing import NDArray

from ...core.inertia.plain_body import frame_about
from ...core.statics.findings import NO_STABLE_POSE
from ...core.verdict.finding import EditRefusedError, Finding
from ...core.verdict.method import Verdict
from ..bodies.measure_object import measure_body
from ..bodies.mesh.hull import MAX_CORNERS
from ..scene import reframe
from ..scene.findings import OPEN_OBJECT
from ..scene.transforms import world
from ..write import properties, reports
from .displayed import drawn
from .stored import results, stability
from .tracking import staleness


def check_stability(context: Context, obj: Object, measured: list[Object]) -> list[str]:
    """Compute and remember an object's convex hull, measuring it if needed; return texts about decisions."""
    depsgraph = context.evaluated_depsgraph_get()
    if properties.stored(obj) is None or staleness.stale_reason(obj, context.scene):
        result = measure_body(obj, depsgraph)
        if result.measurement.method.verdict == Verdict.OPEN:
            raise EditRefusedError(OPEN_OBJECT)
        results.store(obj, result, context.scene)
        measured.append(obj)
    hull = stability.compute(obj, depsgraph)
    extent = float(np.ptp(hull.points, axis=0).max())
    if len(hull.points) >= MAX_CORNERS:
        text = (
            "“{object}” is finely divided: its convex hull is taken with {corners} corners, to {share:percent} of its "
            "size"
        )
        return [reports.phrase(text, object=obj.name, corners=len(hull.points), share=hull.gap / extent)]
    return []


def lay_on_ground(context: Context, obj: Object, pose: int, ground: str, notes: list[str]) -> bool:
    """Lay the object on the ground, on its likeliest pose `pose` or the nearest (0); return whether it had to move."""
    reframe.check_movable(obj)
    measured: list[Object] = []
    notes += check_stability(context, obj, measured)
    staleness.mark_up_to_date(context, measured)
    poses, body = stability.poses(obj, context.scene), drawn(obj, context.scene)
    if poses is None:  # its stored numbers are damaged
        raise EditRefusedError(NO_STABLE_POSE)
    if isinstance(poses, Finding):
        raise EditRefusedError(poses.code, **poses.values)
    assert body is not None  # the poses belong to it
    down = stability.down(context.scene)
    _, rotation = stability.frame(obj)
    normals = poses.normals @ rotation.T
    place = (pose - 1) % len(normals) if pose else int((normals @ down).argmax())
    turn = _shortest_turn(normals[place], down)
    center, size = np.array(body.world.center) / body.unit, max(body.world.gyration) / body.unit
    target = world(obj)
    target[:3, :3] = turn @ target[:3, :3]
    target[:3, 3] = center + turn @ (target[:3, 3] - center)
    target[:3, 3] += (_ground(context, obj, ground, center, down) - poses.heights[place]) * down
    off = np.abs(target - world(obj))
    is_turned = off[:, :3].max() > 1e-6 * np.abs(target[:, :3]).max()
    is_moved = is_turned or off[:, 3].max() > reframe.location_tolerance(obj, size)
    if is_moved:
        reframe.move(context, reframe.Plan(obj, target, size, move_only=False))
    return bool(is_moved)


def _ground(context: Context, obj: Object, ground: str, center: NDArray, down: NDArray) -> float:
    """Return the distance from the center down to the ground, in Blender's units."""
    if ground == "LOWEST":
        support = stability.support(obj, context.scene)
        assert support is not None  # it is known as its poses are
        return support.height
    point = np.array(context.scene.cursor.location, np.float64) if ground == "CURSOR" else np.zeros(3)
    return float((point - center) @ down)


def _shortest_turn(start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (3, 3) rotation by the smallest angle from one (3,) unit vector to another."""
    middle = start + end
    length = np.linalg.norm(middle)
    if length < 1e-8:
        middle = np.array(frame_about(start.tolist())[0])
        return 2.0 * np.outer(middle, middle) - np.eye(3)
    middle /= length
    # Two half turns: about `start`, then about the direction between the two.
    return (2.0 * np.outer(middle, middle) - np.eye(3)) @ (2.0 * np.outer(start, start) - np.eye(3))
