# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat shapes: selected faces, flat meshes, 2-D curves and text as regions of their own plane, seen
from the front.

Faces point to the front; curves and text have it at their own +z. Only curves that Blender gives
access to have exact moments. The region that closed curves bound is also measured as a sheet, from
control points instead of polygons.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import bpy
import numpy as np

from ....core import bodies, flat, inertia, measurement, nurbs, polyhedron, solid, verdict
from ....core.flat import (
    SECTION_NOT_FLAT,
    Plane,
    Section,
    find_defects,
    fit_plane,
    measure_section,
    orient_loops,
    plane_positions,
    project,
    projection_rounding,
    region_moments,
)
from ....core.moments import Measure, Moments, affine_matrices, monomials
from ....core.numerics import Array, Index
from ...read import objects, visibility
from ...read.findings import FLAT_UNSUITABLE, NOT_FILLED, RENDER_DIFFERS, SECTION_FILL
from ...read.section import SectionReading, read_outline_curves, read_section
from ...scale import meters_per_unit
from ..findings import (
    CURVE_FILL_MEASURED,
    OUTLINES_CROSS,
    SECTION_FACES_OVERLAP,
    SECTION_FACES_REVERSED,
    SECTION_FILL_WRONG,
    SECTION_PROJECTED,
)
from ..request import Request
from ..wire import DEGREE, curves_in_world

FILL_AREA_RTOL = 1e-4  # if Blender's fill and the outlines differ by more, the fill is wrong
# Codes of refusals: that an object is no body; and that it is not flat either, so that the first
# refusal is shown.
NO_BODY = {
    measurement.NO_VOLUME,
    inertia.NO_CERTAIN_VOLUME,
    verdict.NO_FACES,
    bodies.SHAPE_OF_OPEN_SURFACE,
}
NOT_FLAT = {SECTION_NOT_FLAT, FLAT_UNSUITABLE}
NORMAL = np.array([0.0, 0.0, 1.0])  # in the plane's own axes
MeasuredSection = tuple[Section, str, tuple[verdict.Finding, ...]]
MEASURED_AS = frozenset({"shell"})


@dataclass(frozen=True, eq=False)
class FlatRegion:
    """A region of a plane, in SI units.

    `name`, `type`: of the object; `description`: the part of it that was read. `plane`: its plane,
    in the world. `spatial`: (n, 3) points in the world; `points`: (n, 2), the same in the plane.
    `edges`: (m, 2) indices; seen from the front, the inside lies to the left of each edge.
    `stored`: largest effect of float32 on a point. `shared`: the length that edges share.
    `drawn_area`: the area that Blender fills, for outlines. `rotation`, `location`: the object's
    frame. `curves`: the outlines in the plane's axes; empty if they are not known.
    """

    name: str
    type: str
    description: str
    plane: Plane
    spatial: Array
    points: Array
    edges: Index
    stored: float
    shared: float
    drawn_area: float | None
    rotation: Array
    location: Array
    curves: tuple[nurbs.Curve, ...]
    findings: tuple[verdict.Finding, ...]

    @property
    def rounded(self) -> float:
        """Largest effect of rounding on a coordinate of a point in the plane."""
        return projection_rounding(self.plane, self.spatial, self.used)

    @cached_property
    def used(self) -> Array:
        """(k, 2) points that are ends of edges."""
        return self.points[np.unique(self.edges)]

    def moments(self, order: int) -> Moments:
        """Return the moments ∫ x^p y^q dA about the centroid, along the plane's axes, or raise
        MeasureError.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            if self.curves:
                moments = _curve_moments(self.curves, order, self.rounded, self.stored)
            else:
                moments = region_moments(
                    self.points, self.edges, order, rounded=self.rounded, stored=self.stored
                )
        if not np.isfinite([moments.raw, moments.rounding_error, moments.input_error]).all():
            raise verdict.ReadError(inertia.MOMENTS_OVERFLOW, order=order)
        return moments


def flat_region(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    *,
    selected: bool = True,
    resolution: int | None = None,
    exact: bool = True,
    unit: float | None = None,
) -> FlatRegion:
    """Return an object, or its selected faces, as a region of a plane, in SI units; MeasureError if
    it is not one. resolution: of curves that are read as polygons, None for the drawn one. exact:
    with the curves themselves if they are known. unit: meters per Blender unit, None for the
    scene's.
    """
    reading = read_section(obj, depsgraph, selected=selected, resolution=resolution)
    unit = unit or meters_per_unit(depsgraph.scene)
    with bodies.name_subject(obj.name):
        polygons = _region_of(reading, obj.type, unit)
        outlines = _curves(obj, depsgraph, reading, polygons.plane, unit) if exact else None
    if outlines is None:
        return polygons
    curves, stored = outlines
    findings = [
        finding
        for finding in polygons.findings
        if finding.code != bodies.DRAWN_AS_POLYGONS
        # Resolutions change nothing, but modifiers do.
        and not (finding.code == RENDER_DIFFERS and finding.values.get("slight"))
    ]
    return replace(
        polygons, curves=curves, stored=max(stored, polygons.stored), findings=tuple(findings)
    )


def section_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> MeasuredSection:
    """Return an object's section (SI, world axes), a description of the measured part, and the
    findings.
    """
    region = flat_region(obj, depsgraph, exact=False)
    section = measure_section(
        region.plane, region.spatial, region.edges, region.stored, region.shared
    )
    return section, region.description, (*region.findings, *area_findings(region, section.area))


def clearer_refusal(
    no_body: verdict.MeasureError, not_flat: verdict.MeasureError
) -> verdict.MeasureError:
    """Return the more helpful of two refusals: that the object is no body, or that it is no flat
    shape.
    """
    is_nearly_flat = no_body.finding.code in NO_BODY and not_flat.finding.code not in NOT_FLAT
    return not_flat if is_nearly_flat else no_body


def _region_of(reading: SectionReading, object_type: str, unit: float) -> FlatRegion:
    """Return the region that polygons or outlines bound; `unit` is in meters per Blender unit."""
    points = reading.points * unit
    error = reading.error * unit
    findings = list(reading.findings)
    plane = fit_plane(
        points, reading.triangles, reading.rotation, reading.location * unit, error, reading.facing
    )
    flat_points = project(plane, points)
    if reading.loops is not None:
        edges = orient_loops(flat_points, reading.loops)
    else:
        edges, flipped = flat.region(plane, points, reading.triangles, reading.faces, error)
        if flipped:
            findings.append(verdict.finding(SECTION_FACES_REVERSED, count=flipped))
    defects = find_defects(flat_points, edges, error)
    are_crossed = defects.crossings or defects.overlapping
    # Outlines that cross, or turn around a point the wrong way, bound no area. Faces that overlap
    # have one each, and their sum is measured with a warning.
    if defects.negative or (reading.loops is not None and are_crossed):
        raise verdict.ReadError(OUTLINES_CROSS)
    if are_crossed:
        findings.append(verdict.finding(SECTION_FACES_OVERLAP))
    if defects.too_many_pairs:
        findings.append(
            verdict.finding(
                solid.UNCHECKED, subject="the overlap of some edges, as there are too many"
            )
        )
    return FlatRegion(
        name=reading.name,
        type=object_type,
        description=reading.description,
        plane=plane,
        spatial=points.astype(np.float64, copy=False),
        points=flat_points,
        edges=edges,
        stored=error,
        shared=defects.shared_length,
        drawn_area=None if reading.drawn_area is None else reading.drawn_area * unit**2,
        rotation=reading.rotation,
        location=reading.location * unit,
        curves=(),
        findings=tuple(findings),
    )


def area_findings(region: FlatRegion, area: float) -> list[verdict.Finding]:
    """Return findings that need a region's area: points off the plane, and faces that Blender fills
    wrongly.
    """
    findings = []
    off = region.plane.out_of_plane
    # Rounding in storage moves the points and the fitted plane; the factor is chosen with a margin.
    if off > 4.0 * region.stored:
        share = float(off / np.sqrt(area))
        findings.append(
            verdict.finding(SECTION_PROJECTED, slight=share < verdict.NEGLIGIBLE, share=share)
        )
    if region.drawn_area is not None and abs(region.drawn_area - area) > FILL_AREA_RTOL * area:
        findings.append(verdict.finding(SECTION_FILL_WRONG, share=float(region.drawn_area / area)))
    return findings


def _curves(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    reading: SectionReading,
    plane: Plane,
    unit: float,
) -> tuple[tuple[nurbs.Curve, ...], float] | None:
    """Return the outlines along the plane's axes and their float32 error, or None if only the
    polygons are usable.
    """
    if reading.loops is None:
        return None
    try:
        curves, matrix = read_outline_curves(obj, depsgraph)
        to_plane = affine_matrices(plane.axes.T, -plane.axes.T @ plane.origin)
        placed, stored = curves_in_world(curves, matrix, unit)
        boundary, _ = nurbs.planar_region([curve.transform(to_plane) for curve in placed], stored)
    except verdict.MeasureError:
        return None
    if len(boundary) != len(reading.loops):  # Blender's polygons leave out some loops
        return None
    is_left = nurbs.plane_moments(boundary, NORMAL, 1).total > 0.0
    return tuple(boundary if is_left else [curve.reverse() for curve in boundary]), stored


def _curve_moments(
    curves: tuple[nurbs.Curve, ...], order: int, rounded: float, stored: float
) -> Moments:
    """Return the area moments about the centroid of the region within curves in the plane z = 0;
    `rounded` and `stored` are the largest effects of rounding and of float32 on a point.
    """
    about = nurbs.plane_moments(curves, NORMAL, 1).center * [1.0, 1.0, 0.0]
    moments = nurbs.plane_moments(curves, NORMAL, order, about)
    lengths = [np.hypot(*np.diff(curve.points[:, :2], axis=0).T).sum() for curve in curves]
    corners = np.concatenate([curve.points[:, :2] for curve in curves])
    # The largest |x| and |y| about the centroid; 1 for z, whose exponent is 0 at `positions`.
    reach = np.append(np.abs(corners - about[:2]).max(axis=0) + 2.0 * (rounded + stored), 1.0)
    positions = plane_positions(order)  # positions of the moments that a flat region has
    largest_monomial = (reach ** monomials(order))[positions].prod(axis=1)

    def swept(displacement: float) -> Array:
        """Return the effect on each moment of moving all points so far along both axes: the curves
        sweep over an area of no more than the length of the moved control polygons times the way.
        """
        way = displacement * np.sqrt(2.0)
        return way * (sum(lengths) + 2.0 * way * len(corners)) * largest_monomial

    raw, rounding_error, input_error = np.zeros((3, len(moments.raw)))
    raw[positions] = moments.raw[positions]
    rounding_error[positions] = moments.rounding_error[positions] + swept(rounded)
    input_error[positions] = swept(stored)
    return Moments(raw, about, Measure.AREA, rounding_error, input_error)


@dataclass
class RegionReading(bodies.Reading):
    """A curve object, and the region that its curves bound.

    `boundary`: in the world, m; holes run against the outline. `normal`: (3,) normal of the curves'
    plane. `stored`: largest effect of float32 on the points, m.
    """

    boundary: tuple[nurbs.Curve, ...] = ()
    normal: Array = field(kw_only=True)
    stored: float = field(kw_only=True)


@dataclass(frozen=True, eq=False)
class RegionBody(measurement.Body):
    """A flat region without thickness of its own."""

    any_order: ClassVar[bool] = True

    boundary: tuple[nurbs.Curve, ...] = ()
    normal: Array = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments]:
        """Return zero moments of the volume, and the moments of the area."""
        area_moments = nurbs.plane_moments(self.boundary, self.normal, order, self.area.about)
        area_moments = bodies.extend_input_error(area_moments, self.area)
        return polyhedron.nothing(order, self.area.about)[0], area_moments


def read(request: Request) -> RegionReading | None:
    """Return the flat region that a curve object bounds as a thin shell of one density, or None for
    other objects.
    """
    obj, options = request.obj, request.settings
    if obj.type != "CURVE" or options.wall != "thin":
        return None
    if request.density is not None or not visibility.shows_flat_region(obj):
        return None
    reading = objects.read_lines(obj, request.depsgraph)
    is_filled = obj.data.dimensions == "2D" and obj.data.fill_mode != "NONE"
    if not is_filled:
        reading.findings.append(verdict.finding(SECTION_FILL, treatment=NOT_FILLED))
    try:
        curves, stored = curves_in_world(reading.curves, reading.matrix, request.settings.unit)
        boundary, normal = nurbs.planar_region(curves, stored)
    except verdict.MeasureError as error:
        if not is_filled:
            raise
        request.findings.append(
            verdict.finding(CURVE_FILL_MEASURED, cause=error.finding.as_record())
        )
        return None
    return RegionReading(**vars(reading), boundary=tuple(boundary), normal=normal, stored=stored)


def body(reading: RegionReading, request: Request) -> measurement.Body:
    """Return the flat region, without its holes, as a sheet."""
    curves = list(reading.boundary)
    area = nurbs.plane_moments(curves, reading.normal)
    boundary_length = nurbs.length_moments(curves, 0).total
    reach = max(float(np.abs(curve.points - area.about).max()) for curve in curves)
    # A moved boundary sweeps over its length times the move; 2 is a margin for moves along several
    # axes.
    area = replace(area, input_error=2.0 * reading.stored * boundary_length * reach**DEGREE)
    return RegionBody(
        polyhedron.nothing(area.order, area.about)[0],
        area,
        verdict.MeshHealth(closed=False, components=len(curves)),
        verdict.Method(verdict.Procedure.SHELL, verdict.Source.NURBS),
        (),
        estimated=True,
        boundary=tuple(curves),
        normal=reading.normal,
    )
