# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests for negative values of a polynomial density in a body.

A density has none if its lower bound on the body's box is not negative, or if it is linear and not negative at the
vertices. Else points of the body are tried: vertices, middles of faces, and grid points inside.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..mesh.point_triangle import winding_number
from .polynomial import Polynomial

NEGLIGIBLE_RTOL = 1e-6  # Relative to the largest density: the effect of float32 coordinates.
GRID_POINTS = 9  # points along each side of the box that are tried
GRID_STEPS = np.array(list(product((np.arange(GRID_POINTS) + 0.5) / GRID_POINTS, repeat=3)))
MAX_LOCATED_POINTS = 24  # points that are located in the body


def find_negative_point(
    density: Polynomial, points: NDArray, triangles: NDArray, solid: bool
) -> tuple[tuple[float, NDArray] | None, bool]:
    """Return a negative value and its (3,) point, or None; and True if there may be an undetected negative value."""
    used = np.unique(triangles)
    tried = points[used]
    if density.degree > 1:
        tried = np.concatenate([tried, points[triangles].mean(axis=1)])
    values = density(tried)
    low, high = points[used].min(axis=0), points[used].max(axis=0)
    grid = low + GRID_STEPS * (high - low) if solid and density.degree > 1 else tried[:0]
    inner = density(grid)

    def inside(i: int) -> bool:
        return abs(winding_number(points, triangles, grid[i])) > 0.5

    largest = float(np.abs(values).max())
    least = int(np.argmin(values))
    if values[least] < 0.0:  # the density may be close to zero all over the surface
        most = next(filter(inside, np.argsort(-inner, kind="stable")[:MAX_LOCATED_POINTS].tolist()), None)
        largest = largest if most is None else max(largest, inner[most])
    if values[least] < -NEGLIGIBLE_RTOL * largest:
        return (float(values[least]), tried[least]), False
    if density.degree <= 1:
        return None, False
    if density.lower_bound(low, high) >= -NEGLIGIBLE_RTOL * largest:
        return None, False
    worst = np.argsort(inner, kind="stable")[:MAX_LOCATED_POINTS]
    negative_index = next(filter(inside, worst[inner[worst] < -NEGLIGIBLE_RTOL * largest].tolist()), None)
    return (None, True) if negative_index is None else ((float(inner[negative_index]), grid[negative_index]), False)
