# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons with holes in the plane, as directed edges: the inside lies to the left of each.

Area moments of any order are integrals over a boundary of 1-simplices (Sheynin and Tuzikov in two
dimensions; see `n_dimensions`): over an edge a, b the triangle with the origin gives (a x
b)·S_pq·p! q! / (p+q+2)!. Outer outlines run counter-clockwise, holes clockwise; separate regions
simply add. Ambiguous regions, with outlines that cross or lie on one another, are found by
`find_defects`: no sum over edges would show them.

`region_moments` returns them as `Moments` with third coordinate zero, which shift, turn, add and
are normalized like those of bodies. Beside the rounding of the integration, which `n_dimensions`
bounds, a region's points may be off: an edge of length l whose ends move by at most d sweeps over
at most d (l + 2 d), and there |x| and |y| exceed those of the ends by at most d.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..moments import Measure, Moments, monomial_count, monomial_index
from ..numerics import (
    Array,
    ArrayLike,
    Index,
    Int64,
    Integers,
    NDArray,
    connected_components,
    float_array,
    index_array,
    rectangle_pairs,
    sums_by_index,
)
from ..polyhedron import SimplexMoments, enclosed_moments, multi_indices
from ..verdict import MeasureError
from .findings import NO_SECTION_AREA, OUTLINE_OPEN, OUTLINES_COINCIDE, OUTLINES_ENCLOSE_NONE

# Edge midpoints of an outline that are tested for lying in other outlines.
SAMPLES_PER_OUTLINE = 16
# Limit of compared pairs of edges, and of pairs of a ray and an edge; rays beyond it are thinned
# out.
MAX_EDGE_PAIRS = 10_000_000
PAIRS_PER_BLOCK = 1 << 18  # Pairs at a time.
RAYS_PER_BLOCK = 64  # neighboring rays at a time, which meet much the same edges
# Relative to the polygon's size: edges that pass each other by less than this touch.
TOUCH_RTOL = 1e-9
# Relative to the distances from an edge's ends: a point this near to its line is on it.
ON_EDGE_RTOL = 1e-12
BOUND_ROUNDING = 1.0 + 1e-9  # The sums that make a bound are rounded themselves.
EDGES_PER_BLOCK = 4096


@dataclass(frozen=True)
class OutlineDefects:
    """Defects that make the inside of edges ambiguous.

    `crossings`: pairs of edges that cross. `too_many_pairs`: True if there were too many pairs to
    compare all of them. `overlapping`: True if the winding number beside an edge is above 1, below
    0, or smaller to the left than to the right. `negative`: True if the winding number to the right
    of an edge is below 0. `shared_length`: the length along which edges run against each other,
    which is not part of the region's boundary.
    """

    crossings: int
    too_many_pairs: bool
    overlapping: bool
    negative: bool = False
    shared_length: float = 0.0


def area_moments(
    points: ArrayLike, edges: ArrayLike, order: int, about: ArrayLike | None = None
) -> SimplexMoments:
    """Return ∫ x^p y^q dA of the region left of (m, 2) closed edges, about the middle of the box,
    with error bounds.
    """
    points, edges = edge_arrays(points, edges)
    ends = [np.bincount(edges[:, i], minlength=len(points)) for i in (0, 1)]
    loose = int(np.count_nonzero(ends[0] != ends[1]))
    if loose:
        raise MeasureError(OUTLINE_OPEN, count=loose)
    return enclosed_moments(points, edges, order, about, allow_open=True)


def edge_arrays(points: ArrayLike, edges: ArrayLike, dimension: int = 2) -> tuple[Array, Integers]:
    """Return (n, 2) points, or in space (n, 3), and (m, 2) edges between them as arrays."""
    points = float_array("points", points, "n", dimension)
    return points, index_array("edges", edges, "m", 2, count=len(points))


def directed_edges(loops: Sequence[ArrayLike]) -> Index:
    """Return the edges of loops, in the direction of each.

    Parameters
    ----------
    loops : sequence of (k,) array_like of int
        Indices of points.

    Returns
    -------
    (m, 2) integer array

    Examples
    --------
    >>> from body_moments.core.flat import directed_edges
    >>> directed_edges([[0, 1, 2]]).tolist()
    [[0, 1], [1, 2], [2, 0]]
    """
    loops = [index_array("loops", loop, "k") for loop in loops]
    loop_edges = [np.stack([loop, np.roll(loop, -1)], axis=1) for loop in loops]
    return np.concatenate(loop_edges).astype(np.intp) if loop_edges else np.empty((0, 2), np.intp)


def orient_loops(points: ArrayLike, loops: Sequence[ArrayLike]) -> Index:
    """Return (m, 2) edges of loops, (k,) indices each, so that points in an odd number of loops are
    left of them.
    """
    points = float_array("points", points, "n", 2)
    loops = [index_array("loops", loop, "k", count=len(points)) for loop in loops]
    lows, highs = (
        np.array([extreme(points[loop], axis=0) for loop in loops]).reshape(-1, 2)
        for extreme in (np.min, np.max)
    )
    oriented = []
    for i, loop in enumerate(loops):
        # Loops whose boxes contain that of this loop.
        around = np.flatnonzero((lows <= lows[i]).all(axis=1) & (highs >= highs[i]).all(axis=1))
        edges = directed_edges([loop])
        midpoints = points[edges[:: max(1, len(edges) // SAMPLES_PER_OUTLINE)]].mean(axis=1)
        depth = 0
        for j in around[around != i].tolist():
            winding = np.abs(winding_numbers(points, directed_edges([loops[j]]), midpoints))
            # 0.5 inside and outside of the other loop, 0 on it, where it winds by half a turn
            clearness = np.abs(winding - 0.5)
            if clearness.max() < 0.25:
                raise MeasureError(OUTLINES_COINCIDE)
            depth += int(winding[np.argmax(clearness)] > 0.5)
        a, b = (points[edges[:, k]] - points[edges[0, 0]] for k in (0, 1))
        is_counterclockwise = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) > 0.0
        oriented.append(loop if is_counterclockwise == (depth % 2 == 0) else loop[::-1])
    return directed_edges(oriented)


def outline_areas(points: NDArray, edges: NDArray) -> Array:
    """Return the (k,) signed areas of outlines, negative ones of holes; outlines that share a point
    count as one.
    """
    origin = points[edges[0, 0]]
    a, b = (points[edges[:, i]] - origin for i in (0, 1))
    outline = connected_components(len(points), edges[:, 0], edges[:, 1])[0][edges[:, 0]]
    sums = sums_by_index(outline, (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2.0)
    return sums[np.unique(outline)]


def find_defects(points: ArrayLike, edges: ArrayLike, error: float = 0.0) -> OutlineDefects:
    """Find defects that make the inside of (m, 2) edges between (n, 2) points ambiguous.

    Outlines may touch, at corners and along edges; the sides of edges so short that their ends
    touch are not tested. error: the largest distance of a point from its intended place; overlaps
    that it may cause count as touching.
    """
    points, edges = edge_arrays(points, edges)
    if not len(edges):
        return OutlineDefects(crossings=0, too_many_pairs=False, overlapping=False)
    local = np.subtract(points, points[edges.ravel()].min(axis=0))
    # Two edges that should touch pass each other by at most 2 errors; 4 leaves a margin.
    touch = TOUCH_RTOL * float(local[edges.ravel()].max()) + 4.0 * error
    crossings, shared_length, too_many_pairs = _crossing_pairs(local, edges, touch)
    left, right = _side_windings(local, edges, touch)
    negative = bool((right < 0).any())
    return OutlineDefects(
        crossings=crossings,
        too_many_pairs=too_many_pairs,
        overlapping=negative or bool((left < right).any() or (left > 1).any()),
        negative=negative,
        shared_length=shared_length,
    )


def winding_numbers(points: NDArray, edges: NDArray, query_points: NDArray) -> Array:
    """Return (k,) winding numbers of the edges about query points; on an edge, the mean of both
    sides.
    """
    turns = [np.zeros(0)]
    block = max(1, PAIRS_PER_BLOCK // max(1, len(edges)))
    for start in range(0, len(query_points), block):
        spans = points[edges] - query_points[start : start + block, None, None]  # (k, m, 2 ends, 2)
        a, b = spans[:, :, 0], spans[:, :, 1]
        cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
        along = (a * b).sum(axis=2)
        # A point on an edge sees its ends in opposite directions: half a turn, whose sign is
        # rounding. The mean of both signs is 0.
        is_on = (np.abs(cross) <= ON_EDGE_RTOL * np.abs(along)) & (along <= 0.0)
        turns.append(np.where(is_on, 0.0, np.arctan2(cross, along)).sum(axis=1) / (2.0 * np.pi))
    return np.concatenate(turns)


def _side_windings(points: NDArray, edges: NDArray, touch: float) -> tuple[Int64, Int64]:
    """Return the (k,) winding numbers left and right of edges longer than 4 `touch`, by rays across
    them; of a sample if there are too many edges.
    """
    span = np.abs(points[edges[:, 1]] - points[edges[:, 0]])
    steep = span[:, 1] >= span[:, 0]
    long = np.hypot(*span.T) > 4.0 * touch
    parts = [
        _steep_side_windings(points, edges, np.flatnonzero(steep & long), touch),
        # A mirror image across x = y makes these edges steep, and swaps their sides. Turning each
        # edge round swaps them back.
        _steep_side_windings(points[:, ::-1], edges[:, ::-1], np.flatnonzero(~steep & long), touch),
    ]
    left, right = zip(*parts)
    return np.concatenate(left), np.concatenate(right)


def _steep_side_windings(
    points: NDArray, edges: NDArray, chosen: NDArray, touch: float
) -> tuple[NDArray, NDArray]:
    """Return `_side_windings` of edges with the indices `chosen`, which rise at least as much as
    they run, by rays to the right from their middles.
    """
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    low = np.minimum(start, end)[:, 1] - touch
    high = np.maximum(start, end)[:, 1] + touch
    along = end - start
    length = np.hypot(*along.T)
    height = float(high.max() - low.min()) or 1.0
    # Share of the edges that a ray may meet, with those that the rays of its block meet; if these
    # are too many, fewer rays are taken.
    share = min(1.0, float((high - low).mean()) / height + RAYS_PER_BLOCK / len(edges))
    pair_count = len(chosen) * len(edges) * max(share, 1.0 / RAYS_PER_BLOCK)
    chosen = chosen[:: max(1, int(pair_count / MAX_EDGE_PAIRS))]
    # Rays of a block are neighbors, so that few edges are near to all of them.
    chosen = chosen[np.argsort((start[chosen] + end[chosen])[:, 1], kind="stable")]
    middle = (start[chosen] + end[chosen]) / 2.0
    rays_per_block = max(1, min(RAYS_PER_BLOCK, PAIRS_PER_BLOCK // len(edges)))
    left, right = np.zeros((2, len(chosen)), np.int64)
    for first in range(0, len(chosen), rays_per_block):
        part = slice(first, first + rays_per_block)
        x, y = middle[part, 0, None], middle[part, 1, None]
        near = np.flatnonzero((high >= y.min()) & (low <= y.max()))
        a, b, d = (values[near] for values in (start, end, along))
        # 1 where the ray's line is crossed upward, -1 downward
        turn = (b[:, 1] > y).astype(np.int64) - (a[:, 1] > y)
        offset = d[:, 0] * (y - a[:, 1]) - d[:, 1] * (x - a[:, 0])  # positive to the edge's left
        is_beside = (x - a[:, 0]) * (x - b[:, 0]) + (y - a[:, 1]) * (y - b[:, 1]) <= 0.0
        # An offset is a distance from the edge's line times the edge's length.
        largest = np.maximum(touch, ON_EDGE_RTOL * length[near]) * length[near]
        is_here = is_beside & (np.abs(offset) <= largest)
        is_ahead = (offset > 0.0) == (turn > 0)
        beyond = np.where(is_ahead & ~is_here, turn, 0).sum(axis=1)
        here = np.where(is_here, turn, 0).sum(axis=1)
        # A ray from the right of the middle crosses the edges beyond; one from the left of it also
        # crosses all edges that lie here.
        is_upward = along[chosen[part], 1] > 0.0
        left[part] = np.where(is_upward, beyond + here, beyond)
        right[part] = np.where(is_upward, beyond, beyond + here)
    return left, right


def _crossing_pairs(points: NDArray, edges: NDArray, touch: float) -> tuple[int, float, bool]:
    """Return the count of pairs of edges that cross by more than `touch`, the length along which
    edges run against each other within `touch`, and True if there are too many pairs to compare.
    """
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    length = np.hypot(*(end - start).T)
    length[length == 0.0] = 1.0
    boxes = np.minimum(start, end) - touch, np.maximum(start, end) + touch
    crossings = tested = 0
    opposed = 0.0
    for i, j, count in rectangle_pairs(boxes, boxes):
        tested += count
        if tested > 2 * MAX_EDGE_PAIRS:  # each pair comes twice
            break
        i, j = i[i < j], j[i < j]
        # Distances of both ends of the second edge from the line of the first, and of the first
        # edge's from the second's.
        sides = np.empty((4, len(i)))
        for row, (p, point) in enumerate(((i, start[j]), (i, end[j]), (j, start[i]), (j, end[i]))):
            span = end[p] - start[p]
            arm = point - start[p]
            sides[row] = (span[:, 0] * arm[:, 1] - span[:, 1] * arm[:, 0]) / length[p]
        crosses = (sides[0] * sides[1] < 0.0) & (sides[2] * sides[3] < 0.0)
        crossings += int((crosses & (np.abs(sides) > touch).all(axis=0)).sum())
        along = (np.abs(sides) <= touch).all(axis=0)
        i, j = i[along], j[along]
        unit = (end[i] - start[i]) / length[i, None]
        first, last = (((point[j] - start[i]) * unit).sum(axis=1) for point in (start, end))
        # Of edges that run against each other, the second starts (first) beyond its end (last); the
        # common length of others is negative or as short as touching ends.
        common = np.minimum(first, length[i]) - np.maximum(last, 0.0)
        opposed += float(common[common > 4.0 * touch].sum())
    return crossings, opposed, tested > 2 * MAX_EDGE_PAIRS


@lru_cache
def plane_positions(order: int) -> Int64:
    """Return the (k,) positions of x^p y^q among `monomials`, in the order of `multi_indices`;
    read-only.
    """
    p, q = multi_indices(2, order).T
    positions = monomial_index(p, q, np.zeros_like(p))
    positions.flags.writeable = False
    return positions


def region_moments(
    points: ArrayLike,
    edges: ArrayLike,
    order: int,
    about: ArrayLike | None = None,
    rounded: float = 0.0,
    stored: float = 0.0,
) -> Moments:
    """Return ∫ x^p y^q dA, p + q ≤ order, of the region to the left of directed edges.

    The moments, with error bounds, are about the centroid, up to rounding, unless `about` is given.

    Parameters
    ----------
    points : (n, 2) array_like
    edges : (m, 2) array_like of int
        Closed: at every point as many edges end as start.
    order : int
    about : (2,) array_like, optional
        The reference point.
    rounded : float
        Largest displacement of each coordinate of the points by rounding.
    stored : float
        Largest displacement of each coordinate by storing the points as float32.

    Returns
    -------
    Moments
        Area moments about (x, y, 0); those with a power of z are zero.

    Raises
    ------
    MeasureError
        If the edges do not close, or enclose no area.

    Notes
    -----
    Zhang and Chen (2001), eqs. 3 and 9, by Sheynin and Tuzikov's formula in two dimensions.

    Examples
    --------
    >>> from body_moments.core.flat import directed_edges, region_moments
    >>> square = [[0, 0], [2, 0], [2, 2], [0, 2]]
    >>> moments = region_moments(square, directed_edges([range(4)]), 4)
    >>> moments.total, moments.about.tolist(), round(moments[2, 2, 0] * 9, 9)
    (4.0, [1.0, 1.0, 0.0], 4.0)
    """
    points, edges = edge_arrays(points, edges)
    if about is None:
        first = area_moments(points, edges, 1)
        bounds = first.rounding_error + _swept(points, edges, first.about, rounded, 1)
        if not abs(first.raw[0]) > bounds[0]:
            raise MeasureError(NO_SECTION_AREA, fault=OUTLINES_ENCLOSE_NONE)
        about = first.about + first.raw[1:] / first.raw[0]
    flat = area_moments(points, edges, order, about)
    positions = plane_positions(order)
    raw, rounding, moved = np.zeros((3, monomial_count(order)))
    raw[positions] = flat.raw
    rounding[positions] = flat.rounding_error + _swept(points, edges, flat.about, rounded, order)
    moved[positions] = _swept(points, edges, flat.about, stored, order)
    return Moments(raw, np.append(flat.about, 0.0), Measure.AREA, rounding, moved)


def _swept(points: NDArray, edges: NDArray, about: NDArray, step: float, order: int) -> Array:
    """Return (k,) bounds of the changes of moments to `order` about `about`, in the order of
    `multi_indices`, if every coordinate of every point moves by at most `step`.

    The area that an edge sweeps, and the largest |x| and |y| there, as in the module's docstring.
    """
    total = np.zeros(len(multi_indices(2, order)))
    if not step > 0.0:
        return total
    p, q = multi_indices(2, order).T
    way = step * np.sqrt(2.0)  # the largest distance of a point
    for start in range(0, len(edges), EDGES_PER_BLOCK):
        a, b = (points[edges[start : start + EDGES_PER_BLOCK, i]] - about for i in (0, 1))
        area = way * (np.hypot(*(b - a).T) + 2.0 * way)
        far = np.maximum(np.abs(a), np.abs(b)) + way
        x, y = (np.vander(column, order + 1, increasing=True).T for column in far.T)
        total += (area * x[p] * y[q]).sum(axis=1)
    return BOUND_ROUNDING * total
