# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed sets of planar faces, cut along planes without a triangulation.

In each face, the chords between the places where its edges cross the plane close the cycle again,
and all chords together bound the new face in the plane.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..mesh import Surface, first_at_equal_position, normals
from ..numerics import Array, Index, Mask, NDArray, connected_components

ON_PLANE_RTOL = 1e-9  # relative to the size: points nearer to a plane are on it


@dataclass(frozen=True, eq=False)
class Piece:
    """Closed planar faces: each edge (start, end) of points belongs to a face, counter-clockwise
    from outside.

    points: (n, 3). face, start, end: (e,) indices for each edge. normals: (f, 3) of faces.
    """

    points: Array
    face: Index
    start: Index
    end: Index
    normals: Array

    def volume(self) -> float:
        """Return the signed volume: the sum of the cones of each face's fan."""
        origin = self.points[self.start[0]]
        a, b, c = (
            self.points[ids] - origin for ids in (self.first()[self.face], self.start, self.end)
        )
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0

    def first(self) -> Index:
        """Return the index of one point of each face, (f,): its first edge's start."""
        first = np.zeros(len(self.normals), np.intp)
        first[self.face[::-1]] = self.start[::-1]  # the last of equal indices wins
        return first

    def take(self, chosen: Mask) -> Piece:
        """Return a piece of the chosen edges alone, with the points and faces that these use."""
        ids, ends = np.unique(np.stack([self.start[chosen], self.end[chosen]]), return_inverse=True)
        faces, face = np.unique(self.face[chosen], return_inverse=True)
        start, end = ends.reshape(2, -1)
        return Piece(self.points[ids], face, start, end, self.normals[faces])


def piece_from_surface(surface: Surface) -> Piece:
    """Return the triangles of a surface that have an area, as the faces of a piece."""
    triangles = surface.all_triangles()[0].astype(np.intp)
    points = np.asarray(surface.points, np.float64)
    triangles = _join_open_edges(points, triangles)
    normal = normals(points, triangles)
    has_area = np.linalg.norm(normal, axis=1) > 0.0
    triangles, normal = triangles[has_area], normal[has_area]
    return Piece(
        points=points,
        face=np.arange(len(triangles)).repeat(3),
        start=triangles.ravel(),
        end=triangles[:, [1, 2, 0]].ravel(),
        normals=normal / np.linalg.norm(normal, axis=1)[:, None],
    )


def _join_open_edges(points: Array, triangles: Index) -> Index:
    """Return triangles whose open edges share points that coincide: lids of curves and texts have
    points of their own.

    Other points stay apart, so that parts that only touch do not become one.
    """
    start = triangles.ravel()
    end = triangles[:, [1, 2, 0]].ravel()
    is_open = ~np.isin(start * len(points) + end, end * len(points) + start)
    ends = np.unique(np.concatenate([start[is_open], end[is_open]]))
    if not len(ends):
        return triangles
    number = np.arange(len(points))
    number[ends] = ends[first_at_equal_position(points[ends])]
    return number[triangles]


def cut(piece: Piece, plane: Array) -> Iterator[Piece]:
    """Yield the connected parts on both sides of a plane, (4,) its normal and offset."""
    normal = plane[:3]
    height = piece.points @ normal - plane[3]
    height[np.abs(height) <= ON_PLANE_RTOL * np.ptp(piece.points, axis=0).max()] = 0.0
    # One crossing for both uses of an edge, by a key of its ends: pieces stay closed.
    low = np.minimum(piece.start, piece.end)
    high = np.maximum(piece.start, piece.end)
    crosses = np.flatnonzero(height[low] * height[high] < 0.0)
    keys, which = np.unique(low[crosses] * len(height) + high[crosses], return_inverse=True)
    low, high = np.divmod(keys, len(height))
    share = (height[low] / (height[low] - height[high]))[:, None]
    points = np.concatenate(
        [piece.points, (1.0 - share) * piece.points[low] + share * piece.points[high]]
    )
    crossing = np.full(len(piece.start), -1)
    crossing[crosses] = len(height) + which
    for sign in (1.0, -1.0):
        half = _half(replace(piece, points=points), sign * height, crossing, sign * normal)
        if half is not None:
            yield from connected_parts(half)


def _half(piece: Piece, height: NDArray, crossing: NDArray, normal: NDArray) -> Piece | None:
    """Return the part of a piece above a plane, closed in the plane; None if nothing is above.

    height: (n,) of the points, without those of crossings. crossing: (e,) index of the point where
    an edge crosses the plane, or -1. normal: (3,) upward.
    """
    from_above = height[piece.start] > 0.0
    to_above = height[piece.end] > 0.0
    crosses = crossing >= 0
    from_below = height[piece.start] < 0.0
    to_below = height[piece.end] < 0.0
    kept = (from_above | to_above) & ~from_below & ~to_below | crosses
    if not kept.any():
        return None
    start = np.where(crosses & from_below, crossing, piece.start)
    end = np.where(crosses & to_below, crossing, piece.end)
    leaves = kept & from_above & ~to_above
    enters = kept & to_above & ~from_above
    # The points where each face's edges meet the plane, in order along the line that both have in
    # common. Between two of them run as many chords as edges that left before outnumber those that
    # entered, forward, or the other way, backward. At a face's end the count is 0 again.
    place = np.concatenate([end[leaves], start[enters]])
    face = np.concatenate([piece.face[leaves], piece.face[enters]])
    step = np.repeat([1, -1], [np.count_nonzero(leaves), np.count_nonzero(enters)])
    along = np.einsum("ij,ij->i", piece.points[place], np.cross(piece.normals[face], normal))
    order = np.lexsort((along, face))
    place = place[order]
    face = face[order]
    count = np.cumsum(step[order])
    chords = np.flatnonzero((count[:-1] != 0) & (place[:-1] != place[1:]))
    chords = chords.repeat(np.abs(count[chords]))
    is_forward = count[chords] > 0
    begin = np.where(is_forward, place[chords], place[chords + 1])
    stop = np.where(is_forward, place[chords + 1], place[chords])
    lid = np.full(len(chords), len(piece.normals))
    whole = Piece(
        piece.points,
        np.concatenate([piece.face[kept], face[chords], lid]),
        np.concatenate([start[kept], begin, stop]),
        np.concatenate([end[kept], stop, begin]),
        np.concatenate([piece.normals, -normal[None]]),
    )
    return whole.take(np.ones(len(whole.start), bool))


def connected_parts(piece: Piece) -> Iterator[Piece]:
    """Yield the connected parts of a piece; a cavity, and a hole of a face, belong to the part
    around them.
    """
    label, count = connected_components(len(piece.points), piece.start, piece.end)
    if count == 1:
        yield piece
        return
    first, second = _joined_by_faces(piece, label)
    group, _ = connected_components(count, first, second)
    edge_label = group[label][piece.start]
    parts = [piece.take(edge_label == number) for number in np.unique(edge_label)]
    volumes = [part.volume() for part in parts]
    boxes = [(part.points.min(axis=0), part.points.max(axis=0)) for part in parts]
    owner = list(range(len(parts)))
    # A cavity, whose volume is negative, belongs to the smallest part with a box around its own.
    for i in np.flatnonzero(np.array(volumes) < 0.0).tolist():
        around = [
            j
            for j in owner
            if volumes[j] > 0.0
            and (boxes[j][0] <= boxes[i][0]).all()
            and (boxes[j][1] >= boxes[i][1]).all()
        ]
        owner[i] = min(around, key=volumes.__getitem__, default=i)
    for i in sorted({*owner}):
        members = [part for part, whose in zip(parts, owner) if whose == i]
        yield members[0] if len(members) == 1 else _join(members)


def _join(parts: Sequence[Piece]) -> Piece:
    """Return one piece of the points, edges and faces of all parts."""
    points = np.cumsum([0, *(len(part.points) for part in parts)])
    faces = np.cumsum([0, *(len(part.normals) for part in parts)])
    return Piece(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.face + shift for part, shift in zip(parts, faces)]),
        np.concatenate([part.start + shift for part, shift in zip(parts, points)]),
        np.concatenate([part.end + shift for part, shift in zip(parts, points)]),
        np.concatenate([part.normals for part in parts]),
    )


def _joined_by_faces(piece: Piece, label: Index) -> tuple[Index, Index]:
    """Return pairs of labels, (p,) and (p,): of the holes in faces, and of the cycles around them.

    label: (n,) connected components of the points. A face of one component has no such hole.
    """
    pairs = []
    of_edge = label[piece.start]
    low = np.full(len(piece.normals), len(label))
    high = np.zeros(len(piece.normals), np.intp)
    np.minimum.at(low, piece.face, of_edge)
    np.maximum.at(high, piece.face, of_edge)
    for face in np.flatnonzero(low < high).tolist():
        edges = np.flatnonzero(piece.face == face)
        a = piece.points[piece.start[edges]]
        b = piece.points[piece.end[edges]]
        middle = a.mean(axis=0)
        twice = np.einsum("ij,j->i", np.cross(a - middle, b - middle), piece.normals[face])
        cycles, which = np.unique(of_edge[edges], return_inverse=True)
        area = np.bincount(which, twice)
        box = np.array(
            [[a[which == i].min(axis=0), a[which == i].max(axis=0)] for i in range(len(cycles))]
        )
        for hole in np.flatnonzero(area <= 0.0).tolist():
            around = (
                (area > 0.0)
                & (box[:, 0] <= box[hole, 0]).all(axis=1)
                & (box[:, 1] >= box[hole, 1]).all(axis=1)
            )
            if around.any():
                outer = np.flatnonzero(around)[area[around].argmin()]
                pairs.append((cycles[hole], cycles[outer]))
    first, second = np.array(pairs, np.intp).reshape(-1, 2).T
    return first, second
