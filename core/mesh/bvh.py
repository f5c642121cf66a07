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

from ..numerics import Array, Index, Mask, NDArray, segment_ranges, spread_bits
from .point_triangle import triangle_distances

RAY_SLOPES = (0.08173, 0.05311)  # the ray is (0.08173, 0.05311, 1)
TRIANGLES_PER_LEAF = 4  # triangles
PAIRS_PER_BATCH = 1 << 17  # pairs looked at together
MAX_BOX_PAIRS = 10_000_000  # pairs of boxes looked at
TRIANGLES_PER_BLOCK = 1 << 14  # triangles whose scratch stays in the cache
LEAST_SLOPE = 1e-30  # Rays: those along a plane count as this steep
RAY_RTOL = 1e-9  # Relative to the reach: nearer hits are the ray's own triangle
CORNER_ATOL = 1e-6  # barycentric: rays through an edge hit


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
        block_component = component[begin : begin + TRIANGLES_PER_BLOCK]
        first = np.flatnonzero(
            np.concatenate([[True], block_component[1:] != block_component[:-1]])
        )
        at = block_component[first]
        index = triangles[begin : begin + TRIANGLES_PER_BLOCK].T.astype(np.intp, order="C")
        corner = [column.take(index) for column in columns]
        for k, (a, b, c) in enumerate(corner):
            low[k, at] = np.minimum(
                low[k, at], np.minimum.reduceat(np.minimum(np.minimum(a, b), c), first)
            )
            high[k, at] = np.maximum(
                high[k, at], np.maximum.reduceat(np.maximum(np.maximum(a, b), c), first)
            )
        b, c = ([x[k] - x[0] for x in corner] for k in (1, 2))
        normal = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]]
        height = sum(n * (x[0] - h[block_component]) for n, x, h in zip(normal, corner, origin))
        volume[at] += np.add.reduceat(height, first)
        area[at] += np.add.reduceat(
            np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2), first
        )
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
    triangles; bottom, top: (3, m) their boxes. root: (c,) root node of each component's tree, or
    -1. A node's first child is `child`, -1 for leaves; the second one follows. A leaf holds
    triangles `first` to `last`. low, high: (n, 3) boxes of nodes; inverted if a node is empty.
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
            triangle_rows = np.flatnonzero(selected[component])
            ids = ids[triangle_rows]
            component = component[triangle_rows]
        low, high = np.empty((2, 3, len(ids)))
        code = np.zeros(len(ids), np.int64)
        corner = (components.low - self.origin).T
        scale = 1023.0 / np.maximum(
            (components.high - components.low).max(axis=1), 1023.0 * np.finfo(float).tiny
        )
        for begin in range(0, len(ids), TRIANGLES_PER_BLOCK):
            triangle_rows = slice(begin, begin + TRIANGLES_PER_BLOCK)
            index = ids[triangle_rows].T.astype(np.intp, order="C")
            for k, column in enumerate(self.vertex_columns):
                a, b, c = column.take(index)
                np.minimum(np.minimum(a, b), c, out=low[k, triangle_rows])
                np.maximum(np.maximum(a, b), c, out=high[k, triangle_rows])
                cell = (
                    0.5 * (low[k, triangle_rows] + high[k, triangle_rows])
                    - corner[k, component[triangle_rows]]
                ) * scale[component[triangle_rows]]
                code[triangle_rows] |= spread_bits(cell.astype(np.int64)) << k
        order = radix_argsort(code)
        order = order[radix_argsort(component[order])]
        self.ids = ids[order].T.astype(np.intp, order="C")
        component = component[order]
        self.bottom = low[:, order]
        self.top = high[:, order]
        return component

    def _build_nodes(self, component: Index, selected: Mask) -> None:
        """Build the nodes over the sorted triangles of these (m,) components."""
        present = np.flatnonzero(selected)
        begin = np.searchsorted(component, present)
        size = np.searchsorted(component, present, side="right") - begin
        leaves = -(-size // TRIANGLES_PER_LEAF)
        depth = np.ceil(np.log2(leaves)).astype(np.intp)
        width = 1 << depth
        offset = np.concatenate([[0], np.cumsum(2 * width - 1)])
        count = int(offset[-1])
        self.root = np.full(len(selected), -1)
        self.root[present] = offset[:-1]
        self.low = np.full((count, 3), np.inf)
        self.high = np.full((count, 3), -np.inf)
        self.first, self.last = np.zeros((2, count), np.intp)
        tree = np.repeat(np.arange(len(present)), 2 * width - 1)
        self.child = 2 * np.arange(count) - offset[tree] + 1
        self.child[np.arange(count) - offset[tree] >= width[tree] - 1] = -1

        k = segment_ranges(leaves)
        tree = np.repeat(np.arange(len(present)), leaves)
        leaf = offset[tree] + width[tree] - 1 + k
        self.first[leaf] = begin[tree] + TRIANGLES_PER_LEAF * k
        self.last[leaf] = np.minimum(self.first[leaf] + TRIANGLES_PER_LEAF, (begin + size)[tree])
        for k in range(3):
            self.low[leaf, k] = np.minimum.reduceat(self.bottom[k], self.first[leaf])
            self.high[leaf, k] = np.maximum.reduceat(self.top[k], self.first[leaf])
        for level in range(int(depth.max()) - 1, -1, -1):
            deep = np.flatnonzero(depth > level)
            node = (offset[deep][:, None] + ((1 << level) - 1 + np.arange(1 << level))).ravel()
            child = self.child[node]
            self.low[node] = np.minimum(self.low[child], self.low[child + 1])
            self.high[node] = np.maximum(self.high[child], self.high[child + 1])

    def corners(self, triangle: Index) -> Array:
        """Return the (3, 3, k) coordinates, about `origin`, of the corners of sorted triangles."""
        return self.vertex_columns.take(self.ids.take(triangle, axis=1), axis=1)

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
        """Return (k,) winding numbers of components around places, and whether each is sure."""
        winding = np.zeros(len(query_points), np.intp)
        sure = np.ones(len(query_points), bool)
        query = np.ascontiguousarray(query_points.T)
        height = query[2] - tolerance
        (u, v) = _across(query)
        pieces = batches(np.arange(len(query_points)), self.root[component])
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
            hit = (
                (top >= height.take(place))
                & (left <= x)
                & (right >= x)
                & (front <= y)
                & (back >= y)
            )
            place, node = place[hit], node[hit]
            child = self.child.take(node)
            leaf = child == -1
            if leaf.any():
                for at, leaves in batches(
                    place[leaf], node[leaf], size=PAIRS_PER_BATCH // TRIANGLES_PER_LEAF
                ):
                    self._count_crossings(query, at, leaves, tolerance, winding, sure)
            place, child = place[~leaf], child[~leaf]
            pieces += batches(np.concatenate([place, place]), np.concatenate([child, child + 1]))
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
        first = self.first.take(leaf)
        size = self.last.take(leaf) - first
        triangle = np.repeat(first, size) + segment_ranges(size)
        place = np.repeat(place, size)
        corner = self.corners(triangle)
        corner -= query.take(place, axis=1)[:, None]
        u, v = _across(corner)
        ids = self.ids.take(triangle, axis=1)
        edge = np.empty(ids.shape)
        positive = np.empty(ids.shape, bool)
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            # Judged from the edge's lower vertex, so that both its triangles see one number; zero
            # counts as positive.
            back = ids[i] > ids[j]
            area = np.where(back, u[j] * v[i] - u[i] * v[j], u[i] * v[j] - u[j] * v[i])
            edge[k] = np.where(back, -area, area)
            positive[k] = (area >= 0.0) ^ back
        struck = np.flatnonzero((positive[0] == positive[1]) & (positive[1] == positive[2]))
        place = place[struck]
        edge = edge[:, struck]
        positive = positive[0, struck]
        heights = corner[2][:, struck]
        total = edge.sum(axis=0)
        flat = total == 0.0
        height = np.einsum("kj,kj->j", edge, heights) / np.where(flat, 1.0, total)
        sure[place[flat | (np.abs(height) <= tolerance)]] = False
        above = height > 0.0
        np.add.at(winding, place[above], np.where(positive[above], 1, -1))

    def distances(self, query_points: Array, component: Index, within: float = np.inf) -> Array:
        """Return the (k,) distances of places (about `origin`) from the surfaces of components; inf
        beyond `within`.
        """
        nearest = np.full(len(query_points), np.nextafter(within, np.inf))
        pieces = batches(np.arange(len(query_points)), self.root[component])
        while pieces:
            place, node = pieces.pop()
            point = query_points[place]
            low = self.low[node]
            high = self.high[node]
            occupied = high[:, 0] >= low[:, 0]
            least = np.linalg.norm(np.maximum(np.maximum(low - point, point - high), 0.0), axis=1)
            most = np.linalg.norm(np.maximum(np.abs(point - low), np.abs(high - point)), axis=1)
            np.minimum.at(nearest, place[occupied], most[occupied] * (1.0 + 1e-12))
            near = occupied & (least <= nearest[place])
            place, node = place[near], node[near]
            child = self.child[node]
            leaf = child == -1
            if leaf.any():
                size = self.last[node[leaf]] - self.first[node[leaf]]
                triangle = np.repeat(self.first[node[leaf]], size) + segment_ranges(size)
                at = np.repeat(place[leaf], size)
                corners = self.corners(triangle).transpose(2, 1, 0)
                np.minimum.at(nearest, at, triangle_distances(query_points[at], corners))
            place, child = place[~leaf], child[~leaf]
            pieces += batches(np.concatenate([place, place]), np.concatenate([child, child + 1]))
        return np.where(nearest <= within, nearest, np.inf)

    def first_hits(self, starts: Array, rays: Array, reach: float) -> tuple[Array, Index]:
        """Return the distances from (k, 3) places (about `origin`) along unit rays to the first
        triangle of the first component, and its sorted row; inf and 0 if none is within `reach`.
        """
        depth = np.full(len(starts), np.inf)
        hit = np.zeros(len(starts), np.intp)
        inverse = 1.0 / np.where(np.abs(rays) > LEAST_SLOPE, rays, LEAST_SLOPE)
        slack = RAY_RTOL * reach
        pieces = batches(np.arange(len(starts)), np.full(len(starts), self.root[0]))
        while pieces:
            line, node = pieces.pop()
            low, high = self.low[node], self.high[node]
            ends = (np.stack([low, high]) - starts[line]) * inverse[line]
            last = np.minimum(ends.max(axis=0).min(axis=1), np.minimum(depth[line], reach))
            crossed = (ends.min(axis=0).max(axis=1) <= last + slack) & (last >= -slack)
            crossed &= high[:, 0] >= low[:, 0]
            line, node = line[crossed], node[crossed]
            child = self.child[node]
            leaf = child == -1
            size = self.last[node[leaf]] - self.first[node[leaf]]
            triangle = np.repeat(self.first[node[leaf]], size) + segment_ranges(size)
            at = np.repeat(line[leaf], size)
            a, b, c = self.corners(triangle).transpose(1, 2, 0)
            across = np.cross(rays[at], c - a)
            volume = np.einsum("ri,ri->r", across, b - a)
            share = 1.0 / np.where(volume != 0.0, volume, np.inf)
            away = starts[at] - a
            turned = np.cross(away, b - a)
            u = np.einsum("ri,ri->r", away, across) * share
            v = np.einsum("ri,ri->r", rays[at], turned) * share
            distance = np.einsum("ri,ri->r", c - a, turned) * share
            is_hit = np.minimum(np.minimum(u, v), 1.0 - u - v) >= -CORNER_ATOL
            is_hit &= (volume != 0.0) & (distance > slack) & (distance < depth[at])
            at, triangle, distance = at[is_hit], triangle[is_hit], distance[is_hit]
            order = np.argsort(-distance, kind="stable")  # the last of equal indices wins
            depth[at[order]] = distance[order]
            hit[at[order]] = triangle[order]
            line, child = line[~leaf], child[~leaf]
            pieces += batches(np.concatenate([line, line]), np.concatenate([child, child + 1]))
        return depth, hit


def _across(places: Array) -> tuple[Array, Array]:
    """Return the points in which the rays through places, (3, ...), meet the plane z = 0."""
    return places[0] - RAY_SLOPES[0] * places[2], places[1] - RAY_SLOPES[1] * places[2]


def batches(*arrays: NDArray, size: int = PAIRS_PER_BATCH) -> list[tuple[NDArray, ...]]:
    """Cut the arrays into parallel pieces of bounded length."""
    return [tuple(array[k : k + size] for array in arrays) for k in range(0, len(arrays[0]), size)]


def tree_of_all(points: NDArray[np.floating], triangles: NDArray[np.integer]) -> Bvh:
    """Return the tree of all triangles as one component."""
    points = np.asarray(points, np.float64)
    component = np.zeros(len(triangles), np.intp)
    whole = sort_components(points, triangles.astype(np.intp, copy=False), component, 1)
    return Bvh(points, whole, np.ones(1, bool))
