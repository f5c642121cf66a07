# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlapping boxes, compared with a search over all pairs."""

import numpy as np
import pytest
from body_moments.core.mesh import bvh
from hypothesis import given

from tests.core.strategies import holds, seeds


@holds(60)
@given(seed=seeds)
def test_box_overlaps_match_a_comparison_of_all_pairs(seed):
    rng = np.random.default_rng(seed)
    count = rng.integers(1, 25)
    centers, extents = rng.uniform(0.0, 10.0, (count, 3)), rng.uniform(0.0, 1.2, (count, 3))
    centers[::2] = np.round(centers[::2])
    extents[1::3] = 0.5  # neighbors that touch
    extents[::4, rng.integers(3)] = 0.0  # flat ones
    shrunk = extents * (1.0 - 1e-6)
    low, high = centers - shrunk, centers + shrunk
    truth = any(
        (low[i] < high[j]).all() and (low[j] < high[i]).all() for i in range(count) for j in range(i + 1, count)
    )
    assert bvh.boxes_overlap(centers, extents) == truth


def test_boxes_sharing_a_side_do_not_meet():
    grid = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    half = np.full((64, 3), 0.5)
    for unit in (1.0, 0.1, 0.7):  # rounded, some would overlap
        assert not bvh.boxes_overlap(unit * grid, unit * half)
        assert bvh.boxes_overlap(unit * grid, 1.001 * unit * half)
    assert bvh.boxes_overlap(np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.1]]), np.array([[1.0, 1.0, 1.0], [2.0, 2.0, 0.0]]))


@pytest.mark.parametrize("margin", [0.0, 0.25, 0.5])
@pytest.mark.parametrize("turn", range(3))
def test_pairs_overlap_by_more_than_the_margin_along_every_axis(margin, turn):
    """On a lattice of quarters many boxes overlap by exactly the margin."""
    rng = np.random.default_rng(turn)
    low = np.roll(rng.integers(0, 16, (60, 3)) * (0.25, 0.25, 0.5), turn, axis=1)
    high = low + 0.25 * rng.integers(1, 9, (60, 3))
    one, other, left_out = bvh.overlapping_box_pairs(low, high, margin, 10_000)
    common = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    truth = {(i, j) for i in range(60) for j in range(i) if common[i, j].min() > margin}
    assert sorted((max(pair), min(pair)) for pair in zip(one, other)) == sorted(truth)
    assert left_out == 0 and len(truth) > 5
