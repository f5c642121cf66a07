# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The explicit formulae of Sheynin and Tuzikov (Pattern Recognition Letters 22, 2001) as they are
printed.

The moment of a tetrahedron with one corner in the origin is det·Σ_pqr / (p+q+r+3)!, that of the
triangle opposite to it 2A·Σ_pqr / (p+q+r+2)!, with Σ_pqr the nine-fold sum of `sigma`. Faces are
fans from their first corner.

A reference, not the way to measure a mesh: its cost grows with the ninth power of the order. It
computes with any number type: `fractions.Fraction` gives exact rational moments, floats rounded
ones, numpy arrays those of many triangles at once. The formulae are about the origin; in floats
subtract a point of the body first (`about`), else only noise is left after cancellation.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate, repeat
from math import comb, factorial, sqrt
from operator import mul
from typing import Any

from ..moments.raw import monomials
from ..numerics import Number, Vector, cross, dot, subtract


def sigma(exponents: tuple[int, int, int], a: Vector, b: Vector, c: Vector) -> Number:
    """Return Σ_pqr of three corners.

    Parameters
    ----------
    exponents : (p, q, r)
    a, b, c : (x, y, z)
        The corners: numbers, or arrays with one entry for each triangle.

    Returns
    -------
    number or array

    Examples
    --------
    >>> from body_moments.core.papers.sheynin_tuzikov_2001 import sigma
    >>> sigma((1, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0))
    6
    """
    powers = [
        [list(accumulate(repeat(corner[axis], n), mul, initial=1)) for corner in (a, b, c)]
        for axis, n in enumerate(exponents)
    ]
    parts = [list(_compositions(n)) for n in exponents]
    total = 0
    for k, k_ways in parts[0]:
        for l, l_ways in parts[1]:
            for m, m_ways in parts[2]:
                # p! q! r! / (k₁! k₂! k₃! l₁! … m₃!) is the number of ways, an integer.
                term = k_ways * l_ways * m_ways
                for v in range(3):
                    term *= factorial(k[v] + l[v] + m[v])
                for v in range(3):
                    for axis, i in ((0, k[v]), (1, l[v]), (2, m[v])):
                        if i:
                            term = term * powers[axis][v][i]
                total = total + term
    return total


def volume_moments(
    points: Sequence[Vector], faces: Sequence[Sequence[int]], order: int, about: Vector = (0, 0, 0)
) -> list[Number]:
    """Return ∫ x^p y^q z^r dV of the solid within outward polygons.

    Parameters
    ----------
    points : sequence of (x, y, z)
        Numbers of one type, exact or not.
    faces : sequence of sequence of int
        Corner indices, counter-clockwise from outside.
    order : int
    about : (x, y, z)

    Returns
    -------
    list of numbers
        In the order of `monomials`.

    Examples
    --------
    >>> from fractions import Fraction
    >>> from body_moments.core.papers.sheynin_tuzikov_2001 import volume_moments
    >>> points = [(0, 0, 0), (Fraction(1), 0, 0), (0, Fraction(1), 0), (0, 0, Fraction(1))]
    >>> volume_moments(points, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], 1)[1]
    Fraction(1, 24)
    """
    sums = _sum_over_faces(points, faces, order, about, lambda a, b, c: dot(a, cross(b, c)))
    return [total / factorial(sum(m) + 3) for m, total in zip(_exponents_to(order), sums)]


def surface_moments(
    points: Sequence[Vector],
    faces: Sequence[Sequence[int]],
    order: int,
    about: Vector = (0, 0, 0),
    root: Callable[[Any], Number] = sqrt,
) -> list[Number]:
    """Return ∫ x^p y^q z^r dA over the faces.

    Parameters
    ----------
    points, faces, order, about
        As for `volume_moments`.
    root : callable
        Returns 2A from (2A)², by default in floats; an exact root gives exact moments.

    Returns
    -------
    list of numbers
        In the order of `monomials`.

    Examples
    --------
    >>> from body_moments.core.papers.sheynin_tuzikov_2001 import surface_moments
    >>> surface_moments([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], 0)
    [0.5]
    """

    def double_area(a: Vector, b: Vector, c: Vector) -> Number:
        normal = cross(subtract(b, a), subtract(c, a))
        return root(dot(normal, normal))

    sums = _sum_over_faces(points, faces, order, about, double_area)
    return [total / factorial(sum(m) + 2) for m, total in zip(_exponents_to(order), sums)]


def _sum_over_faces(
    points: Sequence[Vector],
    faces: Sequence[Sequence[int]],
    order: int,
    about: Vector,
    weight: Callable[[Vector, Vector, Vector], Number],
) -> list[Number]:
    points = [subtract(point, about) for point in points]
    sums: list[Number] = [0] * len(_exponents_to(order))
    for face in faces:
        for j in range(1, len(face) - 1):
            a = points[face[0]]
            b = points[face[j]]
            c = points[face[j + 1]]
            factor = weight(a, b, c)
            if factor:
                sums = [
                    total + factor * sigma(m, a, b, c)
                    for total, m in zip(sums, _exponents_to(order))
                ]
    return sums


def _exponents_to(order: int) -> list[tuple[int, int, int]]:
    """Return (p, q, r) of all monomials to an order, in the order of `monomials`."""
    return [tuple(row) for row in monomials(order).tolist()]


def _compositions(n: int) -> Iterator[tuple[tuple[int, int, int], int]]:
    """Return all (k₁, k₂, k₃) that add up to n, and n! / (k₁! k₂! k₃!)."""
    for first in range(n + 1):
        for second in range(n - first + 1):
            yield (first, second, n - first - second), comb(n, first) * comb(n - first, second)
