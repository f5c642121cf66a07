# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of conics, and surfaces that a curve sweeps along a circle, a line or to another curve, in
their exact rational form; cylinders, cones, spheres and tori that a line or an arc sweeps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..numerics import NDArray, SplineSpace, clamped_space, lengths
from ..nurbs import TURN, Curve, Patch, Quadric

# radians; a quadratic piece of a circle keeps its weights away from zero
MAX_ARC = 2.0 * math.pi / 3.0
SAME_RTOL = 1e-12  # relative to the size: lines and circles by rounding
PROFILE_SAMPLES = 9


def arc_steps(turn: float) -> int:
    """Return the number of quadratic pieces of an arc that turns by an angle."""
    return max(1, math.ceil(turn / MAX_ARC - 1e-9))  # Rounding alone does not add a piece.


def conic_pieces(
    frame: NDArray,
    sizes: tuple[float, float],
    ends: tuple[float, float],
    kind: str = "ELLIPSE",
) -> list[Curve]:
    """Return a part of a conic in a frame (4, 4), between two parameters of ISO 10303-42, as
    quadratic pieces with weights. The middle control point is the meet of a piece's end tangents.

    sizes: both half axes, or both sizes of a hyperbola, or the focal length twice.
    """
    steps = arc_steps(ends[1] - ends[0]) if kind == "ELLIPSE" else 1
    marks = np.linspace(*ends, steps + 1)
    pieces = []
    for low, high in zip(marks[:-1], marks[1:]):
        middle, half = (low + high) / 2.0, (high - low) / 2.0
        t = np.array([low, middle, high])
        if kind == "PARABOLA":
            plane = np.array([[low**2, low * high, high**2], 2.0 * t])
            weight = 1.0
        else:
            cosine, sine = (np.cos, np.sin) if kind == "ELLIPSE" else (np.cosh, np.sinh)
            weight = float(cosine(half))
            plane = np.array([cosine(t), sine(t)]) / [1.0, weight, 1.0]
        points = (plane.T * sizes) @ frame[:3, :2].T + frame[:3, 3]
        pieces.append(Curve(clamped_space(3), points, np.array([1.0, weight, 1.0])))
    return pieces


def revolve(curve: Curve, begin: NDArray, axis: NDArray, start: float, end: float) -> Patch:
    """Return the surface of a curve rotated between two angles, rad, about an axis through a point.

    Its first parameter is the curve's, the second the angle.
    """
    axis = axis / np.linalg.norm(axis)
    if not 0.0 < end - start <= TURN * (1.0 + 1e-9):
        raise ValueError("angles of no surface")
    steps = arc_steps(end - start)
    half_step = (end - start) / steps / 2.0
    angles = np.linspace(start, end, 2 * steps + 1)
    # A quadratic piece of a circle has both ends on it. Its middle control point, where the
    # tangents at these meet, is 1 / cos as far away, and has the weight cos.
    is_middle = np.arange(len(angles)) % 2 == 1
    ring_weights = np.where(is_middle, math.cos(half_step), 1.0)
    arms = curve.points - begin
    heights = np.outer(arms @ axis, axis)
    radial = arms - heights
    across = np.cross(axis, radial)
    # (control points of the curve, angles, 3)
    turned = np.cos(angles)[:, None] * radial[:, None] + np.sin(angles)[:, None] * across[:, None]
    points = begin + heights[:, None] + turned / ring_weights[:, None]
    knots = np.repeat(angles[::2], 2)
    space = SplineSpace((start, *knots.tolist(), end), 3, len(angles))
    return Patch((curve.space, space), points, curve.all_weights[:, None] * ring_weights)


def revolved_quadric(curve: Curve, begin: NDArray, axis: NDArray) -> Quadric | None:
    """Return the whole surface that a line or an arc of a circle sweeps about an axis through a
    point, facing as that of `revolve`, or None for other curves.
    """
    axis = axis / np.linalg.norm(axis)
    places, tangents = curve.derivatives(np.linspace(*curve.space.domain, PROFILE_SAMPLES))
    arms = places - begin
    z = arms @ axis
    radial = arms - np.outer(z, axis)
    distances = lengths(radial)
    side = radial[distances.argmax()] / max(distances.max(), 1e-300)
    tolerance = SAME_RTOL * float(np.abs(arms).max())
    if np.abs(radial @ np.cross(axis, side)).max() > tolerance:
        return None
    # The profile is in a plane with the axis: there its coordinates are r, along `side`, and z.
    r = radial @ side
    frame = np.eye(4)
    frame[:3, :3] = np.stack([side, np.cross(axis, side), axis], axis=1)
    frame[:3, 3] = begin
    rise = np.array([r[-1] - r[0], z[-1] - z[0]])
    off_line = np.abs((r - r[0]) * rise[1] - (z - z[0]) * rise[0]).max()
    if abs(rise[1]) > tolerance and off_line <= tolerance * np.linalg.norm(rise):
        if r.min() < -tolerance:
            return None
        slope = float(rise[0] / rise[1]) if abs(rise[0]) > tolerance else 0.0
        quadric = Quadric(frame, float(r[0] - slope * z[0]), 0.0, slope)
    else:
        # r² + z² = 2 r center_r + 2 z center_z + rest is a circle.
        rows = np.stack([2.0 * r, 2.0 * z, np.ones(len(r))], axis=1)
        center_r, center_z, rest = np.linalg.lstsq(rows, r**2 + z**2, rcond=None)[0]
        minor = math.sqrt(max(rest + center_r**2 + center_z**2, 0.0))
        if np.abs(np.hypot(r - center_r, z - center_z) - minor).max() > tolerance:
            return None
        frame[:3, 3] += center_z * axis
        radius = float(center_r) if abs(center_r) > tolerance else 0.0
        quadric = Quadric(frame, radius, minor)
    # The normal of `revolve` is that of the curve's direction and the way round.
    widest = r.argmax()
    swept_normal = np.cross(tangents[widest], np.cross(axis, arms[widest]))
    at_widest = quadric.project(places[widest : widest + 1])[0]
    _, along, across = quadric.evaluate(*at_widest)
    is_inward = swept_normal @ np.cross(along, across) < 0.0
    return quadric.reverse_orientation() if is_inward else quadric


def rule(first: Curve, second: Curve) -> Patch:
    """Return the surface of lines between equal parameters of two curves in the same form."""
    weights = first.all_weights
    if first.space != second.space or (
        np.abs(weights - second.all_weights).max() > 1e-14 * weights.max()
    ):
        raise ValueError("curves of two forms")
    points = np.stack([first.points, second.points], axis=1)
    return Patch((first.space, clamped_space(2)), points, np.stack([weights] * 2, axis=1))


def join_pieces(curves: Sequence[Curve]) -> Curve:
    """Return Bézier pieces end to end, of one degree and of weight 1 at their ends, as one
    curve.
    """
    if len(curves) == 1:
        return curves[0]
    space = curves[0].space
    order = space.order
    for curve in curves:
        has_unit_ends = curve.all_weights[0] == curve.all_weights[-1] == 1.0
        if curve.space != space or len(curve.points) != order or not has_unit_ends:
            raise ValueError("pieces of several degrees")
    breaks = np.repeat(np.linspace(0.0, 1.0, len(curves) + 1), order - 1).tolist()
    points = np.concatenate([curves[0].points[:1], *(curve.points[1:] for curve in curves)])
    weights = np.concatenate([[1.0], *(curve.all_weights[1:] for curve in curves)])
    return Curve(SplineSpace((0.0, *breaks, 1.0), order, len(points)), points, weights)
