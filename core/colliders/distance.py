# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The largest distances between a body and its colliders, from samples of both surfaces, with their bound."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from ..mesh.bvh import Bvh, sort_components
from ..mesh.hulls import ConvexHull, convex_hull
from ..mesh.point_triangle import triangle_distances
from ..mesh.surface import Surface, normals
from ..polyhedron.integration import volume_and_center
from ..robots.model import Shape
from ..robots.plausibility import spread_directions

STEPS = 24  # sides of triangles between samples, over the extent of what is sampled
MOST_SAMPLES = 20_000
ROUND_POINTS = 400  # of the polyhedra in round shapes
BALL_SAG = 0.012  # of the radius: the greatest depth of their faces in a ball
CONVEX_RTOL = 1e-9  # of the volume that a convex body lacks in its hull
PAIRS_PER_BLOCK = 1 << 20
INSIDE_RTOL = 1e-9  # of the size


def distances(
    surface: Surface, shapes: Sequence[Shape], hull: ConvexHull | None = None, enough: float = inf
) -> tuple[float, float, float]:
    """Return the largest distance of the colliders from the body, outward, and of the body from them, inward, in m.

    surface: closed and outward. hull: its hull, if that is known. enough: outward distances above it may be too small.
    The third number bounds by how much others may be too small. The distance from a convex body is largest at a corner,
    so that only others are sampled.
    """
    hull = hull or convex_hull(surface.points)
    triangles = surface.all_triangles()[0].astype(np.intp)
    points = np.asarray(surface.points, np.float64)
    size = float(np.ptp(hull.points, axis=0).max())
    solids, sags = zip(*map(_polyhedron, shapes))
    samples, step = (hull.points, 0.0) if len(solids) == 1 else _samples(points, triangles, size)
    inward = float(_distances_from_union(samples, solids, size).max(initial=0.0))
    corners = np.concatenate([solid.points for solid in solids])
    outward = float(_distances_from_union(corners, [hull], size).max())
    is_convex = hull_volume(hull) - volume_and_center(surface)[0] <= CONVEX_RTOL * hull_volume(hull)
    if is_convex or outward > enough:
        return outward, inward, step + max(sags)
    tree = Bvh(points, sort_components(points, triangles, np.zeros(len(triangles), np.intp), 1), np.ones(1, bool))
    steps = [step]
    for i, solid in enumerate(solids):
        reach = max(size, float(np.ptp(solid.points, axis=0).max()))
        places, step = _samples(solid.points, solid.triangles, reach)
        covered = np.zeros(len(places), bool)
        for j, other in enumerate(solids):
            if j != i:
                covered |= _heights(places, other).max(axis=1) < -INSIDE_RTOL * size
        places = places[~covered] - tree.origin
        winding, sure = tree.winding_numbers(places, np.zeros(len(places), np.intp), INSIDE_RTOL * size)
        places = places[~((winding != 0) & sure)]
        if len(places):
            outward = max(outward, float(tree.distances(places, np.zeros(len(places), np.intp)).max()))
        steps.append(step)
    return outward, inward, max(steps) + max(sags)


def hull_volume(hull: ConvexHull) -> float:
    """Return the volume of a hull."""
    return volume_and_center(Surface.from_triangles(hull.points, hull.triangles))[0]


@lru_cache(maxsize=1)
def _ball() -> ConvexHull:
    return convex_hull(spread_directions(ROUND_POINTS), 1e-9)


def _polyhedron(shape: Shape) -> tuple[ConvexHull, float]:
    """Return a shape as a convex polyhedron in the link's frame, and the depth by which that lies in a round shape."""
    sag = 0.0
    if shape.surface is not None:
        points = np.asarray(shape.surface.points, np.float64) * shape.size
    elif shape.kind == "box":
        points = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * shape.size
    elif shape.kind in ("sphere", "ellipsoid"):
        hull = _ball().transform(np.diag(np.broadcast_to(shape.size, 3)))
        return replace(hull, points=_placed(hull.points, shape)), BALL_SAG * max(shape.size)
    else:
        radius, length = shape.size
        ring = _ball().points
        if shape.kind == "cylinder":
            turn = np.linspace(0.0, 2.0 * pi, 96, endpoint=False)
            ring = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
        end = np.array([0.0, 0.0, length / 2.0])
        points = np.concatenate([radius * ring + end, radius * ring - end])
    if shape.surface is None and shape.kind != "box":
        sag = BALL_SAG * shape.size[0]
    hull = convex_hull(points, 1e-9)
    return replace(hull, points=_placed(hull.points, shape)), sag


def _placed(points: NDArray[np.float64], shape: Shape) -> NDArray[np.float64]:
    return points @ shape.pose.rotation.T + shape.pose.position


def _heights(points: NDArray[np.float64], hull: ConvexHull) -> NDArray[np.float64]:
    """Return (n, m) signed distances of points from the planes of a hull's faces."""
    normal = normals(hull.points, hull.triangles)
    length = np.linalg.norm(normal, axis=1)
    normal = normal[length > 0.0] / length[length > 0.0, None]
    at = hull.points[hull.triangles[length > 0.0, 0]]
    return points @ normal.T - np.einsum("ij,ij->i", normal, at)


def _distances_from_union(points: NDArray, hulls: Iterable[ConvexHull], size: float) -> NDArray[np.float64]:
    """Return the distances of points from the union of hulls; 0 inside."""
    nearest = np.full(len(points), np.inf)
    for hull in hulls:
        rows = max(1, PAIRS_PER_BLOCK // len(hull.triangles))
        for begin in range(0, len(points), rows):
            part = slice(begin, begin + rows)
            height = _heights(points[part], hull).max(axis=1)
            # The largest height is a lower bound of the distance.
            closer = np.flatnonzero((height < nearest[part]) & (height > INSIDE_RTOL * size))
            nearest[part][height <= INSIDE_RTOL * size] = 0.0
            if len(closer):
                places = points[part][closer].repeat(len(hull.triangles), axis=0)
                corners = np.tile(hull.points[hull.triangles], (len(closer), 1, 1))
                apart = triangle_distances(places, corners).reshape(len(closer), -1).min(axis=1)
                nearest[part][closer] = np.minimum(nearest[part][closer], apart)
    return nearest


def _samples(points: NDArray, triangles: NDArray, size: float) -> tuple[NDArray[np.float64], float]:
    """Return places on triangles, and a bound of the distance of any other place from the nearest of them.

    A place in a triangle is at most 1/√3 of its longest side from the nearest corner.
    """
    corners = points[triangles]
    longest = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    step = size / STEPS
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
