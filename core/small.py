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

from .blocks import TENSOR, TRIPLES, Rows

ROWS, COLUMNS = np.triu_indices(3)
ABOVE, BELOW = [1, 2, 0], [2, 0, 1]
# Where, in a table of x, y, z times xx, xy, xz, yy, yz, zz, the three terms of each symmetric product stand.
CUBE = np.array([[6 * i + TENSOR[j, k], 6 * j + TENSOR[i, k], 6 * k + TENSOR[i, j]] for i, j, k in TRIPLES]).T
FACTORS = np.repeat([1.0, 2.0, 1.0, 4.0 / 3.0], [1, 3, 6, 10])  # of the sums of `blocks`, to whose divisors these bring


def few(points: NDArray, center: NDArray, triangles: NDArray, *, area: bool, shell: bool) -> Rows:
    """The sums of `blocks` over all triangles, (m, 3), as one block; the third order is exact.

    area: whether doubled areas are wanted, shell: also their moments.
    """
    corners = points.T.astype(np.float64).take(triangles.T, axis=1)  # (3, 3, m): x, y, z of a, b, c
    edges = corners[:, 1:] - corners[:, :1]
    first, second = edges[:, 0], edges[:, 1]
    normals = first.take(ABOVE, 0) * second.take(BELOW, 0) - first.take(BELOW, 0) * second.take(ABOVE, 0)
    corners -= center[:, None, None]
    det = np.add.reduce(normals * corners[:, 0])
    double = np.sqrt(np.add.reduce(normals * normals)) if area else np.zeros_like(det)
    summed, pairs = np.add.reduce(corners, axis=1), corners.take(ROWS, 0) * corners.take(COLUMNS, 0)
    both = summed.take(ROWS, 0) * summed.take(COLUMNS, 0), np.add.reduce(pairs, axis=1)

    def sums(weights: NDArray) -> NDArray[np.float64]:
        square, single = both
        weighted = summed * weights
        third = weighted @ (square + 3.0 * single).T
        third += 2.0 * ((corners * weights).reshape(3, -1) @ pairs.reshape(6, -1).T)
        return FACTORS * np.concatenate([
            [np.add.reduce(weights)], np.add.reduce(weighted, axis=1), (square + single) @ weights,
            np.add.reduce(third.take(CUBE))])

    return Rows(sums(det), sums(double) if shell else None, *np.maximum.reduce(np.abs(edges), axis=2).T[:, :, None],
                np.array([[np.add.reduce(np.abs(det))], [np.add.reduce(double)]]), np.array([det.size]))
