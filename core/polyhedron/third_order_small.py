# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The moments of `polyhedron` for bodies of few triangles, where numpy's calls cost more than its arithmetic.

All triangles at once, by the complete homogeneous polynomials of their corners (Sheynin and Tuzikov's formula to third
order): with s = a + b + c, P = aa' + bb' + cc' and a triangle's weight w,

    24 ∫ x = Σ w s,   120 ∫ x x' = Σ w (s s' + P),
    720 ∫ x x' x'' = Σ w (s s' s'' + s P' + the same for the other two orders of the indices + 2 Σ_corners c c' c'').
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .third_order_kernel import PAIR_INDEX, TRIPLES, BlockSums

ROWS, COLUMNS = np.triu_indices(3)
NEXT_AXIS, PREVIOUS_AXIS = [1, 2, 0], [2, 0, 1]
# Where, in a table of x, y, z times xx, xy, xz, yy, yz, zz, the three terms of each symmetric product stand.
CUBE = np.array(
    [[6 * i + PAIR_INDEX[j, k], 6 * j + PAIR_INDEX[i, k], 6 * k + PAIR_INDEX[i, j]] for i, j, k in TRIPLES]
).T
# of the sums of `blocks`, to whose divisors these bring
DIVISOR_FACTORS = np.repeat([1.0, 2.0, 1.0, 8.0 / 3.0], [1, 3, 6, 10])


def integrate_small(points: NDArray, center: NDArray, triangles: NDArray, *, area: bool, shell: bool) -> BlockSums:
    """The sums of `blocks` over all triangles, (m, 3), as one block; the third order is exact.

    area: whether doubled areas are wanted, shell: also their moments.
    """
    corners = points.T.astype(np.float64).take(triangles.T, axis=1)  # (3, 3, m): x, y, z of a, b, c
    edges = corners[:, 1:] - corners[:, :1]
    above, below = edges.take(NEXT_AXIS, 0), edges.take(PREVIOUS_AXIS, 0)
    normals = above[:, 0] * below[:, 1] - below[:, 0] * above[:, 1]
    nodes = np.empty((3, 4, len(triangles)))  # a, b, c and s
    np.subtract(corners, center[:, None, None], nodes[:, :3])
    np.add.reduce(nodes[:, :3], axis=1, out=nodes[:, 3])
    det = np.add.reduce(normals * nodes[:, 0])
    double = np.sqrt(np.add.reduce(normals * normals)) if area else np.zeros(1)
    products = nodes.take(ROWS, 0) * nodes.take(COLUMNS, 0)  # (6, 4, m)
    single = np.add.reduce(products[:, :3], axis=1)
    second = products[:, 3] + single
    np.add(0.5 * second, single, products[:, 3])

    def sums(weights: NDArray) -> NDArray[np.float64]:
        weighted = nodes * weights
        first = np.add.reduce(weighted[:, 3], axis=1)
        third = weighted.reshape(3, -1) @ products.reshape(6, -1).T
        return DIVISOR_FACTORS * np.concatenate(
            [[np.add.reduce(weights)], first, second @ weights, np.add.reduce(third.take(CUBE))]
        )

    edges = np.maximum.reduce(np.abs(edges), axis=2)
    sizes = np.array([np.add.reduce(np.abs(det)), np.add.reduce(double)])
    return BlockSums(
        sums(det), sums(double) if shell else None, edges[:, :1], edges[:, 1:], sizes[:, None], np.array([len(det)])
    )
