# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small things that are done with arrays."""

import numpy as np
from body_moments.core.numerics.arrays import (
    GOLDEN_RATIO_64,
    hash_uint64,
    unique_pairs,
)


def test_hashes_match_splitmix64():
    states = np.uint64(1234567) + np.arange(5, dtype=np.uint64) * GOLDEN_RATIO_64
    published = (
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    )
    assert hash_uint64(states).tolist() == list(published)


def test_pairs_are_each_once_and_sorted():
    pairs = np.random.default_rng(0).integers(0, 9, (200, 2)).astype(np.int32)
    assert np.array_equal(unique_pairs(pairs), np.unique(pairs, axis=0))
    assert unique_pairs(pairs[:0]).shape == (0, 2)
    far = np.array([[2**31 - 1, 0], [0, 2**31 - 1], [2**31 - 1, 0]])
    assert unique_pairs(far).tolist() == [[0, 2**31 - 1], [2**31 - 1, 0]]
