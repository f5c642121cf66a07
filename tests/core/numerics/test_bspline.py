# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Basis functions against rational polynomials, and Blender's rules for knots."""

from fractions import Fraction
from itertools import product
from math import comb

import numpy as np
import pytest
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs.blender_knots import blender_knots, blender_space, is_valid

from tests.core.exact_splines import span_polynomials

SPACES = [clamped_space(order, (0.25, 0.5, 0.5)) for order in range(2, 7)] + [
    SplineSpace((0.0, 0.5, 1.0, 1.5, 3.0, 3.25, 4.0), 3, 4),
    blender_space(6, 4, True, False, False),
    SplineSpace((1e6, 1e6, 1e6, 1e6 + 0.5, 1e6 + 1, 1e6 + 1, 1e6 + 1), 3, 4),
]


@pytest.mark.parametrize("space", SPACES)
def test_values_and_derivatives_match_exact_polynomials(space):
    for j in space.spans:
        polynomials = span_polynomials(space, int(j))
        low, high = space.knots[j], space.knots[j + 1]
        for share in (0.0, 0.125, 0.5, 1.0):
            t = low + share * (high - low)
            found = space.derivatives(np.array([j]), np.array([t]), space.order + 2)
            assert len(found) == space.order + 3 and not np.any(found[space.order :])
            for derivative, values in enumerate(found):
                exact = []
                for row in polynomials:
                    for _ in range(derivative):
                        row = [power * value for power, value in enumerate(row)][1:] or [
                            Fraction(0)
                        ]
                    exact.append(
                        float(sum(value * Fraction(t) ** power for power, value in enumerate(row)))
                    )
                scale = max(1.0, np.abs(exact).max())
                assert np.abs(values[0] - exact).max() <= 1e-14 * scale * space.order


def test_a_cyclic_direction_ends_as_it_begins():
    space = blender_space(7, 5, True, False, False)
    first, last = space.collocation_matrix(np.array(space.domain))
    assert np.abs(first - last).max() <= 4e-16


@pytest.mark.parametrize(
    "knots, order, count, reason",
    [
        ((0, 0, 1, 1), 2, 3, "too few"),
        ((0, 0, 1, 1), 2, 0, "too few"),
        ((0, 1), 2, 1, "too few"),
        ((0, 1, 2), 2, 1, "too few"),
        ((0, 1), 0, 1, "too few"),
        ((0, 1, 0, 1), 2, 2, "ascend"),
        ((0, 0, float("nan"), 1), 2, 2, "ascend"),
        ((0, 0, 1, float("inf")), 2, 2, "ascend"),
        ((0, 0, 0, 0), 2, 2, "empty domain"),
        ((0, 1, 1, 2), 2, 2, "empty domain"),
    ],
)
def test_impossible_knots_are_refused(knots, order, count, reason):
    with pytest.raises(ValueError, match=reason):
        SplineSpace(tuple(float(knot) for knot in knots), order, count)


@pytest.mark.parametrize(
    "knots, order, jumps",
    [
        ((0, 0, 0, 1, 1, 1), 3, False),
        ((0, 0, 0, 0, 1, 1, 1, 1), 3, False),  # at an end of the domain
        ((0, 0, 0, 1, 1, 2, 2, 2), 3, False),
        ((0, 0, 0, 1, 1, 1, 2, 2, 2), 3, True),
        ((0, 1, 1, 2, 3, 4), 2, False),
        ((0, 1, 2, 3, 3, 4), 2, False),
        ((0, 1, 2, 2, 3, 4), 2, True),
        ((0, 0, 1, 2, 3, 3), 2, False),
    ],
)
def test_curves_jump_at_inner_knots_of_full_multiplicity(knots, order, jumps):
    space = SplineSpace(tuple(map(float, knots)), order, len(knots) - order)
    assert space.is_discontinuous is jumps


@pytest.mark.parametrize("space", SPACES)
def test_span_in_bezier_form_is_unchanged(space):
    """Evaluate by Bernstein's polynomials."""
    degree, share = space.order - 1, np.linspace(0.0, 1.0, 9)  # eighths, which round nothing
    bernstein = np.stack(
        [comb(degree, b) * share**b * (1 - share) ** (degree - b) for b in range(degree + 1)],
        axis=1,
    )
    for span, (low, high), weights in zip(space.spans, space.intervals, space.bezier_extraction):
        found = bernstein @ weights
        wanted = space.derivatives(np.full(9, span), low + share * (high - low), 0)[0]
        assert np.abs(found - wanted).max() <= 1e-13
        part = space.bezier_weights(
            np.array([span]), np.array([[low + 0.25 * (high - low), high]])
        )[0]
        wanted = space.derivatives(np.full(9, span), low + (0.25 + 0.75 * share) * (high - low), 0)[
            0
        ]
        assert np.abs(bernstein @ part - wanted).max() <= 1e-13


@pytest.mark.parametrize(
    "settings, knots, domain",
    [
        ((6, 4, False, False, False), list(range(10)), (3, 6)),
        ((6, 4, False, False, True), [0, 0, 0, 0, 1, 2, 3, 3, 3, 3], (0, 3)),
        ((7, 4, False, True, False), [0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3], (1, 2)),
        ((7, 4, False, True, True), [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2], (0, 2)),
        ((6, 4, True, False, False), None, (3, 9)),
        ((6, 4, True, True, False), None, (1, 3)),
        ((5, 3, True, False, True), [0, 1, 1, 2, 3, 4, 5, 5, 6, 7], (1, 5)),
    ],
)
def test_knots_match_blender(settings, knots, domain):
    if knots is not None:
        assert blender_knots(*settings).tolist() == knots
    assert blender_space(*settings).domain == domain


def test_valid_setting_never_fails():
    for count, order, *flags in product(range(1, 12), range(2, 7), *[(False, True)] * 3):
        space = blender_space(count, order, *flags)
        if not is_valid(count, order, *flags):
            assert space is None
        elif space is not None:
            assert space.count == count and space.domain[0] < space.domain[1]
