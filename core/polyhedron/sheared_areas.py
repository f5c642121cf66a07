# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The areas of a surface's images under linear maps that stretch it unevenly: instances.

Volumes follow any linear map by its determinant; areas do not. But a normal does: the image of a triangle with doubled
area vector n under A has cof(A) n (Nanson's formula), so that the triangles are measured once and each map costs one
product of matrices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface
from ..moments.moments import Measure, Moments, U

PRODUCTS_PER_BLOCK = 1 << 17  # products of a map with a normal at a time
SUM_ROUNDINGS = 128  # u: within a block numpy adds up in pairs of sums of at most 128 in 8 lanes


def area_of_images(surface: Surface, linear: NDArray[np.float64]) -> Moments:
    """Return the total area, order 0, of a surface's images under (k, 3, 3) maps, which may stretch it unevenly."""
    triangles, _ = surface.all_triangles()
    a, b, c = (surface.points[triangles[:, i]].T.astype(np.float64) for i in range(3))
    first, second = b - a, c - a
    plus, minus = (np.roll(first, -i, axis=0) * np.roll(second, i, axis=0) for i in (1, -1))
    normals, size = plus - minus, (np.abs(plus) + np.abs(minus)).sum(axis=1)
    above, below = linear[:, [1, 2, 0]], linear[:, [2, 0, 1]]
    plus, minus = (
        above[:, :, second_axis] * below[:, :, third_axis]
        for second_axis, third_axis in (([1, 2, 0], [2, 0, 1]), ([2, 0, 1], [1, 2, 0]))
    )
    cofactors = plus - minus
    step, sums = max(1, PRODUCTS_PER_BLOCK // len(linear)), []
    for start in range(0, len(triangles), step):
        images = cofactors @ normals[:, start : start + step]
        sums.append(np.sqrt(np.einsum("kif,kif->kf", images, images)).sum())
    total = float(sum(sums)) / 2.0
    # A normal is off by 4 u of its terms, a cofactor by 2 u of its; then three products and their sum.
    rounded = (9.0 * np.abs(cofactors) + 2.0 * (np.abs(plus) + np.abs(minus))).sum(axis=(0, 1)) @ size / 2.0
    h, edges = surface.coordinate_error, np.abs(np.concatenate([first, second], axis=1)).sum(axis=1)
    moved = [
        2.0 * (edges[j] * h[k] + edges[k] * h[j]) + 8.0 * h[j] * h[k] * len(triangles)
        for j, k in ((1, 2), (2, 0), (0, 1))
    ]
    return Moments(
        np.array([total]),
        np.zeros(3),
        Measure.AREA,
        np.array([U * (1.0 + 1e-9) * (rounded + (SUM_ROUNDINGS + len(sums)) * total)]),
        np.array([np.abs(cofactors).sum(axis=(0, 1)) @ moved / 2.0]),
    )
