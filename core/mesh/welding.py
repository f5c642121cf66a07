# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices at the same position, and faces on the same vertices, as in triangle soup, text and
NURBS meshes.

Positions that differ by rounding are found on eight grids, each shifted by half a cell along some
of the axes: points that are within half a cell along each axis share a cell of at least one of
them. Within a cell, points are compared only with its first one. Only points with neighbors along a
line enter grids: most meshes have none. Faces are copies if the sums of two hashes over their
vertices agree.
"""

import numpy as np

from ..numerics import (
    NEXT_AXIS,
    Array,
    Index,
    Mask,
    NDArray,
    connected_components,
    first_occurrence,
    hash_uint64,
    lengths,
    sorted_distinct,
)

# Points near to each other are near along this direction, too; planes and axes of usual bodies are
# not across it.
DIRECTION = 0.5477, 0.3163, 0.7746
REACH_MARGIN = 1.01  # allows for the rounding of places along the direction, and of its length
CELL_DIAGONAL = 3.5  # tolerances, two to a side: farther apart than any two points of one cell
WELD_LIMIT_RTOL = 1e-3  # relative to the smallest triangle at a vertex: larger gaps stay


def first_at_equal_position(points: NDArray[np.floating]) -> Index:
    """Return the (n,) first points at exactly the same places as the points; -0.0 equals 0.0."""
    # -0.0 + 0.0 = 0.0
    return first_occurrence(*(points[:, k].astype(np.float64) + 0.0 for k in range(3)))


def may_have_neighbor(
    points: NDArray[np.floating],
    reach: float | Array,
    owner: NDArray[np.integer] | None = None,
) -> Mask:
    """Return an (n,) mask of all points with another point of their owner within `reach`, and of
    some more points.
    """
    x, y, z = points.T.astype(np.float64)
    along = x * DIRECTION[0] + y * DIRECTION[1] + z * DIRECTION[2]
    order = along.argsort() if owner is None else np.lexsort((along, owner))
    along = along[order]
    reach = reach[order[1:]] if isinstance(reach, np.ndarray) else reach
    near = np.flatnonzero(along[1:] - along[:-1] <= REACH_MARGIN * reach)
    if owner is not None:
        near = near[owner[order[near]] == owner[order[near + 1]]]
    result = np.zeros(len(points), bool)
    result[order[near]] = result[order[near + 1]] = True
    return result


def first_at_near_position(points: NDArray[np.floating], tolerance: Array) -> Index:
    """Return (n,) for each point the first of its cluster of points nearer to each other than (n,)
    tolerances.
    """
    place = points.astype(np.float64)
    place = place - place.min(axis=0)
    cell = 2.0 * tolerance.max()
    if not cell:
        return first_at_equal_position(place)
    chosen = np.flatnonzero(may_have_neighbor(place, CELL_DIAGONAL * tolerance.max()))
    if len(chosen) < len(points):
        first = np.arange(len(points))
        if len(chosen):
            first[chosen] = chosen[_first_of_clusters(place[chosen], tolerance[chosen], cell)]
        return first
    return _first_of_clusters(place, tolerance, cell)


def _first_of_clusters(place: Array, tolerance: Array, cell: float) -> Index:
    """Return the (n,) points of `first_at_near_position`, on grids of cells of this size."""
    left, right = [], []
    for shift in np.ndindex(2, 2, 2):
        first = first_at_equal_position(np.floor(place / cell + 0.5 * np.array(shift)))
        distance = np.linalg.norm(place - place[first], axis=1)
        near = (distance <= np.minimum(tolerance, tolerance[first])) & (
            first != np.arange(len(place))
        )
        left.append(first[near])
        right.append(np.flatnonzero(near))
    cluster, number = connected_components(len(place), np.concatenate(left), np.concatenate(right))
    first = np.empty(number, np.intp)
    first[cluster[::-1]] = np.arange(len(place))[::-1]  # the last write wins: the first point
    return first[cluster]


def vertex_tolerance(
    points: NDArray[np.floating],
    triangles: NDArray[np.integer],
    vertices: NDArray[np.integer],
    tolerance: float,
) -> Array:
    """Return the (k,) distances that `vertices` may move: `tolerance`, less if the triangles around
    them are small.
    """
    requested = np.zeros(len(points), bool)
    requested[vertices] = True
    triangles = triangles[requested[triangles].any(axis=1)]
    corners = points[triangles].astype(np.float64)
    longest = lengths(corners - corners.take(NEXT_AXIS, 1))[..., 0].max(axis=1)
    size = np.full(len(points), np.inf)
    np.minimum.at(size, triangles.ravel(), np.repeat(longest, 3))
    return np.minimum(tolerance, WELD_LIMIT_RTOL * size[vertices])


def same_vertices_groups(triangles: NDArray[np.integer], faces: NDArray[np.integer]) -> Index:
    """Return for m triangles the first mesh faces on the same vertices as their own mesh faces,
    `faces` (m,).
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
        corner = sorted_distinct(
            np.repeat(faces[~single], 3).astype(np.int64) * vertices + triangles[~single].ravel()
        )
        owner = corner // vertices
        begin = np.flatnonzero(np.concatenate([[True], owner[1:] != owner[:-1]]))
        for k, salt in enumerate((np.uint64(0), np.uint64(1) << np.uint64(32))):
            sums[k, owner[begin]] = np.add.reduceat(
                hash_uint64((corner % vertices).astype(np.uint64) + salt), begin
            )
    present = np.flatnonzero(pieces)
    group = np.empty(width, np.intp)
    group[present] = present[first_occurrence(*sums[:, present])]
    return group[faces]
