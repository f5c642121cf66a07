# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave vectors of lists and grids, and their products with points, against plain sums."""

import numpy as np
import pytest
from body_moments.core.fourier.nufft import _grid_side
from body_moments.core.fourier.polygon import expand_half, half_of_grid
from body_moments.core.fourier.wave_vectors import FrequencyGrid, GridWaves, ListWaves

from tests.close import close

RNG = np.random.default_rng(5)
LIST = RNG.normal(size=(23, 3)) * np.logspace(-2, 2, 23)[:, None]


@pytest.mark.parametrize("waves", [ListWaves(LIST), GridWaves(FrequencyGrid(5, 3.0), 0.5)], ids=["list", "grid"])
@pytest.mark.parametrize(
    "part, rows", [((0, 23), (0, 23)), ((6, 19), (6, 19)), ((7, 22), (9, 13)), ((13, 14), (13, 14))]
)
def test_products_and_phases_of_some_rows_of_a_part_are_those_of_their_vectors(waves, part, rows):
    points, rows = RNG.normal(size=(3, 7)), slice(*rows)
    q = waves.vectors(rows)
    truth = q.T @ points
    first, second, spare = (np.full(truth.shape, np.nan) for _ in range(3))
    waves.dot(slice(*part), points)(rows, first, spare)
    assert np.abs(first - truth).max() <= 1e-14 * np.abs(truth).max()
    waves.phase_factors(slice(*part), points)(rows, first, second, spare)
    assert np.abs(first - 1j * second - np.exp(-1j * truth)).max() <= 1e-13


def test_a_list_is_sorted_by_size_and_knows_where_each_was():
    waves = ListWaves(LIST[::-1])
    assert (np.diff(np.linalg.norm(waves.q, axis=0)) >= 0.0).all() and waves.rows == 23
    assert np.array_equal(waves.vectors(slice(0, 23)).T, LIST[::-1][waves.order])


@pytest.mark.parametrize("count", [2, 5, 6])
def test_a_grid_is_that_of_the_fast_transform_and_follows_from_its_half(count):
    grid = FrequencyGrid(count, 3.0)
    axis = np.fft.fftshift(np.fft.fftfreq(count)) * count * 3.0 / (count // 2)
    assert close(grid.axis(), axis, rel=1e-15) and grid.step == 3.0 / grid.half
    truth = np.array([(x, y, z) for x in axis for y in axis for z in axis])
    assert close(grid.vectors(), truth, rel=1e-15)

    def waves(q):
        """A transform of something real."""
        return np.exp(-1j * (q @ [0.3, 0.5, 0.7][: q.shape[-1]])) + 2.0

    half = GridWaves(grid, 1.0)
    assert np.abs(grid.expand(waves(half.vectors(slice(0, half.rows)).T)) - waves(truth)).max() <= 1e-14
    flat = FrequencyGrid(count, 3.0, 2)
    assert np.abs(expand_half(flat, waves(half_of_grid(flat))) - waves(flat.vectors())).max() <= 1e-14
    assert close(flat.vectors(), truth[::count, :2], rel=1e-15)


@pytest.mark.parametrize("half", [1, 2, 7, 30, 64, 500])
@pytest.mark.parametrize("width", [4, 5, 13])
def test_the_side_of_the_fine_grid_is_the_next_even_number_of_small_factors(half, width):
    smooth = {2**a * 3**b * 5**c * 7**d for a in range(1, 13) for b in range(8) for c in range(6) for d in range(5)}
    assert _grid_side(half, width) == min(n for n in smooth if n >= 2 * (2 * half + 1) + width)
