# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plane regions bounded by closed curves, with holes: the plane, and the orientation of each curve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..mesh.boxes import overlapping_box_pairs
from ..verdict.finding import MeasureError
from ..verdict.tolerances import WELDING_RTOL
from .curve import Curve
from .curve_moments import curves_center
from .findings import CURVE_OPEN, CURVE_TOO_SMALL, CURVES_CROSS, CURVES_NOT_COPLANAR

SAMPLES_PER_SPAN = 16  # For the first comparison.
FINER_SAMPLES = 64, 256  # Used if the chords of fewer samples cross.
MAX_CHORDS = 8192  # Limit with finer samples.


def planar_region(curves: Sequence[Curve], stored: float = 0.0) -> tuple[list[Curve], NDArray[np.float64]]:
    """Return the curves oriented around a plane region, outer ones counter-clockwise, holes clockwise, and its normal.

    A curve inside an odd number of others is a hole, as in Blender. The first nonzero component of the unit normal (3,)
    in the order z, y, x is positive. stored: largest displacement of the points by storing them. MeasureError if the
    curves are not closed, too small, not in one plane, or cross.
    """
    loops, normal = planar_loops([[curve] for curve in curves], stored)
    return [curve for (curve,) in loops], normal


def planar_loops(
    loops: Sequence[Sequence[Curve]], stored: float = 0.0
) -> tuple[list[list[Curve]], NDArray[np.float64]]:
    """Return loops of curves end to end, oriented as by `planar_region`, and the normal of their plane."""
    curves = [curve for loop in loops for curve in loop]
    center = curves_center(curves)
    size = max(float(np.abs(curve.points - center).max()) for curve in curves)
    tolerance = 4.0 * (WELDING_RTOL * size + stored + 2.0**-52 * float(np.abs(center).max()))
    for loop in loops:
        ends = [curve.evaluate(curve.space.domain) for curve in loop]
        gaps = [np.linalg.norm(before[1] - after[0]) for before, after in zip(ends, [*ends[1:], ends[0]])]
        if max(gaps) > tolerance or any(curve.space.is_discontinuous for curve in loop):
            raise MeasureError(CURVE_OPEN)
    points = np.concatenate([curve.points for curve in curves]) - center
    points -= points.mean(axis=0)  # The middle of a box need not be in the plane.
    _, _, axes = np.linalg.svd(np.concatenate([points, np.zeros((3, 3))]), full_matrices=False)
    if np.abs(points @ axes[2]).max() > tolerance:
        raise MeasureError(CURVES_NOT_COPLANAR)
    normal = axes[2]
    leading = next(axis for axis in (2, 1, 0) if abs(normal[axis]) > 1e-6)
    normal = normal * np.sign(normal[leading])
    frame = np.stack([axes[0], np.cross(normal, axes[0])], axis=1)

    def polygons(each: int) -> list[NDArray]:
        samples = [np.concatenate([curve.samples(each)[:-1] for curve in loop]) for loop in loops]
        return [_without_repeats((points - center) @ frame, tolerance) for points in samples]

    flat = polygons(SAMPLES_PER_SPAN)
    if min(map(len, flat)) < 3:
        raise MeasureError(CURVE_TOO_SMALL)
    spans = sum(len(curve.space.spans) for curve in curves)
    finer = [each for each in FINER_SAMPLES if spans * each <= MAX_CHORDS]
    while chords_cross(flat, tolerance):
        if not finer:
            raise MeasureError(CURVES_CROSS)
        flat = polygons(finer.pop(0))
    oriented = []
    for i, (loop, polygon) in enumerate(zip(loops, flat)):
        depth = _depth(flat, i)
        following = np.roll(polygon, -1, axis=0)
        area = float((polygon[:, 0] * following[:, 1] - polygon[:, 1] * following[:, 0]).sum())
        is_right = (area > 0.0) == (depth % 2 == 0)
        oriented.append(list(loop) if is_right else [curve.reverse() for curve in reversed(loop)])
    return oriented, normal


def _depth(loops: Sequence[NDArray], number: int) -> int:
    """Return how many of the other polygons (n, 2) the first point of one is in, by the crossings of a ray along +x."""
    a = np.concatenate(loops)
    b = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    x, y = loops[number][0]
    upward = (a[:, 1] <= y) != (b[:, 1] <= y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    starts = np.cumsum([0, *map(len, loops[:-1])])
    is_inside = np.add.reduceat(upward & (crossing > x), starts, dtype=np.intp) % 2
    is_inside[number] = 0
    return int(is_inside.sum())


def self_intersects(loop: NDArray, tolerance: float) -> bool:
    """Return whether a polygon (n, 2) crosses itself, along an edge or at a corner; touching does not count."""
    loop = _without_repeats(loop, tolerance)
    return chords_cross([loop], tolerance, touch=False) or (
        chords_cross([loop], tolerance)
        and chords_cross([(loop + np.roll(loop, 1, axis=0)) / 2.0], tolerance, touch=False)
    )


def _without_repeats(loop: NDArray, tolerance: float) -> NDArray[np.float64]:
    """Return a polygon without repeated points."""
    return loop[np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > tolerance]


def chords_cross(loops: Sequence[NDArray], tolerance: float, touch: bool = True) -> bool:
    """Return whether edges of polygons (n, 2) cross by more than a tolerance or, if `touch`, corners coincide."""
    begin = np.concatenate(loops)
    end = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    low, high = (np.pad(corner, ((0, 0), (0, 1))) for corner in (np.minimum(begin, end), np.maximum(begin, end)))
    i, j, _ = overlapping_box_pairs(low, high, -2.0 * tolerance, len(begin) ** 2)
    p, q, a, b = begin[i], end[i], begin[j], end[j]
    if touch and (np.abs(p - a).max(axis=1) <= tolerance).any():
        return True
    sides = [_side(p, q, a), _side(p, q, b), _side(a, b, p), _side(a, b, q)]
    length = [np.linalg.norm(q - p, axis=1), np.linalg.norm(b - a, axis=1)]
    far = [np.abs(side) > tolerance * length[k // 2] for k, side in enumerate(sides)]
    apart = ((sides[0] > 0.0) != (sides[1] > 0.0)) & ((sides[2] > 0.0) != (sides[3] > 0.0))
    return bool((apart & far[0] & far[1] & far[2] & far[3]).any())


def _side(a: NDArray, b: NDArray, point: NDArray) -> NDArray[np.float64]:
    u, v = b - a, point - a
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
