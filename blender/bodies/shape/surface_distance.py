# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points from a shape's surface, and the registration of two shapes by them."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from mathutils.bvhtree import BVHTree

from ....core.mesh import join_surfaces, triangle_distances
from ....core.numerics import Array, Index, NDArray
from ....core.shape import RigidMatch

if TYPE_CHECKING:
    from ..flat.flat_shape import FlatShape
    from .object_shape import Shape

# Relative to the size: distances between these two are wrong for thin triangles in single
# precision.
EXACT_DISTANCE, NEAR_DISTANCE = 1e-5, 1e-2
SURFACE_SAMPLES = 1500  # points of a surface whose distances from another surface are found
POINTS_PER_BATCH = 64  # points whose distances are found at once


class SurfaceDistance:
    """Distances of points from a shape's surface.

    Lengths in meters, world axes. Blender's tree of triangles keeps float32 coordinates, so its
    points are about the center and in units of the size.
    """

    def __init__(self, shape: Shape | FlatShape):
        surface = join_surfaces(list(shape.pieces()))
        self._center = shape.center
        self._scale = shape.size
        self._triangles = triangles = surface.all_triangles()[0]
        self._corners = (surface.points - self._center) / self._scale
        used = surface.used_points()
        middles = surface.points[thinned(triangles)].mean(axis=1)
        farthest = farthest_rows(used - self._center)
        samples = np.concatenate([used[farthest], thinned(used), middles])
        self.points = samples.astype(np.float64, copy=False)
        self._tree = BVHTree.FromPolygons(
            _as_tuples(self._corners), _as_tuples(triangles), all_triangles=True
        )

    def distance(self, points: NDArray, within: float | None = None) -> Array:
        """Return (n,) distances of (n, 3) points, in single precision if clearly above or below the
        limit `within`.
        """
        scaled = (points - self._center) / self._scale
        queries = scaled.tolist()
        # A little beyond both limits, so that float32 hides no distance below them.
        reach = np.inf if within is None else 1.01 * max(NEAR_DISTANCE, within / self._scale)
        # The fourth value is the distance, or None, which becomes NaN, if nothing is within reach.
        nearest = [self._tree.find_nearest(query, reach)[3] for query in queries]
        distances = np.array(nearest, np.float64)
        distances[np.isnan(distances)] = np.inf
        doubtful = np.flatnonzero(
            (distances > EXACT_DISTANCE)
            & (distances < NEAR_DISTANCE)
            & (distances * self._scale > (within or 0.0))
        )
        for start in range(0, len(doubtful), POINTS_PER_BATCH):
            batch = doubtful[start : start + POINTS_PER_BATCH]
            near_triangles = [
                [hit[2] for hit in self._tree.find_nearest_range(queries[i], NEAR_DISTANCE)]
                for i in batch.tolist()
            ]
            # Pairs of a point and a triangle near it, whose index is the third value of a hit.
            point = np.repeat(batch, [len(hits) for hits in near_triangles])
            triangle = np.fromiter(chain.from_iterable(near_triangles), np.intp)
            corners = self._corners[self._triangles[triangle]]
            np.minimum.at(distances, point, triangle_distances(scaled[point], corners))
        return distances * self._scale


def thinned(rows: NDArray) -> NDArray:
    """Return evenly chosen rows of an array, no more than half of SURFACE_SAMPLES."""
    return rows[np.linspace(0, len(rows) - 1, min(len(rows), SURFACE_SAMPLES // 2)).astype(int)]


def farthest_rows(offsets: NDArray) -> Index:
    """Return the indices of the SURFACE_SAMPLES / 10 longest of (n, d) vectors."""
    squares = (offsets**2).sum(axis=1)
    return np.argsort(squares, kind="stable")[-SURFACE_SAMPLES // 10 :]


def _as_tuples(array: NDArray) -> list[tuple]:
    """Return the rows as tuples, because the garbage collector visits lists again and again."""
    return list(zip(*array.T.tolist()))


def register_surfaces(
    source: Any,
    target: Any,
    source_skin: SurfaceDistance,
    target_skin: SurfaceDistance,
    scale: float = 1.0,
) -> RigidMatch:
    """Return the motion that lays a scaled shape (`Shape` or `FlatShape`) onto another one of its
    kind.

    It minimizes the distances of their surfaces.
    """

    def residual(rotation: NDArray, max_points: int | None) -> Array:
        """Return the distances, at the target's scale, that a rotation or reflection leaves, of at
        most about `max_points` points of each surface.
        """
        source_points, target_points = (
            skin.points[:: max(1, len(skin.points) // max_points) if max_points else 1]
            for skin in (source_skin, target_skin)
        )
        placed_source = scale * (source_points - source.center) @ rotation.T + target.center
        placed_target = (target_points - target.center) @ rotation / scale + source.center
        return np.concatenate(
            [target_skin.distance(placed_source), scale * source_skin.distance(placed_target)]
        )

    return source.match(target, residual)
