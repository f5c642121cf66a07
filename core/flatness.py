# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that are not flat, and faces without area.

A face that is not flat has no volume under it until somebody chooses its diagonals. For a quad the two choices differ
by the tetrahedron of its corners, |(b-a)·((c-a)×(d-b))|/6; for a polygon the fan from its first corner differs from
the fan from its second by the tetrahedra on their common edge and each further one. A face counts as not flat where
its diagonals pass each other by more than its coordinates' own errors and a millionth of its size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import Surface
from .topology import mesh_faces
from .vectors import cross, dot

BLOCK = 1 << 14
FLAT = 1e-6  # of the square root of a face's area
NO_AREA = 1e-12  # of a face's size, for float64 points


@dataclass(frozen=True, eq=False)
class Flatness:
    """not_flat: how many faces are not; spread: the volume that the choice of their diagonals can change;
    without_area: (k,) the faces that have none."""

    not_flat: int
    spread: float
    without_area: NDArray[np.integer]


def examine(surface: Surface, error: float) -> Flatness:
    """Quads, and polygons where the surface has the mesh's corners to tell their rings from; other faces are made of
    triangles and have no choice.

    error: (length) how far the points may be from where they were meant."""
    quads, triangles = surface.quads, surface.triangles
    quad_faces, triangle_faces = mesh_faces(surface)
    # Differences of float32 points in float32 err by no more than the points do. The body is brought to size 1, lest
    # sixth powers of small lengths underflow.
    columns = np.array(surface.points.T, order="C")
    low, high = surface.box
    size = max(float((high - low).max()), np.finfo(np.float32).tiny)
    size = 2.0 ** np.ceil(np.log2(size))
    columns *= columns.dtype.type(1.0 / size)
    error = error / size
    with np.errstate(over="ignore", invalid="ignore", under="ignore", divide="ignore"):
        flat = [_quads(columns, quads[k:k + BLOCK], error) for k in range(0, len(quads), BLOCK)]
        thin = [_triangles(columns, triangles[k:k + BLOCK], error) for k in range(0, len(triangles), BLOCK)]
        rings = _polygons(columns, surface, triangle_faces, error) if len(triangles) else (0, 0.0)
    bare = [quad_faces[np.concatenate([part[2] + k * BLOCK for k, part in enumerate(flat)])]] if flat else []
    if thin:
        at = np.concatenate([part + k * BLOCK for k, part in enumerate(thin)])
        if len(at):
            face, pieces = np.unique(triangle_faces[at], return_counts=True)
            whole = np.bincount(triangle_faces, minlength=int(face.max()) + 1)
            bare.append(face[pieces == whole[face]])
    spread = (sum(part[1] for part in flat) + rings[1]) * size ** 3
    return Flatness(not_flat=sum(part[0] for part in flat) + rings[0], spread=float(spread),
                    without_area=np.sort(np.concatenate(bare)) if bare else np.empty(0, np.intp))


def _spans(columns: NDArray, faces: NDArray, *pairs: tuple[int, int]) -> list[list[NDArray]]:
    """For each pair of corners the x, y and z of the vector from the second one to the first."""
    index = faces.T.astype(np.intp, order="C")
    corners = [column.take(index, mode="clip") for column in columns]
    return [[corner[i] - corner[j] for corner in corners] for i, j in pairs]


def _warped(volume: NDArray, square: NDArray, error: float) -> NDArray[np.intp]:
    """Where |volume| is more than the normal, whose square is given, times the height that a flat face may have."""
    near = np.flatnonzero(volume * volume > square * (64.0 * error * error))
    normal = np.sqrt(square[near])
    return near[np.abs(volume[near]) > normal * (8.0 * error + FLAT * np.sqrt(normal))]


def _bare(square: NDArray, first: list[NDArray], second: list[NDArray], error: float) -> NDArray[np.intp]:
    """Where a face, of the body brought to size 1, is narrower than its coordinates' errors."""
    if square.min() > 3.0 * (error * error + 3.0 * NO_AREA * NO_AREA):  # no face is longer than √3
        return np.empty(0, np.intp)
    longest = np.maximum(dot(first, first), dot(second, second))
    return np.flatnonzero(square <= longest * (error * error + NO_AREA * NO_AREA * longest))


def _quads(columns: NDArray, quads: NDArray, error: float) -> tuple[int, float, NDArray[np.intp]]:
    first, second, third = _spans(columns, quads, (2, 0), (3, 1), (1, 0))
    normal = cross(first, second)
    volume = dot(third, normal)
    square = dot(normal, normal)
    warped = _warped(volume, square, error)
    spread = float(np.abs(volume[warped]).sum(dtype=np.float64)) / 6.0
    return len(warped), spread, _bare(square, first, second, error)


def _triangles(columns: NDArray, triangles: NDArray, error: float) -> NDArray[np.intp]:
    first, second = _spans(columns, triangles, (1, 0), (2, 0))
    normal = cross(first, second)
    return _bare(dot(normal, normal), first, second, error)


def _polygons(columns: NDArray, surface: Surface, triangle_faces: NDArray, error: float) -> tuple[int, float]:
    """The faces of more than one triangle: how many are not flat, and their spread."""
    if surface.corner_vertices is None:
        return 0, 0.0
    quad_faces, _ = mesh_faces(surface)
    pieces = np.bincount(triangle_faces, minlength=int(quad_faces.max(initial=-1)) + 1)
    sizes = np.where(pieces > 0, pieces + 2, 0)
    sizes[quad_faces] = 4
    polygon = np.flatnonzero(pieces > 1)
    if not len(polygon) or sizes.sum() != len(surface.corner_vertices):
        return 0, 0.0
    begin = (np.cumsum(sizes) - sizes)[polygon]
    steps = sizes[polygon] - 3
    row = np.repeat(np.arange(len(polygon)), steps)
    at = begin[row] + 2 + np.arange(len(row)) - np.repeat(np.cumsum(steps) - steps, steps)
    ring = surface.corner_vertices.astype(np.intp)
    corners = np.stack([ring[begin[row]], ring[begin[row] + 1], ring[at], ring[at + 1]], axis=1)
    first, second, third = _spans(columns, corners, (2, 0), (3, 1), (1, 0))
    normal = cross(first, second)
    volume = dot(third, normal).astype(np.float64)
    warped = _warped(volume, dot(normal, normal), error)
    return len(np.unique(row[warped])), float(np.abs(volume[warped]).sum()) / 6.0
