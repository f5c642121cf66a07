# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest simple shapes around a body, and the simplest collider within given distances."""

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import inf, pi

import numpy as np

from ..inertia import MassProperties
from ..mesh import ConvexHull, Surface, convex_hull, normals, tree_of_all, triangle_areas
from ..numerics import Array, NDArray
from ..robots import Inertial, Pose, Shape, equal_inertia_shape, primitive_moments
from .body_distances import distances, farthest_sample, hull_of, hull_volume
from .convex_pieces import cut_into_pieces

AXES_CORNERS = 96  # The faces and edges of such a hull give the directions of boxes.
BALL_RTOL = 1e-12  # points outside a ball by less are on it
SIMPLE = ("sphere", "box", "capsule", "cylinder", "hull")  # tried in this order, before pieces
EQUAL = "equal_"
MERGING_SHARE = 0.95  # share of the work that is complete while pieces are merged


@dataclass(frozen=True)
class Wanted:
    """The wanted colliders.

    shape: "box" (the smallest), "axes_box" (along the principal axes), "sphere", "capsule",
    "cylinder", "hull", "pieces", "equal_box", "equal_ellipsoid" or "equal_capsule" (of equal
    inertia), or "automatic": the simplest shape within the distances, else pieces. outward, inward:
    largest distances, m; 0 for no limit of pieces but their number. pieces, vertices: the most
    pieces, and corners of each hull.
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

    surface: closed and outward, m. body: its mass properties in the same frame. hull: that of the
    surface, if it is known. Raise MeasureError if the points have no extent.
    """
    if wanted.shape.startswith(EQUAL):
        frame = body.principal
        inertial = Inertial.with_agreeing_axes(
            body.mass, body.center, body.inertia, frame.moments, frame.axes
        )
        return [equal_inertia_shape(inertial, wanted.shape.removeprefix(EQUAL))]
    hull = hull or hull_of(surface)
    fits = _Fits(hull, body.principal.axes, wanted.vertices)
    if wanted.shape not in ("automatic", "pieces"):
        return [fits.make(wanted.shape)]
    if wanted.shape == "automatic":
        size = float(np.linalg.norm(np.ptp(hull.points, axis=0)))
        reach = wanted.outward
        area = float(triangle_areas(hull.points, hull.triangles).sum())
        # Steiner's formula bounds the volume of all places this near to the hull; its mean width is
        # below its diagonal.
        most = (
            hull_volume(hull)
            + area * reach
            + 2.0 * pi * size * reach**2
            + 4.0 / 3.0 * pi * reach**3
        )
        for name in SIMPLE:
            shape = fits.make(name)
            if shape.kind == "mesh" or _volume(shape) <= most:
                outward, inward, _ = distances(surface, [shape], hull, wanted.outward)
                if outward <= wanted.outward and inward <= wanted.inward:
                    return [shape]
    hulls = yield from cut_into_pieces(surface, wanted.outward, wanted.pieces, wanted.vertices)
    if wanted.outward > 0.0:
        hulls = yield from _merge_within(hulls, surface, wanted)
    return [_hull_shape(hull) for hull in hulls]


def _merge_within(
    hulls: list[ConvexHull], surface: Surface, wanted: Wanted
) -> Generator[float, None, list[ConvexHull]]:
    """Merge pairs of pieces whose common hull keeps the wanted distances, the smallest added volume
    first.

    Outward the distance is sampled. Inward it is at most the sum of the gaps: distances of points
    that a hull of few corners leaves outside, added up over merges.
    """
    tree = tree_of_all(surface.points, surface.all_triangles()[0])
    size = float(np.ptp(surface.points, axis=0).max())
    pieces = dict(enumerate(hulls))
    gaps = {number: hull.gap for number, hull in pieces.items()}
    volumes = {number: hull_volume(hull) for number, hull in pieces.items()}
    compared: set[tuple[int, int]] = set()
    # The added volume, the numbers of two pieces, and their common hull; sorted by the volume.
    trials: list[tuple[float, int, int, ConvexHull]] = []
    while True:
        for i, j in set(combinations(pieces, 2)) - compared:
            points = np.concatenate([pieces[i].points, pieces[j].points])
            merged = convex_hull(points, max_corners=wanted.vertices)
            if merged.gap + max(gaps[i], gaps[j]) <= wanted.inward:
                trials.append((hull_volume(merged) - volumes[i] - volumes[j], i, j, merged))
            compared.add((i, j))
        trials = sorted(
            (added, i, j, merged)
            for added, i, j, merged in trials
            if i in pieces and j in pieces  # not merged meanwhile
        )
        while trials:
            yield MERGING_SHARE
            _, i, j, merged = trials.pop(0)
            farthest, _ = farthest_sample(tree, [merged], size, wanted.outward)
            if farthest < inf:
                break
        else:
            return [*pieces.values()]
        del pieces[i], pieces[j]
        number = max(volumes) + 1
        pieces[number] = merged
        gaps[number] = merged.gap + max(gaps[i], gaps[j])
        volumes[number] = hull_volume(merged)


class _Fits:
    """The shapes around a hull. axes: principal axes as columns. corners: the largest number of
    corners of a simpler hull.
    """

    def __init__(self, hull: ConvexHull, axes: Array, corners: int) -> None:
        self.hull = hull
        self.points = hull.points
        self.axes = axes
        self.corners = corners

    @cached_property
    def box(self) -> Shape:
        """The smallest box."""
        is_simple = len(self.points) <= AXES_CORNERS
        return _smallest_box(
            self.hull if is_simple else convex_hull(self.points, max_corners=AXES_CORNERS), self
        )

    @cached_property
    def circles(self) -> list[tuple[Array, Array, float]]:
        """Axes as columns, with center and radius of the smallest circle around the points along
        the third axis.
        """
        frames = (self.axes, self.box.pose.rotation, np.eye(3))
        turned = [
            frame[:, order] for frame in frames for order in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
        ]
        return [(frame, *enclosing_ball(self.points @ frame[:, :2])) for frame in turned]

    def make(self, shape: str) -> Shape:
        """Return the shape of this name in `Wanted`."""
        if shape == "hull":
            is_simple = len(self.points) <= self.corners
            return _hull_shape(
                self.hull if is_simple else convex_hull(self.points, max_corners=self.corners)
            )
        if shape == "box":
            return self.box
        if shape == "axes_box":
            return _box(self.points, self.axes)
        if shape == "sphere":
            center, radius = enclosing_ball(self.points)
            return Shape("sphere", (radius,), Pose(center))
        return min(
            (_round_shape(shape, self.points, *circle) for circle in self.circles), key=_volume
        )


def _hull_shape(hull: ConvexHull) -> Shape:
    """Return the mesh of a hull."""
    return Shape("mesh", surface=Surface.from_triangles(hull.points, hull.triangles))


def _box(points: Array, axes: Array) -> Shape:
    """Return the box around points with these axes as columns."""
    along = points @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    return Shape("box", tuple((high - low).tolist()), Pose(axes @ (low + high) / 2.0, axes))


def _smallest_box(hull: ConvexHull, fits: _Fits) -> Shape:
    """Return the smallest box along the principal axes, along x, y and z, or with a side in a face
    of the hull and another along an edge.

    hull: simple enough to try all faces and edges. The box is around all points of `fits`.
    """
    points = fits.points
    corners = hull.points[hull.triangles]
    sides = _directions((corners[:, [1, 2, 0]] - corners).reshape(-1, 3))
    boxes = [_box(points, fits.axes), _box(points, np.eye(3))]
    least = min(_volume(box) for box in boxes)
    for normal in _directions(normals(hull.points, hull.triangles)):
        # The directions of the edges in the plane of the face; an edge across it has none.
        first = sides - np.outer(sides @ normal, normal)
        first = _units(first[np.linalg.norm(first, axis=1) > 1e-9])
        second = np.cross(normal, first)
        area = np.ptp(hull.points @ first.T, axis=0) * np.ptp(hull.points @ second.T, axis=0)
        best = int(area.argmin())
        if float(area[best]) * float(np.ptp(hull.points @ normal)) < least:
            boxes.append(_box(points, np.stack([first[best], second[best], normal], axis=1)))
            least = _volume(boxes[-1])
    return min(boxes, key=_volume)


def _volume(shape: Shape) -> float:
    """Return the volume of a primitive."""
    return float(primitive_moments(shape).raw[0])


def _directions(vectors: Array) -> Array:
    """Return the unit vectors along some vectors, each direction or its opposite once: the largest
    coordinate is positive.
    """
    units = _units(vectors[vectors.any(axis=1)])
    largest = units[np.arange(len(units)), np.abs(units).argmax(axis=1)]
    return np.unique(np.round(units * np.sign(largest)[:, None], 12), axis=0)


def _units(vectors: Array) -> Array:
    """Return vectors divided by their lengths, none of which is zero."""
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _round_shape(kind: str, points: NDArray, axes: Array, middle: NDArray, radius: float) -> Shape:
    """Return the cylinder or the capsule around points along the third axis, of one radius.

    axes: columns. middle, radius: of the circle around the points along the third axis.
    """
    along = points @ axes
    # How far a cap reaches over its end at a point's distance from the axis.
    caps = np.zeros(len(points))
    if kind == "capsule":
        caps = np.sqrt(np.maximum(radius**2 - ((along[:, :2] - middle) ** 2).sum(axis=1), 0.0))
    high = (along[:, 2] - caps).max()
    low = (along[:, 2] + caps).min()
    center = axes @ np.append(middle, (low + high) / 2.0)
    return Shape(kind, (radius, max(float(high - low), 0.0)), Pose(center, axes))


def enclosing_ball(points: Array) -> tuple[Array, float]:
    """Return center and radius of the smallest ball, or circle, around (n, d) points.

    The farthest point outside joins the holders, the points on the surface that determine the ball,
    and the smallest ball around these is found among those through d + 1 of them at most.
    """
    dimension = points.shape[1]
    first = points[np.linalg.norm(points - points[0], axis=1).argmax()]
    holders = np.stack([first, points[np.linalg.norm(points - first, axis=1).argmax()]])
    center, radius = _ball_through(holders)
    while True:
        distance = np.linalg.norm(points - center, axis=1)
        farthest = int(distance.argmax())
        if distance[farthest] <= radius * (1.0 + BALL_RTOL) + np.finfo(float).tiny:
            return center, float(distance[farthest])
        holders = np.concatenate([holders, points[farthest : farthest + 1]])
        last = len(holders) - 1
        # The new point is on the surface of the new ball, which is larger.
        subsets = [
            holders[[*chosen, last]]
            for count in range(1, min(dimension, last) + 1)
            for chosen in combinations(range(last), count)
        ]
        balls = []
        for subset in subsets:
            middle, reach = _ball_through(subset)
            if np.linalg.norm(holders - middle, axis=1).max() <= reach * (1.0 + 1e-10):
                balls.append((reach, middle, subset))
        least = min(balls, key=lambda ball: ball[0], default=None)
        if least is None or least[0] <= radius:
            return center, float(distance[farthest])  # rounding alone is left
        radius, center, holders = least


def _ball_through(points: Array) -> tuple[Array, float]:
    """Return center and radius of the ball through points whose center is in their span."""
    legs = points[1:] - points[0]
    offset = np.linalg.lstsq(2.0 * legs, (legs**2).sum(axis=1), rcond=None)[0]
    return points[0] + offset, float(np.linalg.norm(points - points[0] - offset, axis=1).max())
