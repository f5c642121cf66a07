# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of an object, independent of its place: its pose, its symmetry, its signature.

All three need moments of higher order than a measurement has. The body is the same: the solid, or a
shell's sheet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import frexp
from typing import Any

import bpy
import numpy as np

from ....core import bodies, inertia, mesh, polyhedron, verdict
from ....core.measurement import WALL_UNSUPPORTED, Body, Measurement
from ....core.moments import Moments, are_similarities
from ....core.numerics import Array, NDArray, segment_starts
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
from ....core.shape.signatures import Signature, signature, signatures
from ....core.solid import SmallSolid
from ...settings.options import MeasureOptions
from .. import measure_object, stack
from ..measure_body import THREADS, measure_body
from .surface_distance import EXACT_DISTANCE

EQUAL_AXES_ATOL = 1e-12  # cosine: harmonics about axes nearer to each other are equal
# factors on the level of noise: a unique frame is the same for all of them
NOISE_FACTORS = (
    0.5,
    1.0,
    2.0,
)
MAX_FRAME_CHANGE = 0.1  # between two frames that are the same but for noise
MAX_POSE_BOUND = 1e-2  # radians, and relative to the size: above it a pose is not called unique
MATRIX_STRAIN = 2.0**-23  # of a body by the rounding of its matrix to float32
MAX_MISFIT = 0.02  # relative to the size: coordinates with a larger misfit tell no group
COARSE_NOISE = 1e-4, 1e-3  # noise in the moments of a ball with facets
MAX_FACETS = (
    0.05  # relative to the size: between a body of revolution and the polygons that stand for it
)
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
        found = volume if area is None else area
        if not np.isfinite([found.raw, found.rounding_error]).all():
            raise verdict.ReadError(verdict.OBJECT_SIZE, fault=verdict.TOO_LARGE)
        known = self.body.area if self._sheets else self.body.volume
        return bodies.with_input_error(found, known).about_center()

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
        body = self.measurement.mass_properties
        constant = self.body.mass is None
        principal = self.principal_frame()
        axes = principal.axes
        unique = principal.is_unique
        moments = self.moments if constant else self.measurement.mass_moments[0]
        alike = equivalent_frames(moments)
        factors = NOISE_FACTORS
        pose: dict[str, Any] = {"symmetry": None, "symmetry_order": None}
        if constant:
            if len(alike.revolution_axes) == 1 and self._is_polygonal:
                alike = turn_by_harmonics(alike, self._harmonics(axis_last(alike)))
                if not alike.revolution_axes:
                    axes = nearest_frame(alike, axes)
                    unique = len(alike.frames) == 1
                    factors = ()
            pose = self._point_group()
        angle = (
            alike.tilt
            if inertia.EQUAL_AXES[body.principal.symmetry]
            else body.axes_bound(MATRIX_STRAIN)
        )
        if (
            constant
            and alike.revolution_axes
            and not str(pose["symmetry"]).endswith(("K", "∞v", "∞h"))
        ):
            angle = np.pi  # noise hides the axes that the body has
        position = body.rounding_error["center"] + body.input_error["center"]
        unique = unique and max(angle, position / self.size) <= MAX_POSE_BOUND
        for factor in factors if unique else ():
            each = equivalent_frames(moments, factor * inertia.NOISE_LEVEL)
            is_same = (
                len(each.frames) == 1 and np.abs(each.frames[0] - axes).max() < MAX_FRAME_CHANGE
            )
            unique = unique and bool(is_same) and not each.revolution_axes
        return {
            "matrix": inertia.pose_matrix(body.center, axes),
            "unique": unique,
            "angle_bound": angle,
            "position_bound": position,
        } | pose

    def _point_group(self) -> dict[str, Any]:
        """Return the body's point group, and the order of the moments that show it.

        The corners of the surface decide. If the moments are those of a body of revolution or of a
        ball, the body counts as such if its surface is near one, and no axis has a lower order than
        harmonics show.
        """
        axial = self._harmonics if self._is_polygonal else None
        found = symmetry(self.moments, axial=axial)
        group: str | None = found.group
        if self._is_polygonal:
            group = self._confirmed_group(found)
        elif group in UNDECIDED:
            group = "{} or {}".format(UNDECIDED[group], group)
        return {"symmetry": group, "symmetry_order": found.order}

    def _harmonics(self, frame: NDArray) -> AxialHarmonics:
        """Return the harmonics about the third axis of a frame, cached for the last axis."""
        if (
            not self._known_harmonics
            or abs(self._known_harmonics[0].frame[:, 2] @ frame[:, 2]) < 1.0 - EQUAL_AXES_ATOL
        ):
            self._known_harmonics[:] = [
                axial_harmonics(self.pieces(), self.center, frame, area=self._sheets)
            ]
        return self._known_harmonics[0].in_frame(frame)

    def _confirmed_group(self, found: Symmetry) -> str | None:
        """Return the group that the surface has, or the groups that it may have; None if
        coordinates are too coarse.
        """
        moved = (
            max(float(np.linalg.norm(piece.coordinate_error)) for piece in self.pieces())
            / self.size
        )
        near = inertia.NOISE_LEVEL + 4.0 * moved
        far = 4.0 * inertia.NOISE_LEVEL + 16.0 * moved
        if far > MAX_MISFIT:
            return None
        placed = self._placed_triangles(near, far)
        is_round = len(found.revolution_axes) > 0 and placed.is_round(found, MAX_FACETS)
        if is_round and max(map(placed.turn_order, found.revolution_axes)) > MAX_AXIAL_ORDER:
            return found.group
        finite = [Symmetry(each, np.empty((0, 3)), 0) for each in placed.groups() or ()]
        names = [each.group for each in finite]
        if is_round:
            order = max([n for each in finite[:1] for _, n in each.axes], default=0)
            # An axis of a higher order than harmonics show, or facets that are no misfit, count as
            # round.
            known = order > MAX_AXIAL_ORDER or placed.is_round(found, near)
            names = [found.group] if known else [*names, found.group]
        elif not finite:  # as many corners at one distance as a ball has
            coarse = [symmetry(self.moments, noise, self._harmonics) for noise in COARSE_NOISE]
            names = [
                each.group
                for each in coarse
                if len(each.revolution_axes) and placed.is_round(each, MAX_FACETS)
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
        sheets = self._sheets

        def pieces() -> Iterator[mesh.Surface]:
            return (
                piece.transform(np.eye(3) / scale, -self.center / scale) for piece in self.pieces()
            )

        known = min(order, MAX_ORDER_BY_MOMENTS)
        volume, area = polyhedron.polyhedron_moments(
            pieces(),
            known,
            area_order=known if sheets else None,
            about=np.zeros(3),
            reach=radius,
            threads=self.threads,
            allow_open=True,
        )
        result = signature(volume if area is None else area, radius)
        if (order > MAX_ORDER_BY_MOMENTS or result.error > MAX_DESCRIPTOR_ERROR) and not sheets:
            whole = mesh.join_surfaces(list(pieces()))
            triangles = whole.all_triangles()[0]
            result = signature(
                volume, radius, zernike_quadrature(whole.points / radius, triangles, order)
            )
        return replace(result, size=scale * result.size)

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
        allowed = symmetry(self.piece_moments(), max(inertia.NOISE_LEVEL, tolerance))
        placed = self._placed_triangles(tolerance, tolerance)
        found = allowed
        is_round = placed.is_round(allowed, tolerance)
        # Axes of a higher order than groups can have count as axes of revolution.
        if (
            not is_round
            and max(map(placed.turn_order, allowed.revolution_axes), default=np.inf)
            <= MAX_AXIS_ORDER
        ):
            operations = (placed.groups() or [np.eye(3)[None]])[0]
            found = Symmetry(operations, np.empty((0, 3)), allowed.order)
        held = [placed.holds(operation, tolerance) for operation in found.operations]
        return replace(found, operations=found.operations[held]), allowed

    def _placed_triangles(self, near: float, far: float) -> PlacedTriangles:
        """Return the triangles about the center, in units of the size."""
        whole = mesh.join_surfaces(list(self.pieces()))
        points = (whole.points.astype(np.float64) - self.center) / self.size
        return PlacedTriangles(points, whole.all_triangles()[0], near, far)


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


def signed_in_turn(
    objects: Sequence[bpy.types.Object], depsgraph: bpy.types.Depsgraph, order: int
) -> Callable[[bpy.types.Object], Signature | Shape]:
    """Return a function from an object to its signature, or to its `Shape` if it was measured
    outside a stack.
    """
    measured = measure_object.measured_in_turn(objects, depsgraph, SURFACE_OPTIONS)
    known: dict[Measurement, list[Signature | None]] = {}

    def signed(obj: bpy.types.Object) -> Signature | Shape:
        outcome = measured(obj)
        if outcome.index is None:
            return surface_shape(outcome)
        if outcome.stack not in known:
            known.clear()
            known[outcome.stack] = stack_signatures(outcome, order)
        return known[outcome.stack][outcome.index] or surface_shape_of(obj, depsgraph)

    return signed


def stack_signatures(row: stack.Measured, order: int) -> list[Signature | None]:
    """Return the signatures of all members of a row's stack; None for repaired, distant and
    ill-conditioned members.
    """
    members = row.members
    found: list[Signature | None] = [None] * len(members)
    linear = np.array([member.matrix[:3, :3] for member in members])
    is_even = are_similarities(linear)
    determinant = np.linalg.det(linear)
    # A body is a shape in its own coordinates, or the unevenly mapped shape of a single object.
    body_of: dict[tuple[int, int], int] = {}
    solids = []
    maps = []
    of_member = {}
    for i, member in enumerate(members):
        solid = row.shapes[member.shape]
        if not isinstance(solid, SmallSolid):
            continue
        key = (member.shape, -1 if is_even[i] else i)
        if key not in body_of:
            body_of[key] = len(solids)
            solids.append(solid)
            maps.append(np.eye(3) if is_even[i] else linear[i])
        of_member[i] = body_of[key]
    if not solids:
        return found
    of_bodies, scale = _signatures(solids, maps, order)
    center = row.stack.mass_properties.center
    reach = np.finfo(np.float64).eps * np.abs(center).max(axis=1)
    stretch = row.stack.volume / row.shapes.volume.total[[member.shape for member in members]]
    for i, body in of_member.items():
        own = of_bodies[body]
        mapped = 1.0 if is_even[i] else abs(determinant[i])
        size = float(scale[body] * own.size * np.cbrt(stretch[i] / mapped))
        if own.error > MAX_DESCRIPTOR_ERROR or reach[i] > EXACT_DISTANCE / 2.0 * size:
            continue
        is_mirrored = bool(is_even[i] and determinant[i] < 0.0)
        found[i] = replace(
            own, size=size, chirality=-own.chirality if is_mirrored else own.chirality
        )
    return found


def _signatures(
    solids: list[SmallSolid], maps: list[NDArray], order: int
) -> tuple[list[Signature], Array]:
    """Return the signatures of linearly mapped solids, each scaled to about unit size, and the
    (k,) scales.
    """
    points = []
    triangles = []
    first = 0
    for solid, linear in zip(solids, maps):
        parts = solid.parts()
        points.append((parts.points - solid.volume.center) @ linear.T)
        step = -1 if np.linalg.det(linear) < 0.0 else 1
        triangles.append(parts.triangles[:, ::step] + first)
        first += len(parts.points)
    counts = np.array([len(corners) for corners in triangles])
    point_counts = np.array([len(own) for own in points])
    starts = segment_starts(point_counts)
    places = np.concatenate(points)
    radius = np.sqrt(np.maximum.reduceat((places * places).sum(axis=1), starts))
    scale = 2.0 ** np.frexp(radius)[1]  # a power of two rounds nothing
    places /= np.repeat(scale, point_counts)[:, None]
    reach = np.maximum.reduceat(np.abs(places), starts)
    nothing = np.zeros((len(solids), 3))
    joined = np.concatenate(triangles)
    volume = polyhedron.small_moments(
        places, joined, counts, nothing, reach, nothing, area=False, area_moments=False
    )[0]
    volume = polyhedron.extend_small_moments(volume, order, places, joined, counts, reach)
    return signatures(volume, radius / scale), scale
