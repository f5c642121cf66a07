# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums and products of float64 with their rounding errors (Dekker 1971, Knuth), for use if an ulp
would be too much.
"""

from __future__ import annotations

import numpy as np

from .array_types import Array, Complex, NDArray

SPLITTER = 2.0**27 + 1.0


def two_sum(a: NDArray, b: NDArray) -> tuple[NDArray, NDArray]:
    """Return the rounded sum and its error: together exactly a + b."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: NDArray, b: NDArray) -> tuple[NDArray, NDArray]:
    """Return the rounded product and its error; their sum is exactly `a * b`, for products from
    1e-290 to 1e290.
    """
    product = a * b
    (ah, al), (bh, bl) = _split(a), _split(b)
    return product, al * bl - (((product - ah * bh) - al * bh) - ah * bl)


def _split(a: NDArray) -> tuple[NDArray, NDArray]:
    """Split a into two numbers of 26 bits that add up to it."""
    big = SPLITTER * a
    high = big - (big - a)
    return high, a - high


def compensated_normals(a: NDArray, b: NDArray, c: NDArray) -> Array:
    """Return (3, k) (b-a) x (c-a) for corners (3, k), relatively accurate to about u however thin
    the triangles are.
    """
    (u, ul), (v, vl) = two_sum(b, -a), two_sum(c, -a)  # the edges, and their rounding errors
    coordinates = []
    for y, z in ((1, 2), (2, 0), (0, 1)):
        (p, pl) = two_product(u[y], v[z])
        (m, ml) = two_product(u[z], v[y])
        total, rest = two_sum(p, -m)
        coordinates.append(
            total + (rest + (pl - ml) + (u[y] * vl[z] + ul[y] * v[z] - u[z] * vl[y] - ul[z] * v[y]))
        )
    return np.stack(coordinates)


def phase_factors(q: NDArray, x: NDArray) -> Complex:
    """Return (m,) exp(-i q·x) for q (m, n) and x (n,), accurate to a few u, however large the
    phase.
    """
    total, rest = two_product(q[:, 0], x[0])
    for axis in range(1, q.shape[1]):
        product, product_error = two_product(q[:, axis], x[axis])
        total, sum_error = two_sum(total, product)
        rest = rest + (product_error + sum_error)
    return np.exp(-1j * total) * (1.0 - 1j * rest)
