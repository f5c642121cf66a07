# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bézier patches cut from B-spline ones, against exact polynomials and against the patches themselves."""

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.numerics.quadrature import gauss_legendre
from body_moments.core.nurbs import bezier
from body_moments.core.nurbs.bezier import cells_of
from body_moments.core.nurbs.blender_knots import blender_space
from body_moments.core.nurbs.patch import Patch
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
def test_blossoms_are_the_bernstein_coefficients_of_the_exact_polynomials(space):
    n = space.order - 1
    for found, j in zip(space.bezier_extraction, space.spans):
        low, high = Fraction(space.knots[j]), Fraction(space.knots[j + 1])
        for column, row in zip(found.T, span_polynomials(space, int(j))):
            # in u, t = low + (high - low) u, and from powers to Bernstein's polynomials
            powers = [
                sum(value * comb(m, p) * low ** (m - p) for m, value in enumerate(row) if m >= p) * (high - low) ** p
                for p in range(n + 1)
            ]
            exact = [
                float(sum(Fraction(comb(b, p), comb(n, p)) * powers[p] for p in range(b + 1))) for b in range(n + 1)
            ]
            assert np.abs(column - exact).max() <= 1e-15 * space.order
        assert (found >= 0.0).all() and np.abs(found.sum(axis=1) - 1.0).max() <= 1e-15


def patch_of(spaces, weighted, seed=0):
    rng = np.random.default_rng(seed)
    shape = spaces[0].count, spaces[1].count
    return Patch(spaces, rng.uniform(-1.0, 1.0, (*shape, 3)), rng.uniform(0.3, 3.0, shape) if weighted else None)


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("few", [0, 1000])  # about their own first points, and about the common one
@pytest.mark.parametrize("spaces", [(SPACES[3], SPACES[7]), (SPACES[8], SPACES[1]), (SPACES[9], SPACES[6])])
def test_values_and_derivatives_are_those_of_the_patch(spaces, few, weighted, monkeypatch):
    monkeypatch.setattr(bezier, "SMALL_CELL_COUNT", few)
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
                for i, j in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1))
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


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("few", [0, 1000])
def test_quarters_of_cells_are_the_same_surface(few, weighted, monkeypatch):
    monkeypatch.setattr(bezier, "SMALL_CELL_COUNT", few)
    (cells,) = cells_of([patch_of((SPACES[3], SPACES[2]), weighted)], ABOUT)
    whole, parts = (flux_sums(own, ((24,), (24,)), 2)[0].sum(axis=1)[:-1] for own in (cells, cells.split().split()))
    assert len(cells.split()) == 4 * len(cells)
    assert np.abs(whole - parts).max() <= 1e-13 * np.abs(whole).max()


def test_rules_side_by_side_give_what_each_gives_alone():
    (cells,) = cells_of([patch_of((SPACES[3], SPACES[2]), True)], ABOUT)
    both = flux_sums(cells, ((5, 9), (7,)), 3)
    for found, points in zip(both, (5, 9)):
        assert np.abs(found - flux_sums(cells, ((points,), (7,)), 3)[0]).max() <= 1e-14
    both = flux_sums(cells, ((7,), (5, 9)), 3)
    assert np.abs(both[1] - flux_sums(cells, ((7,), (9,)), 3)[0]).max() <= 1e-14


def test_patches_of_the_same_orders_are_evaluated_together_and_some_at_a_time(monkeypatch):
    spaces = [(SPACES[3], SPACES[2]), (clamped_space(4), clamped_space(3, (0.1, 0.7))), (SPACES[3], SPACES[2])]
    patches = [patch_of(own, False, seed) for seed, own in enumerate(spaces)]
    alone = [flux_sums(next(cells_of([patch], ABOUT)), ((6,), (5,)), 2)[0].sum(axis=1) for patch in patches]
    assert len(list(cells_of(patches, ABOUT))) == 1
    monkeypatch.setattr(bezier, "MAX_CELLS", 5)
    parts = list(cells_of(patches, ABOUT))
    assert len(parts) > 2 and max(map(len, parts)) < 15
    together = sum(flux_sums(part, ((6,), (5,)), 2)[0].sum(axis=1) for part in parts)
    assert np.abs(together - sum(alone)).max() <= 1e-14
