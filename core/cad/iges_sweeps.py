# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that a curve sweeps along a circle, a line or to another curve, in their exact rational
form; cylinders, cones, spheres and tori by the part that their boundary spans.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..numerics import Array, NDArray, SplineSpace, clamped_space, lengths
from ..nurbs import TURN, Curve, Patch, Quadric
from .iges_entities import MAX_ARC

SAME_RTOL = 1e-12  # relative to the size: lines and circles by rounding
SAMPLES = 257  # points of a boundary curve that show which part of a surface it spans
MIN_GAP = 0.1  # radians; more than any step between samples of a circle, in rational form too


def revolve(curve: Curve, begin: NDArray, axis: NDArray, start: float, end: float) -> Patch:
    """Return the surface of a curve rotated from a start angle to an end angle about an axis
    through a point.
    """
    axis = axis / np.linalg.norm(axis)
    if not 0.0 < end - start <= TURN * (1.0 + 1e-9):
        raise ValueError("angles of no surface")
    steps = math.ceil((end - start) / MAX_ARC - 1e-9)
    half = (end - start) / steps / 2.0
    angles = np.linspace(start, end, 2 * steps + 1)
    ring = np.where(np.arange(2 * steps + 1) % 2, math.cos(half), 1.0)
    arms = curve.points - begin
    heights = np.outer(arms @ axis, axis)
    radial = arms - heights
    around = (
        np.cos(angles)[:, None] * radial[:, None]
        + np.sin(angles)[:, None] * np.cross(axis, radial)[:, None]
    ) / ring[:, None]
    weights = np.ones(len(arms)) if curve.weights is None else curve.weights
    knots = np.repeat(angles[::2], 2)
    space = SplineSpace((start, *knots.tolist(), end), 3, len(angles))
    return Patch((curve.space, space), begin + heights[:, None] + around, weights[:, None] * ring)


def revolved_quadric(curve: Curve, begin: NDArray, axis: NDArray) -> Quadric | None:
    """Return the whole surface that a line or an arc of a circle sweeps about an axis through a
    point, or None for other curves.
    """
    axis = axis / np.linalg.norm(axis)
    arms = curve.evaluate(np.linspace(*curve.space.domain, 9)) - begin
    z = arms @ axis
    across = arms - np.outer(z, axis)
    r = lengths(across)
    side = across[r.argmax()] / max(r.max(), 1e-300)
    size = float(np.abs(arms).max())
    if np.abs(across @ np.cross(axis, side)).max() > SAME_RTOL * size:
        return None
    frame = np.eye(4)
    frame[:3, :3] = np.stack([side, np.cross(axis, side), axis], axis=1)
    frame[:3, 3] = begin
    r = across @ side
    run = np.array([r[-1] - r[0], z[-1] - z[0]])
    off = np.abs((r - r[0]) * run[1] - (z - z[0]) * run[0]).max()
    if abs(run[1]) > SAME_RTOL * size and off <= SAME_RTOL * size * np.linalg.norm(run):
        slope = float(run[0] / run[1]) if abs(run[0]) > SAME_RTOL * size else 0.0
        is_one_sided = r.min() >= -SAME_RTOL * size
        return Quadric(frame, float(r[0] - slope * z[0]), 0.0, slope) if is_one_sided else None
    rows = np.stack([2.0 * r, 2.0 * z, np.ones(len(r))], axis=1)
    center_r, center_z, rest = np.linalg.lstsq(rows, r**2 + z**2, rcond=None)[0]
    minor = math.sqrt(max(rest + center_r**2 + center_z**2, 0.0))
    if np.abs(np.hypot(r - center_r, z - center_z) - minor).max() > SAME_RTOL * size:
        return None
    frame[:3, 3] += center_z * axis
    return Quadric(frame, float(center_r) if abs(center_r) > SAME_RTOL * size else 0.0, minor)


def rule(first: Curve, second: Curve) -> Patch:
    """Return the surface of lines between equal parameters of two curves in the same form."""
    weights = [
        np.ones(len(one.points)) if one.weights is None else one.weights for one in (first, second)
    ]
    if first.space != second.space or (
        np.abs(weights[0] - weights[1]).max() > 1e-14 * weights[0].max()
    ):
        raise ValueError("curves of two forms")
    points = np.stack([first.points, second.points], axis=1)
    return Patch((first.space, clamped_space(2)), points, np.stack([weights[0]] * 2, axis=1))


def join_pieces(curves: Sequence[Curve]) -> Curve:
    """Return Bézier pieces end to end, of one degree and of weight 1 at their ends, as one
    curve.
    """
    if len(curves) == 1:
        return curves[0]
    order = curves[0].space.order
    weights = [np.ones(order) if one.weights is None else one.weights for one in curves]
    if any(one.space != curves[0].space or len(one.points) != order for one in curves) or any(
        row[0] != 1.0 or row[-1] != 1.0 for row in weights
    ):
        raise ValueError("pieces of several degrees")
    breaks = np.repeat(np.linspace(0.0, 1.0, len(curves) + 1), order - 1).tolist()
    points = np.concatenate([curves[0].points[:1], *(one.points[1:] for one in curves)])
    weight = np.concatenate([[1.0], *(row[1:] for row in weights)])
    return Curve(SplineSpace((0.0, *breaks, 1.0), order, len(points)), points, weight)


def spanned_quadric(quadric: Quadric, curves: Sequence[Curve]) -> Patch:
    """Return the part of a surface that its boundary curves span, all of a closed one if there are
    none.
    """
    frame, radius, minor, slope = quadric.frame, quadric.radius, quadric.minor, quadric.slope
    if not curves and not minor:
        raise ValueError("no boundary")
    start, end = 0.0, TURN
    is_tube = quadric.periods[1] > 0.0
    low, high = (0.0, TURN) if is_tube else quadric.limits
    local = [one.evaluate(np.linspace(*one.space.domain, SAMPLES)) for one in curves]
    points = np.concatenate([frame[:0, :3], *local]) - frame[:3, 3]
    x, y, z = np.linalg.solve(frame[:3, :3], points.T)
    away = np.hypot(x, y)
    if curves:
        start, end = _spanned_angles(np.arctan2(y, x)[away > 1e-9 * (away.max() + radius)])
    if not minor:
        heights = np.array([z.min(), z.max()])
        ends = np.stack([radius + slope * heights, np.zeros(2), heights], axis=1)
        # The apex itself, but for the rounding of its place.
        ends[np.abs(ends[:, 0]) <= 1e-12 * away.max(), 0] = 0.0
        if ends[:, 0].min() < 0.0 or not heights[1] > heights[0]:
            raise ValueError("a part beyond the apex")
        profile = Curve(clamped_space(2), ends)
    else:
        tube = np.arctan2(z, away - radius)
        if curves and is_tube:
            low, high = _spanned_angles(tube)
        elif curves:
            pole = high
            low, high = (
                math.copysign(pole, end) if abs(abs(end) - pole) < 1e-7 else end
                for end in (tube.min(), tube.max())
            )
        circle = Curve(clamped_space(2), np.array([[minor, 0.0, 0.0]] * 2))
        arc = revolve(circle, np.zeros(3), np.array([0.0, -1.0, 0.0]), low, high)
        points = arc.points[0] + (radius, 0.0, 0.0)
        points[np.abs(points[:, 0]) <= 1e-12 * minor, 0] = 0.0
        weights = None if arc.weights is None else arc.weights[0]
        profile = Curve(arc.spaces[1], points, weights)
    patch = revolve(profile, np.zeros(3), np.array([0.0, 0.0, 1.0]), start, end)
    # Outward, as the parameters of analytic surfaces run.
    return patch.reverse_orientation().transform(frame)


def _spanned_angles(angles: Array) -> tuple[float, float]:
    """Return the ends of the arc that angles fill: a whole turn from zero if they leave no gap,
    and from the seam if this is all that they show.

    ValueError if they leave several gaps.
    """
    turned = np.sort(angles % TURN)
    gaps = np.diff(turned, append=turned[0] + TURN)
    wide = np.flatnonzero(gaps > MIN_GAP)
    if len(wide) > 1:
        raise ValueError("a boundary that does not show its part")
    if not len(wide):
        return 0.0, TURN
    if 1e-6 < TURN - gaps[wide[0]] < MIN_GAP:
        # A thin arc, or all but a thin arc.
        raise ValueError("a boundary that does not show its part")
    end = float(turned[wide[0]])
    start = end + float(gaps[wide[0]])
    return (end, end + TURN) if gaps[wide[0]] > TURN - 1e-6 else (start - TURN, end)
