# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The monomials x^p y^q z^r by ascending degree: their number, order and index."""

from __future__ import annotations

from functools import lru_cache
from math import factorial, prod
from typing import TypeVar

import numpy as np

from ..numerics import Array, Index, Int64, Integers

KNOWN_ORDER = 3  # every body has its moments to this order

AnyIndex = TypeVar("AnyIndex", int, Int64)  # an index, or an array of indices


@lru_cache
def monomial_count(order: int) -> int:
    """Return the number of monomials in x, y, z of degree at most `order`."""
    return int((order + 1) * (order + 2) * (order + 3) // 6)


@lru_cache
def order_from_count(count: int) -> int:
    """Return the lowest order that has at least `count` monomials."""
    order = 0
    while monomial_count(order) < count:
        order += 1
    return order


def check_exponents(exponents: object, dimension: int, order: int) -> tuple[int, ...]:
    """Return the exponents.

    TypeError if not `dimension` integers, IndexError if negative or beyond the order.
    """
    powers = tuple(exponents) if isinstance(exponents, (tuple, list, np.ndarray)) else ()
    if len(powers) != dimension or not all(
        isinstance(power, (int, np.integer)) for power in powers
    ):
        raise TypeError("not {:d} integer exponents: {!r}".format(dimension, exponents))
    if min(powers) < 0 or sum(powers) > order:
        raise IndexError("no moment {} to order {:d}".format(tuple(map(int, powers)), order))
    return powers


def monomial_index(p: AnyIndex, q: AnyIndex, r: AnyIndex) -> AnyIndex:
    """Return the index of the monomial x^p y^q z^r, sorted by degree, within a degree by (q + r,
    r).
    """
    negative = (p | q | r) < 0
    if negative if isinstance(negative, bool) else negative.any():
        raise IndexError("negative exponents: {}".format((p, q, r)))
    s = q + r
    n = p + s
    return n * (n + 1) * (n + 2) // 6 + s * (s + 1) // 2 + r


@lru_cache
def monomials(order: int) -> Int64:
    """Return the exponents (p, q, r) of all monomials to an order, in storage order.

    Parameters
    ----------
    order : int

    Returns
    -------
    (K, 3) integer array
        Read-only.

    Examples
    --------
    >>> from body_moments.core.moments import monomials
    >>> monomials(1).tolist()
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    """
    exponents = [
        (n - s, s - r, r) for n in range(order + 1) for s in range(n + 1) for r in range(s + 1)
    ]
    table = np.array(exponents, np.int64)
    table.flags.writeable = False
    return table


def monomial_values(points: Array, order: int) -> Array:
    """Return (n, K) the monomials to an order at points (n, 3)."""
    powers = np.ones((order + 1, 3, len(points)))
    powers[1:] = points.T
    powers = np.multiply.accumulate(powers)
    p, q, r = monomials(order).T
    return (powers[p, 0] * powers[q, 1] * powers[r, 2]).T


def factorial_ratios(exponents: Integers, more: int) -> Array:
    """Return (K,) α! / (|α| + `more`)! of (K, n) exponents, correctly rounded."""
    return np.array(
        [prod(map(factorial, row)) / factorial(sum(row) + more) for row in exponents.tolist()]
    )


@lru_cache
def count_of_degree(degree: int) -> int:
    """Return the number of monomials of exactly this degree."""
    return int((degree + 1) * (degree + 2) // 2)


@lru_cache
def quotient_indices(degree: int, missing: int) -> Index:
    """Return (3, rows) indices, within the degree below, of x^α / x, x^α / y, x^α / z; `missing`
    without the factor.
    """
    table = monomials(degree)[-count_of_degree(degree) :]
    r = table[:, 2]
    s = table[:, 1] + table[:, 2]
    lower = s * (s - 1) // 2
    return np.where(
        table.T > 0, np.array([s * (s + 1) // 2 + r, lower + r, lower + r - 1]), missing
    )


@lru_cache
def product_indices(order: int) -> tuple[Int64, ...]:
    """Return three arrays: the indices of the products with x, y and z of each monomial of a degree
    below `order`.
    """
    lower = monomials(order - 1)
    return tuple(
        np.array([monomial_index(*(row + unit)) for row in lower]) for unit in np.eye(3, dtype=int)
    )


@lru_cache
def tensor_index(degree: int) -> Int64:
    """Return the (3, ..., 3) indices in `Moments.raw` of the entries of the symmetric tensor of a
    degree; read-only.
    """
    axes = np.indices((3,) * degree)
    table = monomial_index(*((axes == axis).sum(axis=0) for axis in range(3)))
    table.flags.writeable = False
    return table
