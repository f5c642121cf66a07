# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The boundary loops of open surfaces: gaps without area, and holes, which are capped.

At each vertex a boundary side is joined to the side whose direction, seen from the vertex, is
nearest to its own. So at a T-junction the long edge and the short ones along it make a loop without
area: the surface is closed there, in space though not in the mesh. The other loops are capped by
the cone to their centroid: as a signed chain, it is the flat cap of a flat loop of any shape,
without a triangulation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics import (
    Array,
    Floats,
    Index,
    Integers,
    Mask,
    NDArray,
    connected_components,
    cross_rows,
    lengths,
    run_starts,
    segment_ranges,
    unique_pairs,
)

MAX_GAP_ASPECT = 1e-3  # largest area of a gap by the square of its perimeter
MAX_END_PAIRS = 4_000_000  # Pairs compared; if there are more, only ends next to each other are.


def side_ends(triangles: Integers, sides: Integers) -> tuple[NDArray, NDArray]:
    """Return the start and end vertices of sides; side 3t + i runs from corner i of triangle t to
    the next corner.
    """
    triangle = sides // 3
    corner = sides % 3
    return triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]


def vertex_pairs(triangles: Integers, sides: Integers) -> Index:
    """Return (k, 2) sides as pairs of vertices, the lower first."""
    return np.sort(np.stack(side_ends(triangles, sides), axis=1))


def distinct_vertex_pairs(triangles: Integers, sides: Integers) -> Index:
    """Return (k, 2) sides as pairs of vertices, the lower first, sorted, each once."""
    return unique_pairs(vertex_pairs(triangles, sides))


def join_sides(
    begin: Array,
    end: Array,
    start: Integers,
    stop: Integers,
    directed: bool,
) -> tuple[Index, Index, Mask]:
    """Return (k,) and (k,) sides, of r, joined in pairs at equal vertices, and True for head to
    tail. If several ends meet, those with the most similar directions are joined first.

    begin, end: (r, 3) positions of the sides' ends; start, stop: (r,) the vertices there. directed:
    True to join sides head to tail only.
    """
    # Ends are numbered too: end e, of 2r, is the start of side e, or for e ≥ r the stop of e - r.
    count = len(start)
    vertex = np.concatenate([start, stop])
    direction = end - begin
    length = lengths(direction)
    direction = np.divide(direction, length, out=np.zeros_like(direction), where=length > 0.0)
    direction = np.concatenate([direction, -direction])  # as seen from each end
    order = np.argsort(vertex, kind="stable")
    first = run_starts(vertex[order])
    degree = np.diff(first, append=len(order))

    simple = first[degree == 2]
    left = [order[simple]]
    right = [order[simple + 1]]
    is_branching = degree > 2
    if is_branching.any():
        first_end, second_end = _candidate_pairs(order, first[is_branching], degree[is_branching])
        if directed:
            fits = (first_end < count) != (second_end < count)
            first_end = first_end[fits]
            second_end = second_end[fits]
        score = np.einsum("ij,ij->i", direction[first_end], direction[second_end])
        best = np.lexsort([second_end, first_end, -score])
        first_end, second_end = _greedy_matching(first_end[best], second_end[best], 2 * count)
        left.append(first_end)
        right.append(second_end)
    left_end = np.concatenate(left)
    right_end = np.concatenate(right)
    follows = (left_end < count) != (right_end < count)
    return left_end % count, right_end % count, follows


def _candidate_pairs(order: NDArray, first: NDArray, degree: NDArray) -> tuple[NDArray, NDArray]:
    """Return pairs of ends that meet at a vertex: all, or only neighbors in `order` if there are
    too many.

    The ends at a vertex are `degree` entries of `order`, from `first` on.
    """
    pairs = degree * (degree - 1) // 2
    if pairs.sum() > MAX_END_PAIRS:
        neighbors = degree - 1
        place = np.repeat(first, neighbors) + segment_ranges(neighbors)
        return order[place], order[place + 1]
    row = np.repeat(np.arange(len(degree)), pairs)
    k = segment_ranges(pairs)
    # The k-th pair (i, j), i < j, of the strict upper triangle read by columns: the numbers are so
    # small that the root is exact for the first pair of a column.
    j = ((1.0 + np.sqrt(1.0 + 8.0 * k)) / 2.0).astype(np.intp)
    i = k - j * (j - 1) // 2
    return order[first[row] + i], order[first[row] + j]


def _greedy_matching(
    first_end: NDArray, second_end: NDArray, end_count: int
) -> tuple[NDArray, NDArray]:
    """Return the matched pairs of ends, each end in one at most. The candidates are sorted best
    first; each round takes those that are the best ones left for both of their ends.
    """
    left, right = [first_end[:0]], [second_end[:0]]
    while len(first_end):
        rank = np.arange(len(first_end))
        # The last write to an end wins, so the best candidate is written last.
        best_as_first = np.full(end_count, len(rank))
        best_as_first[first_end[::-1]] = rank[::-1]
        best_as_second = np.full(end_count, len(rank))
        best_as_second[second_end[::-1]] = rank[::-1]
        best = np.minimum(best_as_first, best_as_second)
        taken = (best[first_end] == rank) & (best[second_end] == rank)
        left.append(first_end[taken])
        right.append(second_end[taken])
        used = np.zeros(end_count, bool)
        used[first_end[taken]] = used[second_end[taken]] = True
        free = ~(used[first_end] | used[second_end])
        first_end = first_end[free]
        second_end = second_end[free]
    return np.concatenate(left), np.concatenate(right)


@dataclass(frozen=True, eq=False)
class BoundaryLoops:
    """Boundary sides (r) grouped into loops (l), numbered in the order of their first sides; in
    unit and unit².

    `of_side`: (r,) loop of each side. `complete`: (l,) True if all its sides are joined at both
    ends. `centroid`: (l, 3) of the curve. `cone_area`: of the cone to it. `planar_area`: norm of
    the loop's area vector. `out_of_plane`: distance from its plane; infinite if it has none.
    """

    of_side: Index
    complete: Mask
    perimeter: Array
    centroid: Array
    cone_area: Array
    planar_area: Array
    out_of_plane: Array

    def has_area(self, tolerance: float | Array) -> Mask:
        """Return an (l,) mask of holes; loops narrower than `tolerance`, one number or (l,), are
        gaps.
        """
        # Area by perimeter is half the width of a narrow loop. A gap is narrow also compared with
        # its length: a hole smaller than the tolerance remains a hole.
        return self.cone_area > self.perimeter * np.minimum(
            tolerance, MAX_GAP_ASPECT * self.perimeter
        )

    def of_each(self, side_values: NDArray) -> NDArray:
        """Return the (l,) values of the loops' first sides. side_values: (r,)."""
        values = np.empty(len(self.perimeter), side_values.dtype)
        values[self.of_side[::-1]] = side_values[::-1]  # The last of equal indices wins.
        return values


@dataclass(frozen=True, eq=False)
class OwnedLoops:
    """The l loops of r boundary sides, joined head to tail within their owners: bodies or
    components.

    `points`: (n, 3). `start`, `stop`: (r,) vertices of the sides. `owner`: (l,) of each loop.
    """

    points: Floats
    start: Integers
    stop: Integers
    loops: BoundaryLoops
    owner: Index

    @classmethod
    def of_sides(cls, points: NDArray, start: NDArray, stop: NDArray, owner: NDArray) -> OwnedLoops:
        """Find the loops of r sides, given by the (r,) points that they run from and to. owner:
        (r,) of each side.
        """
        begin = points[start].astype(np.float64)
        end = points[stop].astype(np.float64)
        # Vertices of different owners are different, so that no loop has two owners.
        start_key = owner * len(points) + start
        stop_key = owner * len(points) + stop
        loops = find_loops(begin, end, join_sides(begin, end, start_key, stop_key, directed=True))
        return cls(points, start, stop, loops, loops.of_each(owner))

    def cones(self) -> tuple[Floats, Integers, Index]:
        """Return the loops' (l, 3) centroids; (k, 3) triangles, the caps; and the (k,) sides that
        they stand on.

        Vertices after those of `points` are the centroids.
        """
        loops = self.loops
        # A loop of three sides is its own cap: with its first vertex as the apex, two of the three
        # triangles collapse.
        centroids = len(self.points) + np.arange(len(self.owner))
        apex = np.where(np.bincount(loops.of_side) == 3, loops.of_each(self.start), centroids)
        triangles = np.stack([self.stop, self.start, apex[loops.of_side]], axis=1)
        kept = np.flatnonzero(has_distinct_vertices(triangles))
        return loops.centroid.astype(self.points.dtype), triangles[kept], kept

    def count_caps(self, tolerance: Array, counted: Mask) -> Array:
        """Return (o, 3) by owner: the number of flat caps, that of curved ones, and the area of
        all.

        tolerance: (o,) lengths. counted: (o,) mask; the numbers of other owners are 0.
        """
        loops = self.loops
        tolerance_of_loop = tolerance[self.owner]
        is_flat = loops.out_of_plane <= tolerance_of_loop
        is_hole = loops.has_area(tolerance_of_loop) & counted[self.owner]
        columns = is_flat, ~is_flat, np.where(is_flat, loops.planar_area, loops.cone_area)
        sums = [np.bincount(self.owner, column * is_hole, len(counted)) for column in columns]
        return np.stack(sums, axis=1, dtype=np.float64)


def has_distinct_vertices(triangles: Integers) -> Mask:
    """Return an (m,) mask of triangles with three different vertices; the others have no boundary
    and no area.
    """
    a, b, c = triangles.T
    return (a != b) & (b != c) & (c != a)


def find_loops(begin: Array, end: Array, links: tuple[NDArray, NDArray, NDArray]) -> BoundaryLoops:
    """Group boundary sides with (r, 3) ends into loops by their `links`, from `join_sides`, and
    measure the loops.
    """
    left, right, _ = links
    of_side, loop_count = connected_components(len(begin), left, right)
    joint_count = np.bincount(np.concatenate([left, right]), minlength=len(begin))
    complete = np.bincount(of_side, joint_count != 2) == 0
    origin = np.empty((loop_count, 3))
    # Positions are about the loop's first vertex: a coordinate that all share stays exact.
    origin[of_side[::-1]] = begin[::-1]
    start_offset, end_offset = begin - origin[of_side], end - origin[of_side]
    length = lengths(end_offset - start_offset)[:, 0]
    perimeter = np.asarray(np.bincount(of_side, length), np.float64)
    weighted_middle = (start_offset + end_offset) * (0.5 * length)[:, None]
    divisor = np.where(perimeter > 0.0, perimeter, 1.0)
    center = np.array([np.bincount(of_side, weighted_middle[:, k]) / divisor for k in range(3)]).T
    start_offset -= center[of_side]
    end_offset -= center[of_side]
    cone = cross_rows(start_offset, end_offset) / 2.0  # area vectors of the cone's triangles
    area = np.array([np.bincount(of_side, cone[:, k]) for k in range(3)]).T
    planar_area = lengths(area)[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = area / planar_area[:, None]
        height = np.zeros(loop_count)
        np.maximum.at(height, of_side, np.abs(np.einsum("ij,ij->i", normal[of_side], start_offset)))
    height[~np.isfinite(height)] = np.inf
    return BoundaryLoops(
        of_side,
        complete,
        perimeter,
        centroid=center + origin,
        cone_area=np.asarray(np.bincount(of_side, lengths(cone)[:, 0]), np.float64),
        planar_area=planar_area,
        out_of_plane=height,
    )
