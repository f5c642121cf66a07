# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons with holes in the plane, as directed edges: the inside lies to the left of each.

Area moments of any order are those of a boundary of 1-simplices (Sheynin and Tuzikov in two dimensions; see `simplex`):
over an edge a, b the triangle with the origin gives (a x b)·S_pq·p! q! / (p+q+2)!. Outer outlines run counter-
clockwise, holes clockwise, separate regions simply add. What makes a region ambiguous, outlines that cross or lie on
one another, is found by `flaws`: no sum over edges would show it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .simplex import SimplexMoments, enclosed_moments, facet_moments
from .topology import components

SAMPLES = 16  # midpoints of an outline's edges that are asked what it lies in
PAIRS = 10_000_000  # midpoints times edges of which winding numbers are taken; more midpoints are thinned out
BLOCK = 1 << 18  # of those at a time
TOUCH = 1e-9  # of the polygon's size: edges that pass each other by less than this touch


@dataclass(frozen=True)
class Flaws:
    """crossings: pairs of edges that cross, lost: whether there were too many pairs to look at all; doubled: whether
    somewhere an edge has more than one region, or less than none, beside it."""

    crossings: int
    lost: bool
    doubled: bool


def area_moments(points: ArrayLike, edges: ArrayLike, order: int, about: ArrayLike | None = None) -> SimplexMoments:
    """∫ x^p y^q dA for all p + q ≤ order, with error bounds.

    points: (n, 2). edges: (m, 2) indices. about: by default the centre of the points' box.
    ValueError where the edges do not close.
    """
    edges = np.asarray(edges)
    ends = [np.bincount(edges[:, i], minlength=len(points)) for i in (0, 1)] if len(edges) else [np.zeros(1)] * 2
    loose = int(np.count_nonzero(ends[0] != ends[1]))
    if loose:
        raise ValueError("The outline is open at {:d} of its corners; close it.".format(loose))
    return enclosed_moments(points, edges, order, about)


def outline_moments(points: ArrayLike, edges: ArrayLike, order: int = 0,
                    about: ArrayLike | None = None) -> SimplexMoments:
    """∫ x^p y^q ds along the edges; of order 0 the perimeter."""
    return facet_moments(points, edges, order, about)


def directed(loops: Sequence[ArrayLike]) -> NDArray[np.intp]:
    """(m, 2) the edges of loops of indices, in the direction of each."""
    rows = [np.stack([np.asarray(loop), np.roll(loop, -1)], axis=1) for loop in loops]
    return np.concatenate(rows).astype(np.intp) if rows else np.empty((0, 2), np.intp)


def nested(points: NDArray, loops: Sequence[NDArray]) -> NDArray[np.intp]:
    """(m, 2) the edges of loops of any direction, turned so that what lies in an odd number of them is inside:
    outlines, holes in those, islands in holes.

    ValueError where one loop runs along another all the way, so that neither is in the other.
    """
    boxes = [(points[loop].min(axis=0), points[loop].max(axis=0)) for loop in loops]
    order = []
    for i, loop in enumerate(loops):
        low, high = boxes[i]
        around = [j for j, (a, b) in enumerate(boxes) if j != i and (a <= low).all() and (high <= b).all()]
        edges = directed([loop])
        middle = points[edges[::max(1, len(edges) // SAMPLES)]].mean(axis=1)
        depth = 0
        for j in around:
            winding = np.abs(winding_numbers(points, directed([loops[j]]), middle))
            clear = np.abs(winding - 0.5)  # a midpoint on the other loop has half a turn
            if clear.max() < 0.25:
                raise ValueError("Two of its outlines lie on one another; remove one of them.")
            depth += int(winding[np.argmax(clear)] > 0.5)
        ahead = _signed_area(points, edges) > 0.0
        order.append(loop if ahead == (depth % 2 == 0) else loop[::-1])
    return directed(order)


def boundary_edges(faces: NDArray, count: int) -> NDArray[np.intp]:
    """(m, 2) the directed edges of (k, 3) triangles over `count` points that no other triangle runs through the other
    way: as often as one direction is more frequent."""
    ahead = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
    low, high = ahead.min(axis=1), ahead.max(axis=1)
    ahead, low, high = (rows[low != high] for rows in (ahead, low, high))
    keys, which = np.unique(low * count + high, return_inverse=True)
    net = np.bincount(which.ravel(), np.where(ahead[:, 0] == low, 1.0, -1.0), minlength=len(keys)).astype(np.int64)
    edges = np.stack([keys // count, keys % count], axis=1) if len(keys) else np.empty((0, 2), np.int64)
    edges = np.where(net[:, None] < 0, edges[:, ::-1], edges)
    return np.repeat(edges, np.abs(net), axis=0).astype(np.intp)


def outline_areas(points: NDArray, edges: NDArray) -> NDArray[np.float64]:
    """(k,) the signed area of each outline: negative ones are holes."""
    if not len(edges):
        return np.zeros(0)
    origin = points[edges[0, 0]]
    a, b = (points[edges[:, i]] - origin for i in (0, 1))
    outline = components(len(points), edges[:, 0], edges[:, 1])[0][edges[:, 0]]
    sums = np.bincount(outline, (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2.0)
    return sums[np.unique(outline)]


def flaws(points: NDArray, edges: NDArray, error: float = 0.0) -> Flaws:
    """What of the edges leaves it open which side is inside. Outlines may touch, at corners and along edges.

    error: how far the points may be from where they were meant; what overlaps by no more touches.
    """
    if not len(edges):
        return Flaws(0, False, False)
    points = points - points[edges.ravel()].min(axis=0)
    touch = TOUCH * float(points[edges.ravel()].max()) + 4.0 * error
    crossings, lost = _crossings(points, edges, touch)
    sampled = edges[::max(1, len(edges) * len(edges) // PAIRS)]
    directions = points[edges[:, 1]] - points[edges[:, 0]]
    doubled = False
    for part, turns, on in _turns(points, edges, points[sampled].mean(axis=1), touch):
        ahead = np.sign((points[sampled[part, 1]] - points[sampled[part, 0]]) @ directions.T)
        step = (on * ahead).sum(axis=1) / 2.0  # from an edge's middle to its left, past all edges that lie on it
        sides = np.round(np.stack([turns - step, turns + step]))
        doubled |= bool((sides[0] > sides[1]).any() or sides.min() < 0.0 or sides.max() > 1.0)
    return Flaws(crossings, lost, doubled)


def winding_numbers(points: NDArray, edges: NDArray, places: NDArray) -> NDArray[np.float64]:
    """(k,) how often the edges go round each place; at a place on an edge the mean of both sides."""
    return np.concatenate([turns for _, turns, _ in _turns(points, edges, places)] or [np.zeros(0)])


def _turns(points: NDArray, edges: NDArray, places: NDArray,
           touch: float = 0.0) -> Iterator[tuple[slice, NDArray, NDArray]]:
    """For blocks of places: which, their winding numbers, and (k, m) whether a place is on an edge, or as near to it as
    `touch`."""
    lengths = touch * np.hypot(*(points[edges[:, 1]] - points[edges[:, 0]]).T)
    block = max(1, BLOCK // max(1, len(edges)))
    for start in range(0, len(places), block):
        part = slice(start, start + block)
        spans = points[edges] - places[part, None, None]  # (k, m, 2 ends, 2)
        a, b = spans[:, :, 0], spans[:, :, 1]
        cross, along = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0], (a * b).sum(axis=2)
        # A place on an edge sees its ends in opposite directions, with a sign that is rounding.
        on = (np.abs(cross) <= np.maximum(1e-12 * np.abs(along), lengths)) & (along <= 0.0)
        yield part, np.where(on, 0.0, np.arctan2(cross, along)).sum(axis=1) / (2.0 * np.pi), on


def _signed_area(points: NDArray, edges: NDArray) -> float:
    a, b = (points[edges[:, i]] - points[edges[0, 0]] for i in (0, 1))
    return float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) / 2.0


def _crossings(points: NDArray, edges: NDArray, touch: float) -> tuple[int, bool]:
    """Pairs of edges that cross by more than `touch`, by a sweep along the longer side of the box: each edge is
    compared with those that begin before it ends. The second value tells whether that was given up.
    """
    axis = int(np.argmax(np.ptp(points[edges.ravel()], axis=0)))
    order = np.argsort(points[edges][:, :, axis].min(axis=1), kind="stable")
    start, end = points[edges[order, 0]], points[edges[order, 1]]
    low, high = np.minimum(start, end)[:, axis], np.maximum(start, end)[:, axis]
    length = np.hypot(*(end - start).T)
    length[length == 0.0] = 1.0
    active, found, looked = np.arange(len(edges)), 0, 0
    for step in range(1, len(edges)):
        active = active[active < len(edges) - step]
        active = active[low[active + step] < high[active]]
        if not len(active):
            break
        looked += len(active)
        if looked > PAIRS:
            return found, True
        i, j = active, active + step
        sides = []
        for p, q, other in ((i, j, start), (i, j, end), (j, i, start), (j, i, end)):
            span, to = end[p] - start[p], other[q] - start[p]
            sides.append((span[:, 0] * to[:, 1] - span[:, 1] * to[:, 0]) / length[p])
        apart = [np.abs(side) > touch for side in sides]
        found += int(np.count_nonzero((sides[0] * sides[1] < 0.0) & (sides[2] * sides[3] < 0.0)
                                      & apart[0] & apart[1] & apart[2] & apart[3]))
    return found, False
