# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fourier transforms of polygons against 120 digits and closed forms."""

import numpy as np
import pytest
from body_moments.core.fourier.polygon import polygon_transform

from tests.core.findings import refused

OUTLINE = np.array([[0, 0], [3, 0], [3.5, 1], [1, 1], [1, 2.5], [0, 2]])
HOLE = np.array([[0.2, 0.3], [0.4, 0.9], [0.7, 0.4]])
SIZES = (1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.5, 1.5, 3.0, 5.0, 20.0, 100.0, 1000.0)


def directions():
    """Wave vectors at random, along an edge, across it and near these."""
    special = np.array([[0.6, 0.8], [1, 0], [0, 1], [0.5, 1], [1, -0.5]])
    return np.concatenate([special, special + 1e-9, special - 1e-5])


@pytest.mark.parametrize("offset", [(0, 0), (-40, 25)])
def test_polygon_with_a_hole_is_right_to_1e_14_of_its_area(offset):
    pytest.importorskip("mpmath")
    from tests.core import fourier_truth

    loops = [OUTLINE + offset, HOLE + offset]
    q = np.concatenate([directions() * size / 3.5 for size in SIZES])
    found = polygon_transform(loops, q)
    error = np.abs(found.values - [fourier_truth.polygon(loops, row) for row in q])
    assert error.max() <= 1e-14 * 4.5
    assert (error <= found.error).all() and found.error.max() <= 1e-12


def test_a_rectangle_has_its_closed_form_at_zero_and_everywhere():
    low, high = np.array([0.5, -1.0]), np.array([2.0, 3.0])
    q = np.concatenate(
        [
            [[0, 0], [1e-30, 1e-31], [1e-300, 0]],
            np.random.default_rng(0).normal(size=(60, 2)) * np.logspace(-15, 3, 60)[:, None],
        ]
    )
    sides = (high - low) * np.sinc(q * (high - low) / (2 * np.pi))
    true = np.prod(sides * np.exp(-0.5j * q * (low + high)), axis=1)
    loop = [low, (high[0], low[1]), high, (low[0], high[1])]
    assert np.abs(polygon_transform([loop], q).values - true).max() <= 1e-14
    assert np.abs(polygon_transform([loop[::-1]], q).values + true).max() <= 1e-14


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_imaginary_part_near_zero_matches_first_moments(scale):
    """Two rectangles side by side, 3 by 1 and 1 by 2: an L with a center beside that of its box."""
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [3.0, 2.0], [3.0, 1.0], [0.0, 1.0]]) - (
        5.0,
        2.0,
    )
    q = np.array([[1e-25, 0.0], [0.0, -1e-25], [2e-26, 3e-26]]) / scale
    found = polygon_transform([corners * scale], q).values / scale**2
    first = (
        np.array([3.0 * (1.5 - 5.0) + 2.0 * (3.5 - 5.0), 3.0 * (0.5 - 2.0) + 2.0 * (1.0 - 2.0)])
        * scale
    )
    assert (
        np.abs(found.real - 5.0).max() <= 1e-14
        and np.abs(found.imag / -(q @ first) - 1.0).max() <= 1e-13
    )


def test_corners_in_line_and_repeated_ones_change_nothing():
    q = np.random.default_rng(0).normal(size=(60, 2)) * np.logspace(-15, 3, 60)[:, None]
    more = np.insert(OUTLINE, 1, [[1, 0], [1, 0], [2, 0]], axis=0)
    assert (
        np.abs(polygon_transform([more], q).values - polygon_transform([OUTLINE], q).values).max()
        <= 1e-14
    )


def test_opposite_frequencies_are_conjugate_and_lists_split():
    q = np.random.default_rng(0).normal(size=(20000, 2)) * 30
    values = polygon_transform([OUTLINE, HOLE], q).values
    assert np.abs(values - polygon_transform([OUTLINE, HOLE], -q).values.conj()).max() <= 1e-14
    assert abs(values[777] - polygon_transform([OUTLINE, HOLE], q[777:778]).values[0]) <= 1e-14


@pytest.mark.parametrize(
    "loops",
    [
        [],
        [[0, 0, 1, 0, 0, 1]],
        [np.zeros((3, 2, 2))],
        [[[0, 0], [1, 0]]],
        [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]],
        [[[0, 0], [1, 0], [0, np.nan]]],
    ],
)
def test_invalid_loops_are_refused(loops):
    with pytest.raises(ValueError, match="loops|finite"):
        polygon_transform(loops, [[1.0, 2.0]])


def test_wave_vectors_of_three_numbers_are_refused():
    with refused("wave_vectors_shape", dimension=2):
        polygon_transform([OUTLINE], [[1.0, 2.0, 3.0]])


def test_grid_matches_its_wave_vectors_and_bounds_hold():
    from body_moments.core.fourier.polygon import RegionTransform
    from body_moments.core.fourier.wave_vectors import FrequencyGrid

    points = np.concatenate([OUTLINE, HOLE])
    edges = np.array([(i, (i + 1) % 6) for i in range(6)] + [(6, 7), (7, 8), (8, 6)])

    def transformed(points, q, **steps):
        transform = RegionTransform(points, edges, q, **steps)
        assert list(transform.steps())[-1] == 1.0
        return transform.result()

    for count in (2, 7, 8):
        grid = FrequencyGrid(count, 5.0, 2)
        found = transformed(points, grid)
        assert found.q.shape == (count**2, 2) and np.array_equal(found.q, grid.vectors())
        assert (
            np.abs(found.values - polygon_transform([OUTLINE, HOLE], grid.vectors()).values).max()
            <= 1e-14
        )
    step, worst = 1e-6, 0.0
    known = transformed(points, grid, rounded=step, stored=step)
    for seed in range(20):
        moved = points + step * np.sign(np.random.default_rng(seed).normal(size=points.shape))
        off = np.abs(transformed(moved, grid).values - known.values)
        assert (off <= known.error).all() and off.max() <= known.input_error
        worst = max(worst, off.max() / known.input_error)
    assert worst > 0.05
