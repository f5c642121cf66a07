# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small things that are done with arrays."""

import numpy as np
from body_moments.core.numerics.arrays import segment_ranges, segment_starts, spread_bits, sums_by_index


def test_each_of_ten_bits_goes_three_places_further():
    values = np.arange(1 << 10)
    truth = [sum((value >> bit & 1) << 3 * bit for bit in range(10)) for value in values.tolist()]
    assert spread_bits(values).tolist() == truth


def test_segments_begin_where_the_others_end():
    counts = np.array([2, 0, 3, 1, 0])
    assert segment_starts(counts).tolist() == [0, 2, 2, 5, 6]
    assert segment_ranges(counts).tolist() == [0, 1, 0, 1, 2, 0]
    assert segment_ranges(counts[:0]).tolist() == []


def test_sums_by_index_are_as_many_as_are_asked_for():
    weights = np.array([0.5, 1.0, 0.25])
    assert sums_by_index(np.array([2, 0, 2]), weights).tolist() == [1.0, 0.0, 0.75]
    assert sums_by_index(np.array([2, 0, 2]), weights, 5).tolist() == [1.0, 0.0, 0.75, 0.0, 0.0]
