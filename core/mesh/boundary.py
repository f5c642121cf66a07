# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A test, piece by piece, that faces close: no edges are sorted, nor kept.

Every place has a keyed 64-bit hash of its coordinates. Every side of a face has a hash of its two
ends, with a sign for its direction. Sides that run along each other in opposite directions cancel:
the sum over all sides, modulo 2^64, is zero if every edge is used equally often both ways.
Otherwise it is zero by a chance below 2^-50, whatever the faces, because each process draws new
keys. (A sum of normals is zero for many surfaces that are open.)
"""

import os

import numpy as np

from ..numerics import Floats, NDArray
from .surface import Surface

FACES_PER_BLOCK = 1 << 14  # faces whose hashes stay in the cache
HALF = np.uint64(32)
# Odd numbers: a factor for each coordinate, two factors for sides, and the start of every hash.
KEYS = np.frombuffer(os.urandom(48), np.uint64) | np.uint64(1)


class BoundarySum:
    """The sum over the sides of a surface's faces, added piece by piece."""

    def __init__(self) -> None:
        self._total = np.zeros((), np.uint64)

    @property
    def is_zero(self) -> bool:
        """True if all sides that were added cancel: the faces close, however they were split."""
        return not self._total

    def add(self, piece: Surface | Floats) -> None:
        """Add the faces of a piece, or (m, 3, 3) corners of triangles.

        Points at the same place are one.
        """
        if not isinstance(piece, Surface):
            for start in range(0, len(piece), FACES_PER_BLOCK):
                block = piece[start : start + FACES_PER_BLOCK]
                self._add_faces(_hash_places(block.reshape(-1, 3)).reshape(-1, 3))
            return
        blocks = np.array_split(piece.points, len(piece.points) // FACES_PER_BLOCK + 1)
        hashes = np.concatenate([*map(_hash_places, blocks)])
        for faces in (piece.triangles, piece.quads):
            for start in range(0, len(faces), FACES_PER_BLOCK):
                self._add_faces(hashes[faces[start : start + FACES_PER_BLOCK]])

    def _add_faces(self, corners: NDArray[np.uint64]) -> None:
        """Add faces by the (m, k) hashes of their corners."""
        columns = [*np.ascontiguousarray(corners.T)]
        for start, stop in zip(columns, [*columns[1:], columns[0]]):
            sides = start ^ stop  # a hash of both ends, times their difference
            sides *= KEYS[3]
            sides ^= sides >> HALF
            sides *= KEYS[4]
            sides *= start - stop
            self._total += np.add.reduce(sides)


def _hash_places(points: Floats) -> NDArray[np.uint64]:
    """Return (n,) hashes of (n, 3) coordinates, by their values as float64."""
    values = np.add(points.T, 0.0, dtype=np.float64)  # -0.0 + 0.0 = 0.0
    words = np.ascontiguousarray(values).view(np.uint64)
    hashes = words[0] ^ KEYS[5]
    shifted = np.empty_like(hashes)
    for axis in range(3):
        if axis:
            hashes += words[axis]
        hashes *= KEYS[axis]
        np.right_shift(hashes, HALF, shifted)
        hashes ^= shifted
    return hashes
