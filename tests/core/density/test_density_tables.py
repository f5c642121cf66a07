# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables ∫ t^l B_i against exact rational integration, and the paper's theorem against both."""

import random
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density.spline_grid import SplineAxis, full_support_integrals
from body_moments.core.moments.raw import U
from body_moments.core.papers.soldea_elber_rivlin_2002_theorem_4_2 import integral_of_basis
from body_moments.tests.core.trivariate import integral

from tests.close import close

DEGREE = 6


def random_knots(order: int, seed: int, repeated: bool = False) -> list[float]:
    rng = random.Random(seed)
    knots = sorted(rng.randrange(-40, 40) / 8 for _ in range(order + 6))
    if repeated:
        knots[2:4] = [knots[2]] * 2
        knots[-2:] = [knots[-1]] * 2
    return knots


def knots_of(kind: str, order: int) -> list[float]:
    if kind == "uniform":
        return [0.25 * i - 1.0 for i in range(order + 6)]
    if kind == "clamped":
        return [-1.0] * order + [-0.5, 0.125, 0.25, 2.0] + [3.0] * order
    return random_knots(order, order, repeated=kind == "repeated")


KINDS = ("uniform", "random", "repeated", "clamped")


def worst(axis: SplineAxis, center: float) -> tuple[float, float]:
    """The largest error over the natural size of an entry, and over its stated bound."""
    table = full_support_integrals(axis.knots - center, axis.order, DEGREE)
    knots = [Fraction(knot) - Fraction(center) for knot in axis.knots.tolist()]
    error, excess = 0.0, 0.0
    for power in range(DEGREE + 1):
        for i in range(axis.count):
            mass = integral(knots, i, axis.order, 0)
            size = float(mass * max(abs(knots[i]), abs(knots[i + axis.order])) ** power)
            off = abs(float(Fraction(table[power, i]) - integral(knots, i, axis.order, power)))
            if size:
                error = max(error, off / size)
                excess = max(excess, off / (size * (2 * axis.order + 3 * DEGREE + 8) * U))
            else:
                assert off == 0.0
    return error, excess


@pytest.mark.parametrize("order", range(1, 7))
@pytest.mark.parametrize("kind", KINDS)
def test_full_supports_are_exact_to_rounding(kind, order):
    error, excess = worst(SplineAxis(np.array(knots_of(kind, order)), order), 0.375)
    assert error < 1e-14
    assert excess < 1.0


@pytest.mark.parametrize("order", (1, 2, 3, 4))
@pytest.mark.parametrize("power", range(4))
def test_theorem_4_2_is_exact_as_printed(order, power):
    knots = [Fraction(n, 7) for n in sorted(random.Random(order).sample(range(-30, 60), order + 5))]
    for i in range(3):
        last = knots[i + order]
        middle = (knots[i] + 3 * last) / 4
        for t in (middle, last, knots[i + 1]):
            assert integral_of_basis(knots, i, order, power, t) == integral(
                knots, i, order, power, high=t
            )


def test_theorem_4_2_with_repeated_knots():
    knots = [Fraction(n) for n in (0, 0, 1, 1, 3, 4, 4, 6)]
    for i in range(4):
        assert integral_of_basis(knots, i, 4, 2, knots[i + 4]) == integral(knots, i, 4, 2)


@pytest.mark.parametrize("order", range(1, 7))
def test_a_uniform_function_has_variance_k_twelfths(order):
    knots = SplineAxis.uniform(1, order).knots / 2.0
    table = full_support_integrals(knots, order, 4)[:, 0]
    k, g = order, 0.5
    assert close(
        table, [g, 0.0, g * k * g**2 / 12, 0.0, g * g**4 * k * (5 * k - 2) / 240], rel=1e-14
    )


def test_splines_have_an_order_up_to_sixteen():
    assert close(full_support_integrals(SplineAxis.uniform(1, 16).knots, 16, 0), 1.0, rel=1e-14)
    for order in (0, 17):
        with pytest.raises(ValueError, match="1…16"):
            SplineAxis.uniform(1, order)
