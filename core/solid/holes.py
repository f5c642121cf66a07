# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rims of open surfaces: loops, which of them are gaps without area, and the caps of the others.

A rim side is joined at each of its vertices to the side that leaves in the most similar direction, so that an edge
and the shorter edges that run back along it (a T-junction) make a loop of their own, which has no area: there the
surface closes in space although it does not in the mesh. The other loops are capped by the cone to their centroid. As a
signed chain, a cone to a point in the loop's plane is the flat cap, whatever the loop's shape, so flat loops need no
triangulation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import ramp
from ..numerics.graph import components

SLIM = 1e-3  # width by length, at most, of a gap that counts as none
MOST_PAIRS = 4_000_000  # of ends that meet; beyond, ends are joined in the order of their numbers


def join_sides(
    begin: NDArray[np.float64],
    end: NDArray[np.float64],
    start: NDArray[np.integer],
    stop: NDArray[np.integer],
    directed: bool,
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.bool_]]:
    """Links between the sides of rims: (k,) one side, (k,) the side joined to it, (k,) whether they run head to tail.

    begin, end: (r, 3) where each side begins and ends; start, stop: (r,) numbers, equal where sides may be joined.
    directed: whether only head to tail will do. Where an even number of sides meet (of them as many arriving as
    leaving) all are joined in pairs, the sharpest turns first.
    """
    count = len(start)
    vertex = np.concatenate([start, stop])
    direction = end - begin
    length = np.linalg.norm(direction, axis=1)[:, None]
    direction = np.divide(direction, length, out=np.zeros_like(direction), where=length > 0.0)
    direction = np.concatenate([direction, -direction])  # both seen from the vertex
    order = np.argsort(vertex, kind="stable")
    first = np.flatnonzero(np.concatenate([[True], np.diff(vertex[order]) != 0]))
    degree = np.diff(np.append(first, len(order)))

    simple = first[degree == 2]
    left, right = [order[simple]], [order[simple + 1]]
    crowded = first[degree > 2], degree[degree > 2]
    if len(crowded[0]):
        one, other = _candidates(order, *crowded)
        if directed:
            fits = (one < count) != (other < count)
            one, other = one[fits], other[fits]
        score = np.einsum("ij,ij->i", direction[one], direction[other])
        best = np.lexsort([other, one, -score])
        one, other = _matched(one[best], other[best], 2 * count)
        left.append(one)
        right.append(other)
    left, right = np.concatenate(left), np.concatenate(right)
    follows = (left < count) != (right < count)
    return left % count, right % count, follows


def _candidates(order: NDArray, first: NDArray, degree: NDArray) -> tuple[NDArray, NDArray]:
    """Pairs of ends that meet at a vertex: all of them, or where that would be too many, neighbours in `order`."""
    pairs = degree * (degree - 1) // 2
    if pairs.sum() > MOST_PAIRS:
        within = np.concatenate([np.ones(len(order) - 1, bool), [False]])
        within[first - 1] = False
        member = np.repeat(first, degree) + ramp(degree)
        member = member[within[member]]
        return order[member], order[member + 1]
    row = np.repeat(np.arange(len(degree)), pairs)
    k = ramp(pairs)
    # The k-th pair (i, j), i < j, of the strict upper triangle read by columns.
    j = ((1.0 + np.sqrt(1.0 + 8.0 * k)) / 2.0).astype(np.intp)
    j -= j * (j - 1) // 2 > k
    j += j * (j + 1) // 2 <= k
    i = k - j * (j - 1) // 2
    return order[first[row] + i], order[first[row] + j]


def _matched(one: NDArray, other: NDArray, ends: int) -> tuple[NDArray, NDArray]:
    """The greedy matching of candidates that come best first: in each round those that are best for both their ends."""
    left, right = [one[:0]], [other[:0]]
    while len(one):
        rank = np.arange(len(one))
        best = np.full(ends, len(one))
        best[one[::-1]] = rank[::-1]
        second = np.full(ends, len(one))
        second[other[::-1]] = rank[::-1]
        best = np.minimum(best, second)
        taken = (best[one] == rank) & (best[other] == rank)
        left.append(one[taken])
        right.append(other[taken])
        used = np.zeros(ends, bool)
        used[one[taken]] = used[other[taken]] = True
        free = ~(used[one] | used[other])
        one, other = one[free], other[free]
    return np.concatenate(left), np.concatenate(right)


@dataclass(frozen=True, eq=False)
class Loops:
    """Rim sides grouped into loops, numbered in the order of their first sides.

    of_side: (r,) the loop of each side. complete: (l,) whether all its sides are joined at both ends. perimeter: (l,).
    centroid: (l, 3), of the curve. cone: (l,) the area of the cone to the centroid. flat: (l,) the norm of the loop's
    area vector. height: (l,) how far from its plane the loop goes; infinite where it has none.
    """

    of_side: NDArray[np.intp]
    complete: NDArray[np.bool_]
    perimeter: NDArray[np.float64]
    centroid: NDArray[np.float64]
    cone: NDArray[np.float64]
    flat: NDArray[np.float64]
    height: NDArray[np.float64]

    def wide(self, tolerance: float) -> NDArray[np.bool_]:
        """(l,) which loops are holes; the others are narrower than `tolerance` (length) and much longer than wide."""
        return self.cone > self.perimeter * np.minimum(tolerance, SLIM * self.perimeter)


def find_loops(begin: NDArray[np.float64], end: NDArray[np.float64], links: tuple[NDArray, NDArray, NDArray]) -> Loops:
    """The loops that the links of `join_sides` make of rim sides, and their measures."""
    of_side, number = components(len(begin), links[0], links[1])
    joined = np.bincount(np.concatenate(links[:2]), minlength=len(begin))
    complete = np.bincount(of_side, joined != 2) == 0
    origin = np.empty((number, 3))
    origin[of_side[::-1]] = begin[::-1]  # about the loop's first vertex: a coordinate that all share stays exact
    a, b = begin - origin[of_side], end - origin[of_side]
    length = np.linalg.norm(b - a, axis=1)
    perimeter = np.bincount(of_side, length)
    middle = (a + b) * (0.5 * length)[:, None]
    divisor = np.where(perimeter > 0.0, perimeter, 1.0)
    center = np.stack([np.bincount(of_side, middle[:, k]) / divisor for k in range(3)], axis=1)
    a -= center[of_side]
    b -= center[of_side]
    wedge = np.cross(a, b) / 2.0
    vector = np.stack([np.bincount(of_side, wedge[:, k]) for k in range(3)], axis=1)
    flat = np.linalg.norm(vector, axis=1)
    cone = np.bincount(of_side, np.linalg.norm(wedge, axis=1))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        normal = vector / flat[:, None]
        height = np.zeros(number)
        np.maximum.at(height, of_side, np.abs(np.einsum("ij,ij->i", normal[of_side], a)))
    height[~np.isfinite(height)] = np.inf
    return Loops(of_side, complete, perimeter, center + origin, cone, flat, height)
