# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A closed surface cut into closed pieces, one for each bone.

A face goes with the bone of the most weight at its corners. If weights tie, the nearer bone counts,
so that the two sides of a symmetric character are cut alike; faces without any weight go with the
nearest bone.

The faces of a bone are bounded by the edges that they share with other bones' faces. Cut edges that
meet, whatever their bones, belong to one cut, which is closed to one apex, its centroid. Each bone
gets the cone on its side of every edge, so that pieces are closed, the cones of neighbors cancel,
and the pieces add up to the whole, exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core import mesh, numerics, polyhedron
from ..moments import Moments

NO_BONE = -1
TIE_RTOL = 1e-5  # weights are float32, and a mirrored face adds them up in another order
NEAR_RTOL = 1e-5  # Relative to a distance: the effect of float32 coordinates.
PAIRS_PER_BLOCK = 1 << 20  # faces times bones whose distances are in memory at a time


@dataclass(frozen=True, eq=False)
class BonePiece:
    """The closed surface, in float64, that goes with one bone: its faces, and the cones that close
    it.

    face_count: the number of triangles that are faces; they come first, then the cones.
    """

    bone: int
    surface: mesh.Surface
    face_count: int

    def moments(self, order: int = 3) -> Moments:
        """Return the moments of its volume, about the middle of its bounding box in the surface's
        coordinates.
        """
        return polyhedron.polyhedron_moments(self.surface, order, exact=True)[0]


def bone_pieces(
    points: numerics.Floats,
    triangles: numerics.Integers,
    bone: numerics.Integers,
    displacement: numerics.NDArray | None = None,
) -> list[BonePiece]:
    """Cut (t, 3) outward triangles with (t,) bones into closed pieces.

    displacement: (3,) errors of the points' coordinates by storing, as of a Surface.
    """
    points = points.astype(np.float64)
    bone_of_side, start, stop = mesh.uncancelled_sides(triangles, bone)
    cut, apexes = _apexes(points, start, stop)
    # A cone runs along its edge against the face, so that it is outward as well.
    cones = np.stack([stop, start, len(points) + cut], axis=1)
    corners = np.concatenate([triangles, cones])
    bone_of_corners = np.concatenate([bone, bone_of_side])
    points = np.concatenate([points, apexes])
    face_counts = np.bincount(bone)
    # Stable: the faces of a bone stay before its cones.
    order = np.argsort(bone_of_corners, kind="stable")
    bones, starts = np.unique(bone_of_corners[order], return_index=True)
    pieces = []
    for number, rows in zip(bones.tolist(), np.split(order, starts[1:])):
        surface = mesh.Surface(*mesh.keep_used(points, corners[rows]), displacement=displacement)
        pieces.append(BonePiece(number, surface, int(face_counts[number])))
    return pieces


def bones_of_caps(
    triangles: numerics.Integers, is_cap: numerics.Mask, bone: numerics.Integers
) -> numerics.Index:
    """Return (t,) bones of triangles: caps, which close holes, get the bones of the faces beside
    them.
    """
    result = np.where(is_cap, NO_BONE, bone)
    edge = mesh.find_edges(triangles).of_side.reshape(-1, 3)
    while (result == NO_BONE).any():
        known = result != NO_BONE
        bone_of_edge = np.full(int(edge.max()) + 1, NO_BONE)
        bone_of_edge[edge[known].ravel()] = np.repeat(result[known], 3)
        beside = bone_of_edge[edge[~known]].max(axis=1)
        if (beside == NO_BONE).all():  # Caps that touch nothing go with the bone of most faces.
            beside[:] = np.bincount(bone[~is_cap], minlength=1).argmax()
        result[~known] = beside
    return result


def _apexes(
    points: numerics.Array, start: numerics.Index, stop: numerics.Index
) -> tuple[numerics.Index, numerics.Array]:
    """Return the (e,) cuts that edges from `start` to `stop` belong to, and the (c, 3) centroids of
    the cuts' edges. start, stop: (e,) vertices.
    """
    if not len(start):
        return np.zeros(0, np.intp), np.zeros((0, 3))
    vertices, ends = np.unique(np.concatenate([start, stop]), return_inverse=True)
    first, last = ends.reshape(2, -1)
    # Components are numbered by vertex; both vertices of an edge are in the same one.
    cut = numerics.connected_components(len(vertices), first, last)[0][first]
    # An edge counts once, however many bones meet there.
    edges = np.unique(
        np.stack([np.minimum(start, stop), np.maximum(start, stop), cut], axis=1), axis=0
    )
    begin, end = points[edges[:, 0]], points[edges[:, 1]]
    origin = points[vertices].mean(axis=0)  # far from the world's origin, digits would be lost
    # Never zero, so that a cut of no length has a centroid, too.
    length = np.maximum(np.linalg.norm(end - begin, axis=1), np.finfo(float).tiny)
    weight = np.bincount(edges[:, 2], length)
    middle = (begin - origin + (end - origin)) / 2.0
    sums = np.stack([np.bincount(edges[:, 2], length * middle[:, k]) for k in range(3)], axis=1)
    return cut, origin + sums / weight[:, None]


@dataclass(frozen=True, eq=False)
class VertexWeights:
    """Weights (w,) of bones on vertices, sorted by vertex, not negative; a vertex and a bone appear
    together once.
    """

    vertex: numerics.Integers
    bone: numerics.Integers
    weight: numerics.Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "weight", np.asarray(self.weight, np.float64))

    def normalized(self) -> numerics.Array:
        """Return the (w,) weights divided by their sum at each vertex, as an armature modifier
        does.
        """
        total = np.bincount(self.vertex, self.weight)[self.vertex]
        return np.divide(self.weight, total, out=np.zeros_like(self.weight), where=total > 0.0)

    def unweighted(self, count: int) -> numerics.Index:
        """Return the vertices below `count` that no bone has any weight on."""
        return np.flatnonzero(np.bincount(self.vertex, self.weight, minlength=count)[:count] == 0.0)


def dominant_bones(
    faces: numerics.Integers,
    corners: numerics.Integers,
    points: numerics.Floats,
    weights: VertexWeights,
    bones: numerics.Floats,
) -> tuple[numerics.Index, numerics.Index]:
    """Return the (f,) bones of faces, -1 without corners, and the (k,) unweighted faces, which get
    the nearest bone.

    faces, corners: (c,) the face, 0 to f - 1, and the vertex of each corner of the surface. points:
    (n, 3) in the bones' coordinates. bones: (b, 2, 3) the two ends of each bone.
    """
    points = points.astype(np.float64)
    bones = bones.astype(np.float64)
    number = len(bones)
    size = np.bincount(faces)
    center = np.stack(
        [np.bincount(faces, points[corners, k]) / np.maximum(size, 1) for k in range(3)], axis=1
    )
    # Candidates are pairs of a face and a bone.
    face, bone, score = _scores(faces, corners, weights, number)
    result = np.full(len(size), NO_BONE)
    # Pairs of a face and a bone are sorted by face: its largest score is that of a segment.
    starts, sizes = np.unique(face, return_index=True, return_counts=True)[1:]
    is_leading = score >= (1.0 - TIE_RTOL) * np.repeat(np.maximum.reduceat(score, starts), sizes)
    face, bone = face[is_leading], bone[is_leading]
    result[face] = bone
    ties = np.bincount(face)[face] > 1
    face, bone = face[ties], bone[ties]
    result[face] = _nearest(face, bone, _distances(center[face], bones[bone]))
    unweighted = np.flatnonzero((result == NO_BONE) & (size > 0))
    block = max(PAIRS_PER_BLOCK // number, 1)
    for start in range(0, len(unweighted), block):
        some_faces = unweighted[start : start + block]
        face = np.repeat(some_faces, number)
        bone = np.tile(np.arange(number), len(some_faces))
        result[face] = _nearest(face, bone, _distances(center[face], bones[bone]))
    return result, unweighted


def _scores(
    faces: numerics.Integers, corners: numerics.Integers, weights: VertexWeights, number: int
) -> tuple[numerics.Index, numerics.Index, numerics.Array]:
    """Return (k,) faces and (k,) bones with weight on their corners, by face, then bone, and (k,)
    summed weights.
    """
    per_vertex = np.bincount(weights.vertex, minlength=int(corners.max(initial=-1)) + 1)
    counts = per_vertex[corners]
    # The weights of a vertex stand in a row: each corner takes those of its vertex.
    starts = numerics.segment_starts(per_vertex)[corners]
    entry = np.repeat(starts, counts) + numerics.segment_ranges(counts)
    # One number for each pair of a face and a bone, ascending by face, then bone.
    key = np.repeat(faces, counts).astype(np.int64) * number + weights.bone[entry]
    pairs, pair_of_entry = np.unique(key, return_inverse=True)
    score = numerics.sums_by_index(pair_of_entry, weights.normalized()[entry])
    is_positive = score > 0.0
    face, bone = np.divmod(pairs[is_positive].astype(np.intp), number)
    return face, bone, score[is_positive]


def _nearest(
    face: numerics.Integers, bone: numerics.Integers, away: numerics.Array
) -> numerics.Integers:
    """Return (k,) for each pair of a face and a bone the nearest bone of this face, the first of
    equally near ones.

    Pairs are sorted by face. away: (k,) distances.
    """
    starts, sizes = np.unique(face, return_index=True, return_counts=True)[1:]
    least = np.repeat(np.minimum.reduceat(away, starts), sizes)
    near = away <= least * (1.0 + NEAR_RTOL)
    first = np.minimum.reduceat(np.where(near, np.arange(len(face)), len(face)), starts)
    return np.repeat(bone[first], sizes)


def _distances(points: numerics.Array, segments: numerics.Array) -> numerics.Array:
    """Return (k,) distances of (k, 3) points, each from its segment, (k, 2, 3)."""
    start = segments[:, 0]
    way = segments[:, 1] - segments[:, 0]
    away = points - start
    squared = (way * way).sum(axis=1)
    share = np.clip((away * way).sum(axis=1) / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)
    return np.linalg.norm(away - share[:, None] * way, axis=1)
