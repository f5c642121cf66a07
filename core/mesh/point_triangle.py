# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points from triangles, in double precision, and generalized winding numbers about
points.

Trees that find the nearest triangle work in single precision, and go wrong on triangles that are
long and thin by as much as their width.

Winding numbers are sums of solid angles, which open surfaces have, too, unlike the counts of
`bvh.Bvh`.
"""

import math

import numpy as np

from ..numerics import Array, ArrayLike, Floats, Integers, NDArray, cross, dot, subtract

TRIANGLES_PER_BLOCK = 1 << 15  # triangles at a time


def triangle_distances(points: ArrayLike, corners: NDArray) -> Array:
    """Return the (m,) distances of (m, 3) points, or of one point, each from its own of (m, 3, 3)
    triangles.
    """
    point = np.asarray(points, np.float64).T
    ends = np.ascontiguousarray(corners.transpose(1, 2, 0))
    if point.ndim == 1:
        point = point[:, None]
    to = [subtract(point, end) for end in ends]
    edges = [subtract(ends[(i + 1) % 3], ends[i]) for i in range(3)]
    normal = cross(edges[0], edges[1])
    size = np.sqrt(dot(normal, normal))
    real = size > 0.0
    nearest = np.full(len(corners), np.inf)
    inside = real
    for away, edge in zip(to, edges):
        length = dot(edge, edge)
        share = np.clip(dot(away, edge) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
        left = subtract(away, [share * component for component in edge])
        nearest = np.minimum(nearest, dot(left, left))
        inside = inside & (dot(normal, cross(edge, away)) >= 0.0)
    nearest = np.sqrt(nearest)
    height = np.abs(dot(normal, to[0])) / np.where(real, size, 1.0)
    return np.where(inside, np.minimum(height, nearest), nearest)


def winding_number(points: Floats, triangles: Integers, point: NDArray) -> float:
    """Return the number of times that triangles (m, 3), closed or open, surround a point."""
    blocks = range(0, len(triangles), TRIANGLES_PER_BLOCK)
    return sum(
        float(solid_angles(points, triangles[start : start + TRIANGLES_PER_BLOCK], point).sum())
        for start in blocks
    ) / (4.0 * math.pi)


def solid_angles(points: NDArray, triangles: Integers, point: ArrayLike = 0.0) -> Array:
    """Return (m,) signed solid angles of triangles seen from a point, by van Oosterom and Strackee
    (1983), eq. 8.
    """
    a, b, c = (points[triangles[:, k]] - np.asarray(point) for k in range(3))
    la, lb, lc = (np.sqrt((v * v).sum(axis=1)) for v in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=1)
    below = (
        la * lb * lc
        + (a * b).sum(axis=1) * lc
        + (b * c).sum(axis=1) * la
        + (c * a).sum(axis=1) * lb
    )
    return 2.0 * np.arctan2(volume, below)
