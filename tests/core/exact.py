# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of polyhedra in rational arithmetic, and closed forms: truths without a tolerance.

Floats are dyadic fractions, so the moments of a mesh of floats are rational numbers; they are found
here with integers of any length. The formula is that of Sheynin and Tuzikov by its generating
function 1 / ((1-a·t)(1-b·t)(1-c·t)), not the quadrature that the add-on uses.
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial, isqrt, lcm

Vector = tuple[Fraction, Fraction, Fraction]


def monomials(order: int) -> list[tuple[int, int, int]]:
    """The exponents of all monomials to an order, in the order of `moments.monomials`."""
    return [(n - s, s - r, r) for n in range(order + 1) for s in range(n + 1) for r in range(s + 1)]


MONOMIALS = monomials(3)


def volume_moments(
    points, triangles, about=(0.0, 0.0, 0.0), order: int = 3, absolute: bool = False
) -> list[Fraction]:
    """The moments ∫ x^p y^q z^r dV to an order about a point, of the cones from that point over the
    triangles.

    absolute: ∫ |x^p y^q z^r| |dV| instead, where no triangle crosses a coordinate plane (else more
    than that).

    points: n rows of 3 numbers, taken exactly. triangles: rows of 3 indices, outward faces
    counter-clockwise.
    """
    integers, scale = _integers(points, about)
    table = monomials(order)
    sums = [0] * len(table)
    for triangle in triangles:
        a, b, c = (integers[int(i)] for i in triangle)
        det = _dot(a, _cross(b, c))
        if absolute:
            det, (a, b, c) = abs(det), (tuple(map(abs, v)) for v in (a, b, c))
        if det:
            for i, value in enumerate(_means(a, b, c, table)):
                sums[i] += det * value
    return [
        Fraction(total, factorial(sum(m) + 3) * scale ** (sum(m) + 3))
        for m, total in zip(table, sums)
    ]


def area_moments(
    points, triangles, about=(0.0, 0.0, 0.0), digits: int = 40, order: int = 3
) -> list[Fraction]:
    """The moments ∫ x^p y^q z^r dA, right to `digits` digits (areas are square roots)."""
    integers, scale = _integers(points, about)
    root = 10**digits
    table = monomials(order)
    sums = [0] * len(table)
    for triangle in triangles:
        a, b, c = (integers[int(i)] for i in triangle)
        normal = _cross(_minus(b, a), _minus(c, a))
        double = isqrt(_dot(normal, normal) * root * root)
        if double:
            for i, value in enumerate(_means(a, b, c, table)):
                sums[i] += double * value
    return [
        Fraction(total, factorial(sum(m) + 2) * root * scale ** (sum(m) + 2))
        for m, total in zip(table, sums)
    ]


def _integers(points, about) -> tuple[list[tuple[int, int, int]], int]:
    origin = [Fraction(float(value)) for value in about]
    rows = [[_rational(value) - o for value, o in zip(point, origin)] for point in points]
    scale = lcm(*(value.denominator for row in rows for value in row))
    return [tuple(int(value * scale) for value in row) for row in rows], scale


def _rational(value) -> Fraction:
    return value if isinstance(value, Fraction) else Fraction(float(value))


def _means(a, b, c, exponents) -> list[int]:
    """p! q! r! times the coefficients of 1 / ((1 - a·t)(1 - b·t)(1 - c·t))."""
    table = {(0, 0, 0): 1, **{m: 0 for m in exponents[1:]}}
    for vertex in (a, b, c):
        for p, q, r in exponents[1:]:  # in this order the lower ones are already multiplied
            table[p, q, r] += (
                (vertex[0] * table[p - 1, q, r] if p else 0)
                + (vertex[1] * table[p, q - 1, r] if q else 0)
                + (vertex[2] * table[p, q, r - 1] if r else 0)
            )
    return [factorial(p) * factorial(q) * factorial(r) * table[p, q, r] for p, q, r in exponents]


def _minus(u, v):
    return tuple(x - y for x, y in zip(u, v))


def _cross(u, v):
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def _dot(u, v):
    return sum(x * y for x, y in zip(u, v))


def box_moments(low, high, order: int = 3) -> list[Fraction]:
    """The volume moments of an axis-aligned box about the origin."""
    low, high = ([Fraction(value) for value in corner] for corner in (low, high))

    def one(axis: int, n: int) -> Fraction:
        return (high[axis] ** (n + 1) - low[axis] ** (n + 1)) / (n + 1)

    return [one(0, p) * one(1, q) * one(2, r) for p, q, r in monomials(order)]


def corner_tetrahedron_moments(a, b, c, order: int = 3) -> list[Fraction]:
    """The volume moments of the tetrahedron (0,0,0), (a,0,0), (0,b,0), (0,0,c): Dirichlet's
    integral.
    """
    a, b, c = Fraction(a), Fraction(b), Fraction(c)
    return [
        Fraction(factorial(p) * factorial(q) * factorial(r), factorial(p + q + r + 3))
        * a ** (p + 1)
        * b ** (q + 1)
        * c ** (r + 1)
        for p, q, r in monomials(order)
    ]


BOX_QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def box(low, high) -> list[tuple[float, float, float]]:
    """The corners of an axis-aligned box, for BOX_QUADS."""
    return [
        (x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])
    ]


def fan(polygons) -> list[tuple[int, int, int]]:
    """Convex polygons as triangles."""
    return [(face[0], face[i], face[i + 1]) for face in polygons for i in range(1, len(face) - 1)]


def prism(
    outline, low, high, caps
) -> tuple[list[tuple[float, float, float]], list[tuple[int, ...]]]:
    """A straight prism: the corners and the faces, polygons, of a counter-clockwise outline of (x,
    y).

    caps: the outline cut into convex polygons of its indices.
    """
    n = len(outline)
    points = [(x, y, z) for z in (low, high) for x, y in outline]
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return points, sides + [tuple(n + i for i in cap) for cap in caps] + [
        tuple(reversed(cap)) for cap in caps
    ]
