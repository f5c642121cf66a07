# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of sides of faces that lie against each other, if every edge has two, which run in opposite directions.

A side runs from its start to its stop. Each is written into a table, into the row of its start, at a place that a hash
of its stop gives: neighbors in the mesh stay in the cache, and nothing is sorted. The partner of a side is looked up in
the row of its stop, at the place that the hash of its start gives. Two sides that find each other so are partners, for
each starts at the stop of the other, whatever the hashes. Sides that found their places taken try again with another
hash, and the sides left after some rounds (around a vertex of many faces) are sorted.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

FACES_PER_BLOCK = 1 << 14  # in the cache with all that is made of them
MAX_SORTED_SIDES = 3 << 10  # a table is made for more
HASH_FACTORS = 0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D, 0x27D4EB2F, 0x165667B1  # primes of xxHash, by Yann Collet
SAMPLED_VERTICES = 512  # vertices with sides that decide on the hash
NOBODY = -1

# Sides as three arrays: their indices, their starts and their stops.
Sides = tuple[NDArray[np.int32], NDArray[np.integer], NDArray[np.integer]]


def faces_across_sides(faces: NDArray[np.integer], vertex_count: int) -> NDArray[np.int32] | None:
    """Return the (n, k) faces across the sides of (n, k) faces; None unless every edge has two opposite sides."""
    if 2 * vertex_count > faces.size or faces.size % 2:  # a vertex has one face
        return None
    bits = int(2 * faces.size // vertex_count).bit_length()
    if max(faces.size, vertex_count << bits) > np.iinfo(np.int32).max:
        return None
    faces = np.ascontiguousarray(faces)
    if any((faces[:, k] == faces[:, k - 1]).any() for k in range(faces.shape[1])):  # a side that is its own partner
        return None
    partner = np.empty(faces.size + 1, np.int32)
    partner[NOBODY] = NOBODY
    left = next(_all_sides(faces, len(faces))) if faces.size <= MAX_SORTED_SIDES else None
    if left is None:
        table = _Table(vertex_count, bits)
        for factor in table.factors_by_distinct_places(faces):
            left = _pair(faces, left, table, np.uint32(factor), partner)
            if left is None:
                return None
    assert left is not None
    found = _paired_by_sorting(*left)
    if found is None:
        return None
    partner[left[0]] = found
    across = partner[:-1].reshape(faces.shape)
    return np.floor_divide(across, np.int32(faces.shape[1]), out=across)


class _Table:
    """A table of sides, by the row of one end vertex and a hash of the other."""

    def __init__(self, vertex_count: int, bits: int):
        self.bits, self.sides = bits, np.zeros(vertex_count << bits, np.int32)  # counted from 1

    def places(self, row: NDArray[np.integer], other: NDArray[np.integer], factor: np.uint32) -> NDArray[np.intp]:
        """Return the table slots of the sides with these end vertices."""
        place = row.astype(np.intp)
        place <<= self.bits
        hashes = other.astype(np.uint32)
        hashes *= factor
        hashes >>= np.uint32(32 - self.bits)
        place += hashes
        return place

    def at(self, places: NDArray[np.intp]) -> NDArray[np.int32]:
        """Return the sides in these slots, NOBODY for an empty slot."""
        return self.sides.take(places, mode="clip") - np.int32(1)

    def factors_by_distinct_places(self, faces: NDArray[np.integer]) -> list[int]:
        """Return the hash factors, those that give sides around some vertices the most distinct places first."""
        flat = faces.ravel()
        first = len(self.sides) >> self.bits + 1
        number = np.flatnonzero((flat >= first) & (flat < first + SAMPLED_VERTICES))
        start, stop = flat[number], flat[_following(number, faces.shape[1])]
        return sorted(HASH_FACTORS, key=lambda factor: -len(np.unique(self.places(start, stop, np.uint32(factor)))))


def _pair(
    faces: NDArray[np.integer], left: Sides | None, table: _Table, factor: np.uint32, partner: NDArray[np.int32]
) -> Sides | None:
    """Pair the sides in `left` (None: all) by a hash. Return the sides still unpaired; None if a side occurs twice."""

    def blocks() -> Iterator[Sides]:
        return _all_sides(faces, FACES_PER_BLOCK) if left is None else _slices(left)

    for number, start, stop in blocks():
        table.sides[table.places(start, stop, factor)] = number + np.int32(1)
    for number, start, stop in blocks():
        partner[_range(number)] = table.at(table.places(stop, start, factor))
    flat = faces.ravel()
    rest: list[tuple[NDArray[np.integer], ...]] = [(np.empty(0, np.int32), flat[:0], flat[:0])]
    for number, start, stop in blocks():
        apart = np.flatnonzero(partner.take(partner[_range(number)], mode="wrap") != number)
        if not len(apart):
            continue
        number, start, stop = (each.take(apart, mode="clip") for each in (number, start, stop))
        winner = table.at(table.places(start, stop, factor))
        if ((flat.take(_following(winner, faces.shape[1]), mode="clip") == stop) & (winner != number)).any():
            return None
        rest.append((number, start, stop))
    number, start, stop = (np.concatenate(each) for each in zip(*rest))
    return number, start, stop


def _following(number: NDArray[np.integer], corners: int) -> NDArray[np.integer]:
    """Return the next side of the same face, for each side."""
    return np.where(number % corners == corners - 1, number - (corners - 1), number + 1)


def _range(number: NDArray[np.int32]) -> slice | NDArray[np.int32]:
    """Return ascending numbers as a slice, if they are without gaps."""
    first, last = int(number[0]), int(number[-1])
    return slice(first, last + 1) if last - first + 1 == len(number) else number


def _all_sides(faces: NDArray[np.integer], faces_per_block: int) -> Iterator[Sides]:
    corners = faces.shape[1]
    for first in range(0, len(faces), faces_per_block):
        start = faces[first : first + faces_per_block].ravel()
        stop = np.empty_like(start)
        stop[:-1] = start[1:]
        stop[corners - 1 :: corners] = start[::corners]
        yield np.arange(corners * first, corners * first + len(start), dtype=np.int32), start, stop


def _slices(sides: Sides) -> Iterator[Sides]:
    number, start, stop = sides
    for first in range(0, len(number), 3 * FACES_PER_BLOCK):
        block = slice(first, first + 3 * FACES_PER_BLOCK)
        yield number[block], start[block], stop[block]


def _paired_by_sorting(
    number: NDArray[np.int32], start: NDArray[np.integer], stop: NDArray[np.integer]
) -> NDArray[np.int32] | None:
    """Return the partner of each of an even number of sides; None if they are no pairs."""
    low, high = np.minimum(start, stop).astype(np.uint64), np.maximum(start, stop).astype(np.uint64)
    key = low << np.uint64(32) | high << np.uint64(1) | (start < stop)
    order = np.argsort(key)
    order = order.reshape(-1, 2)
    if not (np.bitwise_xor(*key[order].T) == 1).all():
        return None
    partner = np.empty_like(number)
    partner[order] = number[order[:, ::-1]]
    return partner
