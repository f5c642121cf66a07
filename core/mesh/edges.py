# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connections of faces: edges, the cheap proof of closedness, connected parts, consistent
orientation.

A surface bounds a body exactly when every edge is used equally often in both directions. If a mesh
names the edge at each of its corners, one scatter proves the common case (each edge once each way)
without sorting: there is one slot for each direction of an edge, and the corners fill as many slots
as there are corners. Without named edges, the sides of faces are sorted by both ends and direction.

Orientation is decided by connected parts on the double cover: each face becomes two nodes, one for
each orientation. A part is orientable if its two covers stay apart.
"""

from dataclasses import dataclass

import numpy as np

from ..numerics import (
    NEXT_AXIS,
    Array,
    Index,
    Mask,
    NDArray,
    as_unsigned,
    connected_components,
    first_occurrence,
    sums_by_index,
)
from .surface import Surface, face_of_each

HASH_FACTOR = np.uint32(0x9E3779B1)  # a prime of xxHash, by Yann Collet


def closed_side_faces(surface: Surface) -> NDArray[np.int32] | None:
    """Return the (2, e) mesh faces beside the used edges if each has two, run in opposite
    directions; else None.
    """
    starts = surface.corner_vertices
    edges = surface.corner_edges
    if starts is None or edges is None or not len(starts) == len(edges) > 0:
        return None
    quad_faces, triangle_faces = face_of_each(surface)
    sizes = ring_sizes(triangle_faces, quad_faces)
    if not sizes.all() or sizes.sum() != len(starts):
        return None
    # a negative edge becomes a large one
    edge_count = int(as_unsigned(edges).max()) + 1
    if edge_count > 2 * len(starts) or edge_count > np.iinfo(edges.dtype).max // 2:
        # Most edges have no faces, or slots would overflow: the table would cost more than sorting.
        return None
    ring_ends = np.cumsum(sizes)
    stops = np.concatenate([starts[1:], starts[:1]])
    stops[ring_ends - 1] = starts[ring_ends - sizes]
    # Each edge has a slot for a side towards its lower vertex, and one for a side towards its
    # higher vertex.
    slots = (starts < stops).astype(edges.dtype)
    slots *= edge_count
    slots += edges
    faces = np.full(2 * edge_count, -1, np.int32)
    faces[slots] = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)
    faces = faces.reshape(2, edge_count)
    if len(starts) != 2 * edge_count:
        has_face = faces.max(axis=0) >= 0
        faces = faces[:, has_face]
    return faces if len(starts) == faces.size and faces.min() >= 0 else None


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
    """Return the edges of (m, 3) triangles.

    quads: number of pairs of triangles at the end, the halves a, b, c and a, c, d of quads; their
    diagonals are edges of their own, even along other edges.
    """
    start = triangles.ravel()
    stop = triangles.take(NEXT_AXIS, 1).ravel()
    low = np.minimum(start, stop)
    high = np.maximum(start, stop)
    width = int(high.max(initial=0)) + 1
    # A run of 2^bits slots for each lower vertex, at least two for each side on average; within the
    # run, the higher vertex is hashed. So neighbors in the mesh share the table's cached part.
    bits = (len(low) // width).bit_length() + 1
    slots = np.left_shift(low, bits, dtype=np.intp)
    slots += (high.astype(np.uint32) * HASH_FACTOR) >> np.uint32(32 - bits)
    keys = np.multiply(low, width, dtype=np.int64)
    keys += high
    first_halves = 3 * (len(triangles) - 2 * quads + 2 * np.arange(quads))
    # The diagonal: the last side of the first half, and the first side of the second half.
    keys[first_halves + 2] = keys[first_halves + 3] = width * width + np.arange(quads)
    first = first_occurrence(keys, slots=slots)
    is_first = first == np.arange(len(first))
    of_side = (np.cumsum(is_first) - 1).take(first)
    return Edges(
        of_side=of_side,
        upward=start < stop,
        first=np.flatnonzero(is_first),
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
    # Upward sides minus downward sides, at the first side of each edge; 0 for sides without length.
    surplus = np.bincount(first, np.sign(stop - start)).astype(np.intp)
    side = np.repeat(np.arange(len(surplus)), np.abs(surplus))
    low = low[side]
    high = high[side]
    upward = surplus[side] > 0
    return owner[side], np.where(upward, low, high), np.where(upward, high, low)


def consistent_orientation(
    count: int,
    a: NDArray[np.integer],
    b: NDArray[np.integer],
    misoriented: Mask,
    weight: Array,
) -> tuple[Mask, Mask]:
    """Return (count,) masks of the faces to turn, and of faces that cannot agree with their part.

    Of each part the faces with the smaller sum of `weight`, (count,), are turned. a, b: (k,)
    neighboring faces; misoriented: (k,) mask of the pairs that disagree.
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
    plain, turned = cover[:count], cover[count:]
    twisted = plain == turned
    flipped = plain > turned  # each part has one of the two ways; the weights decide
    part = np.minimum(plain, turned)
    flipped_weight = np.bincount(part, weight * flipped)
    flipped ^= (2.0 * flipped_weight > np.bincount(part, weight))[part]
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
    edge_and_part, sides = np.unique(edges.of_side * parts + part.repeat(3), return_counts=True)
    is_odd = (sides % 2 == 1) & ~even[edge_and_part // parts]
    unfinished = np.zeros(parts, bool)
    unfinished[edge_and_part[is_odd] % parts] = True
    side = np.flatnonzero(non_manifold[edges.of_side] & unfinished[part].repeat(3))
    edge = edges.of_side[side]
    any_part = np.empty(len(non_manifold), np.intp)
    any_part[edge] = part[side // 3]  # the last one of several parts at an edge
    component, number = connected_components(parts, part[side // 3], any_part[edge])
    return component[part], number


def faces_beside_edges(faces: NDArray[np.integer], vertex_count: int) -> NDArray[np.int32] | None:
    """Return the (2, e) faces beside the edges of (n, k) faces; None unless every edge has two
    opposite sides.
    """
    # A vertex of a closed surface is a corner of two faces at least; all vertices are used.
    if 2 * vertex_count > faces.size or faces.size % 2:
        return None
    columns = np.ascontiguousarray(faces.T)
    vertex_bits = int(vertex_count).bit_length()
    face_bits = len(faces).bit_length()
    # A side as bits: its lower vertex, its higher vertex, and a last bit for its direction.
    keys = np.empty(columns.shape, np.uint64)
    for key, start, stop in zip(keys, columns, np.roll(columns, -1, axis=0)):
        np.minimum(start, stop, out=key, casting="unsafe")
        key <<= np.uint64(vertex_bits)
        key |= np.maximum(start, stop).astype(np.uint64)
        key <<= np.uint64(1)
        key |= start < stop
    if 2 * vertex_bits + 1 + face_bits <= 64:  # sorting keys that end with the face takes less time
        keys <<= np.uint64(face_bits)
        keys |= np.arange(len(faces), dtype=np.uint64)
        keys = keys.ravel()
        keys.sort()
        face_of_side = keys & np.uint64((1 << face_bits) - 1)
        keys >>= np.uint64(face_bits)
    else:
        order = keys.ravel().argsort()
        keys = keys.ravel()[order]
        face_of_side = order % len(faces)
    if not (keys[::2] ^ keys[1::2] == 1).all():  # two sides of an edge differ in the last bit
        return None
    return face_of_side.astype(np.int32).reshape(-1, 2).T
