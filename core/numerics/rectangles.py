# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of rectangles in the plane that overlap, by the cells of a grid."""

from collections.abc import Iterator

import numpy as np

from .array_types import Array, Index
from .arrays import batches, segment_ranges

MAX_CELLS = 2048  # cells of the grid along an axis
MAX_ENTRIES = 1 << 22  # entries of rectangles in cells, besides 16 for each rectangle
PAIRS_PER_BLOCK = 1 << 15
Rectangles = tuple[Array, Array]


def rectangle_pairs(first: Rectangles, second: Rectangles) -> Iterator[tuple[Index, Index, int]]:
    """Yield blocks of the pairs of first and second rectangles that overlap, and the number of
    tested pairs. Rectangles: (n, 2) lower and upper corners.
    """
    low, high = second
    origin = low.min(axis=0)
    extent = high.max(axis=0) - origin
    cell = np.maximum((high - low).mean(axis=0), extent / MAX_CELLS)
    cell = np.where(cell > 0.0, cell, 1.0)
    spans = np.concatenate([first[1] - first[0], high - low])
    while (spans / cell + 2.0).prod(axis=1).sum() > 16.0 * len(spans) + MAX_ENTRIES:
        cell = cell * 2.0
    size = np.floor(extent / cell).astype(np.intp) + 1

    def touched_cells(corners: Rectangles) -> tuple[Index, Index]:
        """Return the cells that rectangles touch, and the rectangle of each."""
        start, stop = (
            np.clip(np.floor((ends - origin) / cell), -1, size).astype(np.intp) for ends in corners
        )
        start, stop = np.maximum(start, 0), np.minimum(stop, size - 1)
        counts = np.maximum(stop - start + 1, 0)
        number = counts.prod(axis=1)
        owner = np.repeat(np.arange(len(start)), number)
        row, column = np.divmod(segment_ranges(number), counts[owner, 1])
        return (start[owner, 0] + row) * size[1] + start[owner, 1] + column, owner

    second_cells, second_owner = touched_cells(second)
    order = np.argsort(second_cells, kind="stable")
    second_cells, second_owner = second_cells[order], second_owner[order]
    first_cells, first_owner = touched_cells(first)
    begin = np.searchsorted(second_cells, first_cells, "left")
    counts = np.searchsorted(second_cells, first_cells, "right") - begin
    for part in batches(counts, PAIRS_PER_BLOCK):
        i = np.repeat(first_owner[part], counts[part])
        j = second_owner[np.repeat(begin[part], counts[part]) + segment_ranges(counts[part])]
        corner = np.maximum(first[0][i], low[j])
        # A pair is taken in the cell of the lowest corner that both rectangles share.
        place = np.clip(np.floor((corner - origin) / cell), 0, size - 1).astype(np.intp)
        taken = place @ (size[1], 1) == np.repeat(first_cells[part], counts[part])
        taken &= (corner < np.minimum(first[1][i], high[j])).all(axis=1)
        yield i[taken], j[taken], len(taken)
