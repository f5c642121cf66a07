# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls of points in space, by quickhull with many points at a time and exact decisions.

Quickhull (Barber, Dobkin and Huhdanpaa 1996) adds the farthest point outside each face. Each round
here adds, in a few operations on arrays, all such points that see no face in common, and no face
across another point's horizon. Their order does not matter, because a face over a horizon's edge is
a positive combination of the two faces at the edge.

The points are rounded to a grid of 2^29 steps over the largest extent. On this grid, integers
decide without rounding on which side of a face a point lies, so the result is always a closed
convex surface. The points themselves are not changed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics import (
    NEXT_AXIS,
    Array,
    ArrayLike,
    Index,
    Int64,
    Mask,
    NDArray,
    batches,
    cross,
    float_array,
    segment_ranges,
    sorted_distinct,
)
from ..verdict import MeasureError
from .findings import HULL_WITHOUT_EXTENT

GRID_BITS = 29
LOW_BITS = (1 << GRID_BITS) - 1
PAIRS_PER_BLOCK = 1 << 18


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
    corners = _first_corners(grid.astype(np.float64), max(step, 1.0))
    if len(corners) == 2:
        raise MeasureError(HULL_WITHOUT_EXTENT)
    if len(corners) == 3:
        return _flat_hull(points, corners, tolerance)
    hull = _GrowingHull(grid, np.array([corners]), np.zeros(len(grid), np.intp), step)
    while max_corners is None or len(hull.corners) // 2 + 2 < max_corners:
        if not hull.add_points(
            None if max_corners is None else max_corners - len(hull.corners) // 2 - 2
        ):
            break
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
    steps = 2.0**GRID_BITS / np.where(extent > 0.0, extent, 1.0)
    grid = np.rint((points - low.repeat(sizes, axis=0)) * steps.repeat(sizes)[:, None]).astype(
        np.int64
    )
    step = max(tolerance * 2.0**GRID_BITS, 1.0)
    volumes = np.zeros(len(starts))
    corners: list[list[int]] = []
    solid: list[int] = []
    for i, (start, size) in enumerate(zip(starts.tolist(), sizes.tolist())):
        if size > 3 and extent[i] > 0.0:
            first = _first_corners(grid[start : start + size].astype(np.float64), step)
            if len(first) == 4:
                corners.append([start + corner for corner in first])
                solid.append(i)
    if not solid:
        return volumes
    number = np.full(len(starts), -1)
    number[solid] = np.arange(len(solid))
    owner = number.repeat(sizes)
    hull = _GrowingHull(grid, np.array(corners), owner, step)
    while hull.add_points():
        pass
    a, b, c = (grid[hull.corners[:, k]].astype(np.float64) for k in range(3))
    whose = owner[hull.corners[:, 0]]
    apex = grid[np.array(corners)[whose, 0]].astype(np.float64)
    sixth = np.einsum("ij,ij->i", a - apex, np.cross(b - apex, c - apex)) / 6.0
    volumes[solid] = np.bincount(whose, sixth, len(solid)) / steps[solid] ** 3
    return volumes


def _first_corners(grid: Array, least: float) -> list[int]:
    """Return four points that span a volume; three or two if all are nearer than `least` to their
    plane or line.
    """
    ends = np.concatenate([grid.argmin(axis=0), grid.argmax(axis=0)])
    apart = np.linalg.norm(grid[ends][:, None] - grid[ends], axis=2)
    first, second = (int(ends[place]) for place in np.unravel_index(apart.argmax(), apart.shape))
    along = (grid[second] - grid[first]) / apart.max()
    offsets = grid - grid[first]
    across = offsets - (offsets @ along)[:, None] * along
    distances = np.linalg.norm(across, axis=1)
    reach = ((grid - 2.0 ** (GRID_BITS - 1)) ** 2).sum(axis=1)
    third = _farthest(distances, reach, least)
    if distances[third] <= least:
        return [first, second]
    heights = offsets @ np.cross(along, across[third] / distances[third])
    fourth = _farthest(np.abs(heights), reach, least)
    if abs(heights[fourth]) <= least:
        return [first, second, third]
    return (
        [first, second, third, fourth] if heights[fourth] < 0.0 else [first, third, second, fourth]
    )


def _farthest(distances: NDArray, reach: NDArray, least: float) -> int:
    """Return the index of the largest distance; among distances equal within `least`, the largest
    reach: a corner.
    """
    equal = np.flatnonzero(distances >= distances.max() - least)
    return int(equal[reach[equal].argmax()])


class _GrowingHull:
    """Hulls on the grid, one for each set of points; and the points still outside, each with a face
    that it sees.

    first: (k, 4) corners of a tetrahedron in each set. owner: (n,) the set of each point, or -1 to
    leave it out. corners: (m, 3) of the faces. normals: (m, 3) exact integers. outside, seen,
    height: the outside points, their faces, and their heights in steps of the grid. reach: squared
    distances of all points from the middle.
    """

    def __init__(self, grid: Int64, first: Index, owner: Index, step: float) -> None:
        self.grid, self.step = grid, step
        self.reach = ((grid.astype(np.float64) - 2.0 ** (GRID_BITS - 1)) ** 2).sum(axis=1)
        self.corners = first[:, [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]].reshape(-1, 3)
        beyond = np.array([[1, 2, 3], [3, 2, 0], [1, 3, 0], [2, 1, 0]], np.intp)
        self.neighbors = (4 * np.arange(len(first))[:, None, None] + beyond).reshape(-1, 3)
        self._set_normals(np.zeros((0, 3), np.int64), self.corners)
        every = np.flatnonzero(owner >= 0)
        self.outside, self.seen, self.height = self._highest(
            every, np.full(len(every), 4), 4 * owner[every]
        )

    def _set_normals(self, kept: Int64, added: Index) -> None:
        """Set the normals of the faces: `kept`, then the normals of new ones, below 2^60, so
        exact.
        """
        a, b, c = (self.grid[added[:, k]].T for k in range(3))
        self.normals = np.concatenate([kept, np.stack(cross(b - a, c - a), axis=1)])
        self.lengths = np.linalg.norm(self.normals.astype(np.float64), axis=1)

    def _heights(self, points: Index, faces: Index) -> Array:
        """Return (k,) normal · (point - corner), rounded but of the right sign; zero only in the
        plane.
        """
        offset = self.grid[points] - self.grid[self.corners[faces, 0]]
        normal = self.normals[faces]
        high = np.einsum("ij,ij->i", normal >> GRID_BITS, offset)
        low = np.einsum("ij,ij->i", normal & LOW_BITS, offset)
        high += low >> GRID_BITS
        return high.astype(np.float64) * 2.0**GRID_BITS + (low & LOW_BITS).astype(np.float64)

    def _highest(self, points: Index, counts: Index, firsts: Index) -> tuple[Index, Index, Array]:
        """Return outside points, the highest face below each (of `counts` from `firsts` on), and
        their heights.
        """
        parts = []
        for block in batches(counts, PAIRS_PER_BLOCK):
            number = counts[block]
            faces = np.repeat(firsts[block], number) + segment_ranges(number)
            height = self._heights(np.repeat(points[block], number), faces) / self.lengths[faces]
            segments = np.cumsum(number) - number
            highest = np.maximum.reduceat(height, segments)
            place = np.flatnonzero(height == np.repeat(highest, number))
            place = place[np.searchsorted(place, segments)]
            above = highest > self.step
            parts.append((points[block][above], faces[place[above]], highest[above]))
        points, faces, height = (np.concatenate(arrays) for arrays in zip(*parts))
        return points, faces, height

    def add_points(self, most: int | None = None) -> bool:
        """Add at most `most` farthest points whose visible faces do not touch.

        Return whether there were any.
        """
        if not len(self.outside):
            return False
        farthest = np.zeros(len(self.corners))
        np.maximum.at(farthest, self.seen, self.height)
        # Of points that are equally far within the tolerance, take a corner: the one farthest from
        # the middle.
        place = np.flatnonzero(self.height >= farthest[self.seen] - self.step)
        order = np.lexsort((self.reach[self.outside[place]], self.seen[place]))
        seen = self.seen[place[order]]
        place = place[order[np.append(seen[1:] != seen[:-1], True)]]
        # the first one is never left out
        place = place[np.lexsort((self.seen[place], -self.height[place]))]
        apexes = self.outside[place]
        visible, horizon = self._visible_faces(apexes, self.seen[place])
        keeps = self._independent(len(apexes), visible, horizon)
        if most is not None:
            keeps &= np.cumsum(keeps) <= most
        visible = visible[keeps[visible[:, 0]]]
        horizon = horizon[keeps[horizon[:, 0]]]
        self._replace_faces(apexes, visible, horizon[np.argsort(horizon[:, 0], kind="stable")])
        return True

    def _visible_faces(self, apexes: Index, faces: Index) -> tuple[Index, Index]:
        """Return (k, 2) pairs of an apex and a visible face, and (l, 3) borders: apex, visible face
        and its side.
        """
        size = len(self.corners)
        front = np.stack([np.arange(len(apexes)), faces], axis=1)
        known = np.sort(front[:, 0] * size + front[:, 1])
        edges = []
        while len(front):
            apex, face = np.repeat(front, 3, axis=0).T
            side = np.tile(np.arange(3), len(front))
            beyond = self.neighbors[face, side]
            sees = self._heights(apexes[apex], beyond) > 0.0
            edges.append(np.stack([apex, face, side], axis=1)[~sees])
            new = sorted_distinct(apex[sees] * size + beyond[sees])
            new = np.setdiff1d(new, known, assume_unique=True)
            known = np.sort(np.concatenate([known, new]))
            front = np.stack(np.divmod(new, size), axis=1)
        return np.stack(np.divmod(known, size), axis=1), np.concatenate(edges)

    def _independent(self, count: int, visible: Index, horizon: Index) -> Mask:
        """Return a (count,) mask of the apexes that no earlier apex disturbs."""
        beyond = self.neighbors[horizon[:, 1], horizon[:, 2]]
        seen_by = np.full(len(self.corners), count)
        np.minimum.at(seen_by, visible[:, 1], visible[:, 0])
        keeps = np.ones(count, bool)
        keeps[visible[seen_by[visible[:, 1]] < visible[:, 0], 0]] = False
        keeps[horizon[seen_by[beyond] < horizon[:, 0], 0]] = False
        return keeps

    def _replace_faces(self, apexes: Index, visible: Index, horizon: Index) -> None:
        """Replace the faces that each apex sees by a cone to that apex. horizon: sorted by apex."""
        apex, face, side = horizon.T
        size = len(self.corners)
        added = len(horizon)
        start = self.corners[face, side]
        end = self.corners[face, NEXT_AXIS[side]]
        beyond = self.neighbors[face, side]
        back = (self.neighbors[beyond] == face[:, None]).argmax(axis=1)
        count = len(self.grid)
        order = np.argsort(apex * count + start)
        following = order[np.searchsorted((apex * count + start)[order], apex * count + end)]
        preceding = np.empty(added, np.intp)
        preceding[following] = np.arange(added)
        self.neighbors[beyond, back] = size + np.arange(added)
        removed = np.zeros(size, bool)
        removed[visible[:, 1]] = True

        number = np.cumsum(np.concatenate([~removed, np.ones(added, bool)])) - 1
        corners = np.stack([start, end, apexes[apex]], axis=1)
        neighbors = np.stack([beyond, size + following, size + preceding], axis=1)
        self.neighbors = number[np.concatenate([self.neighbors[~removed], neighbors])]
        self.corners = np.concatenate([self.corners[~removed], corners])
        self._set_normals(self.normals[~removed], corners)

        owner = np.zeros(size, np.intp)
        owner[visible[:, 1]] = visible[:, 0]
        stays = ~removed[self.seen]
        cones = np.bincount(apex)
        firsts = size - int(np.count_nonzero(removed)) + np.cumsum(cones) - cones
        loose = owner[self.seen[~stays]]
        points, seen, height = self._highest(self.outside[~stays], cones[loose], firsts[loose])
        self.outside = np.concatenate([self.outside[stays], points])
        self.seen = np.concatenate([number[self.seen[stays]], seen])
        self.height = np.concatenate([self.height[stays], height])


def _flat_hull(points: Array, corners: list[int], tolerance: float) -> ConvexHull:
    """Return both sides of the polygon around points in the plane of three of them."""
    a, b, c = points[corners]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    first = (b - a) / np.linalg.norm(b - a)
    plane = (points - a) @ np.stack([first, np.cross(normal, first)], axis=1)
    indices = convex_polygon(plane, tolerance)
    size = len(indices)
    fan = np.stack(
        [np.zeros(size - 2, np.intp), np.arange(1, size - 1), np.arange(2, size)], axis=1
    )
    triangles = np.concatenate([fan, fan[:, [0, 2, 1]]])
    above, below = np.arange(2 * size - 4).reshape(2, -1)
    ends = np.stack([above - 1, above + 1]), np.stack([below - 1, below + 1])
    for sides, beyond in zip(ends, (below, above)):
        sides[0, 0] = beyond[0]
        sides[1, -1] = beyond[-1]
    (before, after), (first, last) = ends
    neighbors = np.concatenate(
        [np.stack([before, below, after], axis=1), np.stack([last, above, first], axis=1)]
    )
    gap = tolerance * float(np.ptp(points, axis=0).max())
    return ConvexHull(points[indices], indices, triangles, neighbors, is_flat=True, gap=gap)


def convex_polygon(points: Array, tolerance: float = 0.0) -> Index:
    """Return (k,) indices of the counter-clockwise corners of (n, 2) points; two on a line, one if
    all are the same.
    """
    ends = np.lexsort((points[:, 1], points[:, 0]))[[0, -1]]
    least = tolerance * float(np.ptp(points, axis=0).max())
    if np.abs(points[ends[1]] - points[ends[0]]).max() <= least:
        return ends[:1]
    corners = ends
    rest = np.repeat(np.arange(len(points)), 2)
    side = np.tile([0, 1], len(points))  # the side of the polygon that the points may be outside of
    while len(rest):
        start = points[corners[side]]
        along = points[np.roll(corners, -1)[side]] - start
        offset = points[rest] - start
        length = np.linalg.norm(along, axis=1)
        height = (offset[:, 0] * along[:, 1] - offset[:, 1] * along[:, 0]) / np.where(
            length > 0.0, length, 1.0
        )
        outside = height > max(least, 4.0 * np.finfo(np.float64).eps * np.abs(points).max())
        rest = rest[outside]
        side = side[outside]
        height = height[outside]
        if not len(rest):
            break
        order = np.lexsort((height, side))
        last = np.append(side[order][1:] != side[order][:-1], True)
        apexes = rest[order[last]]
        sides = side[order[last]]
        corners = np.insert(corners, sides + 1, apexes)
        shift = np.searchsorted(sides, side)  # the number of split sides before
        rest = np.repeat(rest, 2)
        side = np.repeat(side + shift, 2)
        side[1::2] += 1
    return np.roll(corners, -int(corners.argmin()))
