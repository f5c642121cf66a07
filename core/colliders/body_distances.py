# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The largest distances between a body and its colliders, from samples of both surfaces, with their
bound.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from math import inf, pi

import numpy as np

from ..mesh import Bvh, ConvexHull, Surface, convex_hull, normals, tree_of_all
from ..numerics import NEXT_AXIS, Array, NDArray, spread_directions
from ..polyhedron import volume_and_center
from ..robots import Shape
from .convex_pieces import distances_from_triangles

MOST_CONVEX_FACES = 400  # Larger surfaces are not tested for being their own hull.
HULL_RTOL = 1e-8  # relative to the size: distances that count as none
# The extent of a surface, over the side of the triangles between its samples.
STEPS = 24
COARSE_STEPS = 6
MOST_SAMPLES = 20_000
# Points of the polyhedra that stand for round shapes, and of their rings.
ROUND_POINTS = 400
RING_POINTS = 96
END = np.array([0.0, 0.0, 0.5])
BALL_SAG = 0.012  # relative to the radius: the greatest depth of these polyhedra's faces in a ball
CONVEX_RTOL = 1e-9  # share of the volume that a convex body lacks in its hull
PAIRS_PER_BLOCK = 1 << 20
INSIDE_RTOL = 1e-9  # relative to the size
SLIVER_RTOL = 1e-9  # relative to the size: width of faces that count as none
TINY = float(np.finfo(np.float64).tiny)
# Reach of the first two searches for the body around a place, relative to the size.
ON_BODY_RTOL = 1e-10
NEAR_BODY = 0.02


def hull_of(surface: Surface) -> ConvexHull:
    """Return the convex hull of a closed surface: its own triangles if it has few and is convex."""
    points = np.asarray(surface.points, np.float64)
    triangles = surface.all_triangles()[0].astype(np.intp)
    # Euler's formula: a sphere of triangles that uses each corner has so many of them.
    if len(triangles) == 2 * len(points) - 4 and len(triangles) <= MOST_CONVEX_FACES:
        start = triangles.ravel()
        end = triangles[:, NEXT_AXIS].ravel()
        # The side that runs against each side, found by a key of both ends.
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


def distances(
    surface: Surface, shapes: Sequence[Shape], hull: ConvexHull | None = None, enough: float = inf
) -> tuple[float, float, float]:
    """Return the largest distance of the colliders from the body, outward; that of the body from
    them, inward; and a bound of how much both may be too small, m.

    surface: closed and outward. hull: its hull, if that is known. enough: an outward distance above
    it may be much too small.

    The distance from a convex set is a convex function, and so largest at a corner. Only distances
    from a set that is not convex are sampled: from several colliders, or a body with hollows.
    """
    hull = hull or hull_of(surface)
    triangles = surface.all_triangles()[0].astype(np.intp)
    points = np.asarray(surface.points, np.float64)
    size = float(np.ptp(hull.points, axis=0).max())
    solids, sags = zip(*(_polyhedron(shape) for shape in shapes))
    # The corners of its hull are corners of the body.
    samples, missing = hull.points, 0.0
    if len(solids) > 1:
        samples, missing = _samples(points, triangles, size / STEPS)
    nearest = np.full(len(samples), np.inf)
    for shape, solid in zip(shapes, solids):
        # Samples in an earlier shape need no other one.
        rest = np.flatnonzero(nearest > 0.0)
        near = _distances_from_shape(samples[rest], shape, solid, nearest[rest], size)
        nearest[rest] = np.minimum(nearest[rest], near)
    inward = float(nearest.max(initial=0.0))
    corners = np.concatenate([solid.points for solid in solids])
    # The body is in its hull, and the hull below the planes of its faces: the largest height over a
    # plane, and the distance from the hull, are lower bounds of the distance from the body.
    over_planes = float(_heights(corners, hull).max())
    if over_planes > enough:
        return max(over_planes, 0.0), inward, missing + max(sags)
    no_limits = np.full(len(corners), np.inf)
    from_hull = float(_distances_from_hull(corners, hull, no_limits, size).max())
    volume = hull_volume(hull)
    is_convex = volume - volume_and_center(surface)[0] <= CONVEX_RTOL * volume
    if is_convex or from_hull > enough:
        return max(from_hull, 0.0), inward, missing + max(sags)
    tree = tree_of_all(surface.points, surface.all_triangles()[0])
    from_body, outward_missing = farthest_sample(tree, solids, size, enough)
    return max(from_hull, from_body), inward, max(missing, outward_missing) + max(sags)


def farthest_sample(
    tree: Bvh, solids: Sequence[ConvexHull], size: float, enough: float
) -> tuple[float, float]:
    """Return the largest distance of the surface of solids outside a body from it, inf if it is
    above `enough`, and the bound of `_samples`.

    tree: of the body's triangles. size: the body's extent. Coarse samples come first: one that is
    too far decides.
    """
    farthest = missing = 0.0
    for fineness in (COARSE_STEPS, STEPS) if enough < inf else (STEPS,):
        places, missing = _outer_samples(solids, size, fineness)
        farthest = max(farthest, _farthest_outside(tree, places - tree.origin, size, enough))
        if farthest > enough:
            break
    return farthest, missing


def _farthest_outside(tree: Bvh, places: Array, size: float, enough: float) -> float:
    """Return the largest distance of places outside a body from it; inf if it is above `enough`.

    places: (n, 3) from the tree's origin. Most of them are on the body or near to it, and short
    searches leave few for the long one.
    """
    farthest = 0.0
    component = np.zeros(len(places), np.intp)
    for search, within in enumerate((ON_BODY_RTOL * size, min(NEAR_BODY * size, enough), enough)):
        distance = tree.distances(places, component[: len(places)], within)
        farthest = float(distance[distance < inf].max(initial=farthest))
        places = places[distance == inf]
        if search == 0:  # places on the body have no certain winding number
            winding, sure = tree.winding_numbers(
                places, component[: len(places)], INSIDE_RTOL * size
            )
            places = places[~((winding != 0) & sure)]
    return inf if len(places) else farthest


def _outer_samples(solids: Sequence[ConvexHull], size: float, fineness: int) -> tuple[Array, float]:
    """Return places on the surface of the union of solids, and the bound of `_samples`. fineness:
    steps along the extent of the body or of a larger solid.
    """
    kept, bounds = [], []
    for solid in solids:
        extent = max(size, float(np.ptp(solid.points, axis=0).max()))
        places, missing = _samples(solid.points, solid.triangles, extent / fineness)
        bounds.append(missing)
        for other in solids:
            if other is not solid:
                places = places[_heights(places, other).max(axis=1) >= -INSIDE_RTOL * size]
        kept.append(places)
    return np.concatenate(kept), max(bounds)


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
    """Return a shape as a convex polyhedron in the link's frame, and the largest depth of its faces
    in the shape, which is not 0 if the shape is round.
    """
    if shape.surface is not None:
        points = shape.pose.apply(shape.surface.points * shape.size)
        return hull_of(Surface(points, shape.surface.all_triangles()[0])), 0.0
    hull = _unit("sphere" if shape.kind == "ellipsoid" else shape.kind)
    size = shape.size
    if shape.kind == "capsule":
        # The first ROUND_POINTS points of the unit capsule are those of its upper ball. Both balls
        # are scaled and moved apart, and no face of the hull changes.
        ends = np.where((hull.indices < ROUND_POINTS)[:, None], END, -END)
        points = size[0] * (hull.points - ends) + size[1] * ends
    else:
        points = hull.points * (size if shape.kind != "cylinder" else (size[0], size[0], size[1]))
    sag = 0.0 if shape.kind == "box" else BALL_SAG * max(size)
    return replace(hull, points=shape.pose.apply(points)), sag


def _face_normals(hull: ConvexHull) -> Array:
    """Return the (m, 3) unit normals of a hull's faces; zero for faces without area and for
    slivers, whose normals are rounding.
    """
    normal = normals(hull.points, hull.triangles)
    double = np.linalg.norm(normal, axis=1)
    corners = hull.points[hull.triangles]
    longest = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    least = SLIVER_RTOL * np.ptp(hull.points, axis=0).max() * longest
    return np.where((double > least)[:, None], normal / np.maximum(double, TINY)[:, None], 0.0)


def _heights(points: Array, hull: ConvexHull) -> Array:
    """Return (n, m) signed distances of points from the planes of a hull's faces, positive outside;
    -inf for faces without a normal.
    """
    normal = _face_normals(hull)
    at = np.einsum("ij,ij->i", normal, hull.points[hull.triangles[:, 0]])
    return points @ normal.T - np.where(normal.any(axis=1), at, np.inf)


def _distances_from_shape(
    points: NDArray, shape: Shape, solid: ConvexHull, nearest: NDArray, size: float
) -> Array:
    """Return the distances of points from a shape; from meshes and ellipsoids, those of
    `_distances_from_hull` from its polyhedron.
    """
    if shape.kind in ("mesh", "ellipsoid"):
        return _distances_from_hull(points, solid, nearest, size)
    # By symmetry, in the first octant of the shape's frame: there a shape is a box from the origin
    # to `core`, in (r, z) for a cylinder, and all within `radius` of the box.
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
    """Return the distances of points from a hull, 0 inside; those above the points' (n,) `nearest`
    may be too small. size: the body's extent.
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
    """Return (k, 3) places on triangles, about a step apart, more if there were too many, and a
    bound of the distance of any other place from the nearest of them.

    A triangle is divided into equal ones like it. A place in a triangle is at most 1/√3 of its
    longest side from the nearest corner.
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
