# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects as wires: measured from control points, not polygons."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ...core import bodies, measurement, nurbs, polyhedron, verdict
from ...core.moments import FLOAT32_HALF_ULP, KNOWN_ORDER, Moments, U, monomials
from ...core.numerics import Array
from ..read import findings, objects
from .request import Request

MEASURED_AS = frozenset({"wire"})

DEGREE = monomials(KNOWN_ORDER).sum(axis=1)
CLOSED_RTOL = 1e-9  # relative to the wire's reach: ends that are nearer count as one point


@dataclass(frozen=True, eq=False)
class WireBody(measurement.Body):
    """Curves as a wire, without volume or area."""

    any_order: ClassVar[bool] = True

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments]:
        """Return zero moments of the volume and of the area, to an order."""
        return polyhedron.nothing(order, self.volume.about)

    def third_order(self) -> Moments:
        """Return the moments of the length, to third order."""
        assert self.length is not None
        return self.length


def read(request: Request) -> bodies.Reading:
    """Return the curves of an object that is measured as a wire, or raise MeasureError if it has
    none.
    """
    return objects.read_lines(request.obj, request.depsgraph)


def body(reading: bodies.Reading, request: Request) -> measurement.Body:
    """Return the curves as a wire, or raise MeasureError if they have no length."""
    curves, stored = curves_in_world(reading.curves, reading.matrix, request.settings.unit)
    length = nurbs.length_moments(curves)
    if not length.total > 0.0:
        raise verdict.ReadError(findings.NOTHING_TO_MEASURE, cause=findings.NO_SPLINE_LENGTH)
    # Chosen for smooth curves, whose length changes with the place of both ends, and by turning.
    reach = max(float(np.abs(curve.points - length.about).max()) for curve in curves)
    input_error = stored * (2.0 * len(curves) + 8.0 * length.total / reach) * reach**DEGREE
    return WireBody(
        *polyhedron.nothing(KNOWN_ORDER, length.about),
        verdict.MeshHealth(
            closed=all(_is_closed(curve, reach) for curve in curves), components=len(curves)
        ),
        verdict.Method(verdict.Procedure.WIRE),
        (),
        length=replace(length, input_error=input_error),
        estimated=True,
    )


def curves_in_world(
    curves: list[nurbs.Curve], matrix: Array, unit: float
) -> tuple[list[nurbs.Curve], float]:
    """Return curves mapped to the world in m by a (4, 4) matrix in Blender units, and the points'
    float32 error.
    """
    largest = max(float(np.abs(curve.points).max()) for curve in curves)
    scaled = np.array(matrix, np.float64)
    scaled[:3] *= unit
    stored = 2.0 * FLOAT32_HALF_ULP * largest * float(np.linalg.norm(scaled[:3, :3], 2))
    return [curve.transform(scaled) for curve in curves], stored


def _is_closed(curve: nurbs.Curve, reach: float) -> bool:
    """Return whether a curve ends at its start, within the rounding by its size and (32 U, chosen)
    by its distance from the origin.
    """
    first, last = curve.samples(1)[[0, -1]]
    return bool(np.abs(last - first).max() <= CLOSED_RTOL * reach + 32.0 * U * np.abs(first).max())
