# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume moments beyond third order of a stack of small bodies, for the principal axes of many bodies.

The recursion is that of `any_order_kernel`, on all triangles of all bodies at once; each body's sums run over its own
segment of the rows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..moments.exponents import count_of_degree, monomial_count, monomial_values, monomials
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
    """Return the moments of n bodies, `volume` (n, 20), to a higher order; reach: (n, 3) of points from their point."""
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
    largest = monomial_values(reach, order)[:, known:]
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
    vectors, out = np.stack([a, c, b], axis=1), np.empty((monomial_count(order), a.shape[1]))
    levels, terms = (
        np.empty((2, count_of_degree(order), 3, a.shape[1])),
        np.empty((count_of_degree(order - 1), *a.shape)),
    )
    levels[0, 0] = out[0] = 1.0  # C, D and S of degree 0
    for degree in range(1, order + 1):
        below, count = count_of_degree(degree - 1), count_of_degree(degree)
        known, grown = levels[1 - degree % 2, :below], levels[degree % 2, :count]
        np.multiply(known, vectors[0], out=grown[:below])
        grown[below:] = 0.0
        for z, vector in enumerate(vectors[1:]):
            np.multiply(known, vector, out=terms[:below])
            for rows in range(1, degree + 1):  # In each run of equal q + r, rows times y or z are the next run's.
                source, target = rows * (rows - 1) // 2, rows * (rows + 1) // 2 + z
                grown[target : target + rows] += terms[source : source + rows]
        grown[:, 1] += grown[:, 0]
        grown[:, 2] += grown[:, 1]
        out[monomial_count(degree - 1) : monomial_count(degree)] = grown[:, 2]
    return out
