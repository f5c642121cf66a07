# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that are one in space, and faces that are one: what triangle soup, text and NURBS meshes need.

Positions that differ by rounding are found on eight grids, each shifted by half a cell along some of the axes: two
points nearer than half a cell share a cell of at least one of them. Faces are one where the sums of two hashes over
their vertices agree.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import first_occurrence, hash_uint64
from ..numerics.graph import connected_components

WELD_LIMIT_RTOL = 1e-3  # of the smallest triangle at a vertex: nothing larger is ever closed up


def first_at_equal_position(points: NDArray[np.floating]) -> NDArray[np.intp]:
    """(n,) for each point the first one at exactly the same place; -0.0 is 0.0."""
    return first_occurrence(*(points[:, k].astype(np.float64) + 0.0 for k in range(3)))  # -0.0 + 0.0 = 0.0


def first_at_near_position(points: NDArray[np.floating], tolerance: NDArray[np.float64]) -> NDArray[np.intp]:
    """(n,) for each point the first one of its cluster; points nearer than both their tolerances (n,) cluster."""
    place = points.astype(np.float64)
    place = place - place.min(axis=0)
    cell = 2.0 * tolerance.max()
    left, right = [], []
    for shift in np.ndindex(2, 2, 2):
        grid = np.floor(place / cell + 0.5 * np.array(shift))
        first = first_at_equal_position(grid)
        distance = np.linalg.norm(place - place[first], axis=1)
        near = (distance <= np.minimum(tolerance, tolerance[first])) & (first != np.arange(len(points)))
        left.append(first[near])
        right.append(np.flatnonzero(near))
    cluster, number = connected_components(len(points), np.concatenate(left), np.concatenate(right))
    first = np.empty(number, np.intp)
    first[cluster[::-1]] = np.arange(len(points))[::-1]  # of equal indices the last is kept: here the first point
    return first[cluster]


def vertex_tolerance(
    points: NDArray[np.floating], triangles: NDArray[np.integer], vertices: NDArray[np.integer], tolerance: float
) -> NDArray[np.float64]:
    """(k,) how far each of `vertices` may move: `tolerance`, less where the triangles around it are small.

    A part much smaller than the body must not be welded away.
    """
    requested = np.zeros(len(points), bool)
    requested[vertices] = True
    triangles = triangles[requested[triangles].any(axis=1)]
    corners = points[triangles].astype(np.float64)
    longest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    size = np.full(len(points), np.inf)
    np.minimum.at(size, triangles.ravel(), np.repeat(longest, 3))
    return np.minimum(tolerance, WELD_LIMIT_RTOL * size[vertices])


def same_vertices_groups(triangles: NDArray[np.integer], faces: NDArray[np.integer]) -> NDArray[np.intp]:
    """(m,) for each triangle a number that it shares with the triangles of all mesh faces on the same vertices.

    faces: (m,) the mesh face of each triangle. The number is the first such face.
    """
    width = int(faces.max()) + 1
    pieces = np.bincount(faces)
    single = pieces[faces] == 1
    sums = np.zeros((2, width), np.uint64)
    for k, salt in enumerate((np.uint64(0), np.uint64(1) << np.uint64(32))):
        hashes = hash_uint64(triangles[single].astype(np.uint64) + salt)
        sums[k, faces[single]] = hashes[:, 0] + hashes[:, 1] + hashes[:, 2]
    if not single.all():
        vertices = int(triangles.max()) + 1
        corner = np.unique(np.repeat(faces[~single], 3).astype(np.int64) * vertices + triangles[~single].ravel())
        owner = corner // vertices
        begin = np.flatnonzero(np.concatenate([[True], owner[1:] != owner[:-1]]))
        for k, salt in enumerate((np.uint64(0), np.uint64(1) << np.uint64(32))):
            sums[k, owner[begin]] = np.add.reduceat(hash_uint64((corner % vertices).astype(np.uint64) + salt), begin)
    present = np.flatnonzero(pieces)
    group = np.empty(width, np.intp)
    group[present] = present[first_occurrence(*sums[:, present])]
    return group[faces]
