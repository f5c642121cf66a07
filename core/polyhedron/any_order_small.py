# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume moments beyond third order of a stack of small bodies, for the principal axes of many bodies.

The recursion is that of `any_order_kernel`, on all triangles of all bodies at once; each body's sums run over its own
segment of the rows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..moments.exponents import count_of_degree, monomial_count, monomials, quotient_indices
from ..moments.moments import Measure, Moments, U, unchecked_moments
from ..numerics.arrays import batches
from ..numerics.vectors import cross, dot
from .any_order import area_factors

TRIANGLES_PER_BLOCK = 512  # triangles whose levels stay in the cache


def extend_small_moments(
    volume: Moments,
    order: int,
    points: NDArray,
    triangles: NDArray[np.integer],
    counts: NDArray[np.integer],
    reach: NDArray,
) -> Moments:
    """Return the moments of n bodies, `volume` (n, 20), each about a point in its body, to a higher order.

    Triangles are sorted by body. reach: (n, 3) of its points from there, with their possible shifts by storing.
    """
    known, ends = volume.raw.shape[1], np.cumsum(counts)
    powers = monomials(order)[known:]
    degree = powers.sum(axis=1)
    factors = area_factors(order)[known:] / (degree + 3.0)
    coordinates, sums, sizes = np.ascontiguousarray(points.T), [], []
    for part in batches(counts, TRIANGLES_PER_BLOCK):
        rows, own = triangles[ends[part.start] - counts[part.start] : ends[part.stop - 1]], counts[part]
        corners = coordinates.take(rows.T, axis=1).astype(np.float64, copy=False)
        a, b, c = (corners - np.repeat(volume.about[part].T, own, axis=1)[:, None]).transpose(1, 0, 2)
        det = dot(a, cross(b - a, c - a))
        starts = np.cumsum(own) - own
        sums.append(np.add.reduceat(_coefficients(a, b, c, order)[known:] * det, starts, axis=1).T)
        sizes.append(np.add.reduceat(np.abs(det), starts))
    raw = np.concatenate(sums) * factors
    largest = np.multiply.reduce(reach[:, None] ** powers, axis=2)
    # A coefficient is off by (6 n + 8) u, a determinant as much as the known total, and the sums by their lengths.
    relative = U * (14.0 * degree + 16.0 + 3.0 * counts[:, None])
    size = np.concatenate(sizes)[:, None] / (2.0 * degree + 6.0)
    error = (relative * size + 2.0 * volume.rounding_error[:, :1]) * largest + 8.0 * U * np.abs(raw)
    return unchecked_moments(
        np.concatenate([volume.raw, raw], axis=1),
        volume.about,
        Measure.VOLUME,
        np.concatenate([volume.rounding_error, error], axis=1),
        np.concatenate([volume.input_error, volume.input_error[:, :1] * largest], axis=1),
    )


def _coefficients(a: NDArray, b: NDArray, c: NDArray, order: int) -> NDArray[np.float64]:
    """Return the (K, t) S_α of triangles with corners (3, t)."""
    levels = np.zeros((2, 3, a.shape[1]))  # C, D and S of degree 0, and a row of zeros
    levels[0] = 1.0
    vectors, out = np.stack([a, c, b], axis=1), np.empty((monomial_count(order), a.shape[1]))
    out[0] = 1.0
    for degree in range(1, order + 1):
        below, count = count_of_degree(degree - 1), count_of_degree(degree)
        grown = np.zeros((count + 1, 3, a.shape[1]))
        for quotients, vector in zip(quotient_indices(degree, below), vectors):
            terms = levels.take(quotients, axis=0)
            terms *= vector
            grown[:-1] += terms
        grown[:, 1] += grown[:, 0]
        grown[:, 2] += grown[:, 1]
        out[monomial_count(degree - 1) : monomial_count(degree)] = grown[:-1, 2]
        levels = grown
    return out
