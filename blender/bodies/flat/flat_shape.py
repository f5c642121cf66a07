# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of a flat object, seen from its front and never turned over: signature, symmetry, fit
on another one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TypeVar

import bpy
import numpy as np

from ....core import bodies, inertia, mesh, verdict
from ....core.measurement import fingerprint
from ....core.moments import Moments, monomials
from ....core.numerics import Array, Complex, NDArray
from ....core.shape import (
    MAX_ORDER_BY_MOMENTS,
    Residual,
    RigidMatch,
    Signature,
    Symmetry,
    disc_zernike,
    flat_signature,
    flat_symmetry,
    holds_by_moments,
    holds_by_outline,
    match_flat,
)
from ...read.fingerprint import matrix_hash, settings_hash
from ..shape.object_shape import Shape, surface_shape_of
from ..shape.surface_distance import EXACT_DISTANCE, SurfaceDistance, farthest_rows, thinned
from .region import NO_BODY, FlatRegion, clearer_refusal, flat_region

# curves and text are read with this resolution, because shapes must not depend on the drawn one
OUTLINE_RESOLUTION = 64
POSE_ORDER = 12  # for moments of shapes that are laid onto each other


@dataclass(frozen=True, eq=False)
class FlatShape:
    """A flat object, in SI units: moments about the centroid, in the plane's axes, and the
    reading's fingerprint.
    """

    region: FlatRegion
    moments: Moments
    fingerprint: str

    is_display_mesh = False
    has_surface = True

    @property
    def rotation(self) -> Array:
        """(3, 3) axes of the object's frame."""
        return self.region.rotation

    @property
    def axes(self) -> Array:
        """(3, 3) axes of the plane: x, y and the normal as columns."""
        return self.region.plane.axes

    @property
    def center(self) -> Array:
        """(3,) centroid, in the world."""
        return self.region.plane.origin + self.axes @ self.moments.about

    @property
    def size(self) -> float:
        """The radius of gyration about the normal through the centroid, m."""
        return float(np.sqrt((self.moments[2, 0, 0] + self.moments[0, 2, 0]) / self.moments.total))

    @cached_property
    def corners(self) -> Array:
        """(k, 2) ends of the edges, relative to the centroid, in the plane."""
        return self.region.used - self.moments.about[:2]

    @property
    def radius(self) -> float:
        """Radius of the smallest disc about the centroid that holds the shape, m."""
        return float(np.hypot(*self.corners.T).max())

    def zernike(self, radius: float) -> Complex:
        """Return the Zernike moments to POSE_ORDER in a disc of this radius about the centroid, by
        `disc_zernike`.
        """
        return disc_zernike(self.moments.truncate(POSE_ORDER), radius)

    def signature(self, order: int = MAX_ORDER_BY_MOMENTS) -> Signature:
        """Return the shape's signature, with Zernike descriptors to an order."""
        # Scaled to about unit size, because high powers of a length soon exceed the range of
        # numbers.
        scale = 2.0 ** np.frexp(self.radius)[1]  # a power of two rounds nothing
        moments = self.moments.truncate(min(order, MAX_ORDER_BY_MOMENTS))
        degree = monomials(moments.order).sum(axis=1)
        # A moment of the area grows with the power degree + 2 of a length.
        scaled = Moments(moments.raw / scale ** (degree + 2.0), np.zeros(3), moments.measure)
        unit_signature = flat_signature(scaled, self.radius / scale)
        return replace(unit_signature, size=unit_signature.size * scale)

    def pieces(self) -> Iterator[mesh.Surface]:
        """Yield a wall along the outline, one `size` high on both sides of the plane. Points of the
        plane are as far from it as from the outline.
        """
        ends = self.region.points[self.region.edges] - self.moments.about[:2]  # (m, 2 ends, 2)
        count = len(ends)
        height = self.size
        low, high = (
            np.insert(ends.reshape(-1, 2), 2, side * height, axis=1) for side in (-1.0, 1.0)
        )
        points = np.concatenate([low, high]) @ self.axes.T + self.center
        start = 2 * np.arange(count)
        end = start + 1
        above = 2 * count  # from the index of a low point to that of the high one
        lower = np.stack([start, end, end + above], axis=1)
        upper = np.stack([start, end + above, start + above], axis=1)
        triangles = np.concatenate([lower, upper])
        yield mesh.Surface.from_triangles(points, triangles)

    def match(self, target: FlatShape, residual: Residual) -> RigidMatch:
        """Return the motion that lays this shape onto another one, front on front; `residual` as
        for `match_flat`.
        """
        ratio = target.size / self.size  # turns are found between different sizes, too
        radius = max(target.radius, ratio * self.radius)
        return match_flat(
            self.zernike(radius / ratio),
            target.zernike(radius),
            (self.axes, target.axes),
            residual,
            target.size,
        )

    def find_symmetries(self, tolerance: float) -> tuple[Symmetry, Symmetry]:
        """Return the symmetry of the outline and that of the moments; `tolerance` is relative to
        the size.
        """
        zernike = self.zernike(self.radius)
        max_distance = tolerance * self.size
        skin = OutlineDistance(self)  # distances from the outline, and samples of it

        def distance(points: NDArray) -> Array:
            """Return the distances of (n, 2) points of the plane from the outline."""
            return skin.distance(points @ self.axes.T + self.center, within=max_distance)

        flat_points = (skin.points - self.center) @ self.axes
        holds_for_outline = holds_by_outline(flat_points, distance, max_distance)
        noise = max(inertia.NOISE_LEVEL, tolerance)
        holds_for_moments = holds_by_moments(zernike, POSE_ORDER, noise)
        find = partial(flat_symmetry, zernike, POSE_ORDER, self.corners, self.axes)
        return find(holds_for_outline), find(holds_for_moments)


class OutlineDistance(SurfaceDistance):
    """Distances of points of the plane from a flat shape's outline."""

    def __init__(self, shape: FlatShape):
        super().__init__(shape)
        ends = shape.region.points[shape.region.edges] - shape.moments.about[:2]
        middles = ends.mean(axis=1)
        farthest = shape.corners[farthest_rows(shape.corners)]
        samples = np.concatenate([farthest, thinned(shape.corners), thinned(middles)])
        self.points = np.insert(samples, 2, 0.0, axis=1) @ shape.axes.T + shape.center


def distance_from(shape: Shape | FlatShape) -> SurfaceDistance:
    """Return the distance function of a shape's surface or outline."""
    return OutlineDistance(shape) if isinstance(shape, FlatShape) else SurfaceDistance(shape)


def flat_shape_of(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, unit: float | None = None
) -> FlatShape:
    """Return a flat object's shape, or raise MeasureError if it is not flat, or its outlines
    cross.
    """
    region = flat_region(
        obj, depsgraph, selected=False, resolution=OUTLINE_RESOLUTION, exact=False, unit=unit
    )
    region_fingerprint = fingerprint(
        region.points.tobytes(), matrix_hash(obj), settings_hash(obj, depsgraph.scene)
    )
    with bodies.name_subject(obj.name):
        shape = FlatShape(region, region.moments(MAX_ORDER_BY_MOMENTS), region_fingerprint)
    if np.finfo(np.float64).eps * np.abs(shape.center).max() > EXACT_DISTANCE * shape.size:
        raise verdict.ReadError(
            bodies.SHAPE_UNAVAILABLE, cause=bodies.FAR_FROM_ORIGIN, subject=obj.name
        )
    return shape


BodyShape = TypeVar("BodyShape")


def comparable_shape_of(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, flat: bool = False
) -> Shape | FlatShape:
    """Return the shape of an object's body, else its flat shape; with `flat`, the flat shape is
    tried first.
    """
    return body_or_flat(obj, depsgraph, partial(surface_shape_of, depsgraph=depsgraph), flat)


def body_or_flat(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    of_body: Callable[[bpy.types.Object], BodyShape],
    flat: bool,
) -> BodyShape | FlatShape:
    """Return `of_body(obj)`, or the flat shape if the object is no body; with `flat`, the flat
    shape is tried first.
    """
    if flat:
        with suppress(verdict.MeasureError):
            return flat_shape_of(obj, depsgraph)
    try:
        return of_body(obj)
    except verdict.MeasureError as refusal:
        if refusal.finding.code not in NO_BODY:
            raise
        try:
            return flat_shape_of(obj, depsgraph)
        except verdict.MeasureError as error:
            raise clearer_refusal(refusal, error) from None
