# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components of a graph."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# corners at a time: large enough for threads to help. A multiple of 3 and 4, so that no face is split
EDGES_PER_BLOCK = 3 << 16


def connected_components(count: int, a: NDArray[np.integer], b: NDArray[np.integer]) -> tuple[NDArray[np.intp], int]:
    """Number the connected components of a graph.

    Parameters
    ----------
    count : int
        Nodes.
    a, b : (k,) integer arrays
        The two ends of each link.

    Returns
    -------
    component : (count,) integer array
        The component of each node, numbered in the order of their first nodes.
    number : int
        Components.

    Examples
    --------
    >>> from body_moments.core.numerics import connected_components
    >>> component, number = connected_components(4, np.array([0, 2]), np.array([1, 3]))
    >>> component.tolist(), number
    ([0, 0, 1, 1], 2)
    """
    label, number = None, count
    while True:
        blocks = [slice(start, start + EDGES_PER_BLOCK) for start in range(0, len(a), EDGES_PER_BLOCK)]
        node = np.arange(number, dtype=np.int32 if number < 1 << 31 else np.int64)
        parent = node.copy()
        for block in blocks:
            np.minimum.at(
                parent,
                np.maximum(a[block], b[block]).astype(np.intp),
                np.minimum(a[block], b[block]).astype(parent.dtype),
            )
        first = parent == node
        number = int(np.count_nonzero(first))
        if number == 1:  # all paths downward end there
            return np.broadcast_to(np.intp(0), count), 1
        while True:
            grand = parent.take(parent, mode="clip")
            if np.array_equal(grand, parent):
                break
            parent = grand
        tree = (np.cumsum(first, dtype=parent.dtype) - 1).take(parent, mode="clip")
        label = tree if label is None else tree.take(label, mode="clip")
        left_ends, right_ends = [tree[:0]], [tree[:0]]
        for block in blocks:
            left, right = (tree.take(ends[block].astype(np.intp), mode="clip") for ends in (a, b))
            apart = np.flatnonzero(left != right)
            left_ends.append(left[apart])
            right_ends.append(right[apart])
        a, b = np.concatenate(left_ends), np.concatenate(right_ends)
        if not len(a):
            return label.astype(np.intp), number
