# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors in rows, ranges of segments, pairs in bounded pieces, hashes of rows, first occurrences,
Morton order.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeAlias, cast

import numpy as np

from .array_types import Array, Index, Int64, Integers, NDArray

# A number, text or the like for one body; for a stack of bodies, an array with one entry for each.
PerBody: TypeAlias = Any


NEXT_AXIS = np.array([1, 2, 0])
PREVIOUS_AXIS = np.array([2, 0, 1])
IDENTITY_3 = np.eye(3)


def cross_rows(u: NDArray, v: NDArray) -> NDArray:
    """Return the cross products of vectors (..., 3), equal to those of `np.cross`, whose overhead
    is ten times this.
    """
    after = u.take(NEXT_AXIS, -1) * v.take(PREVIOUS_AXIS, -1)
    before = u.take(PREVIOUS_AXIS, -1) * v.take(NEXT_AXIS, -1)
    return after - before


def lengths(vectors: NDArray) -> NDArray:
    """Return the lengths (..., 1) of vectors (..., 3)."""
    return np.sqrt(np.add.reduce(vectors * vectors, axis=-1, keepdims=True))


def as_rows(vectors: list[NDArray]) -> NDArray:
    """Return the vectors (..., k) as rows (..., m, k): `np.stack` along the axis before the last,
    in less time.
    """
    return np.concatenate([vector[..., None, :] for vector in vectors], axis=-2)


def indices_in_range(indices: Integers, count: int) -> bool:
    """Return whether all indices are from 0 to count - 1."""
    return not indices.size or bool(as_unsigned(indices).max() < count)


def as_unsigned(indices: Integers) -> NDArray[np.unsignedinteger]:
    """Return an unsigned view, in which a negative index is a large number."""
    return indices.view(indices.dtype.str.replace("i", "u"))


def spread_bits(value: Int64) -> Int64:
    """Return 10-bit numbers with two zero bits inserted after each bit: a third of a Morton
    code.
    """
    value = (value | value << 16) & 0x030000FF
    value = (value | value << 8) & 0x0300F00F
    value = (value | value << 4) & 0x030C30C3
    return (value | value << 2) & 0x09249249


def segment_ranges(counts: NDArray) -> Index:
    """Return 0, 1, … counts[0] - 1, 0, 1, … counts[1] - 1, and so on."""
    return np.arange(int(np.add.reduce(counts))) - np.repeat(segment_starts(counts), counts)


def segment_starts(counts: NDArray) -> Index:
    """Return 0, counts[0], counts[0] + counts[1], …: the start of each segment of these lengths."""
    return counts.cumsum() - counts


def run_starts(values: Integers) -> Index:
    """Return the (k,) index of the first of each run of equal values, one after the other."""
    return np.flatnonzero(np.diff(values, prepend=values[:1] - 1))


def sums_by_index(indices: Integers, weights: NDArray, count: int = 0) -> Array:
    """Return (count or more,) sums of the weights of each index: `bincount`, typed."""
    return cast("Array", np.bincount(indices, weights, count))


def power_table(values: Array, order: int) -> list[Array]:
    """Return order + 1 arrays: the powers of `values` from 0 to `order`."""
    powers = [np.ones_like(values)]
    for _ in range(order):
        powers.append(powers[-1] * values)
    return powers


def batches(weights: NDArray, size: float) -> Iterator[slice]:
    """Yield slices of consecutive items with weights that add up to about `size`, at least one item
    each.
    """
    total = np.cumsum(weights)
    start = 0
    while start < len(total):
        done = total[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(total, done + size)))
        yield slice(start, stop)
        start = stop


def following_pairs(order: Index, counts: Index, size: int) -> Iterator[tuple[Index, Index]]:
    """Yield pairs of each item of `order`, (n,), with the next `counts`, (n,), items, about `size`
    at a time.
    """
    for part in batches(counts, size):
        row = np.repeat(np.arange(part.start, part.stop), counts[part])
        if len(row):
            yield order[row], order[row + 1 + segment_ranges(counts[part])]


def first_occurrence(*columns: NDArray, slots: Integers | None = None) -> Index:
    """Return (n,) indices of the first row with the bits of each row. slots: (n,) hash slots of the
    first round, the same for equal rows.

    In each round, a table of slots keeps the first of the rows in each slot. Rows that equal it are
    done; the others collided, and go on with another hash.
    """
    bits = [column.view(np.uint64) for column in columns]
    salt = 0
    first = rest = np.arange(len(columns[0]), dtype=np.min_scalar_type(-len(columns[0])))
    while len(rest):
        size = 1 << (2 * len(rest)).bit_length() if slots is None else int(slots.max()) + 1
        if slots is None:
            key = np.zeros(len(rest), np.uint64) + np.uint64(salt)
            for column in bits:
                key = hash_uint64(key + column)
            slots = (key & np.uint64(size - 1)).view(np.intp)
        table = np.empty(size, rest.dtype)
        # numpy keeps the last of equal slots: rows are written backward, so that the first one
        # stays.
        table[slots[::-1]] = np.arange(len(rest) - 1, -1, -1, dtype=rest.dtype)
        kept = table.take(slots).astype(np.intp)
        differs = np.zeros(len(rest), bool)
        for column in bits:
            differs |= column != column.take(kept)
        if len(rest) == len(first):  # the first round, in which `kept` are rows themselves
            first = kept
        else:
            first[rest] = rest[kept]
        collided = np.flatnonzero(differs)
        rest = rest[collided]
        bits = [column[collided] for column in bits]
        slots = None
        salt = salt + 1
    return first.astype(np.intp, copy=False)


# 2^64 divided by the golden ratio, as in SplitMix64
GOLDEN_RATIO_64 = np.uint64(0x9E3779B97F4A7C15)


def hash_uint64(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return a 64-bit hash of 64-bit values: the finalizer of SplitMix64."""
    z = values + GOLDEN_RATIO_64
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


def sorted_distinct(values: Integers) -> Integers:
    """Return (k,) ascending integers, each once: as `np.unique`, whose hash table is slower."""
    values = np.sort(values)
    return values[run_starts(values)]


def unique_pairs(pairs: Integers) -> Index:
    """Return (k, 2) rows of two numbers from 0 to 2³¹, sorted, each once: as `np.unique` along an
    axis, but faster.
    """
    width = int(pairs.max(initial=0)) + 1
    key = sorted_distinct(pairs[:, 0].astype(np.int64) * width + pairs[:, 1])
    return np.stack(np.divmod(key, width), axis=1).astype(np.intp, copy=False)


def distinct_arrays(arrays: NDArray, within: float) -> Array:
    """Return the (n, ...) vectors or matrices that differ from all earlier ones by at least
    `within` in some entry.
    """
    differences = np.abs(arrays[:, None] - arrays)
    is_same = differences.max(axis=tuple(range(2, differences.ndim))) < within
    first_same = is_same.argmax(axis=1)
    return arrays[first_same == np.arange(len(arrays))]


def inertia_of_second(second: NDArray) -> Array:
    """Return the (..., 3, 3) inertia tensors of second moments ∫x x' dm about the same point."""
    return second.trace(axis1=-2, axis2=-1)[..., None, None] * IDENTITY_3 - second


def second_of_inertia(inertia: NDArray) -> Array:
    """Return the (..., 3, 3) second moments ∫x x' dm of inertia tensors about the same point."""
    return inertia.trace(axis1=-2, axis2=-1)[..., None, None] / 2.0 * IDENTITY_3 - inertia
