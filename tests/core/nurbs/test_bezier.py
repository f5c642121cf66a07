# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bézier patches cut from B-spline ones, against exact polynomials and against the patches
themselves.
"""

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from body_moments.core.numerics import SplineSpace, clamped_space, gauss_legendre
from body_moments.core.nurbs import Patch, blender_space
from body_moments.core.nurbs.bezier import cells_of
from body_moments.core.nurbs.patch_moments import flux_sums

from tests.core.exact_splines import span_polynomials

SPACES = [clamped_space(order, (0.25, 0.5, 0.5)) for order in range(1, 7)] + [
    SplineSpace((0.0, 0.5, 1.0, 1.5, 3.0, 3.25, 4.0), 3, 4),
    blender_space(6, 4, True, False, False),
    blender_space(3, 3, True, False, False),
    blender_space(5, 3, True, False, True),
]
ABOUT = np.array([0.25, -0.5, 0.125])


@pytest.mark.parametrize("space", SPACES)
def test_blossoms_match_bernstein_coefficients(space):
    n = space.order - 1
    for found, j in zip(space.bezier_extraction, space.spans):
        low, high = Fraction(space.knots[j]), Fraction(space.knots[j + 1])
        for column, row in zip(found.T, span_polynomials(space, int(j))):
            # in u, t = low + (high - low) u, and from powers to Bernstein's polynomials
            powers = [
                sum(value * comb(m, p) * low ** (m - p) for m, value in enumerate(row) if m >= p)
                * (high - low) ** p
                for p in range(n + 1)
            ]
            exact = [
                float(sum(Fraction(comb(b, p), comb(n, p)) * powers[p] for p in range(b + 1)))
                for b in range(n + 1)
            ]
            assert np.abs(column - exact).max() <= 1e-14 * space.order
        assert (found >= 0.0).all() and np.abs(found.sum(axis=1) - 1.0).max() <= 1e-14


def patch_of(spaces, weighted, seed=0):
    rng = np.random.default_rng(seed)
    shape = spaces[0].count, spaces[1].count
    return Patch(
        spaces,
        rng.uniform(-1.0, 1.0, (*shape, 3)),
        rng.uniform(0.3, 3.0, shape) if weighted else None,
    )


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize(
    "spaces", [(SPACES[3], SPACES[7]), (SPACES[8], SPACES[1]), (SPACES[9], SPACES[6])]
)
def test_cell_values_and_derivatives_match_the_patch(spaces, weighted):
    patch = patch_of(spaces, weighted)
    nodes, step = gauss_legendre(5)[0], 1e-4
    (cells,) = cells_of([patch], ABOUT)
    (s, *first, ss, st, tt), _ = cells.evaluate(((5,), (5,)), 2)
    count = 0
    for a, b in spaces[0].intervals:
        for c, d in spaces[1].intervals:
            u, v = a + (b - a) * nodes, c + (d - c) * nodes
            grid = [
                patch.evaluate_grid(u + (b - a) * i * step, v + (d - c) * j * step) - ABOUT
                for i, j in (
                    (0, 0),
                    (1, 0),
                    (-1, 0),
                    (0, 1),
                    (0, -1),
                    (1, 1),
                    (-1, -1),
                    (1, -1),
                    (-1, 1),
                )
            ]
            assert np.abs(s[:, :, count].transpose(1, 2, 0) - grid[0]).max() <= 1e-14
            differences = [(grid[1] - grid[2]) / 2, (grid[3] - grid[4]) / 2]
            for own, value in zip(first, differences):
                assert np.abs(own[:, :, count].transpose(1, 2, 0) - value / step).max() <= 1e-5
            second = [
                grid[1] - 2 * grid[0] + grid[2],
                (grid[5] + grid[6] - grid[7] - grid[8]) / 4,
                grid[3] - 2 * grid[0] + grid[4],
            ]
            for own, value in zip((ss, st, tt), second):
                assert np.abs(own[:, :, count].transpose(1, 2, 0) - value / step**2).max() <= 1e-4
            count += 1
    assert count == len(cells)


def test_combined_rules_match_single_rules():
    (cells,) = cells_of([patch_of((SPACES[3], SPACES[2]), True)], ABOUT)
    both = flux_sums(cells, ((5, 9), (7,)), 3)
    for found, points in zip(both, (5, 9)):
        assert np.abs(found - flux_sums(cells, ((points,), (7,)), 3)[0]).max() <= 1e-14
    both = flux_sums(cells, ((7,), (5, 9)), 3)
    assert np.abs(both[1] - flux_sums(cells, ((7,), (9,)), 3)[0]).max() <= 1e-14
