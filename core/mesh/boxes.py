# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which axis-aligned boxes meet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import ramp
from .bvh import PIECE


def overlapping_boxes(low: NDArray, high: NDArray, margin: float, most: int) -> tuple[NDArray, NDArray, int]:
    """Pairs of boxes that overlap by more than `margin` along every axis, at most about `most`, and the number of
    candidates that were left out."""
    best = None
    for axis in range(3):
        order = np.argsort(low[:, axis], kind="stable")
        last = np.searchsorted(low[order, axis], high[order, axis] - margin)
        count = np.maximum(last - np.arange(1, len(order) + 1), 0)
        if best is None or count.sum() < best[1].sum():
            best = order, count
    order, count = best
    total = np.cumsum(count)
    left, right, found, looked = [np.empty(0, np.intp)], [np.empty(0, np.intp)], 0, 0
    begin = 0
    while begin < len(order) and found < most and looked < 100 * most:
        done = total[begin - 1] if begin else 0
        end = max(int(np.searchsorted(total, done + PIECE)), begin + 1)
        rows = np.repeat(np.arange(begin, end), count[begin:end])
        looked += len(rows)
        if len(rows):
            i, j = order[rows], order[rows + 1 + ramp(count[begin:end])]
            both = np.all(np.minimum(high[i], high[j]) - np.maximum(low[i], low[j]) > margin, axis=1)
            left.append(i[both])
            right.append(j[both])
            found += int(both.sum())
        begin = end
    skipped = int(total[-1] - (total[begin - 1] if begin else 0)) if len(total) else 0
    return np.concatenate(left), np.concatenate(right), skipped


def boxes_meet(centers: NDArray, extents: NDArray) -> bool:
    """Whether any two of k boxes share more than a rim of rounding. centers, extents: (k, 3), half the sides."""
    axis = int(np.argmax(np.ptp(centers, axis=0)))
    order = np.argsort(centers[:, axis] - extents[:, axis])
    centers, extents = centers[order], extents[order] * (1.0 - 1e-6)
    low, high = centers - extents, centers + extents
    for step in range(1, len(low)):  # neighbours first: where boxes meet, some of them are found soon
        near = low[step:, axis] < high[:-step, axis]
        if not near.any():
            return False
        if ((low[step:] < high[:-step]) & (low[:-step] < high[step:])).all(axis=1).any():
            return True
    return False
