# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Constant sets of smooth splines against closed forms, within the bounds that they report."""

import numpy as np
import pytest
from body_moments.core.density.smooth_threshold import smooth_threshold_body, spline_values

from tests.close import close

X = np.arange(-5.0, 6.0)


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_smoothed_values_match_the_spline(order):
    """Against de Boor's recursion over the knots of a uniform spline, along each axis."""
    coefficients = np.random.default_rng(order).normal(size=(9, 8, 7))
    values = spline_values(coefficients, order, 3)
    for axis, count in enumerate(coefficients.shape):
        knots = np.arange(count + order) - order / 2.0
        t = np.arange(3 * (count - 1) + 1) / 3.0
        inside = (t >= knots[order - 1]) & (t <= knots[count])
        basis = np.zeros((len(t), count))
        for i in range(count):
            one = np.zeros(count)
            one[i] = 1.0
            basis[inside, i] = _evaluate(knots, order, one, t[inside])
        line = np.moveaxis(coefficients, axis, 0)[:, 0, 0]
        plain = np.zeros_like(coefficients)
        plain[:] = line.reshape([-1 if a == axis else 1 for a in range(3)])
        found = np.moveaxis(spline_values(plain, order, 3), axis, 0)[:, 0, 0]
        assert np.abs(found - basis @ line)[inside].max() < 1e-12 * np.abs(line).max()
    assert values.shape == (25, 22, 19)


def _evaluate(knots, order, coefficients, t):
    """De Boor's recursion at points that each lie in a span of full support."""
    result = np.empty(len(t))
    for n, x in enumerate(t):
        k = int(
            np.clip(np.searchsorted(knots, x, side="right") - 1, order - 1, len(coefficients) - 1)
        )
        d = [coefficients[j + k - order + 1] for j in range(order)]
        for r in range(1, order):
            for j in range(order - 1, r - 1, -1):
                i = j + k - order + 1
                share = (x - knots[i]) / (knots[i + order - r] - knots[i])
                d[j] = (1.0 - share) * d[j - 1] + share * d[j]
        result[n] = d[-1]
    return result


def test_a_quadratic_s_ball_within_its_bound():
    """Cubic splines keep quadratics but for a constant: Σ (i² ) β = x² + 1/3, so 9 - |x|² becomes 8
    - |x|².
    """
    samples = 9.0 - (X[:, None, None] ** 2 + X[:, None] ** 2 + X**2)
    found = smooth_threshold_body(samples, 0.0, 4, with_density=True)
    truth = 4.0 / 3.0 * np.pi * 8.0**1.5
    assert 0.0 < abs(found.volume.total - truth) <= found.volume.rounding_error[0] < 1e-4 * truth
    assert abs(found.area.total - 4.0 * np.pi * 8.0) <= found.area.rounding_error[0]
    mass = 4.0 * np.pi * (8.0 * 8.0**1.5 / 3.0 - 8.0**2.5 / 5.0)
    assert abs(found.mass.total - mass) <= found.mass.rounding_error[0] < 1e-3 * mass
    assert close(found.volume.center, (5.0, 5.0, 5.0), rel=1e-9)


def test_a_matrix_and_a_background_place_it():
    samples = np.full((3, 3, 3), 1.0)
    matrix = np.diag([0.5, 2.0, 0.25, 1.0])
    matrix[:3, 3] = 7.0, -1.0, 3.0
    found = smooth_threshold_body(samples, 0.5, 4, matrix=matrix, background=0.0)
    assert not found.clipped
    assert close(found.volume.center, (7.5, 1.0, 3.25), rel=1e-9)
    alone = smooth_threshold_body(samples, 0.5, 4, matrix=matrix)
    within = smooth_threshold_body(samples, 0.5, 4, matrix=matrix, background=0.5)
    for found in (alone, within):
        assert found.clipped and close(found.volume.total, 8.0 * 0.25, rel=1e-12)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_the_background_goes_on_around_the_grid(order):
    """The spline's own number of values gives the same body as the samples alone."""
    samples = np.random.default_rng(order).uniform(1.0, 2.0, (3, 4, 3))
    margin = (order + 1) // 2
    found = smooth_threshold_body(samples, 0.5, order, order=1, background=-3.0)
    padded = smooth_threshold_body(
        np.pad(samples, margin, constant_values=-3.0), 0.5, order, order=1
    )
    assert close(found.volume.total, padded.volume.total, rel=1e-13) and not found.clipped
    assert close(found.volume.center, padded.volume.center - margin, rel=1e-12)
