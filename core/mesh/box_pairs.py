# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of boxes that overlap, found by a sweep along the best axis."""

import numpy as np

from ..numerics import Index, NDArray, following_pairs
from .bvh import PAIRS_PER_BATCH

ROUNDING = 1e-6  # relative to a box's sides


def _sweep(low: NDArray, high: NDArray, margin: float) -> tuple[Index, Index]:
    """Return (k,) boxes, sorted by their lower ends along the axis with the fewest pairs, and (k,)
    counts of later boxes that begin by over `margin` before each one ends.
    """
    sweeps: list[tuple[Index, Index]] = []
    for axis in range(3):
        order = np.argsort(low[:, axis], kind="stable")
        last = np.searchsorted(low[order, axis], high[order, axis] - margin)
        sweeps.append((order, np.maximum(last - np.arange(1, len(order) + 1), 0)))
    return min(sweeps, key=lambda sweep: sweep[1].sum())


def overlapping_box_pairs(
    low: NDArray, high: NDArray, margin: float, most: int
) -> tuple[NDArray, NDArray, int]:
    """Return about `most` pairs (k,), (k,) of boxes that overlap by over `margin`, and the count of
    untested pairs.
    """
    order, counts = _sweep(low, high, margin)
    left = [np.empty(0, np.intp)]
    right = [np.empty(0, np.intp)]
    pair_count = 0
    tested_count = 0
    for i, j in following_pairs(order, counts, PAIRS_PER_BATCH):
        # If hardly any boxes meet, tests are limited, too, to a chosen multiple.
        if pair_count >= most or tested_count >= 100 * most:
            break
        tested_count += len(i)
        meet = np.all(np.minimum(high[i], high[j]) - np.maximum(low[i], low[j]) > margin, axis=1)
        left.append(i[meet])
        right.append(j[meet])
        pair_count += int(meet.sum())
    return np.concatenate(left), np.concatenate(right), int(counts.sum()) - tested_count


def boxes_overlap(centers: NDArray, extents: NDArray) -> bool:
    """Return whether any two of k boxes, (k, 3) centers and half sides, overlap by more than
    rounding.
    """
    extents = extents * (1.0 - ROUNDING)
    low = centers - extents
    high = centers + extents
    # The comparisons are strict, because a flat box overlaps another one by nothing.
    pairs = following_pairs(*_sweep(low, high, 0.0), PAIRS_PER_BATCH)
    return any(bool(((low[i] < high[j]) & (low[j] < high[i])).all(axis=1).any()) for i, j in pairs)
