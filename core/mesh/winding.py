# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Generalized winding numbers of triangle surfaces about points.

They are solid angles, which an open surface has too: not the count of `bvh.Bvh.winding_numbers`, with rays that need
closed shells and answer for thousands of points at once.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

TRIANGLES_PER_BLOCK = 1 << 15  # triangles at a time


def winding_number(points: NDArray[np.floating], triangles: NDArray[np.integer], point: NDArray) -> float:
    """Return how often (m, 3) triangles over (n, 3) points surround a point: their solid angles divided by 4 π.

    A. van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30, 1983. The triangles need not close.
    """
    total = 0.0
    for start in range(0, len(triangles), TRIANGLES_PER_BLOCK):
        a, b, c = (points[triangles[start : start + TRIANGLES_PER_BLOCK, k]] - point for k in range(3))
        la, lb, lc = (np.sqrt((v * v).sum(axis=1)) for v in (a, b, c))
        volume = (a * np.cross(b, c)).sum(axis=1)
        below = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
        total += float(np.arctan2(volume, below).sum())
    return total / (2.0 * math.pi)
