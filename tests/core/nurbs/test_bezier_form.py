# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches with Blender's knots in the place of others, against knots inserted one by one in
rational arithmetic.
"""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs import Patch, bezier_patches, blender_space

WHOLE = (None, None)
SPACES = [
    clamped_space(2, (0.25, 0.5)),
    *(clamped_space(order, (0.25, 0.5, 0.5)) for order in range(3, 7)),
    SplineSpace((0.0, 0.5, 1.0, 1.5, 3.0, 3.25, 4.0), 3, 4),  # not clamped
    SplineSpace((-3.0, -1.0, 0.0, 0.25, 2.0, 7.0, 7.5, 9.0, 9.0, 11.0), 5, 5),
    blender_space(6, 4, True, False, False),  # periodic
    blender_space(5, 3, True, False, True),
]


def insert_knot(knots, points, order, t):
    """Boehm's algorithm: one knot more; all numbers are Fractions."""
    k = max(i for i, knot in enumerate(knots) if knot <= t)
    degree, found = order - 1, []
    for i in range(len(points) + 1):
        if i <= k - degree:
            share = Fraction(1)
        elif i > k:
            share = Fraction(0)
        else:
            width = knots[i + degree] - knots[i]
            share = (t - knots[i]) / width if width else Fraction(0)
        before = points[i - 1] if i > 0 else points[0]
        here = points[i] if i < len(points) else points[-1]
        found.append([share * a + (1 - share) * b for a, b in zip(here, before)])
    return knots[: k + 1] + [t] + knots[k + 1 :], found


def exact_bezier_points(space, points, low, high):
    """Control points of the part [low, high] with every knot in it repeated as often as the degree
    says.
    """
    order = space.order
    knots = [Fraction(knot) for knot in space.knots]
    rows = [
        [Fraction(value) for value in points[i % space.count]] for i in range(space.function_count)
    ]
    low, high = Fraction(low), Fraction(high)
    for t in sorted({low, high, *(knot for knot in knots if low < knot < high)}):
        while knots.count(t) < order - 1:
            knots, rows = insert_knot(knots, rows, order, t)
    first = max(i for i, knot in enumerate(knots) if knot == low) - order + 1
    spans = len({knot for knot in knots if low <= knot < high})
    return rows[first : first + (order - 1) * spans + 1]


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("part", [None, (0.25, 0.75), (0.1, 0.6)])
def test_control_points_match_rational_knot_insertion(space, part):
    if part is not None:
        low, high = space.domain
        part = (low + (high - low) * part[0], low + (high - low) * part[1])
    line = clamped_space(2)
    rng = np.random.default_rng(3)
    points = rng.uniform(-1.0, 1.0, (space.count, 2, 3))
    (found,) = bezier_patches(Patch((space, line), points), (part, None))
    low, high = part or space.domain
    for side in (0, 1):
        exact = exact_bezier_points(space, points[:, side].tolist(), low, high)
        assert len(exact) == len(found.points)
        exact = np.array([[float(value) for value in row] for row in exact])
        assert np.abs(found.points[:, side] - exact).max() <= 4e-16 * space.order


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("s", SPACES[:6])
@pytest.mark.parametrize("t", [SPACES[1], SPACES[6], SPACES[7]])
def test_points_of_the_surface_stay(s, t, weighted):
    rng = np.random.default_rng(4)
    shape = (s.count, t.count)
    patch = Patch(
        (s, t), rng.uniform(-1, 1, (*shape, 3)), rng.uniform(0.2, 5.0, shape) if weighted else None
    )
    (found,) = bezier_patches(patch, WHOLE)
    assert all((np.diff(np.unique(space.knots)) == 1.0).all() for space in found.spaces)
    old, new = (
        [space.uniform_parameters(7) for space in spaces] for spaces in (patch.spaces, found.spaces)
    )
    assert np.abs(patch.evaluate_grid(*old) - found.evaluate_grid(*new)).max() <= 1e-14


def test_part_has_its_own_ends_or_snaps_to_a_knot():
    s, t = clamped_space(4, (0.5,)), clamped_space(3)
    patch = Patch((s, t), np.random.default_rng(5).uniform(-1, 1, (5, 3, 3)))
    (found,) = bezier_patches(patch, ((0.25, 0.5 + 1e-15), (0.1, 0.9)))
    assert found.points.shape == (4, 3, 3)
    u, v = np.linspace(0.0, 1.0, 5), np.linspace(0.0, 1.0, 4)
    truth = patch.evaluate_grid(0.25 + 0.25 * u, 0.1 + 0.8 * v)
    assert np.abs(found.evaluate_grid(u, v) - truth).max() <= 1e-14
    for wrong in (
        (0.5, 0.5),
        (0.75, 0.25),
        (-0.5, 1.0),
        (0.0, 1.5),
        (2.0, 3.0),
        (float("nan"), 1.0),
    ):
        with pytest.raises(ValueError):
            bezier_patches(patch, (wrong, None))


def test_a_jump_makes_two_patches():
    s, t = SplineSpace((0.0, 0.0, 1.0, 1.0, 2.0, 2.0), 2, 4), clamped_space(2)
    points = np.array([[[x, y, 0.0] for y in (0.0, 1.0)] for x in (0.0, 1.0, 5.0, 6.0)])
    first, second = bezier_patches(Patch((s, t), points), WHOLE)
    assert np.array_equal(first.points, points[:2]) and np.array_equal(second.points, points[2:])


def test_steps_have_no_bezier_form():
    steps = SplineSpace((0.0, 1.0, 2.0), 1, 2)
    with pytest.raises(ValueError, match="steps"):
        bezier_patches(Patch((steps, clamped_space(2)), np.zeros((2, 2, 3))), WHOLE)
