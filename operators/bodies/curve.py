# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects as wires, and the flat regions that closed ones bound as sheets: from control points, not polygons."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.moments.moments import FLOAT32_HALF_ULP, Measure, Moments, monomial_count, monomials
from ...core.nurbs.curve import Curve
from ...core.nurbs.curve_moments import length_moments, plane_moments
from ...core.nurbs.planar_region import planar_region
from ...core.verdict.finding import ReadError
from ...core.verdict.health import MeshReport
from .body import MeasuredBody

DEGREE = monomials(3).sum(axis=1)


def wire_body(curves: list[Curve], matrix: np.ndarray, unit: float) -> MeasuredBody:
    """Curves as a wire. matrix: (4, 4) world from their coordinates, Blender units; unit: metres per Blender unit."""
    curves, stored = _curves_in_world(curves, matrix, unit)
    length = length_moments(curves)
    if not length.total > 0.0:
        raise ReadError("no_length")
    nothing = Moments(np.zeros(monomial_count(3)), length.about, Measure.VOLUME)
    # a length moves by as much as its ends, and by its turning as much again: an estimate for smooth curves
    reach = max(float(np.abs(curve.points - length.about).max()) for curve in curves)
    moved = stored * (2.0 * len(curves) + 8.0 * length.total / max(reach, 1e-300)) * reach**DEGREE
    length = replace(length, input_error=moved)
    closed = all(np.allclose(*curve.samples(1)[[0, -1]]) for curve in curves)

    def to_order(order: int, _with_area: bool) -> tuple[Moments, Moments]:
        return tuple(
            Moments(np.zeros(monomial_count(order)), length.about, of) for of in (Measure.VOLUME, Measure.AREA)
        )

    return MeasuredBody(
        nothing,
        Moments(nothing.raw, length.about, Measure.AREA),
        MeshReport(closed=closed, components=len(curves)),
        "wire",
        (),
        length=length,
        moments=to_order,
        estimated=True,
    )


def region_body(curves: list[Curve], matrix: np.ndarray, unit: float) -> MeasuredBody:
    """The flat region that closed curves bound, holes left out, as a sheet without thickness of its own.

    Arguments as for `wire_body`. MeasureError where they bound none.
    """
    curves, stored = _curves_in_world(curves, matrix, unit)
    curves, normal = planar_region(curves, stored)
    area = plane_moments(curves, normal)
    boundary_length = length_moments(curves, 0).total
    reach = max(float(np.abs(curve.points - area.about).max()) for curve in curves)
    area = replace(area, input_error=2.0 * stored * boundary_length * reach**DEGREE)
    nothing = Moments(np.zeros_like(area.raw), area.about, Measure.VOLUME)

    def to_order(order: int, _with_area: bool) -> tuple[Moments, Moments]:
        volume = Moments(np.zeros(monomial_count(order)), area.about, Measure.VOLUME)
        return volume, plane_moments(curves, normal, order, area.about)

    return MeasuredBody(
        nothing,
        area,
        MeshReport(closed=False, components=len(curves)),
        "NURBS shell",
        (),
        moments=to_order,
        estimated=True,
    )


def _curves_in_world(curves: list[Curve], matrix: np.ndarray, unit: float) -> tuple[list[Curve], float]:
    """The curves in the world, m, and by how much storing their points as float32 may have moved them."""
    largest = max(float(np.abs(curve.points).max()) for curve in curves)
    scaled = np.array(matrix, np.float64)
    scaled[:3] *= unit
    stored = 2.0 * FLOAT32_HALF_ULP * largest * float(np.linalg.norm(scaled[:3, :3], 2))
    return [curve.transform(scaled) for curve in curves], stored
