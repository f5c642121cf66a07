# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Generalized winding numbers of triangle surfaces about points.

They are solid angles, which an open surface has too: not the count of `bvh.Bvh.winding_numbers`, with rays that need
closed shells and answer for thousands of points at once.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from ..numerics.arguments import float_array, index_array

TRIANGLES_PER_BLOCK = 1 << 15  # triangles at a time


def winding_number(points: ArrayLike, triangles: ArrayLike, point: ArrayLike) -> float:
    """Return how often triangles surround a point: the sum of their solid angles divided by 4 π.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
        Outward faces counter-clockwise; they need not close.
    point : (3,) array_like

    Returns
    -------
    float
        1 inside a closed outward surface, 0 outside.

    Notes
    -----
    A. van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30, 1983.

    Examples
    --------
    >>> from body_moments.core.mesh import winding_number
    >>> triangles = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> round(winding_number(np.eye(4, 3, -1), triangles, (0.1, 0.1, 0.1)), 9)
    1.0
    """
    points = float_array("points", points, "n", 3)
    triangles = index_array("triangles", triangles, "m", 3, count=len(points))
    point = float_array("point", point, 3)
    total = 0.0
    for start in range(0, len(triangles), TRIANGLES_PER_BLOCK):
        a, b, c = (points[triangles[start : start + TRIANGLES_PER_BLOCK, k]] - point for k in range(3))
        la, lb, lc = (np.sqrt((v * v).sum(axis=1)) for v in (a, b, c))
        volume = (a * np.cross(b, c)).sum(axis=1)
        below = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
        total += float(np.arctan2(volume, below).sum())
    return total / (2.0 * math.pi)
