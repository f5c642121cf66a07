# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assignment of faces of a skinned surface to bones: to the bone with the most weight at their corners.

If weights tie, the nearer bone counts, so that the two sides of a symmetric character are cut alike; faces that no
bone has any weight on go with the nearest bone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.arguments import check_type, float_array, index_array
from ..numerics.arrays import sums_by_index

TIE_RTOL = 1e-5  # weights are float32, and a mirrored face adds them up in another order
NEAR_RTOL = 1e-5  # Relative to a distance: the effect of float32 coordinates.
PAIRS_PER_BLOCK = 1 << 20  # faces times bones whose distances are in memory at a time


@dataclass(frozen=True, eq=False)
class VertexWeights:
    """Weights of bones on vertices, each of which may have several; a vertex and a bone appear together once.

    Parameters
    ----------
    vertex : (w,) integer array
        Sorted.
    bone : (w,) integer array
    weight : (w,) float array
        Not negative.

    Examples
    --------
    >>> from body_moments.core.rig import VertexWeights
    >>> VertexWeights(np.array([0, 0, 2]), np.array([0, 1, 1]), np.array([3.0, 1.0, 0.5])).normalized().tolist()
    [0.75, 0.25, 1.0]
    """

    vertex: NDArray[np.integer]
    bone: NDArray[np.integer]
    weight: NDArray[np.floating]

    def __post_init__(self) -> None:
        vertex = index_array("vertex", self.vertex, "w")
        object.__setattr__(self, "vertex", vertex)
        object.__setattr__(self, "bone", index_array("bone", self.bone, len(vertex)))
        object.__setattr__(self, "weight", float_array("weight", self.weight, len(vertex)))

    def normalized(self) -> NDArray[np.float64]:
        """Return (w,) the weights divided by their sum at each vertex, as an armature deforms."""
        total = np.bincount(self.vertex, self.weight)[self.vertex]
        return np.divide(self.weight, total, out=np.zeros_like(self.weight), where=total > 0.0)

    def unweighted(self, count: int) -> NDArray[np.intp]:
        """Return the vertices below `count` that no bone has any weight on."""
        return np.flatnonzero(np.bincount(self.vertex, self.weight, minlength=count)[:count] == 0.0)


def dominant_bones(
    faces: ArrayLike,
    corners: ArrayLike,
    points: ArrayLike,
    weights: VertexWeights,
    bones: ArrayLike,
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the bone of each face.

    Parameters
    ----------
    faces, corners : (c,) array_like of int
        Of each corner of the surface, the face, 0 to f - 1, and the vertex. A face without corners has no bone.
    points : (n, 3) array_like
        Positions of the vertices, in the coordinates of the bones.
    weights : VertexWeights
    bones : (b, 2, 3) array_like
        Begin and end of each bone.

    Returns
    -------
    bone : (f,) integer array
        -1 for a face without corners.
    by_distance : (k,) integer array
        The faces without any weight, which went with the nearest bone.

    Examples
    --------
    >>> from body_moments.core.rig import VertexWeights, dominant_bones
    >>> weights = VertexWeights(np.array([0, 1, 1]), np.array([0, 0, 1]), np.array([1.0, 0.2, 0.8]))
    >>> points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    >>> bones = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [[9.0, 0.0, 0.0], [9.0, 0.0, 1.0]]])
    >>> dominant_bones(np.zeros(3, int), np.arange(3), points, weights, bones)[0].tolist()
    [0]
    """
    check_type("weights", weights, VertexWeights)
    points, bones = float_array("points", points, "n", 3), float_array("bones", bones, "b", 2, 3)
    faces = index_array("faces", faces, "c")
    corners = index_array("corners", corners, len(faces), count=len(points))
    number = len(bones)
    size = np.bincount(faces)
    center = np.stack([np.bincount(faces, points[corners, k]) / np.maximum(size, 1) for k in range(3)], axis=1)
    face, bone, score = _scores(faces, corners, weights, number)
    result = np.full(len(size), -1)
    starts, sizes = np.unique(face, return_index=True, return_counts=True)[1:]
    leading = score >= (1.0 - TIE_RTOL) * np.repeat(np.maximum.reduceat(score, starts), sizes)
    face, bone = face[leading], bone[leading]
    result[face] = bone
    rivals = np.bincount(face)[face] > 1
    face, bone = face[rivals], bone[rivals]
    result[face] = _nearest(face, bone, _distances(center[face], bones[bone]))
    left = np.flatnonzero((result < 0) & (size > 0))
    block = max(PAIRS_PER_BLOCK // number, 1)
    for start in range(0, len(left), block):
        some = left[start : start + block]
        pairs = np.repeat(some, number), np.tile(np.arange(number), len(some))
        result[pairs[0]] = _nearest(*pairs, _distances(center[pairs[0]], bones[pairs[1]]))
    return result, left


def _scores(
    faces: NDArray[np.integer], corners: NDArray[np.integer], weights: VertexWeights, number: int
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """Return the faces and bones with any weight together, by face and then by bone, and the sum of their weights."""
    per_vertex = np.bincount(weights.vertex, minlength=int(corners.max(initial=-1)) + 1)
    first = np.cumsum(per_vertex) - per_vertex
    repeats = per_vertex[corners]
    owner = np.repeat(np.arange(len(corners)), repeats)
    entry = np.arange(len(owner)) - np.repeat(np.cumsum(repeats) - repeats, repeats) + first[corners][owner]
    key = faces[owner].astype(np.int64) * number + weights.bone[entry]
    pairs, place = np.unique(key, return_inverse=True)
    score = sums_by_index(place, weights.normalized()[entry])
    positive = score > 0.0
    face, bone = np.divmod(pairs[positive].astype(np.intp), number)
    return face, bone, score[positive]


def _nearest(face: NDArray[np.integer], bone: NDArray[np.integer], away: NDArray[np.float64]) -> NDArray[np.integer]:
    """Return (k,) for each row, sorted by face, the nearest bone of its face, the first of equally near ones."""
    starts, sizes = np.unique(face, return_index=True, return_counts=True)[1:]
    least = np.repeat(np.minimum.reduceat(away, starts), sizes)
    near = away <= least * (1.0 + NEAR_RTOL)
    first = np.minimum.reduceat(np.where(near, np.arange(len(face)), len(face)), starts)
    return np.repeat(bone[first], sizes)


def _distances(points: NDArray[np.float64], segments: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (k,) how far each point is from its segment (k, 2, 3)."""
    start, way = segments[:, 0], segments[:, 1] - segments[:, 0]
    away = points - start
    length = (way * way).sum(axis=1)
    share = np.clip((away * way).sum(axis=1) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    return np.linalg.norm(away - share[:, None] * way, axis=1)
