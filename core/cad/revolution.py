# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spheres, capsules, cylinders and cones as one rational patch each, whose weights are exact in float32."""

from __future__ import annotations

import math

import numpy as np

from ..numerics.bspline import SplineSpace
from ..nurbs.blender_knots import blender_space
from ..nurbs.patch import Patch

# A quarter of a circle is (1 - t², 2t) / (1 + t²), which has the weights 1, 1, 2.
_CIRCLE = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)], np.float64)
_WEIGHTS = np.array([1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0])
_ORDER = 3


def revolved_solid(bottom: float, top: float, height: float, axis: str, is_round: bool) -> Patch | None:
    """Return a solid's surface about an axis "X", "Y" or "Z", facing outward, or None if it has no volume.

    bottom, top: the radii at the ends of its straight part, which is `height` long; with a negative height the ends
    change places. is_round: whether half balls, and no disks, follow it. Other axes are taken as Z.
    """
    bottom, top = (abs(top), abs(bottom)) if height < 0.0 else (abs(bottom), abs(top))
    half = abs(height) / 2.0
    if not (math.isfinite(bottom + top + half) and max(bottom, top) > 0.0 and (half > 0.0 or is_round)):
        return None
    profile = _Profile(0.0, -half - bottom * is_round)
    profile.extend(bottom, -half, bend=is_round)
    profile.extend(top, half)
    profile.extend(0.0, half + top * is_round, bend=is_round)
    radii, heights, weights = np.array(profile.rows).T
    columns = radii[None, :, None] * np.concatenate([_CIRCLE, np.zeros((9, 1))], axis=1)[:, None]
    columns[..., 2] = heights
    # Rotated so that the third axis becomes the wanted one.
    points = np.roll(columns, max("ZXY".find(axis), 0), axis=2)
    return Patch((_space(len(_CIRCLE)), _space(len(radii))), points, np.outer(_WEIGHTS, weights))


class _Profile:
    """Control points (radius, height, weight) of quadratic arcs and lines from one end of the axis to the other."""

    def __init__(self, radius: float, height: float) -> None:
        self.rows = [(radius, height, 1.0)]

    def extend(self, radius: float, height: float, bend: bool = False) -> None:
        """Add a line, or with `bend` a quarter of a circle, to a point. Nothing is added if the point is the last."""
        last_radius, last_height, weight = self.rows[-1]
        if (radius, height) == (last_radius, last_height):
            return
        if not bend:
            middle, end = ((last_radius + radius) / 2.0, (last_height + height) / 2.0), weight
        elif radius > last_radius:
            middle, end = (radius, last_height), 2.0 * weight
        else:
            middle, end = (last_radius, height), weight / 2.0
        self.rows += [(*middle, min(weight, end)), (radius, height, end)]


def _space(count: int) -> SplineSpace:
    return blender_space(count, _ORDER, cyclic=False, bezier=True, endpoint=True)  # type: ignore[return-value]
