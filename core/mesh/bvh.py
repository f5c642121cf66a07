# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells with a tree of boxes each, to locate places inside them.

The winding number locates a place; it is counted along a ray that is parallel to no axis. The
crossings are counted in the plane across the ray, with signs that neighboring triangles share, so
that no ray slips through between two of them (half-open edges, the watertight rule of rasterizers).
The search walks down the trees with all points at once, in bounded pieces of work.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numerics import (
    Array,
    Index,
    Mask,
    NDArray,
    cross,
    dot,
    run_starts,
    segment_ranges,
    spread_bits,
)
from .point_triangle import triangle_distances

RAY_SLOPES = (0.08173, 0.05311)  # the ray is (0.08173, 0.05311, 1)
TRIANGLES_PER_LEAF = 4
PAIRS_PER_BATCH = 1 << 17  # pairs looked at together
MAX_BOX_PAIRS = 10_000_000  # pairs of boxes looked at
TRIANGLES_PER_BLOCK = 1 << 14  # triangles whose scratch stays in the cache
LEAST_SLOPE = 1e-30  # unit rays with a smaller component count as this steep
RAY_RTOL = 1e-9  # relative to the reach: nearer hits are those of the triangle that a ray starts on
CORNER_ATOL = 1e-6  # in barycentric coordinates: rays this far outside hit, as do those on an edge


@dataclass(frozen=True, eq=False)
class SortedComponents:
    """Triangles, (m, 3), sorted by component, (m,), and the measures of each of c components.

    start: (c + 1,) first triangles; low, high: (c, 3) boxes; volume: (c,) signed; area: (c,).
    """

    triangles: NDArray[np.integer]
    component: Index
    start: Index
    low: Array
    high: Array
    volume: Array
    area: Array


def sort_components(
    points: NDArray[np.floating],
    triangles: NDArray[np.integer],
    component: Index,
    number: int,
) -> SortedComponents:
    """Sort triangles by component, and measure each component about one of its own vertices."""
    if np.any(component[1:] < component[:-1]):
        order = radix_argsort(component)
        triangles = triangles[order]
        component = component[order]
    start = np.searchsorted(component, np.arange(number + 1))
    columns = np.ascontiguousarray(points.T, np.float64)
    origin = columns[:, triangles[start[:-1], 0]]
    low = np.full((3, number), np.inf)
    high = np.full((3, number), -np.inf)
    volume, area = np.zeros((2, number))
    for begin in range(0, len(triangles), TRIANGLES_PER_BLOCK):
        owner = component[begin : begin + TRIANGLES_PER_BLOCK]
        first = run_starts(owner)
        present = owner[first]  # the components in this block, each once
        index = triangles[begin : begin + TRIANGLES_PER_BLOCK].T.astype(np.intp, order="C")
        corners = [column.take(index) for column in columns]
        for k, (a, b, c) in enumerate(corners):
            lowest = np.minimum.reduceat(np.minimum(np.minimum(a, b), c), first)
            highest = np.maximum.reduceat(np.maximum(np.maximum(a, b), c), first)
            low[k, present] = np.minimum(low[k, present], lowest)
            high[k, present] = np.maximum(high[k, present], highest)
        normal = cross([x[1] - x[0] for x in corners], [x[2] - x[0] for x in corners])
        from_origin = [x[0] - place[owner] for x, place in zip(corners, origin)]
        volume[present] += np.add.reduceat(dot(normal, from_origin), first)
        area[present] += np.add.reduceat(np.sqrt(dot(normal, normal)), first)
    return SortedComponents(triangles, component, start, low.T, high.T, volume / 6.0, area / 2.0)


def radix_argsort(values: NDArray[np.integer]) -> Index:
    """Return the stable order of integers below 2^32, 16 bits at a time: numpy sorts 16-bit
    integers by counting.
    """
    order = np.argsort(values.astype(np.uint16), kind="stable")
    if values.max() > 0xFFFF:
        order = order[np.argsort((values >> 16).astype(np.uint16)[order], kind="stable")]
    return order


class Bvh:
    """One bounding-volume tree for each wanted component: perfect binary trees over triangles in
    Morton order.

    vertex_columns: (3, n) the vertices about `origin`; ids: (3, m) the vertices of the sorted
    triangles; triangle_low, triangle_high: (3, m) their boxes. root: (c,) root node of each
    component's tree, or -1. A node's first child is `child`, -1 for leaves; the second one follows.
    A leaf holds the triangles from `begin` up to `end`, which is excluded. low, high: (n, 3) boxes
    of nodes; inverted if a node is empty.
    """

    def __init__(
        self,
        points: NDArray[np.floating],
        components: SortedComponents,
        selected: Mask,
    ) -> None:
        self.origin = (
            components.low[selected].min(axis=0) + components.high[selected].max(axis=0)
        ) / 2.0
        self.vertex_columns = np.ascontiguousarray(points.T, np.float64) - self.origin[:, None]
        self._build_nodes(self._sort(components, selected), selected)

    def _sort(self, components: SortedComponents, selected: Mask) -> Index:
        """Sort the triangles by selected component and Morton order, set their boxes, and return
        (m,) components.
        """
        ids = components.triangles
        component = components.component
        if not selected.all():
            is_selected = selected[component]
            ids = ids[is_selected]
            component = component[is_selected]
        low, high = np.empty((2, 3, len(ids)))
        code = np.zeros(len(ids), np.int64)
        corner = (components.low - self.origin).T
        # 10 bits for each axis of a component's box
        scale = 1023.0 / np.maximum(
            (components.high - components.low).max(axis=1), 1023.0 * np.finfo(float).tiny
        )
        for begin in range(0, len(ids), TRIANGLES_PER_BLOCK):
            block = slice(begin, begin + TRIANGLES_PER_BLOCK)
            owner = component[block]
            index = ids[block].T.astype(np.intp, order="C")
            for k, column in enumerate(self.vertex_columns):
                a, b, c = column.take(index)
                np.minimum(np.minimum(a, b), c, out=low[k, block])
                np.maximum(np.maximum(a, b), c, out=high[k, block])
                middle = 0.5 * (low[k, block] + high[k, block])
                cell = (middle - corner[k, owner]) * scale[owner]
                code[block] |= spread_bits(cell.astype(np.int64)) << k
        order = radix_argsort(code)
        order = order[radix_argsort(component[order])]
        self.ids = ids[order].T.astype(np.intp, order="C")
        self.triangle_low = low[:, order]
        self.triangle_high = high[:, order]
        return component[order]

    def _build_nodes(self, component: Index, selected: Mask) -> None:
        """Build the nodes over the sorted triangles of these (m,) components.

        A tree of depth d has its 2^d last nodes as leaves. From its root at `offset` on, the
        children of node i are 2i + 1 and 2i + 2.
        """
        present = np.flatnonzero(selected)
        first_triangle = np.searchsorted(component, present)
        triangle_count = np.searchsorted(component, present, side="right") - first_triangle
        leaf_count = -(-triangle_count // TRIANGLES_PER_LEAF)
        depth = np.ceil(np.log2(leaf_count)).astype(np.intp)
        width = 1 << depth
        offset = np.concatenate([[0], np.cumsum(2 * width - 1)])
        count = int(offset[-1])
        self.root = np.full(len(selected), -1)
        self.root[present] = offset[:-1]
        self.low = np.full((count, 3), np.inf)
        self.high = np.full((count, 3), -np.inf)
        self.begin, self.end = np.zeros((2, count), np.intp)
        tree = np.repeat(np.arange(len(present)), 2 * width - 1)
        node = np.arange(count) - offset[tree]
        self.child = np.where(node < width[tree] - 1, offset[tree] + 2 * node + 1, -1)

        k = segment_ranges(leaf_count)
        tree = np.repeat(np.arange(len(present)), leaf_count)
        leaf = offset[tree] + width[tree] - 1 + k
        begin = first_triangle[tree] + TRIANGLES_PER_LEAF * k
        self.begin[leaf] = begin
        self.end[leaf] = np.minimum(
            begin + TRIANGLES_PER_LEAF, (first_triangle + triangle_count)[tree]
        )
        self.low[leaf] = np.minimum.reduceat(self.triangle_low, begin, axis=1).T
        self.high[leaf] = np.maximum.reduceat(self.triangle_high, begin, axis=1).T
        for level in range(int(depth.max()) - 1, -1, -1):
            deep = np.flatnonzero(depth > level)
            node = (offset[deep][:, None] + ((1 << level) - 1 + np.arange(1 << level))).ravel()
            child = self.child[node]
            self.low[node] = np.minimum(self.low[child], self.low[child + 1])
            self.high[node] = np.maximum(self.high[child], self.high[child + 1])

    def corners(self, triangle: Index) -> Array:
        """Return the (3, 3, k) coordinates, about `origin`, of the corners of sorted triangles."""
        return self.vertex_columns.take(self.ids.take(triangle, axis=1), axis=1)

    def triangles_of_leaves(self, leaf: Index, owner: Index) -> tuple[Index, Index]:
        """Return the sorted triangles of (k,) leaves, and the (k,) `owner` of each one's leaf."""
        begin = self.begin.take(leaf)
        count = self.end.take(leaf) - begin
        return np.repeat(begin, count) + segment_ranges(count), np.repeat(owner, count)

    @cached_property
    def _shadows(self) -> Array:
        """The (5, n) top heights of the nodes' boxes, and the least and largest `_across`
        coordinates in them.
        """
        (*low, bottom) = self.low.T
        (*high, top) = self.high.T
        sides = [
            (below - slope * top, above - slope * bottom)
            for below, above, slope in zip(low, high, RAY_SLOPES)
        ]
        return np.stack([top, *sides[0], *sides[1]])

    def winding_numbers(
        self, query_points: Array, component: Index, tolerance: float
    ) -> tuple[Index, Mask]:
        """Return (k,) winding numbers of components around places, (k, 3) about `origin`; and a
        mask of the sure ones: their ray meets no triangle edge-on, nor any within `tolerance`.
        """
        winding = np.zeros(len(query_points), np.intp)
        sure = np.ones(len(query_points), bool)
        query = np.ascontiguousarray(query_points.T)
        height = query[2] - tolerance
        (u, v) = _across(query)
        pieces = cut(np.arange(len(query_points)), self.root[component])
        work = 0
        while pieces:
            place, node = pieces.pop()
            work += len(place)
            if work > MAX_BOX_PAIRS:
                for rest, _ in [*pieces, (place, node)]:
                    sure[rest] = False
                break
            top, left, right, front, back = self._shadows.take(node, axis=1)
            x, y = u.take(place), v.take(place)
            is_hit = (
                (top >= height.take(place))
                & (left <= x)
                & (right >= x)
                & (front <= y)
                & (back >= y)
            )
            place, node = place[is_hit], node[is_hit]
            child = self.child.take(node)
            is_leaf = child == -1
            if is_leaf.any():
                for at, leaves in cut(
                    place[is_leaf], node[is_leaf], size=PAIRS_PER_BATCH // TRIANGLES_PER_LEAF
                ):
                    self._count_crossings(query, at, leaves, tolerance, winding, sure)
            pieces += _both_children(place[~is_leaf], child[~is_leaf])
        return winding, sure

    def _count_crossings(
        self,
        query: NDArray,
        place: NDArray,
        leaf: NDArray,
        tolerance: float,
        winding: NDArray,
        sure: NDArray,
    ) -> None:
        """Add the rays' crossings with triangles of leaves to `winding`; update `sure`. query: (3,
        k) ray starts.
        """
        triangle, place = self.triangles_of_leaves(leaf, place)
        corner = self.corners(triangle)
        corner -= query.take(place, axis=1)[:, None]
        u, v = _across(corner)
        ids = self.ids.take(triangle, axis=1)
        area = np.empty(ids.shape)  # twice the areas between the ray and the edges
        positive = np.empty(ids.shape, bool)
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            # Judged from the edge's lower vertex, so that both its triangles see one number; zero
            # counts as positive.
            back = ids[i] > ids[j]
            from_lower = np.where(back, u[j] * v[i] - u[i] * v[j], u[i] * v[j] - u[j] * v[i])
            area[k] = np.where(back, -from_lower, from_lower)
            positive[k] = (from_lower >= 0.0) ^ back
        struck = np.flatnonzero((positive[0] == positive[1]) & (positive[1] == positive[2]))
        place = place[struck]
        area = area[:, struck]
        positive = positive[0, struck]
        total = area.sum(axis=0)
        flat = total == 0.0
        heights = corner[2][:, struck]
        height = np.einsum("kj,kj->j", area, heights) / np.where(flat, 1.0, total)
        sure[place[flat | (np.abs(height) <= tolerance)]] = False
        above = height > 0.0
        np.add.at(winding, place[above], np.where(positive[above], 1, -1))

    def distances(self, query_points: Array, component: Index, within: float = np.inf) -> Array:
        """Return the (k,) distances of places (about `origin`) from the surfaces of components; inf
        beyond `within`.
        """
        nearest = np.full(len(query_points), np.nextafter(within, np.inf))  # `within` counts
        pieces = cut(np.arange(len(query_points)), self.root[component])
        while pieces:
            place, node = pieces.pop()
            point = query_points[place]
            low = self.low[node]
            high = self.high[node]
            occupied = high[:, 0] >= low[:, 0]
            least = np.linalg.norm(np.maximum(np.maximum(low - point, point - high), 0.0), axis=1)
            most = np.linalg.norm(np.maximum(np.abs(point - low), np.abs(high - point)), axis=1)
            # No box that holds the nearest point may be dropped because its bound was rounded down.
            np.minimum.at(nearest, place[occupied], most[occupied] * (1.0 + 1e-12))
            near = occupied & (least <= nearest[place])
            place, node = place[near], node[near]
            child = self.child[node]
            is_leaf = child == -1
            if is_leaf.any():
                triangle, at = self.triangles_of_leaves(node[is_leaf], place[is_leaf])
                corners = self.corners(triangle).transpose(2, 1, 0)
                np.minimum.at(nearest, at, triangle_distances(query_points[at], corners))
            pieces += _both_children(place[~is_leaf], child[~is_leaf])
        return np.where(nearest <= within, nearest, np.inf)

    def first_hits(self, starts: Array, rays: Array, reach: float) -> tuple[Array, Index]:
        """Return the distances from (k, 3) places (about `origin`) along unit rays to the first
        triangle of the first component, and its sorted row; inf and 0 if none is within `reach`.
        """
        nearest = np.full(len(starts), np.inf)
        hit = np.zeros(len(starts), np.intp)
        inverse = 1.0 / np.where(np.abs(rays) > LEAST_SLOPE, rays, LEAST_SLOPE)
        slack = RAY_RTOL * reach
        pieces = cut(np.arange(len(starts)), np.full(len(starts), self.root[0]))
        while pieces:
            line, node = pieces.pop()
            low, high = self.low[node], self.high[node]
            # distances along the ray at which it meets the planes of the box's sides
            ends = (np.stack([low, high]) - starts[line]) * inverse[line]
            last = np.minimum(ends.max(axis=0).min(axis=1), np.minimum(nearest[line], reach))
            crossed = (ends.min(axis=0).max(axis=1) <= last + slack) & (last >= -slack)
            crossed &= high[:, 0] >= low[:, 0]
            line, node = line[crossed], node[crossed]
            child = self.child[node]
            is_leaf = child == -1
            triangle, at = self.triangles_of_leaves(node[is_leaf], line[is_leaf])
            distance, is_hit = _hit_triangles(starts[at], rays[at], self.corners(triangle))
            is_hit &= (distance > slack) & (distance < nearest[at])
            at, triangle, distance = at[is_hit], triangle[is_hit], distance[is_hit]
            order = np.argsort(-distance, kind="stable")  # the last of equal indices wins
            nearest[at[order]] = distance[order]
            hit[at[order]] = triangle[order]
            pieces += _both_children(line[~is_leaf], child[~is_leaf])
        return nearest, hit


def _hit_triangles(starts: Array, rays: Array, corners: Array) -> tuple[Array, Mask]:
    """Return the (k,) distances along rays at which each meets the plane of its triangle, and a
    mask of those that meet the triangle (Möller and Trumbore 1997). corners: (3, 3, k),
    coordinates first. u, v: the barycentric coordinates of b and c.
    """
    a, b, c = corners.transpose(1, 2, 0)
    across = np.cross(rays, c - a)
    det = np.einsum("ri,ri->r", across, b - a)
    inverse_det = 1.0 / np.where(det != 0.0, det, np.inf)
    away = starts - a
    turned = np.cross(away, b - a)
    u = np.einsum("ri,ri->r", away, across) * inverse_det
    v = np.einsum("ri,ri->r", rays, turned) * inverse_det
    distance = np.einsum("ri,ri->r", c - a, turned) * inverse_det
    is_within = np.minimum(np.minimum(u, v), 1.0 - u - v) >= -CORNER_ATOL
    return distance, is_within & (det != 0.0)


def _across(places: Array) -> tuple[Array, Array]:
    """Return the points in which the rays through places, (3, ...), meet the plane z = 0."""
    return places[0] - RAY_SLOPES[0] * places[2], places[1] - RAY_SLOPES[1] * places[2]


def cut(*arrays: NDArray, size: int = PAIRS_PER_BATCH) -> list[tuple[NDArray, ...]]:
    """Cut the arrays into parallel pieces of bounded length."""
    return [tuple(array[k : k + size] for array in arrays) for k in range(0, len(arrays[0]), size)]


def _both_children(owner: Index, child: Index) -> list[tuple[NDArray, ...]]:
    """Return pieces of pairs of an owner and a node, for both children of each owner's node. child:
    (k,) the first ones.
    """
    return cut(np.concatenate([owner, owner]), np.concatenate([child, child + 1]))


def tree_of_all(points: NDArray[np.floating], triangles: NDArray[np.integer]) -> Bvh:
    """Return the tree of all triangles as one component."""
    points = np.asarray(points, np.float64)
    component = np.zeros(len(triangles), np.intp)
    whole = sort_components(points, triangles.astype(np.intp, copy=False), component, 1)
    return Bvh(points, whole, np.ones(1, bool))
