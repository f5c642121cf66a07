# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components of a graph."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

BLOCK = 3 << 16  # corners at a time: enough for calls that threads gain by. A multiple of 3 and 4, lest faces are split


def components(count: int, a: NDArray[np.integer], b: NDArray[np.integer]) -> tuple[NDArray[np.integer], int]:
    """(count,) the connected component of each node, in the order of their first nodes, and how many there are.

    a, b: the ends of the links between the nodes.
    """
    blocks = [slice(start, start + BLOCK) for start in range(0, len(a), BLOCK)]
    node = np.arange(count, dtype=np.int32 if count < 1 << 31 else np.int64)
    parent = node.copy()
    for rows in blocks:
        parent[np.maximum(a[rows], b[rows]).astype(np.intp)] = np.minimum(a[rows], b[rows])
    first = parent == node
    number = int(np.count_nonzero(first))
    if number == 1:  # all paths downward end there
        return np.broadcast_to(np.intp(0), count), 1
    while True:
        grand = parent.take(parent, mode="clip")
        if np.array_equal(grand, parent):
            break
        parent = grand
    label = (np.cumsum(first, dtype=parent.dtype) - 1).take(parent, mode="clip")
    one, other = [label[:0]], [label[:0]]
    for rows in blocks:
        left, right = (label.take(ends[rows].astype(np.intp), mode="clip") for ends in (a, b))
        apart = np.flatnonzero(left != right)
        one.append(left[apart])
        other.append(right[apart])
    one, other = np.concatenate(one), np.concatenate(other)
    if not len(one):
        return label.astype(np.intp), number
    inner, number = components(number, one, other)
    return inner[label], number
