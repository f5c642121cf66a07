# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls of points in space, of one set or of many sets at once, and of points in a plane.

The points are rounded to the grid of `quickhull`. The points themselves are not changed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics import Array, ArrayLike, Index, float_array
from ..verdict import MeasureError
from .findings import HULL_WITHOUT_EXTENT
from .quickhull import GRID_BITS, GrowingHull, first_corners


@dataclass(frozen=True, eq=False)
class ConvexHull:
    """A closed convex surface of triangles; for points in one plane, both sides of their polygon.

    points, indices: (h, 3) corners as given, and (h,) their indices in the input. triangles: (m, 3)
    rows of `points`, counter-clockwise from outside. neighbors: (m, 3) the triangle across each
    side: from corner 0 to 1, from 1 to 2, from 2 to 0. is_flat: True if all points are in one
    plane. gap: bound of the distances of points from the hull, above the tolerance if the limit of
    corners was reached.
    """

    points: Array
    indices: Index
    triangles: Index
    neighbors: Index
    is_flat: bool
    gap: float

    def transform(self, linear: ArrayLike) -> ConvexHull:
        """Return the hull of the images of the points under (3, 3) `linear` @ x, which may mirror,
        but not flatten.
        """
        matrix = float_array("linear", linear, 3, 3, finite=True)
        is_mirrored = bool(np.linalg.det(matrix) < 0.0)
        return replace(
            self,
            points=self.points @ matrix.T,
            triangles=self.triangles[:, ::-1] if is_mirrored else self.triangles,
            # The sides of the triangle c, b, a are b to c, a to b and c to a of the old one.
            neighbors=self.neighbors[:, [1, 0, 2]] if is_mirrored else self.neighbors,
            gap=self.gap * float(np.linalg.norm(matrix, 2)),
        )


def convex_hull(
    points: ArrayLike, tolerance: float = 1e-8, max_corners: int | None = None
) -> ConvexHull:
    """Compute the convex hull of points.

    Parameters
    ----------
    points : (n, 3) array_like
        Finite.
    tolerance : float
        Relative to the largest extent: points outside by less are left out. Below 1e-8 the grid's
        steps show.
    max_corners : int, optional
        Limit of the corners; the points that are outside by the least are left out.

    Returns
    -------
    ConvexHull

    Raises
    ------
    MeasureError
        If the points are all on one line, or there are none.

    Examples
    --------
    >>> from body_moments.core.mesh import convex_hull
    >>> len(convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 0]]).triangles)
    2
    """
    points = float_array("points", points, "n", 3, finite=True)
    extent = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if not extent > 0.0:
        raise MeasureError(HULL_WITHOUT_EXTENT)
    grid = np.rint((points - points.min(axis=0)) / extent * 2.0**GRID_BITS).astype(np.int64)
    step = tolerance * 2.0**GRID_BITS
    corners = first_corners(grid.astype(np.float64), max(step, 1.0))
    if len(corners) == 2:
        raise MeasureError(HULL_WITHOUT_EXTENT)
    if len(corners) == 3:
        return _flat_hull(points, corners, tolerance)
    hull = GrowingHull(grid, np.array([corners]), np.zeros(len(grid), np.intp), step)
    most = np.inf if max_corners is None else max_corners
    while hull.corner_count < most and hull.add_points(most - hull.corner_count):
        pass
    indices, triangles = np.unique(hull.corners, return_inverse=True)
    gap = max(float(hull.height.max(initial=0.0)) / 2.0**GRID_BITS, tolerance) * extent
    return ConvexHull(
        points[indices], indices, triangles.reshape(-1, 3), hull.neighbors, is_flat=False, gap=gap
    )


def hull_volumes(points: Array, starts: Index, tolerance: float) -> Array:
    """Return the hull volumes of (k,) sets of points, which begin at the rows `starts`; all hulls
    grow at once.

    tolerance: relative to the extent of each set, as for `convex_hull`. A flat set has no volume.
    """
    sizes = np.diff(np.append(starts, len(points)))
    low = np.minimum.reduceat(points, starts)
    extent = (np.maximum.reduceat(points, starts) - low).max(axis=1)
    steps_per_unit = 2.0**GRID_BITS / np.where(extent > 0.0, extent, 1.0)
    offsets = points - low.repeat(sizes, axis=0)
    grid = np.rint(offsets * steps_per_unit.repeat(sizes)[:, None]).astype(np.int64)
    step = max(tolerance * 2.0**GRID_BITS, 1.0)
    volumes = np.zeros(len(starts))
    tetrahedra: list[list[int]] = []
    solid: list[int] = []  # the sets that are not flat
    for i, (start, size) in enumerate(zip(starts.tolist(), sizes.tolist())):
        if size > 3 and extent[i] > 0.0:
            corners = first_corners(grid[start : start + size].astype(np.float64), step)
            if len(corners) == 4:
                tetrahedra.append([start + corner for corner in corners])
                solid.append(i)
    if not solid:
        return volumes
    number = np.full(len(starts), -1)
    number[solid] = np.arange(len(solid))
    owner = number.repeat(sizes)
    hull = GrowingHull(grid, np.array(tetrahedra), owner, step)
    while hull.add_points():
        pass
    a, b, c = (grid[hull.corners[:, k]].astype(np.float64) for k in range(3))
    face_owner = owner[hull.corners[:, 0]]
    apex = grid[np.array(tetrahedra)[face_owner, 0]].astype(np.float64)
    cones = np.einsum("ij,ij->i", a - apex, np.cross(b - apex, c - apex)) / 6.0
    volumes[solid] = np.bincount(face_owner, cones, len(solid)) / steps_per_unit[solid] ** 3
    return volumes


def _flat_hull(points: Array, corners: list[int], tolerance: float) -> ConvexHull:
    """Return both sides of the polygon around points in the plane of three of them."""
    a, b, c = points[corners]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    first = (b - a) / np.linalg.norm(b - a)
    plane = (points - a) @ np.stack([first, np.cross(normal, first)], axis=1)
    indices = convex_polygon(plane, tolerance)
    count = len(indices) - 2
    fan = np.stack([np.zeros(count, np.intp), np.arange(count) + 1, np.arange(count) + 2], axis=1)
    above, below = np.arange(2 * count).reshape(2, -1)
    # A fan's first and last triangles meet those of the other side at the polygon's border.
    before_above, after_above = np.append(below[0], above[:-1]), np.append(above[1:], below[-1])
    before_below, after_below = np.append(above[0], below[:-1]), np.append(below[1:], above[-1])
    return ConvexHull(
        points[indices],
        indices,
        triangles=np.concatenate([fan, fan[:, [0, 2, 1]]]),
        neighbors=np.concatenate(
            [
                np.stack([before_above, below, after_above], axis=1),
                np.stack([after_below, above, before_below], axis=1),
            ]
        ),
        is_flat=True,
        gap=tolerance * float(np.ptp(points, axis=0).max()),
    )


def convex_polygon(points: Array, tolerance: float = 0.0) -> Index:
    """Return (k,) indices of the counter-clockwise corners of (n, 2) points; two on a line, one if
    all are the same. tolerance: relative to the extent; points outside by less are left out.
    """
    ends = np.lexsort((points[:, 1], points[:, 0]))[[0, -1]]
    least = tolerance * float(np.ptp(points, axis=0).max())
    if np.abs(points[ends[1]] - points[ends[0]]).max() <= least:
        return ends[:1]
    corners = ends
    # The points that may be outside, each with a side of the polygon: numbered by its first corner.
    point = np.repeat(np.arange(len(points)), 2)
    side = np.tile([0, 1], len(points))
    # A height below this may be the rounding of the differences that it is made of.
    rounding = 4.0 * np.finfo(np.float64).eps * np.abs(points).max()
    while True:
        start = points[corners[side]]
        along = points[np.roll(corners, -1)[side]] - start
        offset = points[point] - start
        length = np.linalg.norm(along, axis=1)
        height = (offset[:, 0] * along[:, 1] - offset[:, 1] * along[:, 0]) / np.where(
            length > 0.0, length, 1.0
        )
        outside = height > max(least, rounding)
        if not outside.any():
            return np.roll(corners, -int(corners.argmin()))
        point = point[outside]
        side = side[outside]
        order = np.lexsort((height[outside], side))
        is_highest = np.append(side[order][1:] != side[order][:-1], True)
        split_sides = side[order[is_highest]]
        corners = np.insert(corners, split_sides + 1, point[order[is_highest]])
        # Each point goes on with both halves of its side.
        side = np.repeat(side + np.searchsorted(split_sides, side), 2)
        side[1::2] += 1
        point = np.repeat(point, 2)
