# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat regions that closed curves bound, as sheets: measured from control points, not polygons."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ....core.bodies.mesh_body import extend_input_error
from ....core.bodies.reading import Reading
from ....core.measurement.body import Body
from ....core.moments.moments import Measure, Moments, monomial_count
from ....core.nurbs.curve import Curve
from ....core.nurbs.curve_moments import length_moments, plane_moments
from ....core.nurbs.flat_face import planar_region
from ....core.verdict.finding import MeasureError, finding
from ....core.verdict.health import MeshHealth
from ....core.verdict.method import Method, Source, Verdict
from ...read.findings import SECTION_NOT_FILLED
from ...read.objects import read_lines
from ...read.visibility import shows_flat_region
from ..findings import CURVE_FILL_MEASURED
from ..request import Request
from ..wire import DEGREE, curves_in_world

MEASURED_AS = frozenset({"shell"})


@dataclass
class RegionReading(Reading):
    """A curve object, and the region that its curves bound.

    `boundary`: in the world, m; holes run against the outline. `normal`: (3,) normal of the curves' plane.
    `stored`: largest effect of float32 on the points, m.
    """

    boundary: tuple[Curve, ...] = ()
    normal: NDArray[np.float64] = field(kw_only=True)
    stored: float = field(kw_only=True)


@dataclass(frozen=True, eq=False)
class RegionBody(Body):
    """A flat region without thickness of its own."""

    any_order: ClassVar[bool] = True

    boundary: tuple[Curve, ...] = ()
    normal: NDArray[np.float64] = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments]:
        """Return zero moments of the volume, and the moments of the area."""
        volume = Moments(np.zeros(monomial_count(order)), self.area.about, Measure.VOLUME)
        of_region = plane_moments(self.boundary, self.normal, order, self.area.about)
        return volume, extend_input_error(of_region, self.area)


def read(request: Request) -> RegionReading | None:
    """Return the flat region that a curve object bounds as a thin shell of one density, or None for other objects."""
    obj, options = request.obj, request.settings
    if obj.type != "CURVE" or options.wall != "thin":
        return None
    if request.density is not None or not shows_flat_region(obj):
        return None
    reading = read_lines(obj, request.depsgraph)
    is_filled = obj.data.dimensions == "2D" and obj.data.fill_mode != "NONE"
    if not is_filled:
        reading.findings.append(finding(SECTION_NOT_FILLED))
    try:
        curves, stored = curves_in_world(reading.curves, reading.matrix, request.settings.unit)
        boundary, normal = planar_region(curves, stored)
    except MeasureError as error:
        if not is_filled:
            raise
        request.findings.append(finding(CURVE_FILL_MEASURED, cause=error.finding.as_record()))
        return None
    common = {entry.name: getattr(reading, entry.name) for entry in fields(Reading)}
    return RegionReading(**common, boundary=tuple(boundary), normal=normal, stored=stored)


def body(reading: RegionReading, request: Request) -> Body:
    """Return the flat region, without its holes, as a sheet."""
    curves = list(reading.boundary)
    area = plane_moments(curves, reading.normal)
    boundary_length = length_moments(curves, 0).total
    reach = max(float(np.abs(curve.points - area.about).max()) for curve in curves)
    area = replace(area, input_error=2.0 * reading.stored * boundary_length * reach**DEGREE)
    return RegionBody(
        Moments(np.zeros_like(area.raw), area.about, Measure.VOLUME),
        area,
        MeshHealth(closed=False, components=len(curves)),
        Method(Verdict.SHELL, Source.NURBS),
        (),
        estimated=True,
        boundary=tuple(curves),
        normal=reading.normal,
    )
