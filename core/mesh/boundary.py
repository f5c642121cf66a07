# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether faces close, piece by piece: no edges are sorted, nor kept.

Every place has a hash, and every side of a face one of its two ends, with a sign for its direction. Sides that run
along each other in opposite directions cancel. So the sum over all sides, modulo 2^64, is zero where every edge is used
as often one way as the other, and otherwise by a chance of 2^-64 only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import hash_uint64
from .surface import Surface

FACES_PER_BLOCK = 1 << 16


class BoundarySum:
    """The sum over the sides of faces, of pieces that are added one after the other.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.mesh.boundary import BoundarySum
    >>> total = BoundarySum()
    >>> total.add(Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2]]))
    >>> total.is_zero
    False
    >>> total.add(Surface.from_triangles(np.eye(4, 3, -1), [[1, 2, 3]]))
    >>> total.is_zero
    True
    """

    def __init__(self) -> None:
        self._total = np.zeros(1, np.uint64)

    @property
    def is_zero(self) -> bool:
        """Whether all sides that were added cancel: the faces close, wherever they were split."""
        return not self._total[0]

    def add(self, piece: Surface) -> None:
        """Add the faces of a piece. Points at the same place are one."""
        keys = np.zeros(len(piece.points), np.uint64)
        for k in range(3):
            column = piece.points[:, k].astype(np.float64) + 0.0  # -0.0 + 0.0 = 0.0
            keys = hash_uint64(keys + column.view(np.uint64))
        for faces in (piece.triangles, piece.quads):
            for start in range(0, len(faces), FACES_PER_BLOCK):
                corners = keys[faces[start : start + FACES_PER_BLOCK]]
                self._total += _sum_of_sides(corners, np.roll(corners, -1, axis=1))


def _sum_of_sides(start: NDArray[np.uint64], stop: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The sum over sides, each a hash of its ends, negative where it runs to the lower one."""
    sides = hash_uint64(hash_uint64(np.minimum(start, stop)) + np.maximum(start, stop))
    forward = np.add.reduce(sides[start < stop], dtype=np.uint64)
    return forward - np.add.reduce(sides[start > stop], dtype=np.uint64, keepdims=True)
