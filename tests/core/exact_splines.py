# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of polynomial B-spline patches in rational arithmetic, and patches whose bodies have
closed forms.

The basis is built as polynomials by the recursion of Cox and de Boor, span by span, and the z-flux
is integrated term by term: neither Gauss's rule nor the radial flux that the add-on uses.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from body_moments.core.numerics.bspline import SplineSpace
from body_moments.core.nurbs import Patch, blender_space

HALF = np.sqrt(0.5)


def span_polynomials(space: SplineSpace, j: int) -> list[list[Fraction]]:
    """The coefficients, lowest first, in the parameter itself, of the functions that act in
    span j.
    """
    knots = [Fraction(knot) for knot in space.knots]
    rows = {j: [Fraction(1)]}
    for order in range(2, space.order + 1):
        found = {}
        for i in range(j - order + 1, j + 1):
            total = [Fraction(0)] * order
            if i in rows:
                width = knots[i + order - 1] - knots[i]
                for power, value in enumerate(rows[i]):
                    total[power + 1] += value / width
                    total[power] -= value * knots[i] / width
            if i + 1 in rows:
                width = knots[i + order] - knots[i + 1]
                for power, value in enumerate(rows[i + 1]):
                    total[power] += value * knots[i + order] / width
                    total[power + 1] -= value / width
            found[i] = total
        rows = found
    return [rows[i] for i in range(j - space.order + 1, j + 1)]


def flux_moment(patch: Patch, exponents: tuple[int, int, int]) -> Fraction:
    """∫∫ x^p y^q z^(r+1) / (r+1) N_z ds dt about the origin, exactly, of a polynomial patch."""
    p, q, r = exponents
    total = Fraction(0)
    s_space, t_space = patch.spaces
    for j in s_space.spans:
        s_basis = span_polynomials(s_space, int(j))
        rows = s_space.controls_of_spans(np.array([j]))[0]
        for k in t_space.spans:
            t_basis = span_polynomials(t_space, int(k))
            columns = t_space.controls_of_spans(np.array([k]))[0]
            x, y, z = (
                _surface(patch.points[..., axis], rows, columns, s_basis, t_basis)
                for axis in range(3)
            )
            integrand = _minus(
                _times(_derived(x, 0), _derived(y, 1)), _times(_derived(x, 1), _derived(y, 0))
            )
            for factor, power in ((x, p), (y, q), (z, r + 1)):
                for _ in range(power):
                    integrand = _times(integrand, factor)
            total += _integral(integrand, s_space.knots[j : j + 2], t_space.knots[k : k + 2])
    return total / (r + 1)


def _surface(values, rows, columns, s_basis, t_basis) -> np.ndarray:
    table = np.full((len(rows), len(columns)), Fraction(0), object)
    for row, along in zip(rows, s_basis):
        for column, across in zip(columns, t_basis):
            table = table + Fraction(float(values[row, column])) * np.outer(along, across)
    return table


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    result = np.full(
        (a.shape[0] + b.shape[0] - 1, a.shape[1] + b.shape[1] - 1), Fraction(0), object
    )
    for (i, j), value in np.ndenumerate(b):
        if value:
            result[i : i + a.shape[0], j : j + a.shape[1]] += value * a
    return result


def _minus(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a - b


def _derived(a: np.ndarray, axis: int) -> np.ndarray:
    a = np.moveaxis(a, axis, 0)
    result = np.full(a.shape, Fraction(0), object)
    for power in range(1, len(a)):
        result[power - 1] = power * a[power]
    return np.moveaxis(result, 0, axis)


def _integral(a: np.ndarray, s, t) -> Fraction:
    def powers(bounds, count):
        low, high = (Fraction(float(bound)) for bound in bounds)
        return [(high ** (n + 1) - low ** (n + 1)) / (n + 1) for n in range(count)]

    return sum(
        value * along * across
        for along, row in zip(powers(s, a.shape[0]), a)
        for across, value in zip(powers(t, a.shape[1]), row)
    )


def circle() -> tuple[np.ndarray, np.ndarray]:
    """(8, 2) and (8,): the unit circle as four quarters of order 3, for cyclic, Bézier and endpoint
    flags.
    """
    corners = np.array(
        [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)], float
    )
    return corners, np.array([1.0, HALF] * 4)


ROUND = blender_space(8, 3, True, True, True)
ARCH = blender_space(5, 3, False, True, True)


def sphere() -> Patch:
    """The unit sphere, outward."""
    around, weights = circle()
    profile = [(0, -1, 1), (1, -1, HALF), (1, 0, 1), (1, 1, HALF), (0, 1, 1)]
    points = np.array([[(x * out, y * out, z) for out, z, _ in profile] for x, y in around])
    return Patch((ROUND, ARCH), points, np.outer(weights, [weight for *_, weight in profile]))


def torus(major: float = 0.75, minor: float = 0.25) -> Patch:
    """A torus about the z axis, outward."""
    around, weights = circle()
    points = np.array(
        [
            [(x * (major + minor * u), y * (major + minor * u), minor * v) for u, v in around]
            for x, y in around
        ]
    )
    return Patch((ROUND, ROUND), points, np.outer(weights, weights))


def tube(radius: float = 1.0, half: float = 1.0) -> Patch:
    """The lateral surface of a cylinder about the z axis, outward."""
    around, weights = circle()
    points = np.array([[(x * radius, y * radius, z) for z in (-half, half)] for x, y in around])
    return Patch(
        (ROUND, blender_space(2, 2, False, False, True)), points, np.outer(weights, [1.0, 1.0])
    )
