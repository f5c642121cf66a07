# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and center of a closed surface alone, in one light pass: as needed for a deforming body at every frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface
from ..numerics.vectors import cross, dot

FACES_PER_BLOCK = 1 << 13  # faces whose intermediate arrays stay in the cache


def volume_and_center(surface: Surface) -> tuple[float, NDArray[np.float64]]:
    """Return the volume that a closed surface encloses, negative if inside out, and its (3,) centroid, if finite."""
    points = np.ascontiguousarray(surface.points.T, np.float64)
    middle = points.mean(axis=1)
    points -= middle[:, None]
    sums = np.zeros(4)
    for start in range(0, len(surface.triangles), FACES_PER_BLOCK):
        sums += _triangles(points, surface.triangles[start : start + FACES_PER_BLOCK])
    for start in range(0, len(surface.quads), FACES_PER_BLOCK):
        sums += _quads(points, surface.quads[start : start + FACES_PER_BLOCK])
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(sums[0] / 6.0), middle + sums[1:] / (4.0 * sums[0])


def _triangles(points: NDArray[np.float64], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
    """Return (4,): 6 times the volume and 24 times the three first moments. points: (3, n)."""
    a, b, c = (points.take(corner, axis=1) for corner in triangles.T)
    return _sums((dot(cross(b, c), a), a + b + c))


def _quads(points: NDArray[np.float64], quads: NDArray[np.integer]) -> NDArray[np.float64]:
    a, b, c, d = (points.take(corner, axis=1) for corner in quads.T)
    u, v, diagonal = b - a, d - a, c - a
    # True if the normals of the two triangles along ac face away from each other, by Lagrange's identity.
    flipped = dot(u, v) * dot(diagonal, diagonal) > dot(u, diagonal) * dot(v, diagonal)
    if flipped.any():  # cut from b to d
        a, b, c, d = (np.where(flipped, other, corner) for corner, other in ((a, b), (b, c), (c, d), (d, a)))
    w = cross(a, c)
    first, second = -dot(b, w), dot(d, w)
    return _sums((first, a + b + c), (second, a + c + d))


def _sums(*parts: tuple[NDArray[np.float64], NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the (4,) sums of volumes, and of volumes times sums of corners, (3, k)."""
    return sum(
        [np.append(volumes.sum(), np.einsum("ij,j->i", corners, volumes)) for volumes, corners in parts], np.zeros(4)
    )
