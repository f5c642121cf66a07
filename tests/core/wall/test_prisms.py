# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Jacobians of wall prisms and their first roots, in rational arithmetic."""

from fractions import Fraction
from math import isqrt

import numpy as np
import pytest
from body_moments.core.moments.raw import U
from body_moments.core.wall.walls import first_positive_root


def exact_root(a, b, c, error=(0, 0, 0)):
    """Return the first positive root of a + b s + c s² less an error, in fractions to 60 digits, or
    None.
    """
    a, b, c = (Fraction(float(x)) - Fraction(float(e)) for x, e in zip((a, b, c), error))
    if a <= 0:
        return Fraction(0)
    square = b * b - 4 * a * c
    if square < 0:
        return None
    digits = 10**60
    root = Fraction(
        isqrt(square.numerator * square.denominator * digits**2), square.denominator * digits
    )
    return 2 * a / (root - b) if root > b else None


@pytest.mark.parametrize("scale", [1.0, 2.0**-40, 2.0**40])
@pytest.mark.parametrize("unit", [1.0, 2.0**-12, 2.0**12])
def test_a_prism_is_good_up_to_the_first_root_and_no_farther(scale, unit):
    """Real roots of either sign, of sizes far apart; none; double ones, which rounding may have
    split.
    """
    roots = [
        (3.0, 7.0),
        (3.0, -7.0),
        (-3.0, 7.0),
        (-3.0, -7.0),
        (1.0, 1e9),
        (-1.0, 1e9),
        (1e9, -1e-3),
        (0.3, 0.31),
    ]
    rows = [(1.0, -1.0 / p - 1.0 / q, 1.0 / p / q) for p, q in roots]
    rows += [
        (1.0, 0.0, 1.0),
        (1.0, -1.9, 1.0),
        (1.0, 1.0, 4.0),
        (1.0, -0.1, 0.0),
        (1.0, 0.5, 0.0),
        (1.0, 0.0, 0.0),
    ]
    rows += [(1.0, 0.25, -1e-13), (1.0, -0.25, -1e-13), (0.125, 0.0, -2.0)]
    columns = scale * np.array(rows).T * np.array([[1.0], [1.0 / unit], [1.0 / unit**2]])
    found = first_positive_root(np.repeat(columns[:, None], 3, axis=1), np.zeros_like(columns))
    for value, row in zip(found.tolist(), columns.T):
        truth = exact_root(*row)
        if truth is None:
            assert value == np.inf
        else:
            b, product = float(row[1]) ** 2, 4.0 * float(row[0] * row[2])
            near = 64.0 * U * (1.0 + (b + abs(product)) / abs(b - product) if b != product else 1.0)
            assert truth * (1 - Fraction(near)) <= Fraction(value) <= truth


def test_double_root_is_found_at_any_rounding():
    rng = np.random.default_rng(3)
    twice = rng.uniform(0.1, 10.0, 200)
    columns = np.array([np.ones(200), -2.0 / twice, 1.0 / twice**2])
    found = first_positive_root(np.repeat(columns[:, None], 3, axis=1), np.zeros_like(columns))
    assert (np.abs(found / twice - 1.0) < 1e-6).all()
    squares = [Fraction(float(b)) ** 2 - 4 * Fraction(float(c)) for _, b, c in columns.T]
    assert min(squares) < 0 < max(squares)
