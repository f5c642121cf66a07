# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells that go through each other: an edge of one pierces a triangle of the other.

The search walks down the trees of both shells with all pairs at once, in bounded pieces of work.
"""

import numpy as np

from ..numerics import Array, Index, Mask, NDArray, segment_ranges
from .bvh import MAX_BOX_PAIRS, PAIRS_PER_BATCH, TRIANGLES_PER_LEAF, Bvh, cut


def intersecting_pairs(
    tree: Bvh, first: NDArray, second: NDArray, tolerance: float, vertex: NDArray | None = None
) -> tuple[Mask, Mask]:
    """Return (k,) masks of pairs in which an edge pierces the other by the tolerance, and of
    undecided pairs.

    first, second: (k,) components. vertex: (n,) numbers; triangles with a common number are not
    compared.
    """
    intersects, unfinished = np.zeros((2, len(first)), bool)
    pieces = cut(np.arange(len(first)), tree.root[first], tree.root[second])
    work = 0
    while pieces:
        pair, a, b = pieces.pop()
        is_open = ~intersects[pair]
        pair, a, b = (values[is_open] for values in (pair, a, b))
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
        are_leaves = (child_a == -1) & (child_b == -1)
        if are_leaves.any():
            for leaf_pair, leaf_a, leaf_b in cut(
                pair[are_leaves],
                a[are_leaves],
                b[are_leaves],
                size=PAIRS_PER_BATCH // TRIANGLES_PER_LEAF**2,
            ):
                _intersect_leaves(tree, leaf_pair, leaf_a, leaf_b, tolerance, intersects, vertex)
            pair, a, b, child_a, child_b = (x[~are_leaves] for x in (pair, a, b, child_a, child_b))
        # The larger box is opened; a leaf never is.
        size_a = (tree.high[a] - tree.low[a]).max(axis=1)
        size_b = (tree.high[b] - tree.low[b]).max(axis=1)
        opens_a = (child_b == -1) | ((size_a >= size_b) & (child_a != -1))
        opens_b = ~opens_a
        pieces += cut(
            np.concatenate([pair[opens_a], pair[opens_a], pair[opens_b], pair[opens_b]]),
            np.concatenate([child_a[opens_a], child_a[opens_a] + 1, a[opens_b], a[opens_b]]),
            np.concatenate([b[opens_a], b[opens_a], child_b[opens_b], child_b[opens_b] + 1]),
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
    size_a = tree.end[a] - tree.begin[a]
    size_b = tree.end[b] - tree.begin[b]
    k = segment_ranges(size_a * size_b)
    row = np.repeat(np.arange(len(a)), size_a * size_b)
    first = tree.begin[a][row] + k // size_b[row]
    second = tree.begin[b][row] + k % size_b[row]
    pair = pair[row]
    meet = np.ones(len(pair), bool)
    for low, high in zip(tree.triangle_low, tree.triangle_high):
        meet &= (low[first] <= high[second]) & (low[second] <= high[first])
    first, second, pair = (values[meet] for values in (first, second, pair))
    if vertex is not None:
        of_first = vertex[tree.ids[:, first]]
        of_second = vertex[tree.ids[:, second]]
        apart = np.logical_and.reduce([x != y for x in of_first for y in of_second])
        first, second, pair = (values[apart] for values in (first, second, pair))
    corners, partners = (tree.corners(triangle).transpose(1, 2, 0) for triangle in (first, second))
    intersects[pair[_edges_cross_triangles(corners, partners, tolerance)]] = True
    intersects[pair[_edges_cross_triangles(partners, corners, tolerance)]] = True


def _edges_cross_triangles(corners: Array, partners: Array, tolerance: float) -> Index:
    """Return the indices of the k triangles with an edge through their partner by over the
    tolerance. corners, partners: (3, k, 3), corner, triangle, coordinate.

    The depth of an edge is the least of three lengths: how far inside the partner's sides it goes
    through its plane, and the heights over this plane at which it passes the sides, or ends, on
    either side.
    """
    normal = np.cross(partners[1] - partners[0], partners[2] - partners[0])
    length = np.linalg.norm(normal, axis=1)[:, None]
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0)
    height = np.einsum("kij,ij->ki", corners - partners[0], normal)
    passing = np.flatnonzero((height.max(axis=0) > tolerance) & (height.min(axis=0) < -tolerance))
    corners = corners[:, passing]
    partners = partners[:, passing]
    normal = normal[passing]
    height = height[:, passing]
    depth = np.full(len(passing), -np.inf)
    for i in range(3):
        rise = height[i]
        fall = height[i - 1]
        crosses = (np.minimum(rise, fall) < -tolerance) & (np.maximum(rise, fall) > tolerance)
        share = rise / np.where(crosses, rise - fall, 1.0)
        inside = np.where(crosses, np.inf, -np.inf)
        # The part of the edge, as shares of its length, that is within the partner's sides.
        first_share = np.zeros(len(passing))
        last_share = np.ones(len(passing))
        for k in range(3):
            side = partners[k] - partners[k - 1]
            inward = np.cross(normal, side) / np.linalg.norm(side, axis=1)[:, None]
            begin, end = (
                np.einsum("ij,ij->i", inward, corners[j] - partners[k]) for j in (i, i - 1)
            )
            inside = np.minimum(inside, begin + share * (end - begin))
            passes = begin / np.where(begin != end, begin - end, 1.0)
            first_share = np.where(begin < 0.0, np.maximum(first_share, passes), first_share)
            last_share = np.where(end < 0.0, np.minimum(last_share, passes), last_share)
        at_ends = [np.abs(rise + part * (fall - rise)) for part in (first_share, last_share)]
        depth = np.maximum(depth, np.minimum.reduce([inside, *at_ends]))
    return passing[depth > tolerance]
