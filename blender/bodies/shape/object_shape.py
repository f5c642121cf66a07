# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of an object, independent of its place: its pose, its symmetry, its signature.

All three need moments of higher order than a measurement has. The body is the same: the solid, or a
shell's sheet.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import frexp
from typing import Any

import bpy
import numpy as np

from ....core import bodies, inertia, mesh, polyhedron, verdict
from ....core.measurement import WALL_UNSUPPORTED, Body, Measurement
from ....core.moments import Moments
from ....core.numerics import Array, NDArray
from ....core.shape import (
    MAX_AXIS_ORDER,
    MAX_DESCRIPTOR_ERROR,
    MAX_ORDER,
    MAX_ORDER_BY_MOMENTS,
    UNDECIDED,
    PlacedTriangles,
    Residual,
    RigidMatch,
    Symmetry,
    equivalent_frames,
    match,
    nearest_frame,
    symmetry,
    unique_frame,
    zernike_quadrature,
)
from ....core.shape.axial_harmonics import (
    MAX_AXIAL_ORDER,
    AxialHarmonics,
    axial_harmonics,
    axis_last,
    turn_by_harmonics,
)
from ....core.shape.signatures import Signature, signature
from ...settings.options import MeasureOptions
from .. import stack
from ..measure_body import THREADS, measure_body
from .surface_distance import EXACT_DISTANCE

EQUAL_AXES_ATOL = 1e-12  # cosine: harmonics about axes nearer to each other are equal
# factors on the level of noise: a unique frame is the same for all of them
NOISE_FACTORS = (0.5, 1.0, 2.0)
MAX_FRAME_CHANGE = 0.1  # between two frames that are the same but for noise
MAX_POSE_BOUND = 1e-2  # radians, and relative to the size: above it a pose is not called unique
MATRIX_STRAIN = 2.0**-23  # of a body by the rounding of its matrix to float32
MAX_MISFIT = 0.02  # relative to the size: coordinates with a larger misfit tell no group
COARSE_NOISE = 1e-4, 1e-3  # noise in the moments of a ball with facets
# relative to the size: distance between a body of revolution and the polygons that stand for it
MAX_FACETS = 0.05
SURFACE_OPTIONS = MeasureOptions(threads=THREADS)  # for the shape of a surface


@dataclass(frozen=True)
class Shape:
    """The shape of a measured object, in SI units and world axes, described by moments of higher
    order.
    """

    measurement: Measurement
    body: Body
    threads: int
    _known_harmonics: list[AxialHarmonics] = field(default_factory=list)

    @property
    def rotation(self) -> Array:
        """(3, 3) axes of the object's frame."""
        return self.measurement.rotation

    @property
    def fingerprint(self) -> str:
        """Fingerprint of the measurement."""
        return self.measurement.fingerprint

    @property
    def is_display_mesh(self) -> bool:
        """True if the pieces are the display mesh of a smooth body, whose moments differ a
        little.
        """
        return self.measurement.method.source == verdict.Source.NURBS

    @property
    def center(self) -> Array:
        """(3,) center of the shape, which is not the center of mass if the density varies."""
        return self.moments.about

    @property
    def size(self) -> float:
        """The largest radius of gyration."""
        return float(self.measurement.mass_properties.radii_of_gyration.max())

    @cached_property
    def moments(self) -> Moments:
        """Moments about the center, to the order that a pose needs; ReadError if they exceed the
        range of numbers.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            volume, area = self.body.moments(MAX_ORDER, self._sheets)
        moments = volume if area is None else area  # the area's for a shell
        if not np.isfinite([moments.raw, moments.rounding_error]).all():
            raise verdict.ReadError(verdict.OBJECT_SIZE, fault=verdict.TOO_LARGE)
        measured = self.body.area if self._sheets else self.body.volume
        return bodies.with_input_error(moments, measured).about_center()

    def piece_moments(self) -> Moments:
        """Return moments like `moments`, but of the polygons, which replace a smooth surface in
        comparisons.
        """
        if not self.is_display_mesh:
            return self.moments
        volume, area = polyhedron.polyhedron_moments(
            self.pieces(),
            MAX_ORDER,
            area_order=MAX_ORDER if self._sheets else None,
            about=self.center,
            threads=self.threads,
            allow_open=True,
        )
        return (volume if area is None else area).about_center()

    @property
    def _sheets(self) -> bool:
        """True if the body consists of sheets, described by their area, not by a volume."""
        return self.measurement.kind == "shell"

    def pieces(self) -> Iterator[mesh.Surface]:
        """Yield the surfaces of the body in world coordinates."""
        return self.body.surfaces(self._sheets)

    def principal_frame(self) -> inertia.PrincipalFrame:
        """Return the frame that moments to sixth order fix; the measured one if the density
        varies.
        """
        measured = self.measurement.mass_properties.principal
        if measured.is_unique or self.body.mass is not None:
            return measured
        return unique_frame(self.moments, self.rotation)

    def pose(self) -> dict[str, Any]:
        """Return the pose for a record (`docs/shape.md`), with harmonics to order 30 if the body
        may be round.
        """
        properties = self.measurement.mass_properties
        is_uniform = self.body.mass is None
        moments = self.moments if is_uniform else self.measurement.mass_moments[0]
        principal = self.principal_frame()
        axes = principal.axes
        is_unique = principal.is_unique
        frames = equivalent_frames(moments)
        is_fixed_by_harmonics = False
        if is_uniform and len(frames.revolution_axes) == 1 and self._is_polygonal:
            frames = turn_by_harmonics(frames, self._harmonics(axis_last(frames)))
            is_fixed_by_harmonics = not frames.revolution_axes
        if is_fixed_by_harmonics:
            axes = nearest_frame(frames, axes)
            is_unique = len(frames.frames) == 1
        group = self._point_group() if is_uniform else {"symmetry": None, "symmetry_order": None}
        is_revolved = str(group["symmetry"]).endswith(("K", "∞v", "∞h"))
        if is_uniform and frames.revolution_axes and not is_revolved:
            angle_bound = np.pi  # noise hides the axes that the body has
        elif inertia.EQUAL_AXES[properties.principal.symmetry]:
            angle_bound = frames.tilt
        else:
            angle_bound = properties.axes_bound(MATRIX_STRAIN)
        position_bound = properties.rounding_error["center"] + properties.input_error["center"]
        is_sharp = max(angle_bound, position_bound / self.size) <= MAX_POSE_BOUND
        return {
            "matrix": inertia.pose_matrix(properties.center, axes),
            "unique": is_unique
            and is_sharp
            and (is_fixed_by_harmonics or _is_stable_frame(moments, axes)),
            "angle_bound": angle_bound,
            "position_bound": position_bound,
        } | group

    def _point_group(self) -> dict[str, Any]:
        """Return the body's point group, and the order of the moments that show it.

        The corners of the surface decide. If the moments are those of a body of revolution or of a
        ball, the body counts as such if its surface is near one, and no axis has a lower order than
        harmonics show.
        """
        axial = self._harmonics if self._is_polygonal else None
        by_moments = symmetry(self.moments, axial=axial)
        group: str | None = by_moments.group
        if self._is_polygonal:
            group = self._confirmed_group(by_moments)
        elif group in UNDECIDED:
            group = f"{UNDECIDED[group]} or {group}"
        return {"symmetry": group, "symmetry_order": by_moments.order}

    def _harmonics(self, frame: NDArray) -> AxialHarmonics:
        """Return the harmonics about the third axis of a frame; the latest ones are kept."""
        if (
            not self._known_harmonics
            or abs(self._known_harmonics[0].frame[:, 2] @ frame[:, 2]) < 1.0 - EQUAL_AXES_ATOL
        ):
            self._known_harmonics[:] = [
                axial_harmonics(self.pieces(), self.center, frame, area=self._sheets)
            ]
        return self._known_harmonics[0].in_frame(frame)

    def _confirmed_group(self, by_moments: Symmetry) -> str | None:
        """Return the group that the surface has, or the groups that it may have; None if
        coordinates are too coarse.
        """
        coordinate_error = (
            max(float(np.linalg.norm(piece.coordinate_error)) for piece in self.pieces())
            / self.size
        )
        # Misfits relative to the size: points nearer than `near` always count as equal, points
        # farther than `far` never. The factors are chosen: a few errors, and four times as many.
        near = inertia.NOISE_LEVEL + 4.0 * coordinate_error
        far = 4.0 * inertia.NOISE_LEVEL + 16.0 * coordinate_error
        if far > MAX_MISFIT:
            return None
        triangles = self._placed_triangles(near, far)
        axes = by_moments.revolution_axes
        is_round = len(axes) > 0 and triangles.is_round(by_moments, MAX_FACETS)
        if is_round and max(map(triangles.turn_order, axes)) > MAX_AXIAL_ORDER:
            return by_moments.group
        by_corners = [
            Symmetry(operations, np.empty((0, 3)), 0) for operations in triangles.groups() or ()
        ]
        names = [finite.group for finite in by_corners]
        if is_round:
            order = max([n for _, n in by_corners[0].axes], default=0) if by_corners else 0
            # An axis of a higher order than harmonics show, or facets that are no misfit, count as
            # round.
            is_certain = order > MAX_AXIAL_ORDER or triangles.is_round(by_moments, near)
            names = [by_moments.group] if is_certain else [*names, by_moments.group]
        elif not by_corners:  # as many corners at one distance as a ball has
            coarse = [symmetry(self.moments, noise, self._harmonics) for noise in COARSE_NOISE]
            names = [
                candidate.group
                for candidate in coarse
                if len(candidate.revolution_axes) and triangles.is_round(candidate, MAX_FACETS)
            ]
        return " or ".join(dict.fromkeys(names)) or None

    @property
    def _is_polygonal(self) -> bool:
        return self.has_surface and not self.is_display_mesh

    @property
    def has_surface(self) -> bool:
        """True if there are polygons, which a signature and a comparison of surfaces need."""
        return self.body.has_surface

    def signature(self, order: int = MAX_ORDER_BY_MOMENTS) -> Signature:
        """Return Zernike descriptors of polygons to `order`, by quadrature above 20 and if raw
        moments lose digits.
        """
        points = np.concatenate([piece.used_points() - self.center for piece in self.pieces()])
        radius = float(np.sqrt((points * points).sum(axis=1).max()))
        # About the center and at about unit size, because high powers of a length soon exceed the
        # range of numbers.
        scale = 2.0 ** frexp(radius)[1]  # a power of two rounds nothing
        radius /= scale
        moment_order = min(order, MAX_ORDER_BY_MOMENTS)
        volume, area = polyhedron.polyhedron_moments(
            self._scaled_pieces(scale),
            moment_order,
            area_order=moment_order if self._sheets else None,
            about=np.zeros(3),
            reach=radius,
            threads=self.threads,
            allow_open=True,
        )
        result = signature(volume if area is None else area, radius)
        is_imprecise = order > MAX_ORDER_BY_MOMENTS or result.error > MAX_DESCRIPTOR_ERROR
        if is_imprecise and not self._sheets:
            whole = mesh.join_surfaces(list(self._scaled_pieces(scale)))
            triangles = whole.all_triangles()[0]
            result = signature(
                volume, radius, zernike_quadrature(whole.points / radius, triangles, order)
            )
        return replace(result, size=scale * result.size)

    def _scaled_pieces(self, scale: float) -> Iterator[mesh.Surface]:
        """Yield the surfaces of the body about its center, divided by `scale`."""
        for piece in self.pieces():
            yield piece.transform(np.eye(3) / scale, -self.center / scale)

    def match(self, target: Shape, residual: Residual) -> RigidMatch:
        """Return the motion that lays this shape onto another one; `residual` as for
        `core.shape.match`.
        """
        return match(self.moments, target.moments, residual, target.size)

    def find_symmetries(self, tolerance: float) -> tuple[Symmetry, Symmetry]:
        """Return the symmetry of the surface and that of the moments; `tolerance` is relative to
        the size.
        """
        # The tolerance for moments is the same as for the surface.
        by_moments = symmetry(self.piece_moments(), max(inertia.NOISE_LEVEL, tolerance))
        triangles = self._placed_triangles(tolerance, tolerance)
        by_surface = by_moments
        # Without axes of revolution, the surface counts as round about all of them.
        if not triangles.is_round(by_moments, tolerance):
            turn_orders = map(triangles.turn_order, by_moments.revolution_axes)
            # Axes of a higher order than groups can have count as axes of revolution.
            if max(turn_orders, default=np.inf) <= MAX_AXIS_ORDER:
                # No symmetry but the identity is certain if there are too many candidates.
                operations = (triangles.groups() or [np.eye(3)[None]])[0]
                by_surface = Symmetry(operations, np.empty((0, 3)), by_moments.order)
        is_held = [triangles.holds(operation, tolerance) for operation in by_surface.operations]
        return replace(by_surface, operations=by_surface.operations[is_held]), by_moments

    def _placed_triangles(self, near: float, far: float) -> PlacedTriangles:
        """Return the triangles about the center, in units of the size."""
        whole = mesh.join_surfaces(list(self.pieces()))
        points = (whole.points.astype(np.float64) - self.center) / self.size
        return PlacedTriangles(points, whole.all_triangles()[0], near, far)


def _is_stable_frame(moments: Moments, axes: NDArray) -> bool:
    """Return whether moments fix this frame alone, at every level of noise that is tried."""
    for factor in NOISE_FACTORS:
        equivalent = equivalent_frames(moments, factor * inertia.NOISE_LEVEL)
        if len(equivalent.frames) != 1 or equivalent.revolution_axes:
            return False
        if np.abs(equivalent.frames[0] - axes).max() >= MAX_FRAME_CHANGE:
            return False
    return True


class NoShapeError(verdict.ReadError):
    """The refusal of an object that can be measured, but has no shape of its own."""

    def __init__(self, reason: str | verdict.Finding, measurement: Measurement):
        super().__init__(reason, subject=measurement.name)
        self.measurement = measurement


def surface_shape_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Shape:
    """Measure an object in threads and return its shape, or raise MeasureError if it has no shape
    or no polygons.
    """
    return surface_shape(measure_body(obj, depsgraph, SURFACE_OPTIONS))


def surface_shape(measured: stack.Measured) -> Shape:
    """Return the shape of a body that was measured with SURFACE_OPTIONS, which must have
    polygons.
    """
    shape = shape_of_measured(measured, SURFACE_OPTIONS.threads)
    if not shape.has_surface:
        raise NoShapeError(
            verdict.finding(bodies.SHAPE_UNAVAILABLE, cause=bodies.NEEDS_POLYGONS),
            shape.measurement,
        )
    return shape


def shape_of(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, options: MeasureOptions | None = None
) -> Shape:
    """Measure an object for its shape, or raise MeasureError; NoShapeError if it can be measured
    but has no shape.
    """
    options = options or MeasureOptions()
    return shape_of_measured(measure_body(obj, depsgraph, options), options.threads)


def shape_of_measured(measured: stack.Measured, threads: int) -> Shape:
    """Return the shape of a measured body, or raise NoShapeError if it has none."""
    measurement, body = measured.measurement, measured.body
    if body.mass is not None and not body.has_surface:
        raise NoShapeError(bodies.SHAPE_OF_GRID, measurement)
    if body.wall is not None or body.length is not None:
        code = WALL_UNSUPPORTED if body.length is None else bodies.WIRE_UNSUPPORTED
        raise NoShapeError(verdict.finding(code, quantity="A pose or signature"), measurement)
    if measurement.method.procedure == verdict.Procedure.OPEN:
        raise NoShapeError(bodies.SHAPE_OF_OPEN_SURFACE, measurement)
    shape = Shape(measurement, body, threads)
    if np.finfo(np.float64).eps * np.abs(shape.center).max() > EXACT_DISTANCE * shape.size:
        raise NoShapeError(
            verdict.finding(bodies.SHAPE_UNAVAILABLE, cause=bodies.FAR_FROM_ORIGIN), measurement
        )
    return shape
