# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small things that are done with arrays."""

import numpy as np
import pytest
from body_moments.core.numerics import arrays
from body_moments.core.numerics.arrays import (
    GOLDEN_RATIO_64,
    batches,
    first_occurrence,
    following_pairs,
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


@pytest.mark.parametrize("columns", [1, 2, 3])
@pytest.mark.parametrize("kinds", [1, 3, 40, 10**6])
def test_the_first_of_equal_rows_is_found_by_their_bits(columns, kinds):
    rows = np.random.default_rng(kinds).integers(0, kinds, (columns, 500)).astype(np.int64) << 40
    seen = {}
    truth = [seen.setdefault(row, i) for i, row in enumerate(zip(*rows.tolist()))]
    assert first_occurrence(*rows).tolist() == truth
    zeros = np.array([0.0, -0.0, 0.0, np.nan, np.nan])
    assert first_occurrence(zeros).tolist() == [0, 1, 0, 3, 3]


@pytest.mark.parametrize("size", [0.5, 1.0, 3.0, 7.5, 100.0])
def test_batches_are_as_many_whole_items_as_their_size_allows_but_one_at_least(size):
    weights = np.array([1.0, 2.0, 0.0, 4.0, 9.0, 0.5, 0.5, 0.5, 3.0])
    found, start = list(batches(weights, size)), 0
    for part in found:
        assert part.start == start < part.stop and part.step is None
        start, own = part.stop, weights[part]
        assert len(own) == 1 or own.sum() < size + own[-1]
        if part.stop < len(weights):
            assert own.sum() + weights[part.stop] >= size
    assert start == len(weights) and not list(batches(weights[:0], size))


@pytest.mark.parametrize("size", [1, 4, 100])
def test_following_pairs_are_each_item_with_as_many_next_ones(size):
    order, counts = np.array([7, 3, 9, 1, 4, 0]), np.array([2, 0, 3, 1, 1, 0])
    pairs = [pair for a, b in following_pairs(order, counts, size) for pair in zip(a.tolist(), b.tolist())]
    assert pairs == [(7, 3), (7, 9), (9, 1), (9, 4), (9, 0), (1, 4), (4, 0)]
    assert not list(following_pairs(order, np.zeros(6, int), size))
