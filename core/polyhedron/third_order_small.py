# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and area moments to third order of bodies of few triangles, one or a stack of them, exact
to rounding.

Here numpy's calls cost more than its arithmetic, so all triangles of all bodies are taken at once,
by the complete homogeneous polynomials of their corners (Sheynin and Tuzikov's formula to third
order): with s = a + b + c, P = aa' + bb' + cc' and a triangle's weight w,

    24 ∫ x = Σ w s,   120 ∫ x x' = Σ w (s s' + P),
    720 ∫ x x' x'' = Σ w (s s' s'' + s P' + the same for the other two orders of the indices
                          + 2 Σ_corners c c' c'').

Each body's sums run over its own segment of the rows, so that they are the same to the bit for any
neighbors.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..moments.exponents import monomials
from ..moments.moments import Measure, Moments, U, unchecked_moments
from ..numerics.arrays import NEXT_AXIS, PREVIOUS_AXIS, batches
from .third_order_kernel import PAIR_INDEX, TRIPLES

EXPONENTS = monomials(3)
DEGREE = EXPONENTS.sum(axis=1)
# Factors of each monomial, as indices of 1, x, y, z.
MONOMIAL_FACTORS = np.sort(
    [[0] * (3 - p - q - r) + [1] * p + [2] * q + [3] * r for p, q, r in EXPONENTS]
)
DIVISORS = np.array([6.0, 24.0, 120.0, 1080.0])[DEGREE]  # divide the sums below
PRODUCT_ROUNDINGS = (
    8.0 * DEGREE
)  # errors of the products of weights and nodes, in units of rounding
THIRD_ORDER_SHARE = np.repeat(
    [1.0, 2.0], 10
)  # the third moments about the middles come to as much again at most
CONE_DIVISORS = 2.0 * DEGREE + 6.0  # ∫ f over a cone is w E[f] / this
AREA_FACTORS = DEGREE + 3.0  # ∫ f over a triangle is (doubled area E[f]) / 2, this much more
TRIANGLES_PER_BLOCK = 2048  # triangles whose products stay in the cache
ROWS, COLUMNS = np.triu_indices(3)
AXIS_PAIRS = (1, 2), (2, 0), (0, 1)
# Indices of the three terms of each symmetric product in a table of x, y, z times xx, xy, xz, yy,
# yz, zz.
CUBE = np.array(
    [
        [6 * i + PAIR_INDEX[j, k], 6 * j + PAIR_INDEX[i, k], 6 * k + PAIR_INDEX[i, j]]
        for i, j, k in TRIPLES
    ]
).T


def small_moments(
    points: NDArray,
    triangles: NDArray[np.integer],
    counts: NDArray[np.integer],
    center: NDArray[np.float64],
    reach: NDArray[np.float64],
    half_ulp: NDArray[np.float64],
    *,
    area: bool,
    area_moments: bool,
) -> tuple[Moments, Moments, NDArray[np.float64]]:
    """Return stacked volumes and areas of n bodies, and (n, 2) sums of the cones over faces,
    positive and signed.

    Triangles are sorted by body, at least one each. reach: (n, 3) largest distances of points from
    `center`. half_ulp: (n, 3) their shifts by storage. Without `area` the areas are zero, and the
    `input_error` is larger.
    """
    coordinates = np.ascontiguousarray(points.T)
    ends = np.cumsum(counts)
    sums = []
    for part in batches(counts, TRIANGLES_PER_BLOCK):
        rows = triangles[ends[part.start] - counts[part.start] : ends[part.stop - 1]]
        corners = coordinates.take(rows.T, axis=1).astype(np.float64, copy=False)
        sums.append(_segment_sums(corners, counts[part], center[part], area, area_moments))
    of_volume, of_area, side, base, sizes = (
        sums[0] if len(sums) == 1 else map(np.concatenate, zip(*sums))
    )
    products = side[:, :, None] * base[:, None] * counts[:, None, None]
    number = counts[:, None]
    tau = np.array([products[:, i, j] + products[:, j, i] for i, j in AXIS_PAIRS]).T
    lengths = np.sqrt(np.add.reduce(side * side, axis=1)) + np.sqrt(
        np.add.reduce(base * base, axis=1)
    )
    edges = lengths[:, None] * number  # bound the sums at the triangles' first corners
    rounding, inputs = error_bounds(reach, half_ulp, tau, edges, sizes, number, 3.0 * number, area)
    raw = of_volume / DIVISORS
    cones = np.array([sizes[:, 0], of_volume[:, 0]]).T
    error = rounding[0] / CONE_DIVISORS + 8.0 * U * np.abs(raw)
    volume = unchecked_moments(raw, center, Measure.VOLUME, error, inputs[0])
    if not area:
        return volume, Moments(np.zeros((len(counts), 1)), center, Measure.AREA), cones
    raw = of_area / (DIVISORS / AREA_FACTORS) if area_moments else sizes[:, 1:] / 2.0
    kept = raw.shape[1]
    error = rounding[1, :, :kept] / 2.0 + 8.0 * U * np.abs(raw)
    return volume, unchecked_moments(raw, center, Measure.AREA, error, inputs[1, :, :kept]), cones


def _segment_sums(
    corners: NDArray, counts: NDArray[np.integer], center: NDArray, area: bool, area_moments: bool
) -> tuple[NDArray, ...]:
    """Return five arrays of sums for n bodies. corners: (3, 3, t) x, y, z of the corners a, b, c of
    their triangles.

    These are (n, 20) Σ w f, which `DIVISORS` turn into moments; the same with doubled areas, or (n,
    0); the largest components of b-a and of c-a, (n, 3) each; and (n, 2) Σ |w| and Σ doubled area.
    """
    starts = np.cumsum(counts) - counts
    edges = corners[:, 1:] - corners[:, :1]
    above = edges.take(NEXT_AXIS, 0)
    below = edges.take(PREVIOUS_AXIS, 0)
    normals = above[:, 0] * below[:, 1] - below[:, 0] * above[:, 1]
    nodes = np.empty((3, 4, corners.shape[2]))  # a, b, c and s
    middle = center.T[:, None] if len(counts) == 1 else np.repeat(center.T, counts, axis=1)[:, None]
    np.subtract(corners, middle, nodes[:, :3])
    np.add.reduce(nodes[:, :3], axis=1, out=nodes[:, 3])
    sums = np.empty((20, nodes.shape[2]))  # the sums of each triangle, for a weight of 1
    sums[0] = 1.0
    sums[1:4] = nodes[:, 3]
    products = nodes.take(ROWS, 0) * nodes.take(COLUMNS, 0)  # (6, 4, t)
    single = np.add.reduce(products[:, :3], axis=1)
    np.add(products[:, 3], single, sums[4:10])
    np.add(0.5 * sums[4:10], single, products[:, 3])
    third = nodes[:, None, 0] * products[:, 0]
    for node in range(1, 4):
        third += nodes[:, None, node] * products[:, node]
    np.add.reduce(third.reshape(18, -1).take(CUBE, 0), axis=0, out=sums[10:])
    det = np.add.reduce(normals * nodes[:, 0])
    sizes = np.zeros((2, len(det)))
    np.abs(det, sizes[0])
    if area:
        np.sqrt(np.add.reduce(normals * normals), sizes[1])
    largest = np.maximum.reduceat(np.abs(edges), starts, axis=2)
    return (
        np.add.reduceat(sums * det, starts, axis=1).T,
        np.add.reduceat(sums * sizes[1], starts, axis=1).T
        if area_moments
        else np.empty((len(counts), 0)),
        largest[:, 0].T,
        largest[:, 1].T,
        np.add.reduceat(sizes, starts, axis=1).T,
    )


def error_bounds(
    reach: NDArray,
    half_ulp: NDArray,
    tau: NDArray,
    edges: NDArray,
    sizes: NDArray,
    counts: NDArray,
    sum_roundings: NDArray | float,
    area: bool,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the errors of Σ w E[f] and `input_error`, (2, n, 20), for determinants and doubled
    areas as weights w.

    tau: (n, 3) the sums of τ (see `third_order`). edges: (n, 1) the sum of two edges of each
    triangle. sizes: (n, 2) Σ |w|. counts: (n, 1) triangles. sum_roundings: of the sums, in units u.
    """
    moved_reach = reach + half_ulp
    powers = monomial_bounds(reach)
    displaced = monomial_bounds(moved_reach)
    weight = (
        9.0
        * U
        * np.array([np.add.reduce(reach * tau, axis=1), np.add.reduce(tau, axis=1)])[:, :, None]
    )
    size = sizes.T[:, :, None] * (1.0 + 1e-9)
    # Then come their products with the nodes, the sums, and the loss by underflow.
    steps = PRODUCT_ROUNDINGS + sum_roundings
    rounding = (
        (weight + 1e-290 * counts + (U * (size + weight)) * steps) * powers * THIRD_ORDER_SHARE
    )
    inputs = np.zeros((2, len(reach), 20))
    if half_ulp.any():
        step = np.sqrt(np.add.reduce(half_ulp * half_ulp, axis=1))[:, None]
        double = size[1] if area else np.sqrt(np.add.reduce(tau * tau, axis=1))[:, None]
        # A closed surface sweeps this volume if float32 moves its points.
        swept = double / 2.0 + step * edges + 2.0 * step * step * counts
        tilted = step * (edges + 2.0 * step * counts)
        share = half_ulp / np.where(
            moved_reach > 0.0, moved_reach, 1.0
        )  # 1 for an axis without extent
        inputs[0] = step * swept * displaced
        inputs[1] = displaced * (tilted + np.add.reduce(share[:, None] * EXPONENTS, axis=2) * swept)
    return rounding, inputs


def monomial_bounds(reaches: NDArray) -> NDArray[np.float64]:
    """Return the (k, 20) largest values of the monomials within (k, 3) reaches."""
    factors = np.ones((len(reaches), 4))
    factors[:, 1:] = reaches
    return np.multiply.reduce(factors.take(MONOMIAL_FACTORS, axis=1), axis=2)
