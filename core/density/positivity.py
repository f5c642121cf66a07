# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a density that is a polynomial is negative somewhere in a body.

It is not where its bound on the box around the body says so, nor, if it is linear, where it is not at the vertices.
Else points of the body are tried: vertices, middles of faces, and those of a grid that are inside.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..mesh.winding import winding
from .polynomial import Polynomial

NEGLIGIBLE = 1e-6  # of the largest density: float32 coordinates make as much
GRID = 9  # points along each side of the box that are tried
STEPS = np.array(list(product((np.arange(GRID) + 0.5) / GRID, repeat=3)))
TRIED = 24  # points that are located in the body


def negative_place(
    density: Polynomial, points: NDArray, triangles: NDArray, solid: bool
) -> tuple[tuple[float, NDArray] | None, bool]:
    """A value below zero and its place, (3,), in the body or on its surface, None where none was found; and whether
    there may be one although none was found.

    points: (n, 3) in the density's coordinates. triangles: (m, 3). solid: the inside counts too.
    """
    used = np.unique(triangles)
    tried = points[used]
    if density.degree > 1:
        tried = np.concatenate([tried, points[triangles].mean(axis=1)])
    values = density(tried)
    low, high = points[used].min(axis=0), points[used].max(axis=0)
    grid = low + STEPS * (high - low) if solid and density.degree > 1 else tried[:0]
    inner = density(grid)

    def inside(i: int) -> bool:
        return abs(winding(points, triangles, grid[i])) > 0.5

    largest = float(np.abs(values).max())
    least = int(np.argmin(values))
    if values[least] < 0.0:  # at the surface, where the density of all of it may be next to nothing
        most = next(filter(inside, np.argsort(-inner)[:TRIED].tolist()), None)
        largest = largest if most is None else max(largest, inner[most])
    if values[least] < -NEGLIGIBLE * largest:
        return (values[least], tried[least]), False
    if density.degree <= 1:
        return None, False
    if density.lower_bound(low, high) >= -NEGLIGIBLE * largest:
        return None, False
    worst = np.argsort(inner)[:TRIED]
    found = next(filter(inside, worst[inner[worst] < -NEGLIGIBLE * largest].tolist()), None)
    return (None, True) if found is None else ((inner[found], grid[found]), False)
