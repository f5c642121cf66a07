# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Standing bodies: the support polygon and the place of the center of mass over it; the poses in
which bodies rest.

A rigid body at rest on a plane stands if the foot of the plumb line through its center is inside
the convex hull of its contact points, the support polygon. The margin is the foot's distance from
the nearest edge; about that edge the body tips when the ground is tilted by more than atan(margin /
height of the center).

A body rests stably on a face of its convex hull if the foot of the center of mass is inside the
face. From any other face it tips onto the next one, over the edge that the foot has passed by the
largest distance. It ends on a stable face, because the center sinks all the time. The share of a
pose is the quasi-static estimate of Wiegley, Rao and Goldberg ("Computing a statistical
distribution of stable poses for a polyhedron", Allerton 1992). All orientations are equally likely
when the body is let go, it lands on the face below the center, and nothing bounces; so a face's
probability is its solid angle, seen from the center. A face that is not stable adds its probability
to the face that the body tips onto.
"""

from dataclasses import dataclass
from math import atan2
from typing import NamedTuple

import numpy as np

from ..inertia import frame_about
from ..mesh import ConvexHull, convex_polygon, normals, solid_angles
from ..numerics import (
    Array,
    ArrayLike,
    Index,
    Mask,
    NDArray,
    check_filled,
    check_type,
    connected_components,
    float_array,
    run_starts,
    sums_by_index,
    unit_vector,
)
from ..verdict import MeasureError
from .findings import CENTER_OUTSIDE_HULL, NO_STABLE_POSE

# Relative to the body's extent: points up to this height above the lowest one touch the ground.
CONTACT_RTOL = 1e-6
NEAR = 0.1  # Relative to the polygon's extent: the foot is near the edge.
# Relative to the corners' distances: zero after rounding.
ON_EDGE = 4.0 * float(np.finfo(np.float64).eps)
# Relative to the body's extent: nearer corners are in a plane, smaller margins count as none.
PLANE_RTOL = 1e-6
ALIKE_COSINE = 0.5  # For normals: across the edge of a face they mostly differ by more.


@dataclass(frozen=True, eq=False)
class Support:
    """The stand of a body on the ground, in the unit and the frame of its points.

    `polygon`: (k, 3) corners of the support polygon, counter-clockwise from above; two if it is a
    line, one if a point. `foot`: the point of the ground below the center of mass. `height`: of the
    center above the ground. `margin`: distance of the foot from the nearest edge, negative if it is
    outside the polygon. `direction`: unit vector along the ground across the nearest edge, over
    which the body tips first or falls. `up`: unit vector against gravity.
    """

    polygon: Array
    foot: Array
    height: float
    margin: float
    direction: Array
    up: Array

    @property
    def stands(self) -> bool:
        """True if the foot is inside the polygon; a body balanced on an edge, a line or a point
        does not stand.
        """
        return self.margin > 0.0

    @property
    def tipping_angle(self) -> float:
        """The tilt of the ground at which the body tips, in radians; negative if it tips by
        itself.
        """
        return atan2(self.margin, self.height)

    @property
    def is_near_edge(self) -> bool:
        """True if the margin is below a tenth of the polygon's extent."""
        return self.margin < NEAR * float(np.linalg.norm(np.ptp(self.polygon, axis=0)))

    def target(self, margin: float | None) -> Array:
        """Return the (3,) polygon point nearest to the foot with a margin; the middle if it is None
        or too large.
        """
        axes = ground_axes(-self.up)[:, :2]
        corners = (self.polygon - self.foot) @ axes
        inside = corners[:0] if margin is None else nearest_inside(corners, margin)
        return self.foot + axes @ (inside[0] if len(inside) else polygon_middle(corners))


def ground_axes(down: ArrayLike) -> Array:
    """Return a (3, 3) rotation with two columns along the ground and the third up; down: direction
    of gravity.
    """
    return np.transpose(frame_about((-unit_vector("down", down)).tolist()))


def find_support(
    points: ArrayLike,
    center: ArrayLike,
    down: ArrayLike = (0.0, 0.0, -1.0),
    tolerance: float = CONTACT_RTOL,
) -> Support:
    """Find the support polygon of a body on the ground below it.

    Parameters
    ----------
    points : (n, 3) array_like
        Points of the body; the corners of its convex hull are enough. The ground goes through the
        lowest of them.
    center : (3,) array_like
        Center of mass.
    down : (3,) array_like
        Direction of gravity.
    tolerance : float
        Relative to the largest extent of the points: higher points do not touch the ground.

    Returns
    -------
    Support

    Examples
    --------
    >>> from body_moments.core.statics import find_support
    >>> corners = [[x, y, z] for x in (0.0, 4.0) for y in (0.0, 2.0) for z in (0.0, 1.0)]
    >>> find_support(corners, center=[2.0, 1.0, 0.5], down=[1.0, 0.0, 0.0]).height
    2.0
    """
    points = float_array("points", points, "n", 3)
    center = float_array("center", center, 3)
    check_filled("points", points)
    heights = (points - center) @ ground_axes(down)[:, 2]
    reach = tolerance * float(np.ptp(points, axis=0).max())
    return support_of_contacts(points[heights <= heights.min() + reach], center, down)


def find_contacts(
    points: NDArray,
    matrix: NDArray,
    down: NDArray,
    ground: float,
    reach: float,
    may_touch: ArrayLike = True,
) -> tuple[Index, Array, float]:
    """Return the (k,) indices of the points that touch level ground, their (k, 3) places in the
    world, and the least height above the ground of a point that counts.

    points: (n, 3) of a body. matrix: (4, 4) from these to the world. down: (3,) unit vector of
    gravity in the world. ground: its height against gravity from the world's origin. reach: points
    up to this height above it touch it. may_touch: (n,) mask of points that count.
    """
    heights = points @ (-down @ matrix[:3, :3]).astype(points.dtype) - (
        down @ matrix[:3, 3] + ground
    )
    heights = np.where(may_touch, heights, np.inf)
    rows = np.flatnonzero(heights <= reach)
    return rows, points[rows] @ matrix[:3, :3].T + matrix[:3, 3], float(heights.min(initial=np.inf))


def support_of_contacts(
    contacts: ArrayLike,
    center: ArrayLike,
    down: ArrayLike = (0.0, 0.0, -1.0),
    tolerance: float = 0.0,
) -> Support:
    """Find the support polygon of (n, 3) contact points at any heights: hands on a wall, feet on
    stairs.

    The polygon is the hull of the contacts projected along gravity onto the ground through the
    lowest contact, without corners that stand out by less than the tolerance, relative to its
    extent.
    """
    center = np.asarray(center, np.float64)
    axes = ground_axes(down)
    local = (np.asarray(contacts, np.float64) - center) @ axes
    height = -float(local[:, 2].min())
    corners = local[convex_polygon(local[:, :2], tolerance), :2]
    margin, direction = polygon_margin(corners)
    polygon = (
        np.concatenate([corners, np.full((len(corners), 1), -height)], axis=1) @ axes.T + center
    )
    return Support(
        polygon, center - height * axes[:, 2], height, margin, axes[:, :2] @ direction, axes[:, 2]
    )


def polygon_margin(corners: Array) -> tuple[float, Array]:
    """Return the distance of the origin inside a convex polygon, and the unit vector over the
    nearest edge.

    corners: (k, 2) counter-clockwise. Returns the distance from the nearest edge; outside, minus
    the distance from the polygon; and the direction, (2,), from inside straight over that edge,
    from outside away from the polygon.
    """
    along = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(along, axis=1)
    edges = np.flatnonzero(lengths > 0.0)
    if len(edges) > 2:
        outward = np.stack([along[edges, 1], -along[edges, 0]], axis=1) / lengths[edges, None]
        distances = (outward * corners[edges]).sum(axis=1)
        nearest = int(distances.argmin())
        if distances[nearest] >= 0.0:
            return float(distances[nearest]), outward[nearest]
    # Outside, or of a line or a point: the place on the edges nearest to the origin.
    squares = np.where(lengths > 0.0, lengths**2, 1.0)
    share = np.clip(-(corners * along).sum(axis=1) / squares, 0.0, 1.0)
    closest = corners + share[:, None] * along
    distances = np.linalg.norm(closest, axis=1)
    nearest = int(distances.argmin())
    if distances[nearest] > ON_EDGE * np.abs(corners).max():
        return -float(distances[nearest]), -closest[nearest] / distances[nearest]
    # On the edge: straight over it; a point has no edge, and any direction will do.
    side = along[nearest] / lengths[nearest] if lengths[nearest] > 0.0 else np.array([0.0, -1.0])
    return 0.0, np.array([side[1], -side[0]])


def polygon_middle(corners: Array) -> Array:
    """Return the centroid, (2,), of the area of a convex polygon, or else of a line or point."""
    first = corners - corners[0]
    second = np.roll(corners, -1, axis=0) - corners[0]
    areas = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    if not areas.sum() > 0.0:
        return corners.mean(axis=0)
    return corners[0] + areas @ (first + second) / (3.0 * areas.sum())


def nearest_inside(corners: Array, margin: float) -> Array:
    """Return the (1, 2) point nearest to the origin that is `margin` inside a convex polygon, none
    if there is none.
    """
    along = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(along, axis=1)
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1)
    outward = outward / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    # Each edge allows outward · x ≤ limit. The nearest point is the origin, its foot on one of
    # these lines, or where two of them meet.
    limits = (outward * corners).sum(axis=1) - margin
    first, second = np.triu_indices(len(corners), 1)
    cross = outward[first, 0] * outward[second, 1] - outward[first, 1] * outward[second, 0]
    turned = limits[first, None] * outward[second] - limits[second, None] * outward[first]
    meets = np.stack([turned[:, 1], -turned[:, 0]], axis=1)
    meets = meets / np.where(cross == 0.0, np.inf, cross)[:, None]
    candidates = np.concatenate([np.zeros((1, 2)), outward * limits[:, None], meets[cross != 0.0]])
    slack = 1e-9 * np.abs(corners).max()
    allowed = candidates[(candidates @ outward.T <= limits + slack).all(axis=1)]
    return allowed[np.linalg.norm(allowed, axis=1).argsort()[:1]]


@dataclass(frozen=True, eq=False)
class RestingPoses:
    """Stable resting poses, the likeliest first.

    `normals`: (k, 3) outward unit normals of the faces that the body rests on; at rest they point
    down. `shares`: (k,) quasi-static probabilities, adding up to 1. `margins`: (k,) distances of
    the center's foot from the nearest edge of the face. `heights`: (k,) heights of the center above
    the ground.
    """

    normals: Array
    shares: Array
    margins: Array
    heights: Array

    @property
    def tipping_angles(self) -> Array:
        """(k,) tilts of the ground at which the body tips, in radians."""
        return np.arctan2(self.margins, self.heights)


def resting_poses(
    hull: ConvexHull, center: ArrayLike, tolerance: float = PLANE_RTOL
) -> RestingPoses:
    """Find the stable resting poses of a body.

    Parameters
    ----------
    hull : ConvexHull
        Hull of the body, made with a tolerance that is not below the noise of its points.
    center : (3,) array_like
        Its center of mass.
    tolerance : float
        Relative to the hull's largest extent: triangles with corners this near to one plane are one
        face, and faces with a smaller margin are not stable. At least twice the distance of points
        outside the hull is used.

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
    heights = faces.heights
    if heights.min() < -least or hull.is_flat and faces.margins.max() < -least:
        raise MeasureError(CENTER_OUTSIDE_HULL)
    angles = solid_angles(points, hull.triangles)
    shares = sums_by_index(faces.face, angles, len(heights)) / (4.0 * np.pi)
    # A face that contains the center has an uncertain solid angle: it gets the share that the
    # others leave.
    has_center = heights <= 1e-9 * extent  # in its plane, within rounding
    if has_center.any():
        shares[has_center] = (1.0 - shares[~has_center].sum()) / np.count_nonzero(has_center)
    is_stable = faces.margins > least
    # Over the edge of a face with a margin near zero the center may rise: the body stays where it
    # is.
    rests = is_stable | (heights[faces.beyond] >= heights)
    # The face that a body ends on: each round follows twice as many edges.
    ends = np.where(rests, np.arange(len(rests)), faces.beyond)
    while not np.array_equal(further := ends[ends], ends):
        ends = further
    shares = sums_by_index(ends, shares, len(rests))
    poses = np.flatnonzero(is_stable)
    if not len(poses):
        raise MeasureError(NO_STABLE_POSE)
    poses = poses[np.lexsort((heights[poses], -np.round(shares[poses], 12)))]
    return RestingPoses(faces.units[poses], shares[poses], faces.margins[poses], heights[poses])


class _Faces(NamedTuple):
    """Faces of a hull. face: (m,) of each triangle. units: (f, 3) outward unit normals. heights,
    margins: (f,) of the center above the face, and of its foot inside the nearest edge. beyond:
    (f,) the face beyond the edge that the foot is nearest to, or has passed farthest.
    """

    face: Index
    units: Array
    heights: Array
    margins: Array
    beyond: Index


def _faces(points: NDArray, hull: ConvexHull, least: float) -> _Faces:
    """Return the faces of a hull, each of triangles in one plane.

    points: (n, 3) corners of the hull from the body's center. least: smaller distances from a plane
    count as 0.
    """
    triangles, neighbors = hull.triangles, hull.neighbors
    area_vectors = normals(points, triangles)
    face, count = _coplanar(points, triangles, neighbors, area_vectors, least)
    summed = np.stack([sums_by_index(face, column, count) for column in area_vectors.T], axis=1)
    lengths = np.linalg.norm(summed, axis=1)
    unit = summed / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    heights = np.full(count, -np.inf)
    for k in range(3):
        np.maximum.at(heights, face, np.einsum("ij,ij->i", unit[face], points[triangles[:, k]]))

    # Each side between two faces, seen from the owner, and the face beyond it. The distance is that
    # of the center's foot inside the side.
    triangle, side = np.nonzero(face[neighbors] != face[:, None])
    owner = face[triangle]
    beyond = face[neighbors[triangle, side]]
    start = points[triangles[triangle, side]]
    along = points[triangles[triangle, (side + 1) % 3]] - start
    inward = np.cross(unit[owner], along)
    length = np.linalg.norm(inward, axis=1)
    distance = -np.einsum("ij,ij->i", inward, start) / np.where(length > 0.0, length, 1.0)
    order = np.lexsort((distance, owner))
    nearest = order[run_starts(owner[order])]  # empty if the whole hull is one face
    margins = np.full(count, -np.inf)
    margins[owner[nearest]] = distance[nearest]
    nearest_face = np.arange(count)
    nearest_face[owner[nearest]] = beyond[nearest]
    return _Faces(face, unit, heights, margins, nearest_face)


def _coplanar(
    points: NDArray, triangles: NDArray, neighbors: NDArray, area_vectors: NDArray, least: float
) -> tuple[Index, int]:
    """Return the (m,) faces of the triangles, and the number of faces.

    neighbors: (m, 3) triangles beyond each side. area_vectors: (m, 3) normals as long as the
    doubled areas. least: largest distance from a plane that counts as 0.

    Neighbors are in one plane if the corner of the smaller one is in the plane of the larger. A
    sliver may join triangles on both its sides that are not in one plane. Such a group is divided,
    and only neighbors that face alike are joined; the triangles of a group still not in one plane,
    such as a fine rounding, stay single.
    """
    lengths = np.linalg.norm(area_vectors, axis=1)
    triangle, side = np.divmod(np.arange(neighbors.size), 3)
    other = neighbors.ravel()
    larger = lengths[triangle] >= lengths[other]
    triangle, other, side = (values[larger] for values in (triangle, other, side))
    # The corner of the other triangle that is not on the common side, from the larger one's plane.
    corners = triangles[other]
    shared = (corners == triangles[triangle, side][:, None]) | (
        corners == triangles[triangle, (side + 1) % 3][:, None]
    )
    apart = (
        points[corners[np.arange(len(other)), shared.argmin(axis=1)]]
        - points[triangles[triangle, 0]]
    )
    unit = area_vectors / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    cosine = np.einsum("ij,ij->i", unit[triangle], unit[other])
    flat = (cosine >= 0.0) & (np.abs(np.einsum("ij,ij->i", unit[triangle], apart)) <= least)
    order = np.argsort(lengths, kind="stable")

    def join_triangles(pairs: Mask) -> tuple[Index, Mask]:
        """Return the (m,) groups of triangles joined by these pairs, and an (m,) mask of groups not
        in one plane.
        """
        face, count = connected_components(len(triangles), triangle[pairs], other[pairs])
        largest = np.empty(count, np.intp)
        largest[face[order]] = order  # the last one written is the largest
        base = largest[face]
        offsets = points[triangles] - points[triangles[base, 0]][:, None]
        off = np.abs(np.einsum("ij,ikj->ik", unit[base], offsets)).max(axis=1)
        bent = np.zeros(count, bool)
        # Each step to a neighbor may add `least`; 4 such steps still count as one plane.
        bent[face[off > 4.0 * least]] = True
        return face, bent[face]

    _, bent = join_triangles(flat)
    face, bent = join_triangles(flat & (~bent[triangle] | (cosine >= ALIKE_COSINE)))
    label = np.where(bent, len(face) + np.arange(len(face)), face)
    _, label = np.unique(label, return_inverse=True)
    return label.ravel(), int(label.max()) + 1
