# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cut and fill of open surfaces against closed forms and rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.cuts import cut_fill, cut_fill_between, fit_rim
from body_moments.core.verdict import MeasureError

from tests.core.bodies import box


def terrain(n, heights, size=1.0, diagonal=0, shift=0.0):
    """A grid of (n + 1)² points with random or given heights."""
    axis = np.linspace(0.0, size, n + 1) + shift
    x, y = np.meshgrid(axis, axis, indexing="ij")
    z = heights(x, y) if callable(heights) else heights.standard_normal(x.shape)
    i = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
    halves = [(a, b, c), (a, c, d)] if diagonal == 0 else [(a, b, d), (b, c, d)]
    triangles = np.concatenate([np.stack(half, axis=-1).reshape(-1, 3) for half in halves])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles


def exact_sides(points, triangles, level):
    """Return the exact volumes of a height field above and below a level."""
    volumes = [Fraction(0), Fraction(0)]
    for triangle in triangles.tolist():
        rows = [[Fraction(float(value)) for value in points[i]] for i in triangle]
        (ax, ay, a), (bx, by, b), (cx, cy, c) = rows
        area = abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
        heights = [z - Fraction(level) for z in (a, b, c)]
        for side, sign in enumerate((1, -1)):
            positive = [sign * z for z in heights if sign * z > 0]
            others = [-sign * z for z in heights if sign * z <= 0]
            if len(positive) == 3:
                volumes[side] += area * sum(positive) / 3
            elif len(positive) == 1:
                (top,) = positive
                volumes[side] += area * top**3 / (top + others[0]) / (top + others[1]) / 3
            elif len(positive) == 2:
                (low,) = others
                missing = low**3 / (low + positive[0]) / (low + positive[1]) if low else 0
                volumes[side] += area * (sum(positive) - low + missing) / 3
    return volumes


@pytest.mark.parametrize("seed", range(20))
def test_terrain_against_a_level_equals_rational_arithmetic(seed):
    rng = np.random.default_rng(seed)
    points, triangles = terrain(6, rng)
    points = points * rng.choice([1e-3, 1.0, 1e3], 3)
    level = [0.0, points[7, 2], 9.0, -9.0][seed % 4] * 1.0
    flipped = np.where(rng.random(len(triangles))[:, None] < 0.3, triangles[:, ::-1], triangles)
    found = cut_fill(points + [1e4, 0, 0], flipped, (0, 0, 2), 2 * level)
    cut, fill = exact_sides(points + [1e4, 0, 0], triangles, level)
    for moments, truth in ((found.cut, cut), (found.fill, fill)):
        assert abs(moments.total - truth) <= 1e-12 * float(cut + fill)
    assert abs(found.net - float(cut - fill)) <= 1e-12 * float(cut + fill)


@pytest.mark.parametrize("diagonal", [0, 1])
def test_two_terrains_on_one_grid_are_their_difference(diagonal):
    rng = np.random.default_rng(5)
    before, triangles = terrain(8, rng)
    after, others = terrain(8, rng, diagonal=diagonal)
    found = cut_fill_between(after, others, before, triangles)
    if diagonal == 0:
        difference = before.copy()
        difference[:, 2] = after[:, 2] - before[:, 2]
        truth = cut_fill(difference, triangles)
        assert abs(found.cut.total - truth.cut.total) < 1e-13
        assert abs(found.cut_area - truth.cut_area) < 1e-13
        np.testing.assert_allclose(found.fill.center[:2], truth.fill.center[:2], atol=1e-12)
    levels = [cut_fill(points, faces) for points, faces in ((after, others), (before, triangles))]
    assert abs(found.net - levels[0].net + levels[1].net) < 1e-13
    assert abs(found.cut_area + found.fill_area - 1.0) < 1e-13
    assert found.compared == pytest.approx(1.0)


@pytest.mark.parametrize("place", [0.0, 1e5])
def test_slopes_on_different_grids_are_their_closed_form(place):
    # The surfaces z = x and z = 0.3 over [0, 1]², the first on a coarse and turned grid.
    slope, triangles = terrain(3, lambda x, y: x - place)
    slope[:, :2] += place
    slope[:, 2] += place
    level, others = terrain(7, lambda x, y: 0.3 + 0 * x, size=2.0, shift=-0.25)
    level[:, :2] += place
    found = cut_fill_between(slope, triangles, level, others)
    accuracy = 1e-13 + 1e-15 * place
    assert abs(found.cut.total - 0.7**2 / 2) < accuracy
    assert abs(found.fill.total - 0.3**2 / 2) < accuracy
    assert np.abs(
        found.cut.center - [place + 0.3 + 0.7 * 2 / 3, place + 0.5, 0.3 + 0.7 / 3]
    ).max() < (1e-11 + 1e-13 * place)


def test_partial_overlap_states_its_share():
    own, triangles = terrain(4, lambda x, y: 1 + 0 * x)
    other, others = terrain(5, lambda x, y: 0 * x, shift=0.5)
    found = cut_fill_between(own, triangles, other, others)
    assert found.compared == pytest.approx(0.25)
    assert found.cut.total == pytest.approx(0.25)


def test_pit_below_its_rim_wherever_it_is():
    points, triangles = terrain(10, lambda x, y: -x * (1 - x) * y * (1 - y))
    rng = np.random.default_rng(2)
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    truth = cut_fill(points, triangles).fill.total
    moved = points @ turn.T + 7.0
    normal, offset = fit_rim(moved, triangles, turn[:, 2])
    found = cut_fill(moved, triangles, normal, offset)
    np.testing.assert_allclose(normal, turn[:, 2], atol=1e-12)
    assert abs(found.fill.total - truth) < 1e-13
    assert found.cut.total < 1e-13


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: cut_fill(*box()), "closed"),
        (lambda: fit_rim(*box()), "no rim"),
        (lambda: cut_fill(np.zeros((3, 3)), np.zeros((0, 3), int)), "no faces"),
        (lambda: fit_rim(np.eye(3)[[0, 1, 0]], [[0, 1, 2]]), "rim"),
        (
            lambda: cut_fill_between(
                *terrain(2, lambda x, y: x), *terrain(2, lambda x, y: x, shift=9.0)
            ),
            "nowhere",
        ),
        (
            lambda: cut_fill_between(
                np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, -0.2, 1.0], [0.4, 0.4, 2]]),
                [[0, 1, 2], [1, 0, 3], [3, 0, 4]],
                *terrain(2, lambda x, y: x),
            ),
            "overhang",
        ),
    ],
)
def test_surface_without_cut_and_fill_is_refused(call, message):
    with pytest.raises(MeasureError, match=message):
        call()
