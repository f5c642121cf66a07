# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A closed surface cut into closed pieces, one for each bone.

The faces of a bone are bounded by the edges that they share with other bones' faces. Cut edges that meet, whatever
their bones, belong to one cut, which is closed to one apex, its centroid. Each bone gets the cone on its side of every
edge, so that pieces are closed, the cones of neighbors cancel, and the pieces add up to the whole, exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh.edges import find_edges
from ..mesh.surface import Surface
from ..moments.moments import Moments
from ..numerics.graph import connected_components
from ..polyhedron.integration import polyhedron_moments

NO_BONE = -1


@dataclass(frozen=True, eq=False)
class BonePiece:
    """The closed surface, in float64, that goes with one bone: its faces, and the cones that close it.

    face_count: the number of triangles that are faces; they come first, then the cones.
    """

    bone: int
    surface: Surface
    face_count: int

    def moments(self, order: int = 3) -> Moments:
        """Return the moments of its volume, about the middle of its bounding box in the surface's coordinates."""
        return polyhedron_moments(self.surface, order, exact=True)[0]


def bone_pieces(
    points: NDArray[np.floating],
    triangles: NDArray[np.integer],
    bone: NDArray[np.integer],
    displacement: NDArray | None = None,
) -> list[BonePiece]:
    """Cut (t, 3) outward triangles with (t,) bones into closed pieces; displacement: (3,) by storing."""
    points = points.astype(np.float64)
    owner, start, stop = _cut_edges(len(points), triangles, bone)
    cut, apexes = _apexes(points, start, stop)
    corners = np.concatenate([triangles, np.stack([stop, start, len(points) + cut], axis=1)])
    labels = np.concatenate([bone, owner])
    points = np.concatenate([points, apexes])
    order = np.argsort(labels, kind="stable")
    bones, starts = np.unique(labels[order], return_index=True)
    faces = np.bincount(bone)
    pieces = []
    for one, rows in zip(bones.tolist(), np.split(order, starts[1:])):
        used, local = np.unique(corners[rows], return_inverse=True)
        surface = Surface(points[used], local.reshape(-1, 3), displacement=displacement)
        pieces.append(BonePiece(one, surface, int(faces[one])))
    return pieces


def bones_of_caps(
    triangles: NDArray[np.integer], is_cap: NDArray[np.bool_], bone: NDArray[np.integer]
) -> NDArray[np.intp]:
    """Return (t,) bones of triangles: caps, which close holes, get the bones of the faces beside them."""
    result = np.where(is_cap, NO_BONE, bone)
    edge = find_edges(triangles).of_side.reshape(-1, 3)
    while (result == NO_BONE).any():
        known = result != NO_BONE
        of_edge = np.full(int(edge.max()) + 1, NO_BONE)
        of_edge[edge[known].ravel()] = np.repeat(result[known], 3)
        found = of_edge[edge[~known]].max(axis=1)
        if (found == NO_BONE).all():  # Caps that touch nothing go with the bone of most faces.
            found[:] = np.bincount(bone[~is_cap], minlength=1).argmax()
        result[~known] = found
    return result


def _cut_edges(
    count: int, triangles: NDArray[np.integer], bone: NDArray[np.integer]
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Return (k,) bones, starts and ends of the sides of each bone's triangles that no opposite side cancels."""
    start = triangles.ravel().astype(np.int64)
    stop = np.roll(triangles, -1, axis=1).ravel().astype(np.int64)
    shape = int(bone.max(initial=0)) + 1, count, count
    key = np.ravel_multi_index((np.repeat(bone, 3), np.minimum(start, stop), np.maximum(start, stop)), shape)
    edges, place = np.unique(key, return_inverse=True)
    left = np.bincount(place, np.where(start < stop, 1.0, -1.0)).astype(np.intp)
    owner, low, high = np.unravel_index(np.repeat(edges, np.abs(left)), shape)
    forward = np.repeat(left, np.abs(left)) > 0
    return owner, np.where(forward, low, high), np.where(forward, high, low)


def _apexes(
    points: NDArray[np.float64], start: NDArray[np.intp], stop: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Return the cut that each edge belongs to, and (c, 3) the centroids of the cuts' edges."""
    if not len(start):
        return np.zeros(0, np.intp), np.zeros((0, 3))
    vertices, ends = np.unique(np.concatenate([start, stop]), return_inverse=True)
    first, last = ends.reshape(2, -1)
    cut = connected_components(len(vertices), first, last)[0][first]
    # An edge counts once, however many bones meet there.
    edges = np.unique(np.stack([np.minimum(start, stop), np.maximum(start, stop), cut], axis=1), axis=0)
    begin, end = points[edges[:, 0]], points[edges[:, 1]]
    origin = points[vertices].mean(axis=0)  # far from the world's origin, digits would be lost
    length = np.maximum(np.linalg.norm(end - begin, axis=1), np.finfo(float).tiny)
    weight = np.bincount(edges[:, 2], length)
    middle = (begin - origin + (end - origin)) / 2.0
    sums = np.stack([np.bincount(edges[:, 2], length * middle[:, k]) for k in range(3)], axis=1)
    return cut, origin + sums / weight[:, None]
