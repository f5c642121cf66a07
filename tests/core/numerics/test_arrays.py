# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small things that are done with arrays."""

import numpy as np
import pytest
from body_moments.core.numerics import arrays
from body_moments.core.numerics.arrays import (
    GOLDEN_RATIO_64,
    first_occurrence,
    hash_uint64,
    power_table,
    segment_ranges,
    segment_starts,
    spread_bits,
    sums_by_index,
    unique_pairs,
)


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


def test_hashes_are_what_splitmix64_gives_after_the_seed_1234567():
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


def test_powers_begin_with_one():
    values = np.array([0.5, -2.0, 0.0])
    found = power_table(values, 3)
    assert [row.tolist() for row in found] == [[1.0] * 3, [0.5, -2.0, 0.0], [0.25, 4.0, 0.0], [0.125, -8.0, 0.0]]


@pytest.mark.parametrize("columns", [1, 2, 3])
def test_of_different_rows_fewer_than_half_lose_their_slot_in_each_round(monkeypatch, columns):
    """Rows that agree in all columns but one, whichever it is: else each round might find a single one."""
    hashed = []
    monkeypatch.setattr(arrays, "hash_uint64", lambda values: hashed.append(len(values)) or hash_uint64(values))
    for own in range(columns):
        rows = np.full((columns, 1000), 7, np.uint64)
        rows[own] = np.arange(1000) + 2**40
        hashed.clear()
        assert first_occurrence(*rows).tolist() == list(range(1000))
        rounds = hashed[columns:]
        assert all(2 * later < earlier for earlier, later in zip([1000, *rounds], rounds)) and len(rounds) < 12
