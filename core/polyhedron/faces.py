# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces with their edges and normals, gathered in blocks; and the box around a surface."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

import numpy as np

from ..mesh import Surface, has_flipped_corners
from ..numerics import Array, NDArray

MIN_FLIP_COSINE = 1e-6  # float32 may choose a quad's other diagonal if the cosine is below this
FLOAT32_OVERFLOW = 1e9  # edges from which the fourth powers in that decision leave its range
FLOAT32_UNDERFLOW = 1e-36  # products below this may have underflowed there
NO_VERTEX = "no such vertex"


def paired_corners(triangles: NDArray) -> list[NDArray] | None:
    """Return (k/2,) corners of quads, if triangles 2i and 2i+1 are always halves of a quad; else
    None.
    """
    first = triangles[0::2]
    second = triangles[1::2]
    if not len(second) or len(first) != len(second):
        return None
    # The halves share the side of corners i and i - 1 of the first, j and j + 1 of the second.
    for i in range(3):
        for j in range(3):
            ends = ((i, j), (i - 1, (j + 1) % 3))
            if all(
                first[0, a] == second[0, b] and np.array_equal(first[:, a], second[:, b])
                for a, b in ends
            ):
                return [first[:, i], first[:, (i + 1) % 3], first[:, i - 1], second[:, (j + 2) % 3]]
    return None


class Faces:
    """Rows of t faces: triangles a, b, c, perhaps a, c, d.

    corners: (3, c, t). edges: (3, c-1, t) from a. normals: (3, c-2, t), doubled areas long.
    """

    def __init__(self, corners: Array):
        self.corners = corners
        self.edges = corners[:, 1:] - corners[:, :1]
        first = self.edges[:, :-1]
        second = self.edges[:, 1:]
        self.normals = np.empty(first.shape)
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            np.multiply(first[y], second[z], self.normals[x])
            self.normals[x] -= first[z] * second[y]

    @classmethod
    def gather(cls, coordinates: NDArray, rows: NDArray) -> Faces:
        """Gather triangles, (m, 3) rows, by two if they are halves of quads, or quads, (m, 4) rows,
        turned as Blender cuts them. coordinates: (3, n) of the points, which must exist.
        """
        is_quad = rows.shape[1] == 4
        halves = None if is_quad else paired_corners(rows)
        corners = coordinates.take(rows.T if halves is None else halves, axis=1, mode="wrap")
        faces = cls(corners.astype(np.float64, copy=False))
        if is_quad:
            faces._turn_quads(coordinates.dtype)
        return faces

    def lengths(self) -> Array:
        """Return the (c-2, t) doubled areas."""
        return np.sqrt(np.einsum("ift,ift->ft", self.normals, self.normals))

    def _turn_quads(self, dtype: np.dtype) -> None:
        """Turn quads so that a, c is the diagonal that Blender, in float32, draws."""
        suspects = np.arange(self.corners.shape[2])
        if dtype == np.float32:
            cosine = np.einsum("it,it->t", self.normals[:, 0], self.normals[:, 1])
            squares = np.einsum("ict,ict->ct", self.edges, self.edges)
            limit = squares[1] * np.sqrt(squares[0] * squares[2])
            np.maximum(MIN_FLIP_COSINE * limit, FLOAT32_UNDERFLOW, out=limit)
            limit[np.maximum.reduce(squares) > FLOAT32_OVERFLOW**2] = np.inf
            suspects = suspects[cosine <= limit]
        if not len(suspects):
            return
        flipped = suspects[has_flipped_corners(*self.corners[:, :, suspects].swapaxes(0, 1))]
        turned = Faces(np.roll(self.corners[:, :, flipped], -1, axis=1))
        self.corners[:, :, flipped] = turned.corners
        self.edges[:, :, flipped] = turned.edges
        self.normals[:, :, flipped] = turned.normals


def face_blocks(surface: Surface, size: int) -> Iterator[tuple[int, NDArray]]:
    """Yield the first rows and the rows, for `Faces.gather`, of blocks of triangles, then of quads:
    `size` quads or triangles, or twice as many triangles that may be halves of quads.
    """
    per_face = 1 if paired_corners(surface.triangles[:2]) is None else 2
    for rows, step in ((surface.triangles, per_face * size), (surface.quads, size)):
        for start in range(0, len(rows), step):
            yield start, rows[start : start + step]


def finite_box(surface: Surface) -> tuple[Array, Array]:
    """Return the least and the largest coordinates. ValueError if they are not finite."""
    low, high = surface.box
    if not all(map(isfinite, low.tolist() + high.tolist())):
        raise ValueError("coordinates must be finite")
    return low, high


def box_center(low: NDArray, high: NDArray, dtype: np.dtype) -> Array:
    """Return the center of a box of points, rounded for float32 ones so that subtracting it is
    exact.
    """
    center = low / 2.0 + high / 2.0
    return center.astype(np.float32).astype(np.float64) if dtype == np.float32 else center
