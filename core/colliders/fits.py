# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest simple shapes around a body, and the simplest collider within given distances.

The largest distances between a body and its colliders come from samples of both surfaces, with
their bound.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import combinations
from math import inf, pi

import numpy as np

from ..inertia import MassProperties
from ..mesh import Bvh, ConvexHull, Surface, convex_hull, normals, tree_of_all, triangle_areas
from ..numerics import NEXT_AXIS, Array, NDArray, spread_directions
from ..polyhedron import volume_and_center
from ..robots import Inertial, Pose, Shape, equal_inertia_shape, primitive_moments
from .convex_pieces import cut_into_pieces, distances_from_triangles

AXES_CORNERS = 96  # The faces and edges of such a hull give the directions of boxes.
MOST_CONVEX_FACES = 400  # Larger surfaces are not tested for being their own hull.
HULL_RTOL = 1e-8  # relative to the size: distances that count as none
BALL_RTOL = 1e-12  # points outside a ball by less are on it
SIMPLE = ("sphere", "box", "capsule", "cylinder", "hull")  # tried in this order, before pieces
EQUAL = "equal_"
# sides of triangles between samples, over the extent of what is sampled
STEPS = 24
COARSE_STEPS = 6
MOST_SAMPLES = 20_000
# of the polyhedra in round shapes
ROUND_POINTS = 400
RING_POINTS = 96
END = np.array([0.0, 0.0, 0.5])
BALL_SAG = 0.012  # relative to the radius: the greatest depth of their faces in a ball
CONVEX_RTOL = 1e-9  # share of the volume that a convex body lacks in its hull
PAIRS_PER_BLOCK = 1 << 20
INSIDE_RTOL = 1e-9  # relative to the size
SLIVER_RTOL = 1e-9  # relative to the size: width of faces that count as none
TINY = float(np.finfo(np.float64).tiny)
# relative to the size: reach of the first searches for the body around a place
ON_BODY_RTOL = 1e-10
NEAR_BODY = 0.02
MERGING_SHARE = 0.95  # of the work that is completed when pieces are merged


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


def hull_of(surface: Surface) -> ConvexHull:
    """Return the convex hull of a closed surface: its own triangles if it has few and is convex."""
    points = np.asarray(surface.points, np.float64)
    triangles = surface.all_triangles()[0].astype(np.intp)
    # Each corner is used, and only once, as on a sphere.
    if len(triangles) == 2 * len(points) - 4 and len(triangles) <= MOST_CONVEX_FACES:
        start = triangles.ravel()
        end = triangles[:, NEXT_AXIS].ravel()
        side = start * len(points) + end
        order = np.argsort(side)
        place = np.searchsorted(side[order], end * len(points) + start)
        across = order[np.minimum(place, len(order) - 1)]
        gap = HULL_RTOL * float(np.ptp(points, axis=0).max())
        if (start[across] == end).all() and (end[across] == start).all():
            hull = ConvexHull(
                points,
                np.arange(len(points)),
                triangles,
                (across // 3).reshape(-1, 3),
                is_flat=False,
                gap=gap,
            )
            if _heights(points, hull).max() <= gap:
                return hull
    return convex_hull(points)


def _merge_within(
    hulls: list[ConvexHull], surface: Surface, wanted: Wanted
) -> Generator[float, None, list[ConvexHull]]:
    """Merge pairs of pieces whose common hull keeps the outward distance, the smallest added volume
    first.
    """
    tree = tree_of_all(surface.points, surface.all_triangles()[0])
    size = float(np.ptp(surface.points, axis=0).max())
    pieces = dict(enumerate(hulls))
    gaps = {number: hull.gap for number, hull in pieces.items()}
    volumes = {number: hull_volume(hull) for number, hull in pieces.items()}
    compared: set[tuple[int, int]] = set()
    trials: list[tuple[float, int, int, ConvexHull]] = []
    while True:
        for i, j in set(combinations(pieces, 2)) - compared:
            points = np.concatenate([pieces[i].points, pieces[j].points])
            merged = convex_hull(points, max_corners=wanted.vertices)
            if merged.gap + max(gaps[i], gaps[j]) <= wanted.inward:
                trials.append((hull_volume(merged) - volumes[i] - volumes[j], i, j, merged))
            compared.add((i, j))
        trials = sorted(trial for trial in trials if {*trial[1:3]} <= pieces.keys())
        while trials:
            yield MERGING_SHARE
            _, i, j, merged = trials.pop(0)
            if all(
                _farthest_outside(tree, places - tree.origin, size, wanted.outward) < inf
                for fineness in (COARSE_STEPS, STEPS)
                for places in (_outer_samples([merged], size, fineness)[0],)
            ):
                break
        else:
            return [*pieces.values()]
        del pieces[i], pieces[j]
        number = max(volumes) + 1
        pieces[number] = merged
        gaps[number] = merged.gap + max(gaps[i], gaps[j])
        volumes[number] = hull_volume(merged)


class _Fits:
    """The shapes around a hull. axes: principal axes as columns. corners: of a simpler hull, at
    most.
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
    return Shape("mesh", surface=Surface.from_triangles(hull.points, hull.triangles))


def _box(points: Array, axes: Array) -> Shape:
    """Return the box around points with these axes as columns."""
    along = points @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    return Shape("box", tuple((high - low).tolist()), Pose(axes @ (low + high) / 2.0, axes))


def _smallest_box(hull: ConvexHull, fits: _Fits) -> Shape:
    """Return the smallest box along the principal axes, along x, y and z, or with a side in a face
    of the hull.
    """
    points = fits.points
    corners = hull.points[hull.triangles]
    sides = _directions((corners[:, [1, 2, 0]] - corners).reshape(-1, 3))
    boxes = [_box(points, fits.axes), _box(points, np.eye(3))]
    least = min(_volume(box) for box in boxes)
    for normal in _directions(normals(hull.points, hull.triangles)):
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
    return float(primitive_moments(shape).raw[0])


def _directions(vectors: Array) -> Array:
    """Return the unit vectors along some vectors, each direction once, without its sense."""
    units = _units(vectors[vectors.any(axis=1)])
    largest = units[np.arange(len(units)), np.abs(units).argmax(axis=1)]
    return np.unique(np.round(units * np.sign(largest)[:, None], 12), axis=0)


def _units(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _round_shape(kind: str, points: NDArray, axes: Array, middle: NDArray, radius: float) -> Shape:
    """Return the cylinder around points along the third axis, or the capsule, which is as thin."""
    along = points @ axes
    caps = np.zeros(len(points))
    if kind == "capsule":
        caps = np.sqrt(np.maximum(radius**2 - ((along[:, :2] - middle) ** 2).sum(axis=1), 0.0))
    high = (along[:, 2] - caps).max()
    low = (along[:, 2] + caps).min()
    center = axes @ np.append(middle, (low + high) / 2.0)
    return Shape(kind, (radius, max(float(high - low), 0.0)), Pose(center, axes))


def enclosing_ball(points: Array) -> tuple[Array, float]:
    """Return center and radius of the smallest ball, or circle, around (n, d) points.

    The farthest point outside joins the points that hold the ball, of which the ball needs at most
    d + 1.
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


def _ball_through(points: Array) -> tuple[Array, float]:
    """Return center and radius of the ball through points whose center is in their span."""
    legs = points[1:] - points[0]
    offset = np.linalg.lstsq(2.0 * legs, (legs**2).sum(axis=1), rcond=None)[0]
    return points[0] + offset, float(np.linalg.norm(points - points[0] - offset, axis=1).max())


def distances(
    surface: Surface, shapes: Sequence[Shape], hull: ConvexHull | None = None, enough: float = inf
) -> tuple[float, float, float]:
    """Return the largest distance of the colliders from the body, outward, and of the body from
    them, inward, in m.

    surface: closed and outward. hull: its hull, if that is known. enough: outward distances above
    it may be too small. The third number bounds by how much others may be too small. The distance
    from a convex body is largest at a corner, so that only others are sampled.
    """
    hull = hull or hull_of(surface)
    triangles = surface.all_triangles()[0].astype(np.intp)
    points = np.asarray(surface.points, np.float64)
    size = float(np.ptp(hull.points, axis=0).max())
    solids, sags = zip(*(_polyhedron(shape) for shape in shapes))
    samples, step = (
        (hull.points, 0.0) if len(solids) == 1 else _samples(points, triangles, size / STEPS)
    )
    nearest = np.full(len(samples), np.inf)
    for shape, solid in zip(shapes, solids):
        rest = np.flatnonzero(nearest > 0.0)
        near = _distances_from_shape(samples[rest], shape, solid, nearest[rest], size)
        nearest[rest] = np.minimum(nearest[rest], near)
    inward = float(nearest.max(initial=0.0))
    corners = np.concatenate([solid.points for solid in solids])
    outward = float(_heights(corners, hull).max())
    if outward <= enough:
        outward = float(
            _distances_from_hull(corners, hull, np.full(len(corners), np.inf), size).max()
        )
    is_convex = hull_volume(hull) - volume_and_center(surface)[0] <= CONVEX_RTOL * hull_volume(hull)
    if is_convex or outward > enough:
        return max(outward, 0.0), inward, step + max(sags)
    tree = tree_of_all(surface.points, surface.all_triangles()[0])
    own_step = 0.0
    for fineness in (COARSE_STEPS, STEPS) if enough < inf else (STEPS,):
        places, own_step = _outer_samples(solids, size, fineness)
        outward = max(outward, _farthest_outside(tree, places - tree.origin, size, enough))
        if outward > enough:
            break
    return outward, inward, max(step, own_step) + max(sags)


def _farthest_outside(tree: Bvh, places: Array, size: float, enough: float) -> float:
    """Return the largest distance of places outside a body from it; inf if it is above `enough`.

    Most places are on the body or near to it, and short searches leave few for the long one.
    """
    farthest = 0.0
    component = np.zeros(len(places), np.intp)
    for step, within in enumerate((ON_BODY_RTOL * size, min(NEAR_BODY * size, enough), enough)):
        distance = tree.distances(places, component[: len(places)], within)
        farthest = float(distance[distance < inf].max(initial=farthest))
        places = places[distance == inf]
        if step == 0:
            winding, sure = tree.winding_numbers(
                places, component[: len(places)], INSIDE_RTOL * size
            )
            places = places[~((winding != 0) & sure)]
    return inf if len(places) else farthest


def _outer_samples(solids: Sequence[ConvexHull], size: float, fineness: int) -> tuple[Array, float]:
    """Return places on the surface of the union of solids, and the bound of their distances as of
    `_samples`.
    """
    kept, steps = [], []
    for solid in solids:
        reach = max(size, float(np.ptp(solid.points, axis=0).max()))
        places, step = _samples(solid.points, solid.triangles, reach / fineness)
        steps.append(step)
        for other in solids:
            if other is not solid:
                places = places[_heights(places, other).max(axis=1) >= -INSIDE_RTOL * size]
        kept.append(places)
    return np.concatenate(kept), max(steps)


def hull_volume(hull: ConvexHull) -> float:
    """Return the volume of a hull."""
    return volume_and_center(Surface.from_triangles(hull.points, hull.triangles))[0]


@lru_cache
def _unit(kind: str) -> ConvexHull:
    """Return a box, ball, cylinder or capsule whose sides, radius and length are 1."""
    points = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    if kind != "box":
        turn = np.linspace(0.0, 2.0 * pi, RING_POINTS, endpoint=False)
        ring = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
        points = ring if kind == "cylinder" else spread_directions(ROUND_POINTS)
    if kind in ("cylinder", "capsule"):
        points = np.concatenate([points + END, points - END])
    return convex_hull(points, 1e-9)


def _polyhedron(shape: Shape) -> tuple[ConvexHull, float]:
    """Return a shape as a convex polyhedron in the link's frame, and the depth by which that lies
    in a round shape.
    """
    if shape.surface is not None:
        points = shape.pose.apply(shape.surface.points * shape.size)
        return hull_of(Surface(points, shape.surface.all_triangles()[0])), 0.0
    hull = _unit("sphere" if shape.kind == "ellipsoid" else shape.kind)
    size = shape.size
    if shape.kind == "capsule":  # the ends move apart, and no face changes
        ends = np.where((hull.indices < ROUND_POINTS)[:, None], END, -END)
        points = size[0] * (hull.points - ends) + size[1] * ends
    else:
        points = hull.points * (size if shape.kind != "cylinder" else (size[0], size[0], size[1]))
    return replace(
        hull, points=shape.pose.apply(points)
    ), 0.0 if shape.kind == "box" else BALL_SAG * max(size)


def _face_normals(hull: ConvexHull) -> Array:
    """Return the (m, 3) unit normals of a hull's faces; those of faces without area are zero, and
    of slivers, whose normals are rounding.
    """
    normal = normals(hull.points, hull.triangles)
    double = np.linalg.norm(normal, axis=1)
    corners = hull.points[hull.triangles]
    longest = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    least = SLIVER_RTOL * np.ptp(hull.points, axis=0).max() * longest
    return np.where((double > least)[:, None], normal / np.maximum(double, TINY)[:, None], 0.0)


def _heights(points: Array, hull: ConvexHull) -> Array:
    """Return (n, m) signed distances of points from the planes of a hull's faces; -inf from faces
    without area.
    """
    normal = _face_normals(hull)
    at = np.einsum("ij,ij->i", normal, hull.points[hull.triangles[:, 0]])
    return points @ normal.T - np.where(normal.any(axis=1), at, np.inf)


def _distances_from_shape(
    points: NDArray, shape: Shape, solid: ConvexHull, nearest: NDArray, size: float
) -> Array:
    """Return the distances of points from a shape as `_distances_from_hull` does; exact for round
    shapes, too.
    """
    if shape.kind in ("mesh", "ellipsoid"):
        return _distances_from_hull(points, solid, nearest, size)
    place = np.abs((points - shape.pose.position) @ shape.pose.rotation)
    if shape.kind == "cylinder":
        place = np.stack([np.hypot(place[:, 0], place[:, 1]), place[:, 2]], axis=1)
    length = shape.size[-1] / 2.0
    core, radius = {
        "box": (np.array(shape.size) / 2.0, 0.0),
        "sphere": (np.zeros(3), shape.size[0]),
        "capsule": (np.array([0.0, 0.0, length]), shape.size[0]),
        "cylinder": (np.array([shape.size[0], length]), 0.0),
    }[shape.kind]
    return np.maximum(np.linalg.norm(np.maximum(place - core, 0.0), axis=1) - radius, 0.0)


def _distances_from_hull(points: NDArray, hull: ConvexHull, nearest: NDArray, size: float) -> Array:
    """Return the distances of points from a hull, 0 inside; those above `nearest` may be too
    small.
    """
    distance = np.zeros(len(points))
    normal = _face_normals(hull)
    rows = max(1, PAIRS_PER_BLOCK // len(hull.triangles))
    for begin in range(0, len(points), rows):
        part = points[begin : begin + rows]
        heights = _heights(part, hull)
        face = heights.argmax(axis=1)
        height = heights[np.arange(len(part)), face]
        distance[begin : begin + rows] = np.where(height > INSIDE_RTOL * size, height, 0.0)
        # The largest height is a lower bound, and the distance if its foot is on the hull.
        farther = np.flatnonzero(
            (height > INSIDE_RTOL * size) & (height < nearest[begin : begin + rows])
        )
        feet = part[farther] - height[farther, None] * normal[face[farther]]
        farther = farther[_heights(feet, hull).max(axis=1, initial=-np.inf) > INSIDE_RTOL * size]
        distance[begin + farther] = distances_from_triangles(
            part[farther], hull.points[hull.triangles]
        )
    return distance


def _samples(points: NDArray, triangles: NDArray, step: float) -> tuple[Array, float]:
    """Return places on triangles, a step apart or more, and a bound of any other place's distance
    from the nearest.

    A place in a triangle is at most 1/√3 of its longest side from the nearest corner.
    """
    corners = points[triangles]
    longest = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    parts = np.maximum(np.ceil(longest / step), 1.0).astype(int)
    while (count := int(((parts + 1) * (parts + 2) // 2).sum())) > MOST_SAMPLES and parts.max() > 1:
        step *= max(1.2, (count / MOST_SAMPLES) ** 0.5)
        parts = np.maximum(np.ceil(longest / step), 1.0).astype(int)
    places = [points[np.unique(triangles)]]
    for number in np.unique(parts[parts > 1]).tolist():
        i, j = np.nonzero(np.add.outer(np.arange(number + 1), np.arange(number + 1)) <= number)
        shares = np.stack([i, j, number - i - j], axis=1) / number
        places.append((shares @ corners[parts == number]).reshape(-1, 3))
    return np.concatenate(places), float((longest / parts).max() / 3.0**0.5)
