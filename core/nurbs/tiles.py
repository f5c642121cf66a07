# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Quadrilaterals that fill a region within closed loops of coordinates.

The region is cut into rows at the heights of the loops' samples. In a row, the region is between an
edge that enters it and the next one that leaves it. A height is a coordinate along the strips of
`strips`; the other coordinate may have a period.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..numerics import Array, Index, NDArray
from .piece_nets import SAMPLES
from .quadric import Quadric
from .spline_chart import SplineChart

SAME_HEIGHT = 1e-9  # relative to all heights: samples that share a row of tiles


class _Cells(NamedTuple):
    """Parts of rows in the region. row: (n,) of each. left, right: (2, n) the other coordinates of
    its ends at the row's bottom and top.
    """

    row: Index
    left: Array
    right: Array


def region_tiles(
    chart: Quadric | SplineChart, tracks: NDArray, lines: NDArray, axis: int, base: float, each: int
) -> Array:
    """Return (n, 4, 2) coordinates of the corners of quadrilaterals that fill a region.

    tracks, lines, axis, base: as for `TrimmedFace`. each: steps to a span or a quarter of a turn;
    not 3 or 5, with which no whole number of steps between samples would reach a track's end.
    """
    other = 1 - axis
    samples = tracks[:, :: max(1, (SAMPLES - 1) // each)]
    track_edges = np.stack([samples[:, :-1], samples[:, 1:]], axis=2).reshape(-1, 2, 2)
    edges = np.concatenate([track_edges, lines])
    # In whole grains, heights that differ by rounding are equal.
    marks = np.append(edges[..., axis], base)
    grain = SAME_HEIGHT * max(float(np.ptp(marks)), 1e-300)
    edge_heights = np.round(edges[..., axis].T / grain)
    widths = chart.step(each)
    rows = _cut_rows(np.unique(np.round(marks / grain)), widths[axis] / grain)
    # The region is on the left of an edge.
    ascends = edge_heights[1] > edge_heights[0]
    enters = ascends if axis == 0 else ~ascends
    period = chart.periods[other]
    places = edges[..., other].T
    cells, empty = _crossed_cells(places, edge_heights, enters, rows, period)
    if period:
        full = _full_rows(places, edge_heights, rows, empty, base / grain, period)
        cells = _Cells(
            np.concatenate([cells.row, full]),
            np.concatenate([cells.left, np.zeros((2, len(full)))], axis=1),
            np.concatenate([cells.right, np.full((2, len(full)), period)], axis=1),
        )
    return _cut_cells(cells, rows * grain, axis, widths[other])


def _cut_rows(heights: NDArray, width: float) -> Array:
    """Return (2, n) bottoms and tops of the rows between heights, none higher than a width."""
    cuts = [
        np.linspace(bottom, top, 1 + max(1, int(np.ceil((top - bottom) / width - 1e-9))))[:-1]
        for bottom, top in zip(heights[:-1], heights[1:])
    ]
    cut_heights = np.concatenate([*cuts, heights[-1:]])
    return np.stack([cut_heights[:-1], cut_heights[1:]])


def _crossed_cells(
    places: NDArray, heights: NDArray, enters: NDArray, rows: NDArray, period: float
) -> tuple[_Cells, Index]:
    """Return the cells of rows that edges cross, and the indices of the other rows.

    places, heights: (2, m) both coordinates of the edges' begins and ends. enters: (m,) whether the
    region begins at an edge as the other coordinate grows. rows: (2, n) bottoms and tops.
    """
    bottom, top = rows[..., None]
    low, high = heights.min(axis=0), heights.max(axis=0)
    row, edge = np.nonzero((low <= bottom) & (high >= top) & (low < high))
    slope = (places[1] - places[0])[edge] / (heights[1] - heights[0])[edge]
    crossings = places[0, edge] + (rows[:, row] - heights[0, edge]) * slope
    if period:
        crossings -= period * np.floor(crossings.mean(axis=0) / period)
    enters = enters[edge]
    order = np.lexsort((crossings.sum(axis=0), row))
    # A row whose first edge leaves the region begins in it: that edge comes last, a period later.
    first = order[np.unique(row[order], return_index=True)[1]] if len(order) else order
    crossings[:, first[~enters[first]]] += period
    order = np.lexsort((crossings.sum(axis=0), row))
    is_same_row = np.diff(row[order]) == 0
    pairs = np.flatnonzero(enters[order][:-1] & ~enters[order][1:] & is_same_row)
    begin, end = order[pairs], order[pairs + 1]
    cells = _Cells(row[begin], crossings[:, begin], crossings[:, end])
    return cells, np.setdiff1d(np.arange(rows.shape[1]), row)


def _full_rows(
    places: NDArray, heights: NDArray, rows: NDArray, empty: Index, base: float, period: float
) -> Index:
    """Return the rows without edges that are in the region: those beyond which, seen from the base
    line, edges wind an odd number of times. places, heights, rows: as for `_crossed_cells`.
    """
    # All heights are whole grains, so half a grain decides on which side of the base a row is.
    bottom, top = rows[:, empty, None]
    level = heights.mean(axis=0)
    is_beyond = np.where(bottom >= base - 0.5, level > bottom, level < top)
    turns = (is_beyond * (places[1] - places[0])).sum(axis=1) / period
    return empty[np.round(np.abs(turns)) % 2 == 1]


def _cut_cells(cells: _Cells, rows: NDArray, axis: int, width: float) -> Array:
    """Return (n, 4, 2) coordinates of the corners of parts of cells, none wider than a width."""
    part_counts = np.ceil((cells.right - cells.left).max(axis=0) / width)
    part_counts = np.maximum(part_counts, 1).astype(np.intp)
    cell = np.repeat(np.arange(len(cells.row)), part_counts)
    first_part = np.cumsum(part_counts) - part_counts
    part = np.arange(len(cell)) - first_part[cell]
    corners = []
    for end, step in ((0, 0), (0, 1), (1, 1), (1, 0)):
        share = (part + step) / part_counts[cell]
        place = cells.left[end, cell] * (1.0 - share) + cells.right[end, cell] * share
        height = rows[end, cells.row[cell]]
        corners.append(np.stack([place, height] if axis else [height, place], axis=-1))
    return np.stack(corners, axis=1)
