# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The poses in which a body rests on a plane, and their probabilities.

A rigid body rests on faces of its convex hull. It rests stably on faces that have the foot of the center of mass
inside; from any other face it tips over the edge that the foot is farthest outside of, onto the next face, and ends in
a stable one, for the center sinks all the time. The share of a pose is the quasi-static estimate of Wiegley, Rao and
Goldberg ("Computing a statistical distribution of stable poses for a polyhedron", Allerton 1992): all orientations are
equally likely when the body is let go, the face below the center is the one that it lands on, so that its probability
is the solid angle of the face seen from the center, and nothing bounces. A face that is not stable adds its probability
to the face that the body tips onto.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh.hulls import ConvexHull
from ..mesh.surface import normals
from ..numerics.arguments import check_type, float_array
from ..numerics.arrays import sums_by_index
from ..numerics.graph import connected_components
from ..verdict.finding import MeasureError
from .findings import CENTER_OUTSIDE_HULL, NO_STABLE_POSE

PLANE_RTOL = 1e-6  # Relative to the body's extent: nearer corners are in a plane, smaller margins count as none.
ALIKE_COSINE = 0.5  # For normals: across the edge of a face they mostly differ by more.


@dataclass(frozen=True, eq=False)
class RestingPoses:
    """Stable resting poses, the likeliest first.

    `normals`: (k, 3) outward unit normals of the faces that the body rests on; at rest they point down.
    `shares`: (k,) quasi-static probabilities, adding up to 1.
    `margins`: (k,) distances of the center's foot from the nearest edge of the face.
    `heights`: (k,) heights of the center above the ground.
    """

    normals: NDArray[np.float64]
    shares: NDArray[np.float64]
    margins: NDArray[np.float64]
    heights: NDArray[np.float64]

    @property
    def tipping_angles(self) -> NDArray[np.float64]:
        """(k,) tilts of the ground at which the body tips, in radians."""
        return np.arctan2(self.margins, self.heights)


@dataclass(frozen=True, eq=False)
class _Faces:
    """Faces of a hull: (m,) the face of each triangle, (f, 3) unit normals, (f,) heights of the center, (f,) margins.

    beyond: (f,) the face beyond the edge that the foot is nearest to or farthest outside of.
    """

    face: NDArray[np.intp]
    normals: NDArray[np.float64]
    heights: NDArray[np.float64]
    margins: NDArray[np.float64]
    beyond: NDArray[np.intp]


def resting_poses(hull: ConvexHull, center: ArrayLike, tolerance: float = PLANE_RTOL) -> RestingPoses:
    """Find the stable resting poses of a body.

    Parameters
    ----------
    hull : ConvexHull
        Hull of the body, made with a tolerance that is not below the noise of its points.
    center : (3,) array_like
        Its center of mass.
    tolerance : float
        Relative to the hull's largest extent: triangles with corners this near to one plane are one face, and faces
        with a smaller margin are not stable. At least twice the distance of points outside the hull is used.

    Returns
    -------
    RestingPoses

    Raises
    ------
    MeasureError
        If the center is outside the hull, which no body allows, or no pose is stable.

    Examples
    --------
    >>> from body_moments.core.mesh import convex_hull
    >>> from body_moments.core.statics import resting_poses
    >>> wedge = convex_hull([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 1], [1, 0, 1], [0, 2, 1]])
    >>> len(resting_poses(wedge, center=[1 / 3, 2 / 3, 1 / 2]).shares)
    5
    """
    check_type("hull", hull, ConvexHull)
    points = hull.points - float_array("center", center, 3)
    extent = float(np.ptp(hull.points, axis=0).max())
    least = max(tolerance * extent, 2.0 * hull.gap)
    faces = _faces(points, hull, least)
    if faces.heights.min() < -least or hull.is_flat and faces.margins.max() < -least:
        raise MeasureError(CENTER_OUTSIDE_HULL)
    shares = sums_by_index(faces.face, _solid_angles(points, hull.triangles), len(faces.heights)) / (4.0 * np.pi)
    # A face that contains the center has an uncertain solid angle: it gets the share that the others leave.
    around = faces.heights <= 1e-9 * extent
    if around.any():
        shares[around] = (1.0 - shares[~around].sum()) / np.count_nonzero(around)
    stable = faces.margins > least
    # Over the edge of a face with a margin near zero the center may rise: the body stays where it is.
    rests = stable | (faces.heights[faces.beyond] >= faces.heights)
    ends = np.where(rests, np.arange(len(rests)), faces.beyond)
    while not np.array_equal(further := ends[ends], ends):
        ends = further
    shares = sums_by_index(ends, shares, len(rests))
    kept = np.flatnonzero(stable)
    if not len(kept):
        raise MeasureError(NO_STABLE_POSE)
    kept = kept[np.lexsort((faces.heights[kept], -np.round(shares[kept], 12)))]
    return RestingPoses(faces.normals[kept], shares[kept], faces.margins[kept], faces.heights[kept])


def _solid_angles(points: NDArray, triangles: NDArray) -> NDArray[np.float64]:
    """Return (m,) solid angles of triangles seen from the origin, by van Oosterom and Strackee (1983), eq. 8."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    la, lb, lc = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    ab, bc, ca = ((first * second).sum(axis=1) for first, second in ((a, b), (b, c), (c, a)))
    return 2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)


def _faces(points: NDArray, hull: ConvexHull, least: float) -> _Faces:
    """Find the faces of a hull, given its points from the center; least: distances below it count as none."""
    triangles, neighbors = hull.triangles, hull.neighbors
    double = normals(points, triangles)
    face, count = _coplanar(points, triangles, neighbors, double, least)
    summed = np.stack([sums_by_index(face, double[:, axis], count) for axis in range(3)], axis=1)
    lengths = np.linalg.norm(summed, axis=1)
    unit = summed / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    heights = np.full(count, -np.inf)
    for k in range(3):
        np.maximum.at(heights, face, np.einsum("ij,ij->i", unit[face], points[triangles[:, k]]))

    triangle, side = np.nonzero(face[neighbors] != face[:, None])
    owner, beyond = face[triangle], face[neighbors[triangle, side]]
    start = points[triangles[triangle, side]]
    along = points[triangles[triangle, (side + 1) % 3]] - start
    inward = np.cross(unit[owner], along)
    length = np.linalg.norm(inward, axis=1)
    distance = -np.einsum("ij,ij->i", inward, start) / np.where(length > 0.0, length, 1.0)
    order = np.lexsort((distance, owner))
    first = np.ones(len(order), bool)  # Empty if the whole hull is one face.
    first[1:] = owner[order][1:] != owner[order][:-1]
    nearest = order[first]
    margins, over = np.full(count, -np.inf), np.arange(count)
    margins[owner[nearest]], over[owner[nearest]] = distance[nearest], beyond[nearest]
    return _Faces(face, unit, heights, margins, over)


def _coplanar(
    points: NDArray, triangles: NDArray, neighbors: NDArray, double: NDArray, least: float
) -> tuple[NDArray[np.intp], int]:
    """Return the (m,) faces of the triangles, and the number of faces.

    Neighbors are in one plane if the corner of the smaller one is in the plane of the larger. A sliver may join
    triangles on both its sides that are not in one plane. Such a group is divided, and only neighbors that face alike
    are joined; the triangles of a group still not in one plane, such as a fine rounding, stay single.
    """
    lengths = np.linalg.norm(double, axis=1)
    triangle, side = np.divmod(np.arange(neighbors.size), 3)
    other = neighbors.ravel()
    larger = lengths[triangle] >= lengths[other]
    triangle, other, side = triangle[larger], other[larger], side[larger]
    corners = triangles[other]
    shared = (corners == triangles[triangle, side][:, None]) | (corners == triangles[triangle, (side + 1) % 3][:, None])
    apart = points[corners[np.arange(len(other)), shared.argmin(axis=1)]] - points[triangles[triangle, 0]]
    unit = double / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    cosine = np.einsum("ij,ij->i", unit[triangle], unit[other])
    flat = (cosine >= 0.0) & (np.abs(np.einsum("ij,ij->i", unit[triangle], apart)) <= least)
    order = np.argsort(lengths, kind="stable")

    def join_triangles(pairs: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
        """Return the (m,) groups of triangles joined by these pairs, and an (m,) mask of groups not in one plane."""
        face, count = connected_components(len(triangles), triangle[pairs], other[pairs])
        largest = np.empty(count, np.intp)
        largest[face[order]] = order  # the last one written is the largest
        base = largest[face]
        offsets = points[triangles] - points[triangles[base, 0]][:, None]
        off = np.abs(np.einsum("ij,ikj->ik", unit[base], offsets)).max(axis=1)
        bent = np.zeros(count, bool)
        bent[face[off > 4.0 * least]] = True
        return face, bent[face]

    _, bent = join_triangles(flat)
    face, bent = join_triangles(flat & (~bent[triangle] | (cosine >= ALIKE_COSINE)))
    label = np.where(bent, len(face) + np.arange(len(face)), face)
    _, label = np.unique(label, return_inverse=True)
    return label.ravel(), int(label.max()) + 1
