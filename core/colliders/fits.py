# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest simple shapes around a body, and the simplest collider within given distances."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import pi

import numpy as np
from numpy.typing import NDArray

from ..inertia.mass_properties import MassProperties
from ..mesh.hulls import ConvexHull, convex_hull
from ..mesh.surface import Surface, normals, triangle_areas
from ..robots.model import Inertial, Pose, Shape
from ..robots.primitives import equal_inertia_shape, primitive_moments
from .distance import distances, hull_volume
from .pieces import cut_into_pieces

AXES_CORNERS = 48  # of the hull whose faces and edges give the directions of boxes
BALL_RTOL = 1e-12  # points outside a ball by less are on it
SIMPLE = ("sphere", "box", "capsule", "cylinder", "hull")  # tried in this order, before pieces
EQUAL = "equal_"


@dataclass(frozen=True)
class Wanted:
    """The wanted colliders.

    shape: "box" (the smallest), "axes_box" (along the principal axes), "sphere", "capsule", "cylinder", "hull",
    "pieces", "equal_box", "equal_ellipsoid" or "equal_capsule" (of equal inertia), or "automatic": the simplest shape
    within the distances, else pieces. outward, inward: largest distances, m; 0 for no limit of pieces but their number.
    pieces, vertices: the most pieces, and corners of each hull.
    """

    shape: str
    outward: float
    inward: float
    pieces: int
    vertices: int


def make_colliders(
    surface: Surface, body: MassProperties, wanted: Wanted, hull: ConvexHull | None = None
) -> Generator[float, None, list[Shape]]:
    """Make the colliders of a body, in steps that yield the completed share.

    surface: closed and outward, m. body: its mass properties in the same frame. hull: that of the surface, if it is
    known. Raise MeasureError if the points have no extent.
    """
    if wanted.shape.startswith(EQUAL):
        frame = body.principal
        inertial = Inertial.with_agreeing_axes(body.mass, body.center, body.inertia, frame.moments, frame.axes)
        return [equal_inertia_shape(inertial, wanted.shape.removeprefix(EQUAL))]
    hull = hull or convex_hull(surface.points)
    fits = _Fits(hull, body.principal.axes, wanted.vertices)
    if wanted.shape not in ("automatic", "pieces"):
        return [fits.make(wanted.shape)]
    if wanted.shape == "automatic":
        size, reach = float(np.linalg.norm(np.ptp(hull.points, axis=0))), wanted.outward
        area = float(triangle_areas(hull.points, hull.triangles).sum())
        # Steiner's formula bounds the volume of all places this near to the hull; its mean width is below its diagonal.
        most = hull_volume(hull) + area * reach + 2.0 * pi * size * reach**2 + 4.0 / 3.0 * pi * reach**3
        for name in SIMPLE:
            shape = fits.make(name)
            if shape.kind == "mesh" or _volume(shape) <= most:
                outward, inward, _ = distances(surface, [shape], hull, wanted.outward)
                if outward <= wanted.outward and inward <= wanted.inward:
                    return [shape]
    hulls = yield from cut_into_pieces(surface, wanted.outward, wanted.pieces, wanted.vertices)
    return [_hull_shape(hull) for hull in hulls]


class _Fits:
    """The shapes around a hull. axes: principal axes as columns. corners: of a simpler hull, at most."""

    def __init__(self, hull: ConvexHull, axes: NDArray[np.float64], corners: int) -> None:
        self.hull, self.points, self.axes, self.corners = hull, hull.points, axes, corners

    @cached_property
    def box(self) -> Shape:
        """The smallest box."""
        is_simple = len(self.points) <= AXES_CORNERS
        return _smallest_box(self.hull if is_simple else convex_hull(self.points, max_corners=AXES_CORNERS), self)

    @cached_property
    def circles(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64], float]]:
        """Axes as columns, with center and radius of the smallest circle around the points along the third axis."""
        frames = (self.axes, self.box.pose.rotation, np.eye(3))
        turned = [frame[:, order] for frame in frames for order in ([0, 1, 2], [1, 2, 0], [2, 0, 1])]
        return [(frame, *enclosing_ball(self.points @ frame[:, :2])) for frame in turned]

    def make(self, shape: str) -> Shape:
        """Return the shape of this name in `Wanted`."""
        if shape == "hull":
            is_simple = len(self.points) <= self.corners
            return _hull_shape(self.hull if is_simple else convex_hull(self.points, max_corners=self.corners))
        if shape == "box":
            return self.box
        if shape == "axes_box":
            return _box(self.points, self.axes)
        if shape == "sphere":
            center, radius = enclosing_ball(self.points)
            return Shape("sphere", (radius,), Pose(center))
        fit = _capsule if shape == "capsule" else _cylinder
        return min((fit(self.points, *circle) for circle in self.circles), key=_volume)


def _hull_shape(hull: ConvexHull) -> Shape:
    return Shape("mesh", surface=Surface.from_triangles(hull.points, hull.triangles))


def _box(points: NDArray[np.float64], axes: NDArray[np.float64]) -> Shape:
    """Return the box around points with these axes as columns."""
    along = points @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    return Shape("box", tuple((high - low).tolist()), Pose(axes @ (low + high) / 2.0, axes))


def _smallest_box(hull: ConvexHull, fits: _Fits) -> Shape:
    """Return the smallest box along the principal axes, along x, y and z, or with a side in a face of the hull."""
    points = fits.points
    corners = hull.points[hull.triangles]
    sides = (corners[:, [1, 2, 0]] - corners).reshape(-1, 3)
    boxes = [_box(points, fits.axes), _box(points, np.eye(3))]
    least = min(_volume(box) for box in boxes)
    for normal in np.unique(np.round(_units(normals(hull.points, hull.triangles)), 12), axis=0):
        across = sides - np.outer(sides @ normal, normal)
        first = _units(across[np.linalg.norm(across, axis=1) > 1e-9 * np.abs(sides).max()])
        second = np.cross(normal, first)
        area = np.ptp(hull.points @ first.T, axis=0) * np.ptp(hull.points @ second.T, axis=0)
        best = int(area.argmin())
        if float(area[best]) * float(np.ptp(hull.points @ normal)) < least:
            boxes.append(_box(points, np.stack([first[best], second[best], normal], axis=1)))
            least = _volume(boxes[-1])
    return min(boxes, key=_volume)


def _volume(shape: Shape) -> float:
    return float(primitive_moments(shape).raw[0])


def _units(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _cylinder(points: NDArray[np.float64], axes: NDArray[np.float64], middle: NDArray, radius: float) -> Shape:
    """Return the cylinder around points along the third axis."""
    along = points @ axes
    low, high = along[:, 2].min(), along[:, 2].max()
    center = axes @ np.append(middle, (low + high) / 2.0)
    return Shape("cylinder", (radius, float(high - low)), Pose(center, axes))


def _capsule(points: NDArray[np.float64], axes: NDArray[np.float64], middle: NDArray, radius: float) -> Shape:
    """Return the capsule around points along the third axis, as thin as the cylinder."""
    along = points @ axes
    caps = np.sqrt(np.maximum(radius**2 - ((along[:, :2] - middle) ** 2).sum(axis=1), 0.0))
    high, low = (along[:, 2] - caps).max(), (along[:, 2] + caps).min()
    center = axes @ np.append(middle, (low + high) / 2.0)
    return Shape("capsule", (radius, max(float(high - low), 0.0)), Pose(center, axes))


def enclosing_ball(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return center and radius of the smallest ball, or circle, around (n, d) points.

    The farthest point outside joins the points that hold the ball, of which the ball needs at most d + 1.
    """
    dimension = points.shape[1]
    first = points[np.linalg.norm(points - points[0], axis=1).argmax()]
    held = np.stack([first, points[np.linalg.norm(points - first, axis=1).argmax()]])
    center, radius = _ball_through(held)
    while True:
        distance = np.linalg.norm(points - center, axis=1)
        farthest = int(distance.argmax())
        if distance[farthest] <= radius * (1.0 + BALL_RTOL) + np.finfo(float).tiny:
            return center, float(distance[farthest])
        held = np.concatenate([held, points[farthest : farthest + 1]])
        balls = []
        for count in range(2, min(dimension + 1, len(held)) + 1):
            for chosen in combinations(range(len(held)), count):
                if len(held) - 1 in chosen:  # the new point holds the ball
                    middle, reach = _ball_through(held[[*chosen]])
                    if np.linalg.norm(held - middle, axis=1).max() <= reach * (1.0 + 1e-10):
                        balls.append((reach, middle, chosen))
        if not balls or min(balls, key=lambda ball: ball[0])[0] <= radius:
            return center, float(distance[farthest])  # rounding alone is left
        radius, center, chosen = min(balls, key=lambda ball: ball[0])
        held = held[[*chosen]]


def _ball_through(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return center and radius of the ball through points whose center is in their span."""
    legs = points[1:] - points[0]
    offset = np.linalg.lstsq(2.0 * legs, (legs**2).sum(axis=1), rcond=None)[0]
    return points[0] + offset, float(np.linalg.norm(points - points[0] - offset, axis=1).max())
