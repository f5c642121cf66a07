# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules of quadrature that are exact for polynomials: on a line and over a triangle; directions all
around.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .array_types import Array


@lru_cache
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Return read-only nodes and weights, (points,), of the rule on [0, 1] that is exact to degree
    2 points - 1.
    """
    nodes, weights = np.polynomial.legendre.leggauss(points)
    nodes = (nodes + 1.0) / 2.0
    weights = weights / 2.0
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


@lru_cache
def gauss_legendre_with_ends(points: int) -> tuple[Array, Array]:
    """Return the rule of `gauss_legendre` with the nodes 0 and 1 of weight 0 added at its ends;
    read-only.
    """
    nodes, weights = gauss_legendre(points)
    nodes = np.concatenate([[0.0], nodes, [1.0]])
    weights = np.concatenate([[0.0], weights, [0.0]])
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


@lru_cache
def triangle_rule(n: int) -> tuple[Array, Array]:
    """Return (3, k) barycentric points and (k,) weights, of sum 1/2, of a rule exact to degree 2n -
    1 over a triangle.

    It has n² points, for n = 3 the seven of Radon (1948): the Gauss-Legendre rule across the
    triangle times the Gauss-Jacobi rule towards its tip, for the weight 1 - u by which it narrows
    (nodes by Golub and Welsch, 1969).
    """
    if n == 3:
        root = np.sqrt(15.0)
        barycentric = [
            [1.0 / 3.0] * 3,
            *(
                np.roll([1.0 - 2.0 * a, a, a], k)
                for a in ((6.0 - root) / 21.0, (6.0 + root) / 21.0)
                for k in range(3)
            ),
        ]
        return np.array(barycentric).T, np.array(
            [270.0, *[155.0 - root] * 3, *[155.0 + root] * 3]
        ) / 2400.0
    k = np.arange(n)
    beside = np.sqrt((k[1:] * (k[1:] + 1.0)) / (2.0 * k[1:] + 1.0) ** 2)
    u, vectors = np.linalg.eigh(
        np.diag(-1.0 / ((2.0 * k + 1.0) * (2.0 * k + 3.0)))
        + np.diag(beside, 1)
        + np.diag(beside, -1)
    )
    u = (u + 1.0) / 2.0
    towards = vectors[0] ** 2 / 2.0
    v, across = gauss_legendre(n)
    second = np.outer(1.0 - u, v).reshape(-1)
    first = np.repeat(u, n)
    return np.stack([1.0 - first - second, first, second]), np.outer(towards, across).reshape(-1)


@lru_cache
def spread_directions(count: int) -> Array:
    """Return read-only (count, 3) unit directions, spread evenly over the sphere: Fibonacci's
    lattice.
    """
    index = np.arange(count) + 0.5
    height = 1.0 - 2.0 * index / count
    turn = np.pi * (1.0 + 5.0**0.5) * index
    across = np.sqrt(1.0 - height * height)
    directions = np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
    directions.flags.writeable = False
    return directions
