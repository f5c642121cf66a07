# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connections of faces: edges, the cheap proof of closedness, connected parts, consistent
orientation.

A surface bounds a body exactly when every edge is used equally often in both directions. If a mesh
names the edge at each of its corners, one scatter proves the common case (each edge once each way)
without sorting: there is one slot for each direction of an edge, and the corners fill as many slots
as there are corners. Without named edges, the sides of faces are paired through a table. Each side
is written into the row of its start, at a place that a hash of its stop gives, so that neighbors in
the mesh stay in the cache. Its partner is looked up in the row of its stop, by the hash of its
start. Two sides that find each other so are partners, because each starts at the stop of the other,
whatever the hashes. Sides whose places are taken try again with another hash; sides left after some
rounds (around a vertex of many faces) are sorted.

Orientation is decided by connected parts on the double cover: each face becomes two nodes, one for
each orientation. A part is orientable if its two covers stay apart.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..numerics import (
    EDGES_PER_BLOCK,
    NEXT_AXIS,
    Array,
    Index,
    Mask,
    NDArray,
    connected_components,
    first_occurrence,
    sums_by_index,
)
from .surface import Surface, face_of_each

HASH_FACTOR = np.uint32(0x9E3779B1)  # a prime of xxHash, by Yann Collet
FACES_PER_BLOCK = 1 << 14  # in the cache with all that is made of them
MAX_SORTED_SIDES = 3 << 13  # a table is made for more
# primes of xxHash, by Yann Collet
HASH_FACTORS = (
    0x9E3779B1,
    0x85EBCA77,
    0xC2B2AE3D,
    0x27D4EB2F,
    0x165667B1,
)
SAMPLED_VERTICES = 512  # vertices with sides that decide on the hash
NOBODY = -1
# Sides as three arrays: their indices, their starts and their stops.
Sides = tuple[NDArray[np.int32], NDArray[np.integer], NDArray[np.integer]]


def closed_side_faces(surface: Surface) -> NDArray[np.int32] | None:
    """Return the (2, e) mesh faces beside the used edges if each has two, run in opposite
    directions; else None.
    """
    corners = surface.corner_vertices
    edges = surface.corner_edges
    if corners is None or edges is None or not len(corners) == len(edges) > 0:
        return None
    sides_at = _sides_at(surface, corners)
    if sides_at is None:
        return None
    # a negative edge becomes a large one
    count = int(edges.view("u{:d}".format(edges.itemsize)).max()) + 1
    if count > 2 * len(corners) or count > np.iinfo(edges.dtype).max // 2:
        # Most of them without faces, or too many for their type: a table costs more than a search.
        return None
    sides = np.full(2 * count, -1, np.int32)
    for start in range(0, len(corners), EDGES_PER_BLOCK):
        faces, upward = sides_at(start)
        slot = upward.astype(edges.dtype)
        slot *= count
        slot += edges[start : start + EDGES_PER_BLOCK]
        sides[slot.astype(np.intp)] = faces
    sides = sides.reshape(2, count)
    if len(corners) != 2 * count:  # edges without faces
        sides = sides[:, sides.max(axis=0) >= 0]
    return sides if len(corners) == sides.size and sides.min() >= 0 else None


def _sides_at(
    surface: Surface, corners: NDArray[np.integer]
) -> Callable[[int], tuple[NDArray[np.int32], Mask]] | None:
    """Return a function from a block's first corner to faces and directions of its corners; None if
    they do not fit.
    """
    quads = len(surface.quads)
    triangles = len(surface.triangles)
    if not triangles and surface.quad_faces is None:
        size = 4
    elif not quads and surface.triangle_faces is None:
        size = 3
    else:
        quad_faces, triangle_faces = face_of_each(surface)
        sizes = ring_sizes(triangle_faces, quad_faces)
        ends = np.cumsum(sizes)
        if not sizes.all() or ends[-1] != len(corners):
            return None
        owner = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)
        following = np.concatenate([corners[1:], corners[:1]])
        following[ends - 1] = corners[ends - sizes]
        return lambda start: (
            owner[start : start + EDGES_PER_BLOCK],
            corners[start : start + EDGES_PER_BLOCK] < following[start : start + EDGES_PER_BLOCK],
        )
    if len(corners) != size * (quads + triangles):
        return None
    faces = np.repeat(np.arange(EDGES_PER_BLOCK // size, dtype=np.int32), size)

    def sides_at(start: int) -> tuple[NDArray[np.int32], Mask]:
        vertices = corners[start : start + EDGES_PER_BLOCK]
        upward = np.empty(len(vertices), bool)
        np.less(vertices[:-1], vertices[1:], out=upward[:-1])
        np.less(vertices[size - 1 :: size], vertices[::size], out=upward[size - 1 :: size])
        return faces[: len(vertices)] + np.int32(start // size), upward

    return sides_at


def ring_sizes(
    triangle_faces: NDArray[np.integer], quad_faces: NDArray[np.integer], count: int = 0
) -> Index:
    """Return (count or more,) corner counts of mesh faces, found from their triangles or quads; 0
    for missing faces.
    """
    pieces = np.bincount(triangle_faces, minlength=max(count, int(quad_faces.max(initial=-1)) + 1))
    sizes = np.where(pieces > 0, pieces + 2, 0)
    sizes[quad_faces] = 4
    return sizes


@dataclass(frozen=True, eq=False)
class Edges:
    """The undirected edges of m triangles.

    Side 3t + i runs from corner i of triangle t to the next one.

    of_side: (3m,) the edge of each side; upward: (3m,) if the side runs from the lower vertex to
    the higher; first: (e,) the first side of each edge, ascending; count: (e,) number of sides.
    """

    of_side: Index
    upward: Mask
    first: Index
    count: Index

    def signed_use_count(self, flipped: Mask) -> Array:
        """Return (e,) upward sides minus downward sides of each edge, once the `flipped` triangles
        are reversed.
        """
        return sums_by_index(self.of_side, np.where(self.upward ^ np.repeat(flipped, 3), 1.0, -1.0))

    def manifold_side_pairs(self) -> tuple[Index, Index]:
        """Return the two sides of every edge that has exactly two."""
        two = self.count == 2
        last = np.empty(len(two), np.intp)
        last[self.of_side] = np.arange(len(self.of_side))  # the last write to equal indices wins
        return self.first[two], last[two]

    def adjacency(self) -> tuple[Index, Index]:
        """Return pairs of triangles as two (k,) arrays; the pairs connect all triangles at an
        edge.
        """
        side = np.arange(len(self.of_side))
        first = self.first[self.of_side]
        later = first != side
        return first[later] // 3, side[later] // 3

    def boundary_sides(self) -> Index:
        """Return the sides of edges that have only one, ascending."""
        return self.first[self.count == 1]

    def boundary_ends(
        self, triangles: NDArray[np.integer]
    ) -> tuple[NDArray[np.integer], NDArray[np.integer]]:
        """Return the start vertices and the end vertices of the boundary sides of (m, 3)
        triangles.
        """
        side = self.boundary_sides()
        return triangles.ravel()[side], triangles.take(NEXT_AXIS, 1).ravel()[side]


def find_edges(triangles: NDArray[np.integer], quads: int = 0) -> Edges:
    """Return the edges of (m, 3) triangles; the last 2 * `quads` are halves with diagonals of their
    own.
    """
    start = triangles.ravel()
    stop = triangles.take(NEXT_AXIS, 1).ravel()
    low = np.minimum(start, stop)
    high = np.maximum(start, stop)
    width = int(high.max(initial=0)) + 1
    bits = (
        len(low) // width
    ).bit_length() + 1  # neighbors in the mesh share the table's cached part
    slots = np.left_shift(low, bits, dtype=np.intp)
    slots += (high.astype(np.uint32) * HASH_FACTOR) >> np.uint32(32 - bits)
    keys = np.multiply(low, width, dtype=np.int64)
    keys += high
    diagonals = 3 * (len(triangles) - 2 * quads + 2 * np.arange(quads))
    keys[diagonals + 2] = keys[diagonals + 3] = width * width + np.arange(quads)
    first = first_occurrence(keys, slots=slots)
    begins = first == np.arange(len(first))
    of_side = (np.cumsum(begins) - 1).take(first)
    return Edges(
        of_side=of_side,
        upward=start < stop,
        first=np.flatnonzero(begins),
        count=np.bincount(of_side),
    )


def uncancelled_sides(
    triangles: NDArray[np.integer], owner: NDArray[np.integer]
) -> tuple[Index, Index, Index]:
    """Return (k,) owners, starts and ends of the sides of (m, 3) triangles that no opposite one of
    their owner cancels.

    They are in the order of the sides. owner: (m,) of each triangle.
    """
    start = triangles.ravel().astype(np.int64)
    stop = triangles.take(NEXT_AXIS, 1).ravel().astype(np.int64)
    low = np.minimum(start, stop)
    high = np.maximum(start, stop)
    owner = np.repeat(owner, 3).astype(np.int64)
    first = first_occurrence(low, high, owner)
    # nothing of sides without length
    left = np.bincount(first, np.sign(stop - start)).astype(np.intp)
    first = np.repeat(np.arange(len(left)), np.abs(left))
    low = low[first]
    high = high[first]
    forward = left[first] > 0
    return owner[first], np.where(forward, low, high), np.where(forward, high, low)


def consistent_orientation(
    count: int,
    a: NDArray[np.integer],
    b: NDArray[np.integer],
    misoriented: Mask,
    weight: Array,
) -> tuple[Mask, Mask]:
    """Return (count,) masks of faces to turn, the smaller area (weight), and of faces that cannot
    agree.
    """
    flipped, twisted = np.zeros((2, count), bool)
    if not misoriented.any():
        return flipped, twisted
    # Nodes f and f + count: the face as it is and turned.
    cover, _ = connected_components(
        2 * count,
        np.concatenate([a, a + count]),
        np.concatenate([b + count * misoriented, b + count * ~misoriented]),
    )
    plain, reverse = cover[:count], cover[count:]
    twisted = plain == reverse
    flipped = plain > reverse
    part = np.minimum(plain, reverse)
    moved = np.bincount(part, weight * flipped)
    whole = np.bincount(part, weight)
    flipped ^= (2.0 * moved > whole)[part]
    return flipped & ~twisted, twisted


def group_components(edges: Edges, part: Index, parts: int, even: Mask) -> tuple[Index, int]:
    """Return (m,) components of triangles, made of whole parts, and their number.

    part: (m,) parts connected across edges of two sides; even: (e,) mask of edges of one side that
    gaps close. A part that closes by itself is a component, though it may share edges (two boxes
    that meet in an edge). Parts that do not close by themselves and share an edge are one component
    (a box with an inner wall).
    """
    non_manifold = edges.count > 2
    if not non_manifold.any():
        return part, parts
    key = edges.of_side * parts + part.repeat(3)
    used, uses = np.unique(key, return_counts=True)
    odd = (uses % 2 == 1) & ~even[used // parts]
    unfinished = np.zeros(parts, bool)
    unfinished[used[odd] % parts] = True
    side = np.flatnonzero(non_manifold[edges.of_side] & unfinished[part].repeat(3))
    meet = np.empty(len(non_manifold), np.intp)
    meet[edges.of_side[side]] = part[side // 3]  # any part at the edge
    component, number = connected_components(parts, part[side // 3], meet[edges.of_side[side]])
    return component[part], number


def faces_across_sides(faces: NDArray[np.integer], vertex_count: int) -> NDArray[np.int32] | None:
    """Return the (n, k) faces across the sides of (n, k) faces; None unless every edge has two
    opposite sides.
    """
    if 2 * vertex_count > faces.size or faces.size % 2:  # a vertex has one face
        return None
    bits = int(2 * faces.size // vertex_count).bit_length()
    if max(faces.size, vertex_count << bits) > np.iinfo(np.int32).max:
        return None
    faces = np.ascontiguousarray(faces)
    # a side that is its own partner
    if any((faces[:, k] == faces[:, k - 1]).any() for k in range(faces.shape[1])):
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
        # counted from 1
        self.bits = bits
        self.sides = np.zeros(vertex_count << bits, np.int32)

    def places(
        self, row: NDArray[np.integer], other: NDArray[np.integer], factor: np.uint32
    ) -> Index:
        """Return the table slots of the sides with these end vertices."""
        place = row.astype(np.intp)
        place <<= self.bits
        hashes = other.astype(np.uint32)
        hashes *= factor
        hashes >>= np.uint32(32 - self.bits)
        place += hashes
        return place

    def at(self, places: Index) -> NDArray[np.int32]:
        """Return the sides in these slots, NOBODY for an empty slot."""
        return self.sides.take(places, mode="clip") - np.int32(1)

    def factors_by_distinct_places(self, faces: NDArray[np.integer]) -> list[int]:
        """Return the hash factors, those that give sides around some vertices the most distinct
        places first.
        """
        flat = faces.ravel()
        first = len(self.sides) >> self.bits + 1
        number = np.flatnonzero((flat >= first) & (flat < first + SAMPLED_VERTICES))
        start = flat[number] - first
        stop = flat[_following(number, faces.shape[1])]

        def distinct_places(factor: int) -> int:
            return int(np.count_nonzero(np.bincount(self.places(start, stop, np.uint32(factor)))))

        return sorted(HASH_FACTORS, key=distinct_places, reverse=True)


def _pair(
    faces: NDArray[np.integer],
    left: Sides | None,
    table: _Table,
    factor: np.uint32,
    partner: NDArray[np.int32],
) -> Sides | None:
    """Pair the sides in `left` (None: all) by a hash.

    Return the sides still unpaired; None if a side occurs twice.
    """

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
        if (
            (flat.take(_following(winner, faces.shape[1]), mode="clip") == stop)
            & (winner != number)
        ).any():
            return None
        rest.append((number, start, stop))
    number, start, stop = (np.concatenate(each) for each in zip(*rest))
    return number, start, stop


def _following(number: NDArray[np.integer], corners: int) -> NDArray[np.integer]:
    """Return the next side of the same face, for each side."""
    return np.where(number % corners == corners - 1, number - (corners - 1), number + 1)


def _range(number: NDArray[np.int32]) -> slice | NDArray[np.int32]:
    """Return ascending numbers as a slice, if they are without gaps."""
    first = int(number[0])
    last = int(number[-1])
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
    low = np.minimum(start, stop).astype(np.uint64)
    high = np.maximum(start, stop).astype(np.uint64)
    key = low << np.uint64(32) | high << np.uint64(1) | (start < stop)
    order = np.argsort(key)
    order = order.reshape(-1, 2)
    if not (np.bitwise_xor(*key[order].T) == 1).all():
        return None
    partner = np.empty_like(number)
    partner[order] = number[order[:, ::-1]]
    return partner
