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
    from_corners = [subtract(point, end) for end in ends]
    edges = [subtract(ends[(i + 1) % 3], ends[i]) for i in range(3)]
    normal = cross(edges[0], edges[1])
    normal_length = np.sqrt(dot(normal, normal))
    has_area = normal_length > 0.0
    squared_to_edges = np.full(len(corners), np.inf)
    is_above = has_area  # the point's foot on the plane is in the triangle
    for from_corner, edge in zip(from_corners, edges):
        squared_length = dot(edge, edge)
        along = dot(from_corner, edge) / np.where(squared_length > 0.0, squared_length, 1.0)
        share = np.clip(along, 0.0, 1.0)
        from_edge = subtract(from_corner, [share * component for component in edge])
        squared_to_edges = np.minimum(squared_to_edges, dot(from_edge, from_edge))
        is_above = is_above & (dot(normal, cross(edge, from_corner)) >= 0.0)
    to_edges = np.sqrt(squared_to_edges)
    height = np.abs(dot(normal, from_corners[0])) / np.where(has_area, normal_length, 1.0)
    return np.where(is_above, np.minimum(height, to_edges), to_edges)


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
    numerator = (a * np.cross(b, c)).sum(axis=1)
    denominator = (
        la * lb * lc
        + (a * b).sum(axis=1) * lc
        + (b * c).sum(axis=1) * la
        + (c * a).sum(axis=1) * lb
    )
    return 2.0 * np.arctan2(numerator, denominator)
