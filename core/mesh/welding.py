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
    Integers,
    Mask,
    NDArray,
    connected_components,
    first_occurrence,
    hash_uint64,
    lengths,
    run_starts,
    sorted_distinct,
)

# Points near to each other are near along this direction, too; planes and axes of usual bodies are
# not across it.
DIRECTION = 0.5477, 0.3163, 0.7746
REACH_MARGIN = 1.01  # allows for the rounding of places along the direction, and of its length
CELL_DIAGONAL = 3.5  # in tolerances, above 2 √3: a cell has sides of two
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

    reach: one distance, or (n,), the same for all points of an owner.
    """
    x, y, z = points.T.astype(np.float64)
    along = x * DIRECTION[0] + y * DIRECTION[1] + z * DIRECTION[2]
    order = along.argsort() if owner is None else np.lexsort((along, owner))
    along = along[order]
    reach = reach[order[1:]] if isinstance(reach, np.ndarray) else reach
    near = np.flatnonzero(along[1:] - along[:-1] <= REACH_MARGIN * reach)
    if owner is not None:
        near = near[owner[order[near]] == owner[order[near + 1]]]
    has_near = np.zeros(len(points), bool)
    has_near[order[near]] = has_near[order[near + 1]] = True
    return has_near


def first_at_near_position(points: NDArray[np.floating], tolerance: Array) -> Index:
    """Return (n,) for each point the first of its cluster of points nearer to each other than (n,)
    tolerances.
    """
    place = points.astype(np.float64)
    place = place - place.min(axis=0)
    cell = 2.0 * tolerance.max()
    if not cell:
        return first_at_equal_position(place)
    first = np.arange(len(points))
    chosen = np.flatnonzero(may_have_neighbor(place, CELL_DIAGONAL * tolerance.max()))
    if len(chosen):
        first[chosen] = chosen[_first_of_clusters(place[chosen], tolerance[chosen], cell)]
    return first


def _first_of_clusters(place: Array, tolerance: Array, cell: float) -> Index:
    """Return the (n,) points of `first_at_near_position`, on grids of cells of this size."""
    point = np.arange(len(place))
    left, right = [], []
    for shift in np.ndindex(2, 2, 2):
        first = first_at_equal_position(np.floor(place / cell + 0.5 * np.array(shift)))
        distance = np.linalg.norm(place - place[first], axis=1)
        is_near = distance <= np.minimum(tolerance, tolerance[first])
        is_near &= first != point
        left.append(first[is_near])
        right.append(point[is_near])
    cluster, number = connected_components(len(place), np.concatenate(left), np.concatenate(right))
    first = np.empty(number, np.intp)
    first[cluster[::-1]] = point[::-1]  # the last write wins: the first point
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
    is_asked = np.zeros(len(points), bool)
    is_asked[vertices] = True
    triangles = triangles[is_asked[triangles].any(axis=1)]
    corners = points[triangles].astype(np.float64)
    longest_side = lengths(corners - corners.take(NEXT_AXIS, 1))[..., 0].max(axis=1)
    smallest = np.full(len(points), np.inf)
    np.minimum.at(smallest, triangles.ravel(), np.repeat(longest_side, 3))
    return np.minimum(tolerance, WELD_LIMIT_RTOL * smallest[vertices])


def same_vertices_groups(triangles: NDArray[np.integer], faces: NDArray[np.integer]) -> Index:
    """Return for m triangles the first mesh faces on the same vertices as their own mesh faces,
    `faces` (m,).
    """
    face_count = int(faces.max()) + 1
    triangle_counts = np.bincount(faces)
    is_triangle = triangle_counts[faces] == 1
    sums = np.zeros((2, face_count), np.uint64)
    hashes = _vertex_hashes(triangles[is_triangle])
    sums[:, faces[is_triangle]] = hashes[..., 0] + hashes[..., 1] + hashes[..., 2]
    if not is_triangle.all():
        # The triangles of a polygon share vertices: each counts once.
        vertex_count = int(triangles.max()) + 1
        keys = sorted_distinct(
            np.repeat(faces[~is_triangle], 3).astype(np.int64) * vertex_count
            + triangles[~is_triangle].ravel()
        )
        face = keys // vertex_count
        begin = run_starts(face)
        hashes = _vertex_hashes(keys % vertex_count)
        sums[:, face[begin]] = np.add.reduceat(hashes, begin, axis=1)
    present = np.flatnonzero(triangle_counts)
    group = np.empty(face_count, np.intp)
    group[present] = present[first_occurrence(*sums[:, present])]
    return group[faces]


def _vertex_hashes(vertices: Integers) -> NDArray[np.uint64]:
    """Return (2, …) two independent hashes of vertex numbers below 2^32."""
    salts = np.array([0, 1 << 32], np.uint64).reshape(2, *[1] * vertices.ndim)
    return hash_uint64(vertices.astype(np.uint64) + salts)
