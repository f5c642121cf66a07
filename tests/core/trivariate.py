# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Trivariate splines in exact rational arithmetic, piece by piece and without any formula of the
add-on's.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
from body_moments.core.moments.raw import monomials


def pieces(knots: list[Fraction], i: int, k: int) -> dict[int, list[Fraction]]:
    """B_{i,k} as polynomials: span -> coefficients in ascending powers of t, by the recursion on
    polynomials.
    """
    if k == 1:
        return {i: [Fraction(1)]} if knots[i] < knots[i + 1] else {}
    total: dict[int, list[Fraction]] = {}

    def add(part: dict, low: Fraction, high: Fraction, rising: bool) -> None:
        if high == low:
            return
        slope = (1 if rising else -1) / (high - low)
        constant = (-low if rising else high) / (high - low)
        for span, polynomial in part.items():
            result = total.setdefault(span, [Fraction(0)] * k)
            for power, c in enumerate(polynomial):
                result[power] += constant * c
                result[power + 1] += slope * c

    add(pieces(knots, i, k - 1), knots[i], knots[i + k - 1], True)
    add(pieces(knots, i + 1, k - 1), knots[i + 1], knots[i + k], False)
    return total


def integral(
    knots: list,
    i: int,
    k: int,
    power: int,
    low: Fraction | None = None,
    high: Fraction | None = None,
) -> Fraction:
    """∫ t^power B_{i,k}(t) dt over [low, high], by default over the whole support."""
    knots = [Fraction(knot) for knot in knots]
    total = Fraction(0)
    for span, polynomial in pieces(knots, i, k).items():
        a, b = knots[span], knots[span + 1]
        a, b = (a if low is None else max(a, low)), (b if high is None else min(b, high))
        if a < b:
            total += sum(
                c * (b ** (n + power + 1) - a ** (n + power + 1)) / (n + power + 1)
                for n, c in enumerate(polynomial)
            )
    return total


def exact_moments(coefficients: np.ndarray, axes, order: int, about) -> list[Fraction]:
    """The moments of a spline with exact coefficients and knots, in the order of `monomials`."""
    tables = []
    for axis, center in zip(axes, about):
        knots = [Fraction(float(knot)) - Fraction(float(center)) for knot in axis.knots]
        tables.append(
            [
                [integral(knots, i, axis.order, power) for i in range(axis.count)]
                for power in range(order + 1)
            ]
        )
    result = []
    for p, q, r in monomials(order).tolist():
        x, y, z = tables[0][p], tables[1][q], tables[2][r]
        result.append(
            sum(
                Fraction(float(coefficients[i, j, k])) * x[i] * y[j] * z[k]
                for i, j, k in product(*map(range, coefficients.shape))
                if coefficients[i, j, k]
            )
        )
    return result
