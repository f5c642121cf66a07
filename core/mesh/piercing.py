# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells that go through each other: an edge of one pierces a triangle of the other.

The search walks down the trees of both shells with all pairs at once, in bounded pieces of work.
"""

import numpy as np

from ..numerics import Array, Index, Mask, NDArray, segment_ranges
from .bvh import MAX_BOX_PAIRS, PAIRS_PER_BATCH, TRIANGLES_PER_LEAF, Bvh, batches


def intersecting_pairs(
    tree: Bvh, first: NDArray, second: NDArray, tolerance: float, vertex: NDArray | None = None
) -> tuple[Mask, Mask]:
    """Return (k,) masks of pairs in which an edge pierces the other by the tolerance, and of
    undecided pairs.
    """
    intersects, unfinished = np.zeros((2, len(first)), bool)
    pieces = batches(np.arange(len(first)), tree.root[first], tree.root[second])
    work = 0
    while pieces:
        pair, a, b = pieces.pop()
        going = ~intersects[pair]
        pair, a, b = (values[going] for values in (pair, a, b))
        work += len(pair)
        if work > MAX_BOX_PAIRS:
            for rest, *_ in [*pieces, (pair,)]:
                unfinished[rest] = True
            break
        meet = np.all(
            np.minimum(tree.high[a], tree.high[b]) - np.maximum(tree.low[a], tree.low[b]) >= 0.0,
            axis=1,
        )
        pair, a, b = (values[meet] for values in (pair, a, b))
        child_a, child_b = tree.child[a], tree.child[b]
        both = (child_a == -1) & (child_b == -1)
        if both.any():
            for of, left, right in batches(
                pair[both], a[both], b[both], size=PAIRS_PER_BATCH // TRIANGLES_PER_LEAF**2
            ):
                _intersect_leaves(tree, of, left, right, tolerance, intersects, vertex)
            pair, a, b, child_a, child_b = (x[~both] for x in (pair, a, b, child_a, child_b))
        # The larger box is opened; a leaf never is.
        extent = (tree.high[a] - tree.low[a]).max(axis=1) >= (tree.high[b] - tree.low[b]).max(
            axis=1
        )
        left = (child_b == -1) | (extent & (child_a != -1))
        pieces += batches(
            np.concatenate([pair[left], pair[left], pair[~left], pair[~left]]),
            np.concatenate([child_a[left], child_a[left] + 1, a[~left], a[~left]]),
            np.concatenate([b[left], b[left], child_b[~left], child_b[~left] + 1]),
        )
    return intersects, unfinished


def _intersect_leaves(
    tree: Bvh,
    pair: NDArray,
    a: NDArray,
    b: NDArray,
    tolerance: float,
    intersects: NDArray,
    vertex: NDArray | None,
) -> None:
    """Mark, in `intersects`, the pairs with a triangle in one leaf that is pierced by an edge in
    the other.
    """
    size_a = tree.last[a] - tree.first[a]
    size_b = tree.last[b] - tree.first[b]
    k = segment_ranges(size_a * size_b)
    row = np.repeat(np.arange(len(a)), size_a * size_b)
    first = tree.first[a][row] + k // size_b[row]
    second = tree.first[b][row] + k % size_b[row]
    pair = pair[row]
    meet = np.ones(len(pair), bool)
    for low, high in zip(tree.bottom, tree.top):
        meet &= (low[first] <= high[second]) & (low[second] <= high[first])
    first, second, pair = (values[meet] for values in (first, second, pair))
    if vertex is not None:
        mine = vertex[tree.ids[:, first]]
        theirs = vertex[tree.ids[:, second]]
        apart = np.logical_and.reduce([x != y for x in mine for y in theirs])
        first, second, pair = (values[apart] for values in (first, second, pair))
    corner, plane = (tree.corners(triangle).transpose(1, 2, 0) for triangle in (first, second))
    for _ in range(2):
        intersects[pair[_edges_cross_triangles(corner, plane, tolerance)]] = True
        corner, plane = plane, corner


def _edges_cross_triangles(corner: Array, plane: Array, tolerance: float) -> Index:
    """Return the indices of triangles (3, k, 3) with an edge through their partner by over the
    tolerance.
    """
    normal = np.cross(plane[1] - plane[0], plane[2] - plane[0])
    length = np.linalg.norm(normal, axis=1)[:, None]
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0)
    height = np.einsum("kij,ij->ki", corner - plane[0], normal)
    at = np.flatnonzero((height.max(axis=0) > tolerance) & (height.min(axis=0) < -tolerance))
    corner = corner[:, at]
    plane = plane[:, at]
    normal = normal[at]
    height = height[:, at]
    depth = np.full(len(at), -np.inf)
    for i in range(3):
        p = corner[i]
        q = corner[i - 1]
        rise = height[i]
        fall = height[i - 1]
        crosses = (np.minimum(rise, fall) < -tolerance) & (np.maximum(rise, fall) > tolerance)
        share = rise / np.where(crosses, rise - fall, 1.0)
        within = np.where(crosses, np.inf, -np.inf)
        first = np.zeros(len(at))
        last = np.ones(len(at))
        for k in range(3):
            edge = plane[k] - plane[k - 1]
            inward = np.cross(normal, edge) / np.linalg.norm(edge, axis=1)[:, None]
            begin, end = (np.einsum("ij,ij->i", inward, point - plane[k]) for point in (p, q))
            within = np.minimum(within, begin + share * (end - begin))
            leaves = begin / np.where(begin != end, begin - end, 1.0)
            first = np.where(begin < 0.0, np.maximum(first, leaves), first)
            last = np.where(end < 0.0, np.minimum(last, leaves), last)
        # both ends of the part over the partner
        over = [np.abs(rise + part * (fall - rise)) for part in (first, last)]
        depth = np.maximum(depth, np.minimum.reduce([within, *over]))
    return at[depth > tolerance]
