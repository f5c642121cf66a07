# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of overlapping rectangles, against the test of every pair."""

import numpy as np
import pytest
from body_moments.core.numerics import rectangle_pairs


def rectangles(kind, count, rng):
    low = rng.integers(0, 12, (count, 2)).astype(float)
    if kind == "on cell borders":
        return low, low + rng.integers(0, 4, (count, 2))
    if kind == "of all sizes":
        return low, low + rng.lognormal(-3.0, 3.0, (count, 2))
    return low * (1.0, 0.0), low * (1.0, 0.0) + rng.integers(0, 2, (count, 2))


@pytest.mark.parametrize("kind", ["on cell borders", "of all sizes", "on a line"])
@pytest.mark.parametrize("scale", [1.0, 1e-200, 1e150])
@pytest.mark.parametrize("offset", [0.0, -1e9, 1e16])
def test_each_overlapping_pair_comes_once(kind, scale, offset):
    rng = np.random.default_rng(1)
    first, second = (
        tuple(scale * (corners + offset) for corners in rectangles(kind, count, rng))
        for count in (200, 150)
    )
    low, high = (
        choose(one[:, None], other)
        for choose, one, other in zip((np.maximum, np.minimum), first, second)
    )
    pairs = [np.stack([i, j], axis=1) for i, j, _ in rectangle_pairs(first, second)]
    found = np.concatenate(pairs)
    order = np.lexsort(found.T[::-1])
    assert np.array_equal(found[order], np.argwhere((low < high).all(axis=2)))
