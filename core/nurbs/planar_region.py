# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The region of a plane that closed curves bound, holes left out: which plane, and which way each curve runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import MeasureError
from ..verdict.tolerances import TOLERANCE
from .curve import Curve
from .curve_moments import curves_center

EACH = 16, 64, 256  # samples of a span: more where what fewer make seems to cross
MOST_CHORDS = 8192  # of the finer ones
MOST_PAIRS = 4_000_000  # of chords compared at a time


def plane_region(curves: Sequence[Curve], stored: float = 0.0) -> tuple[list[Curve], NDArray[np.float64]]:
    """The curves, outer ones counter-clockwise about the normal and holes clockwise, and the unit normal (3,).

    stored: by how much storing their points may have moved them.
    Every second curve inside of others is a hole, as Blender fills them. The normal is the coordinate axis, or other
    direction, that points most along +z, then +y, then +x. MeasureError where the curves are not
    closed, not in one plane, or cross.
    """
    center = curves_center(curves)
    size = max(float(np.abs(curve.points - center).max()) for curve in curves)
    tolerance = 4.0 * (TOLERANCE * size + stored + 2.0**-52 * float(np.abs(center).max()))
    loops = [curve.samples(EACH[0]) for curve in curves]
    if any(np.linalg.norm(loop[0] - loop[-1]) > tolerance for loop in loops) or any(
        curve.space.is_torn for curve in curves
    ):
        raise MeasureError("curve_open")
    points = np.concatenate([curve.points for curve in curves]) - center
    _, _, axes = np.linalg.svd(np.concatenate([points, np.zeros((3, 3))]), full_matrices=False)
    if np.abs(points @ axes[2]).max() > tolerance:
        raise MeasureError("curves_not_coplanar")
    normal = axes[2]
    leading = next(axis for axis in (2, 1, 0) if abs(normal[axis]) > 1e-6)
    normal = normal * np.sign(normal[leading])
    frame = np.stack([axes[0], np.cross(normal, axes[0])], axis=1)

    def polygons(each: int) -> list[NDArray]:
        return [_apart((curve.samples(each)[:-1] - center) @ frame, tolerance) for curve in curves]

    flat = polygons(EACH[0])
    if min(map(len, flat)) < 3:
        raise MeasureError("curve_too_small")
    spans, crossing = sum(len(curve.space.spans) for curve in curves), cross(flat, tolerance)
    for each in EACH[1:]:
        if crossing and spans * each <= MOST_CHORDS:
            flat = polygons(each)
            crossing = cross(flat, tolerance)
    if crossing:
        raise MeasureError("curves_cross")
    found = []
    for i, (curve, loop) in enumerate(zip(curves, flat)):
        depth = sum(_within(loop[0], other) for j, other in enumerate(flat) if j != i)
        following = np.roll(loop, -1, axis=0)
        area = float((loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0]).sum())
        found.append(curve if (area > 0.0) == (depth % 2 == 0) else curve.reversed())
    return found, normal


def _within(point: NDArray, loop: NDArray) -> bool:
    """Whether a point is in a polygon (n, 2): the crossings of a ray along +x."""
    a, b = loop, np.roll(loop, -1, axis=0)
    upward = (a[:, 1] <= point[1]) != (b[:, 1] <= point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        x = a[:, 0] + (point[1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(upward & (x > point[0])) % 2)


def crosses_itself(loop: NDArray, tolerance: float) -> bool:
    """Whether a polygon (n, 2) runs through itself, in a corner too, but does not merely touch itself."""
    loop = _apart(loop, tolerance)
    return cross([loop], tolerance, touch=False) or (
        cross([loop], tolerance) and cross([(loop + np.roll(loop, 1, axis=0)) / 2.0], tolerance, touch=False)
    )


def _apart(loop: NDArray, tolerance: float) -> NDArray[np.float64]:
    """A polygon without repeated points."""
    return loop[np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > tolerance]


def cross(loops: Sequence[NDArray], tolerance: float, touch: bool = True) -> bool:
    """Whether chords of polygons (n, 2) cross by more than a tolerance. touch: or corners of them coincide."""
    a = np.concatenate(loops)
    b = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    step = max(1, MOST_PAIRS // len(a))
    for start in range(0, len(a), step):
        p, q = a[start : start + step, None], b[start : start + step, None]
        if touch and np.count_nonzero(np.abs(p - a).max(axis=2) <= tolerance) > len(p):
            return True
        sides = [_side(p, q, a), _side(p, q, b), _side(a, b, p), _side(a, b, q)]
        length = [np.linalg.norm(q - p, axis=2), np.linalg.norm(b - a, axis=1)]
        limits = [tolerance * length[0]] * 2 + [tolerance * length[1]] * 2
        far = [np.abs(side) > limit for side, limit in zip(sides, limits)]
        apart = ((sides[0] > 0.0) != (sides[1] > 0.0)) & ((sides[2] > 0.0) != (sides[3] > 0.0))
        if (apart & far[0] & far[1] & far[2] & far[3]).any():
            return True
    return False


def _side(a: NDArray, b: NDArray, point: NDArray) -> NDArray[np.float64]:
    u, v = b - a, point - a
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
