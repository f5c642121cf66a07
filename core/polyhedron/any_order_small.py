# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The volume moments of a stack of small bodies beyond third order, for the axes of many.

The recursion is that of `any_order_kernel`, on all triangles of all bodies at once; each body's sums run over its own
segment of the rows.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

from ..moments.exponents import count_of_degree, monomial_count, monomials, quotient_indices
from ..moments.moments import Measure, Moments, U
from ..numerics.vectors import cross, dot

TRIANGLES_PER_BLOCK = 256  # whose levels stay in the cache


def extend_small_moments(
    volume: Moments,
    order: int,
    points: NDArray,
    triangles: NDArray[np.integer],
    counts: NDArray[np.integer],
    reach: NDArray,
) -> Moments:
    """Return the moments of n bodies to a higher order.

    `volume` has third order, (n, 20), each about a point in its body; the triangles are sorted by body, at least one
    each. `reach`, (n, 3), bounds the distances of its points from that point, with their possible shifts by storing.
    """
    known, ends = volume.raw.shape[1], np.cumsum(counts)
    powers, degree, factors = _new_monomials(known, order)
    coordinates, first, sums, sizes = np.ascontiguousarray(points.T), 0, [], []
    while first < len(counts):
        start = ends[first] - counts[first]
        last = max(first + 1, int(np.searchsorted(ends, start + TRIANGLES_PER_BLOCK, "right")))
        part, own = slice(first, last), counts[first:last]
        corners = coordinates.take(triangles[start : ends[last - 1]].T, axis=1).astype(np.float64, copy=False)
        corners = corners - np.repeat(volume.about[part].T, own, axis=1)[:, None]
        a, b, c = corners.transpose(1, 0, 2)
        det = dot(a, cross(b - a, c - a))
        starts = np.cumsum(own) - own
        sums.append(np.add.reduceat(_coefficients(a, b, c, order)[known:] * det, starts, axis=1).T)
        sizes.append(np.add.reduceat(np.abs(det), starts))
        first = last
    raw = np.concatenate(sums) * factors
    largest = np.multiply.reduce(reach[:, None] ** powers, axis=2)
    # a coefficient is off by (6 n + 8) u, a determinant by what the known total is, and the sums by their lengths
    relative = U * (14.0 * degree + 16.0 + 3.0 * counts[:, None])
    size = np.concatenate(sizes)[:, None] / (2.0 * degree + 6.0)
    error = (relative * size + 2.0 * volume.rounding_error[:, :1]) * largest + 8.0 * U * np.abs(raw)
    return Moments(
        np.concatenate([volume.raw, raw], axis=1),
        volume.about,
        Measure.VOLUME,
        np.concatenate([volume.rounding_error, error], axis=1),
        np.concatenate([volume.input_error, volume.input_error[:, :1] * largest], axis=1),
    )


@lru_cache
def _new_monomials(known: int, order: int) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """Return exponents and degrees of the monomials after so many, and their factors from coefficients to moments."""
    powers = monomials(order)[known:]
    degree = powers.sum(axis=1)
    factors = [np.prod([float(factorial(p)) for p in row]) / factorial(sum(row) + 2) for row in powers.tolist()]
    return powers, degree, np.array(factors) / (degree + 3.0)


def _coefficients(a: NDArray, b: NDArray, c: NDArray, order: int) -> NDArray[np.float64]:
    """Return (K, t) the S_α of triangles with corners (3, t)."""
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
