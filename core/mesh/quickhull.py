# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Quickhull with many points at a time and exact decisions.

Quickhull (Barber, Dobkin and Huhdanpaa 1996) adds the farthest point outside each face. Each round
here adds, in a few operations on arrays, all such points that see no face in common, and no face
across another point's horizon. Their order does not matter, because a face over a horizon's edge is
a positive combination of the two faces at the edge.

The points are on a grid of 2^29 steps over the largest extent. There, integers decide without
rounding on which side of a face a point lies, so the result is always a closed convex surface.
"""

from __future__ import annotations

import numpy as np

from ..numerics import (
    NEXT_AXIS,
    Array,
    Index,
    Int64,
    Mask,
    NDArray,
    batches,
    cross,
    segment_ranges,
    segment_starts,
    sorted_distinct,
)

GRID_BITS = 29
LOW_BITS = (1 << GRID_BITS) - 1
PAIRS_PER_BLOCK = 1 << 18


def first_corners(grid: Array, least: float) -> list[int]:
    """Return the indices of four points that span a volume, the first three counter-clockwise from
    outside; three or two if all are nearer than `least` to their plane or line. grid: (n, 3).
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
    if heights[fourth] < 0.0:
        return [first, second, third, fourth]
    return [first, third, second, fourth]


def _farthest(distances: NDArray, reach: NDArray, least: float) -> int:
    """Return the index of the largest distance; among distances equal within `least`, the largest
    reach: a corner.
    """
    equal = np.flatnonzero(distances >= distances.max() - least)
    return int(equal[reach[equal].argmax()])


class GrowingHull:
    """Hulls on the grid, one for each set of points; and the points still outside, each with a face
    that it sees.

    first: (k, 4) corners of a tetrahedron in each set. owner: (n,) the set of each point, or -1 to
    leave it out. corners: (m, 3) of the faces. neighbors: (m, 3) the face across each side.
    normals: (m, 3) exact integers. outside, seen, height: the outside points, their faces, and
    their heights in steps of the grid. reach: squared distances of all points from the middle.
    """

    def __init__(self, grid: Int64, first: Index, owner: Index, step: float) -> None:
        self.grid, self.step = grid, step
        self.reach = ((grid.astype(np.float64) - 2.0 ** (GRID_BITS - 1)) ** 2).sum(axis=1)
        self.corners = first[:, [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]].reshape(-1, 3)
        beyond = np.array([[1, 2, 3], [3, 2, 0], [1, 3, 0], [2, 1, 0]], np.intp)
        self.neighbors = (4 * np.arange(len(first))[:, None, None] + beyond).reshape(-1, 3)
        self._set_normals(np.zeros((0, 3), np.int64), self.corners)
        points = np.flatnonzero(owner >= 0)
        self.outside, self.seen, self.height = self._highest(
            points, np.full(len(points), 4), 4 * owner[points]
        )

    @property
    def corner_count(self) -> int:
        """The number of corners if there is a single hull, by Euler's formula."""
        return len(self.corners) // 2 + 2

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
        # The product, of up to 91 bits, as high · 2^29 + low.
        high = np.einsum("ij,ij->i", normal >> GRID_BITS, offset)
        low = np.einsum("ij,ij->i", normal & LOW_BITS, offset)
        high += low >> GRID_BITS
        return high.astype(np.float64) * 2.0**GRID_BITS + (low & LOW_BITS).astype(np.float64)

    def _highest(self, points: Index, counts: Index, firsts: Index) -> tuple[Index, Index, Array]:
        """Return the points above one of their faces, the face that each is highest above, and
        their heights.

        points: (k,). counts, firsts: (k,) the faces of each point: `counts` from `firsts` on.
        """
        parts = []
        for block in batches(counts, PAIRS_PER_BLOCK):
            number = counts[block]
            faces = np.repeat(firsts[block], number) + segment_ranges(number)
            height = self._heights(np.repeat(points[block], number), faces) / self.lengths[faces]
            starts = segment_starts(number)
            highest = np.maximum.reduceat(height, starts)
            pairs = np.flatnonzero(height == np.repeat(highest, number))
            first_pairs = pairs[np.searchsorted(pairs, starts)]  # one for each point
            above = highest > self.step
            parts.append((points[block][above], faces[first_pairs[above]], highest[above]))
        points, faces, height = (np.concatenate(arrays) for arrays in zip(*parts))
        return points, faces, height

    def add_points(self, most: float = np.inf) -> bool:
        """Add at most `most` farthest points whose visible faces do not touch.

        Return whether there were any.
        """
        if not len(self.outside):
            return False
        farthest = np.zeros(len(self.corners))
        np.maximum.at(farthest, self.seen, self.height)
        # Of points that are equally far within the tolerance, take a corner: the one farthest from
        # the middle.
        chosen = np.flatnonzero(self.height >= farthest[self.seen] - self.step)
        order = np.lexsort((self.reach[self.outside[chosen]], self.seen[chosen]))
        seen = self.seen[chosen[order]]
        chosen = chosen[order[np.append(seen[1:] != seen[:-1], True)]]
        # The highest comes first, and so is never left out.
        chosen = chosen[np.lexsort((self.seen[chosen], -self.height[chosen]))]
        apexes = self.outside[chosen]
        visible, horizon = self._visible_faces(apexes, self.seen[chosen])
        is_added = self._independent(len(apexes), visible, horizon)
        is_added &= np.cumsum(is_added) <= most
        visible = visible[is_added[visible[:, 0]]]
        horizon = horizon[is_added[horizon[:, 0]]]
        self._replace_faces(apexes, visible, horizon[np.argsort(horizon[:, 0], kind="stable")])
        return True

    def _visible_faces(self, apexes: Index, faces: Index) -> tuple[Index, Index]:
        """Return (k, 2) pairs of an apex, counted from 0, and a face that it sees; and (l, 3)
        horizons: apex, visible face and the side of this face with an invisible face beyond.

        faces: one that each apex sees.
        """
        size = len(self.corners)
        front = np.stack([np.arange(len(apexes)), faces], axis=1)
        known = np.sort(front[:, 0] * size + front[:, 1])  # pairs as one number
        horizons = []
        while len(front):
            apex, face = np.repeat(front, 3, axis=0).T
            side = np.tile(np.arange(3), len(front))
            beyond = self.neighbors[face, side]
            sees = self._heights(apexes[apex], beyond) > 0.0
            horizons.append(np.stack([apex, face, side], axis=1)[~sees])
            new = sorted_distinct(apex[sees] * size + beyond[sees])
            new = np.setdiff1d(new, known, assume_unique=True)
            known = np.sort(np.concatenate([known, new]))
            front = np.stack(np.divmod(new, size), axis=1)
        return np.stack(np.divmod(known, size), axis=1), np.concatenate(horizons)

    def _independent(self, count: int, visible: Index, horizon: Index) -> Mask:
        """Return a (count,) mask of the apexes that no earlier apex disturbs, by seeing one of
        their visible faces or a face beyond their horizon.
        """
        beyond = self.neighbors[horizon[:, 1], horizon[:, 2]]
        first_to_see = np.full(len(self.corners), count)
        np.minimum.at(first_to_see, visible[:, 1], visible[:, 0])
        is_independent = np.ones(count, bool)
        is_independent[visible[first_to_see[visible[:, 1]] < visible[:, 0], 0]] = False
        is_independent[horizon[first_to_see[beyond] < horizon[:, 0], 0]] = False
        return is_independent

    def _replace_faces(self, apexes: Index, visible: Index, horizon: Index) -> None:
        """Replace the faces that each apex sees by a cone to that apex. horizon: sorted by apex."""
        apex, face, side = horizon.T
        size = len(self.corners)
        start = self.corners[face, side]
        end = self.corners[face, NEXT_AXIS[side]]
        # The cones' faces are numbered after the old ones, which are removed last.
        cone_face = size + np.arange(len(horizon))
        beyond = self.neighbors[face, side]
        back = (self.neighbors[beyond] == face[:, None]).argmax(axis=1)
        self.neighbors[beyond, back] = cone_face
        # The next face around an apex starts where a face ends.
        start_key = apex * len(self.grid) + start
        order = np.argsort(start_key)
        following = order[np.searchsorted(start_key[order], apex * len(self.grid) + end)]
        preceding = np.empty(len(horizon), np.intp)
        preceding[following] = np.arange(len(horizon))

        is_kept = np.ones(size, bool)
        is_kept[visible[:, 1]] = False
        number = np.cumsum(np.append(is_kept, np.ones(len(horizon), bool))) - 1
        corners = np.stack([start, end, apexes[apex]], axis=1)
        neighbors = np.stack([beyond, cone_face[following], cone_face[preceding]], axis=1)
        self.neighbors = number[np.concatenate([self.neighbors[is_kept], neighbors])]
        self.corners = np.concatenate([self.corners[is_kept], corners])
        self._set_normals(self.normals[is_kept], corners)

        # Points that saw a removed face may see the cone in its place.
        apex_of_face = np.zeros(size, np.intp)
        apex_of_face[visible[:, 1]] = visible[:, 0]
        cone_sizes = np.bincount(apex)
        cone_starts = int(np.count_nonzero(is_kept)) + segment_starts(cone_sizes)
        stays = is_kept[self.seen]
        cone = apex_of_face[self.seen[~stays]]
        points, seen, height = self._highest(
            self.outside[~stays], cone_sizes[cone], cone_starts[cone]
        )
        self.outside = np.concatenate([self.outside[stays], points])
        self.seen = np.concatenate([number[self.seen[stays]], seen])
        self.height = np.concatenate([self.height[stays], height])
