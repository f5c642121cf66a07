# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recursion of `any_order`: sums over triangles, and pairs of triangles, to any order.

Over the triangle a, b, c the mean of the monomial x^α of degree n is 2 α! / (n+2)! times the
coefficient S_α of the generating function 1 / ((1-a·ξ)(1-b·ξ)(1-c·ξ)). Each factor is one level of
a recursion,

    C_α = (n! / α!) a^α,    D_α = C_α + Σ_i c_i D_{α-e_i},    S_α = D_α + Σ_i b_i S_{α-e_i},

with only one degree kept at a time. Two triangles a, b, c and a, c, d share C and D. Rows are the
monomials of one degree in the order of `monomials`: in runs of equal q + r, within which a factor
y or z moves rows to the next run. All sums are of positive terms if the coordinates are positive,
so a computed S_α is off by at most (6 n + 8) u S_α(|a|, |b|, |c|).
"""

from functools import lru_cache
from math import factorial

import numpy as np

from ..moments import U, count_of_degree, monomials, quotient_indices
from ..numerics import Array, Index

FACES_PER_CHUNK = 32  # faces that share one bound of their coordinates
SLICES = 16  # slices of a block, whose products are added up
# Rounding of a determinant, and of a doubled area, relative to the sizes of their terms: see
# `third_order`.
DETERMINANT_ROUNDING = 9.0 * U
# Underflow loses less than its root of a length, and less than `DETERMINANT_ROUNDING` times it of a
# doubled area.
MIN_SQUARED_LENGTH = 1e-145
UNDERFLOW_BOUND = (
    1e-220  # more than underflow can lose of one face whose coordinates are at most 256
)


@lru_cache
def multinomials(degree: int) -> Array:
    """Return (rows, 1) n! / α!, exact to degree 30."""
    return np.array(
        [
            [factorial(degree) // (factorial(p) * factorial(q) * factorial(r))]
            for p, q, r in monomials(degree)[-count_of_degree(degree) :].tolist()
        ],
        np.float64,
    )


def coefficient_sums(corners: Array, weights: Array, starts: Index, order: int) -> Array:
    """Return (w, K, s) Σ weight S_α to an order over the faces from each of s starts on.

    corners: (3, 3 or 4, t) of triangles a, b, c, perhaps a, c, d. weights: (w, 1 or 2, t).
    """
    first = corners[:, 0]
    vectors = corners[:, 1:, None]  # b, c, perhaps d
    pair_weights = np.add.reduce(weights, axis=1)[:, None]  # the weights of both triangles
    below = count_of_degree(order - 1)
    powers = np.empty((count_of_degree(order), corners.shape[2]))
    powers[0] = 1.0
    levels = np.empty((vectors.shape[1], below, corners.shape[2]))  # S, D and S
    levels[:, 0] = 1.0
    sums = [np.add.reduceat(pair_weights, starts, axis=2)]
    for degree in range(1, order):
        count = count_of_degree(degree)
        raise_powers(powers, degree, first)
        _multiply(levels, degree, vectors)
        levels[1, :count] += multinomials(degree) * powers[:count]
        levels[::2, :count] += levels[1, :count]
        sums.append(_scalar_products(weights, levels[::2, :count], starts))
    # The sums of the last degree need no S and no D of that degree.
    raise_powers(powers, order, first)
    last = multinomials(order) * _scalar_products(pair_weights, powers[None], starts)
    level_weights = np.empty((len(weights), *levels[:, 0].shape))
    level_weights[:, ::2] = weights
    level_weights[:, 1:2] = pair_weights
    for axis, quotients in enumerate(quotient_indices(order, below)):
        products = _scalar_products(level_weights * corners[axis, 1:], levels, starts)
        rows = np.flatnonzero(quotients < below)
        last[:, rows] += products[:, quotients[rows]]
    return np.concatenate([*sums, last], axis=1)


def _scalar_products(weights: Array, rows: Array, starts: Index) -> Array:
    """Return (w, r, s) sums of (w, f, t) weights times (f, r, t) rows, from each start on."""
    if len(starts) > 1 or rows.shape[2] % SLICES:
        terms = np.einsum("wft,frt->wrt", weights, rows)
        return np.add.reduceat(terms, starts, axis=2)
    # einsum adds slices in one pass, into rows that stay in the cache.
    weights = weights.reshape(*weights.shape[:2], SLICES, -1)
    rows = rows.reshape(*rows.shape[:2], SLICES, -1)
    return np.add.reduce(np.einsum("wfjt,frjt->wrt", weights, rows), axis=2)[:, :, None]


def _multiply(levels: Array, degree: int, vectors: Array) -> None:
    """Replace (l, rows, t) L, one degree lower, by Σ_i v_i L_{α-e_i}; (3, l, 1, t) vectors v."""
    count = count_of_degree(degree - 1)
    last = levels[:, count - degree : count]
    grown = levels[:, count : count + degree + 1]
    np.multiply(last, vectors[1], grown[:, :-1])
    np.multiply(last[:, -1:], vectors[2], grown[:, -1:])
    grown[:, 1:-1] += last[:, :-1] * vectors[2]
    stop = count
    for run in range(degree - 1, 0, -1):
        start = stop - run - 1
        rows = levels[:, start:stop]
        before = levels[:, start - run : start]
        rows *= vectors[0]
        rows[:, :-1] += before * vectors[1]
        rows[:, 1:] += before * vectors[2]
        stop = start
    levels[:, 0] *= vectors[0, :, 0]


def raise_powers(powers: Array, degree: int, vector: Array) -> None:
    """Replace (rows, ...) x^α, times weights, of one degree lower by those of `degree`."""
    count = count_of_degree(degree - 1)
    np.multiply(powers[count - degree : count], vector[1], powers[count : count + degree])
    np.multiply(powers[count - 1], vector[2], powers[count + degree])
    np.multiply(powers[:count], vector[0], powers[:count])


def absolute_sums(
    corners: Array, edges: Array, weights: Array, half_ulp: Array, order: int
) -> Array:
    """Return (sets, K) Σ weight reach^α over chunks of faces, for each set of weights.

    The weights are |determinant| with its rounding, that rounding alone, the volume that moving
    vertices by half ulps sweeps; and with areas: doubled area with its rounding, that alone, and
    the area that moving the vertices adds. edges: (3, c-1, t) from the first corner.
    """
    starts = np.arange(0, corners.shape[2], FACES_PER_CHUNK)
    farthest = np.maximum.reduce(np.abs(corners), axis=1)
    reach = np.maximum.reduceat(farthest, starts, axis=1) * (1.0 + 4.0 * U) + half_ulp[:, None]
    squares = np.maximum.reduceat(np.einsum("ict,ict->ct", edges, edges), starts, axis=1)
    lengths = np.sqrt(squares + MIN_SQUARED_LENGTH) * (1.0 + 1e-9)
    sizes = np.add.reduceat(np.add.reduce(np.abs(weights), axis=1), starts, axis=1) * (1.0 + 1e-9)
    # This bounds Σ |normal|, and the products that make up its components.
    terms = FACES_PER_CHUNK * (lengths[:-1] * lengths[1:]).sum(axis=0)
    rounding = DETERMINANT_ROUNDING * terms
    step = np.linalg.norm(half_ulp)
    # A doubled area is off by at most the errors of the normal's three components.
    double = terms if len(weights) == 1 else sizes[1] + 3.0 * rounding
    sides = (lengths[:-1] + lengths[1:]).sum(axis=0)
    added = step * FACES_PER_CHUNK * (sides + 2.0 * (len(lengths) - 1) * step)
    uncertain = rounding * reach.sum(axis=0)
    seeds = [sizes[0] + uncertain, uncertain, step * (double / 2.0 + added)]
    if len(weights) == 2:
        seeds += [double, 3.0 * rounding, added]
    powers = np.empty((count_of_degree(order), len(seeds), len(starts)))
    powers[0] = seeds
    by_degree = [np.add.reduce(powers[:1], axis=2)]
    for degree in range(1, order + 1):
        raise_powers(powers, degree, reach)
        by_degree.append(np.add.reduce(powers[: count_of_degree(degree)], axis=2))
    return np.concatenate(by_degree).T
