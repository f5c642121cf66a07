# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Standing bodies: the support polygon and the place of the center of mass over it.

A rigid body at rest on a plane stands if the foot of the plumb line through its center is inside the convex hull of its
contact points, the support polygon. The margin is the foot's distance from the nearest edge; about that edge the body
tips when the ground is tilted by more than atan(margin / height of the center).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..inertia.plain_body import frame_about
from ..mesh.hulls import convex_polygon
from ..numerics.arguments import check_filled, float_array

CONTACT_RTOL = 1e-6  # Relative to the body's extent: points up to this height above the lowest one touch the ground.
NEAR = 0.1  # Relative to the polygon's extent: the foot is near the edge.
ON_EDGE = 4.0 * float(np.finfo(np.float64).eps)  # Relative to the corners' distances: zero after rounding.


@dataclass(frozen=True, eq=False)
class Support:
    """The stand of a body on the ground, in the unit and the frame of its points.

    `polygon`: (k, 3) corners of the support polygon, counter-clockwise from above; two if it is a line, one if a point.
    `foot`: the point of the ground below the center of mass. `height`: of the center above the ground.
    `margin`: distance of the foot from the nearest edge, negative if it is outside the polygon.
    `direction`: unit vector along the ground across the nearest edge, over which the body tips first or falls.
    `up`: unit vector against gravity.
    """

    polygon: NDArray[np.float64]
    foot: NDArray[np.float64]
    height: float
    margin: float
    direction: NDArray[np.float64]
    up: NDArray[np.float64]

    @property
    def stands(self) -> bool:
        """True if the foot is inside the polygon; a body balanced on an edge, a line or a point does not stand."""
        return self.margin > 0.0

    @property
    def tipping_angle(self) -> float:
        """The tilt of the ground at which the body tips, in radians; negative if it tips by itself."""
        return atan2(self.margin, self.height)

    @property
    def is_near_edge(self) -> bool:
        """True if the margin is below a tenth of the polygon's extent."""
        return self.margin < NEAR * float(np.linalg.norm(np.ptp(self.polygon, axis=0)))

    def target(self, margin: float | None) -> NDArray[np.float64]:
        """Return the point of the polygon nearest to the foot with a margin, (3,); None, or too much: the middle."""
        axes = ground_axes(-self.up)[:, :2]
        corners = (self.polygon - self.foot) @ axes
        inside = corners[:0] if margin is None else nearest_inside(corners, margin)
        return self.foot + axes @ (inside[0] if len(inside) else polygon_middle(corners))


def ground_axes(down: ArrayLike) -> NDArray[np.float64]:
    """Return a (3, 3) rotation with two columns along the ground and the third up; down: direction of gravity."""
    up = -float_array("down", down, 3)
    return np.transpose(frame_about((up / float(np.linalg.norm(up))).tolist()))


def find_support(
    points: ArrayLike, center: ArrayLike, down: ArrayLike = (0.0, 0.0, -1.0), tolerance: float = CONTACT_RTOL
) -> Support:
    """Find the support polygon of a body on the ground below it.

    Parameters
    ----------
    points : (n, 3) array_like
        Points of the body; the corners of its convex hull are enough. The ground goes through the lowest of them.
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
    points, center = float_array("points", points, "n", 3), float_array("center", center, 3)
    check_filled("points", points)
    axes = ground_axes(down)
    local = (points - center) @ axes
    low = float(local[:, 2].min())
    contacts = local[local[:, 2] <= low + tolerance * float(np.ptp(points, axis=0).max())]
    return _support(contacts[:, :2], -low, center, axes)


def support_of_contacts(
    contacts: ArrayLike, center: ArrayLike, down: ArrayLike = (0.0, 0.0, -1.0), tolerance: float = 0.0
) -> Support:
    """Find the support polygon of (n, 3) contact points at any heights: hands on a wall, feet on stairs.

    The polygon is the hull of the contacts projected along gravity onto the ground through the lowest contact, without
    corners that stand out by less than the tolerance, relative to its extent.
    """
    center = np.asarray(center, np.float64)
    axes = ground_axes(down)
    local = (np.asarray(contacts, np.float64) - center) @ axes
    return _support(local[:, :2], -float(local[:, 2].min()), center, axes, tolerance)


def _support(contacts: NDArray, height: float, center: NDArray, axes: NDArray, tolerance: float = 0.0) -> Support:
    """Return the support of (n, 2) contacts on the ground, in coordinates from the foot."""
    corners = contacts[convex_polygon(contacts, tolerance)]
    margin, direction = polygon_margin(corners)
    polygon = np.concatenate([corners, np.full((len(corners), 1), -height)], axis=1) @ axes.T + center
    return Support(polygon, center - height * axes[:, 2], height, margin, axes[:, :2] @ direction, axes[:, 2])


def polygon_margin(corners: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
    """Return how far the origin is inside a convex polygon, and the unit vector over the nearest edge.

    corners: (k, 2) counter-clockwise. Returns the distance from the nearest edge; outside, minus the distance from the
    polygon; and the direction, (2,), from inside straight over that edge, from outside away from the polygon.
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
    squares = np.where(lengths > 0.0, lengths**2, 1.0)
    share = np.clip(-(corners * along).sum(axis=1) / squares, 0.0, 1.0)
    closest = corners + share[:, None] * along
    distances = np.linalg.norm(closest, axis=1)
    nearest = int(distances.argmin())
    if distances[nearest] > ON_EDGE * np.abs(corners).max():
        return -float(distances[nearest]), -closest[nearest] / distances[nearest]
    side = along[nearest] / lengths[nearest] if lengths[nearest] > 0.0 else np.array([0.0, -1.0])
    return 0.0, np.array([side[1], -side[0]])


def polygon_middle(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the centroid, (2,), of the area of a convex polygon, or else of a line or point."""
    first, second = corners - corners[0], np.roll(corners, -1, axis=0) - corners[0]
    areas = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    if not areas.sum() > 0.0:
        return corners.mean(axis=0)
    return corners[0] + areas @ (first + second) / (3.0 * areas.sum())


def nearest_inside(corners: NDArray[np.float64], margin: float) -> NDArray[np.float64]:
    """Return the (1, 2) point nearest to the origin that is `margin` inside a convex polygon, none if there is none."""
    along = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(along, axis=1)
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    limits = (outward * corners).sum(axis=1) - margin
    first, second = np.triu_indices(len(corners), 1)
    cross = outward[first, 0] * outward[second, 1] - outward[first, 1] * outward[second, 0]
    turned = limits[first, None] * outward[second] - limits[second, None] * outward[first]
    meets = np.stack([turned[:, 1], -turned[:, 0]], axis=1) / np.where(cross == 0.0, np.inf, cross)[:, None]
    points = np.concatenate([np.zeros((1, 2)), outward * limits[:, None], meets[cross != 0.0]])
    points = points[(points @ outward.T <= limits + 1e-9 * np.abs(corners).max()).all(axis=1)]
    return points[np.linalg.norm(points, axis=1).argsort()[:1]]
