# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components of a graph.

Components are found by hooking (after Shiloach and Vishkin, J. Algorithms 3, 1982): every node
takes its lowest neighbor as its parent if that is lower, which cannot make a cycle; pointer jumping
halves the paths; the trees become the nodes of the next round. A node that a round leaves alone has
a lower neighbor after it, so two rounds at least halve the trees. With any lower neighbor in place
of the lowest, a star could take as many rounds as it has links.
"""

from __future__ import annotations

import numpy as np

from .array_types import DTypeLike, Index, Integers, NDArray

# Links at a time: enough for threads to help.
EDGES_PER_BLOCK = 3 << 16
NODES_PER_BLOCK = 1 << 14  # in the cache with the paths that lead from them


def connected_components(count: int, a: Integers, b: Integers) -> tuple[Index, int]:
    """Return (count,) components of nodes joined by links a-b, (k,), numbered by first nodes, and
    their number.
    """
    label, number = None, count
    while True:
        blocks = [
            slice(start, start + EDGES_PER_BLOCK) for start in range(0, len(a), EDGES_PER_BLOCK)
        ]
        parent = np.arange(number, dtype=np.min_scalar_type(-number))
        for block in blocks:
            np.minimum.at(
                parent,
                np.maximum(a[block], b[block]).astype(np.intp),
                np.minimum(a[block], b[block]).astype(parent.dtype),
            )
        tree, number = _trees(parent)
        if number == 1:
            return _zeros(count, np.intp), 1
        label = tree if label is None else tree.take(label, mode="clip")
        left_ends, right_ends = [tree[:0]], [tree[:0]]
        for block in blocks:
            left, right = (tree.take(ends[block].astype(np.intp), mode="clip") for ends in (a, b))
            apart = np.flatnonzero(left != right)
            left_ends.append(left[apart])
            right_ends.append(right[apart])
        a = np.concatenate(left_ends)
        b = np.concatenate(right_ends)
        if not len(a):
            return label.astype(np.intp), number


def _zeros(count: int, dtype: DTypeLike) -> NDArray:
    """Return a read-only array (count,) of zeros that takes no memory, like `np.broadcast_to` but
    in less time.
    """
    return np.ndarray((count,), dtype, bytes(8), strides=(0,))


def _trees(parent: Integers) -> tuple[Integers, int]:
    """Return the root of each node's tree, and the number of trees. parent: no higher than the
    node; overwritten.
    """
    roots = np.flatnonzero(parent == np.arange(len(parent), dtype=parent.dtype))
    if len(roots) == 1:  # all paths downward end there
        return _zeros(len(parent), parent.dtype), 1
    tree = np.empty_like(parent)
    tree[roots] = np.arange(len(roots), dtype=parent.dtype)
    for start in range(0, len(parent), NODES_PER_BLOCK):
        block = parent[start : start + NODES_PER_BLOCK]
        while True:
            grand = parent.take(block, mode="clip")
            if (grand == block).all():
                break
            block[...] = grand
        tree[start : start + NODES_PER_BLOCK] = tree.take(block, mode="clip")
    return tree, len(roots)
