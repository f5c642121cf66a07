# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts with a given mass: their given center and inertia, and point masses, which have no
geometry.

Given values replace a body's mass moments: mass, center and second moments. Volume and area stay as
measured.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....core import bodies, moments, verdict
from ....core.measurement import (
    DENSITY_FROM_MASS,
    ZERO_QUANTITY,
    Body,
    Measurement,
    find_extent,
    fingerprint,
    measure_total,
)
from ....core.moments.raw import SECOND_MOMENT_INDEX, Measure, Moments, U, monomial_count
from ....core.numerics import Array, NDArray, shortest_decimal
from ...read.fingerprint import matrix_hash
from ...read.objects import locate
from ...settings.given import GivenPart, is_point_mass
from ..findings import CENTER_OUTSIDE, GIVEN, GIVEN_CENTER, GIVEN_INERTIA_IMPOSSIBLE, INERTIA
from ..request import Request

COUNT = monomial_count(moments.KNOWN_ORDER)
FIRST_MOMENTS = slice(1, 4)  # in the order of `monomials`
HIGHER_MOMENTS = slice(4, None)  # moments of second and third order
GIVEN_RTOL = 1e-6  # slack for values typed with few digits, relative to the trace or the box


def given_moments(
    mass: float, given: GivenPart, rotation: NDArray, location: NDArray, geometry: Moments | None
) -> tuple[Moments, list[verdict.Finding]]:
    """Return mass moments (SI, world, about the center) of a part with given mass, center and
    inertia, and findings. rotation (3, 3), location (3,): the object's frame in m. geometry: the
    moments in proportion to which the mass is spread; without them it is at the object's origin.
    """
    if not mass > 0.0:
        raise verdict.ReadError(ZERO_QUANTITY, quantity="mass")
    raw, rounding_error, input_error = np.zeros((3, COUNT))
    center = location
    if geometry is not None:
        factor = mass / geometry.total
        central = geometry.truncate(moments.KNOWN_ORDER).about_center()
        raw = central.raw * factor
        rounding_error = central.rounding_error * factor
        input_error = central.input_error * factor
        center = central.about
        rounding_error[0] = U * mass  # the mass itself is given, so no input error remains
        input_error[0] = 0.0
    raw[0] = mass
    findings = []
    if given.center is not None:
        center = location + rotation @ given.center
        for array in (raw, rounding_error, input_error):
            array[FIRST_MOMENTS] = 0.0
        findings.append(verdict.finding(GIVEN, quantity="center of mass"))
    if given.inertia is not None:
        for array in (raw, rounding_error, input_error):
            array[HIGHER_MOMENTS] = 0.0
        second = rotation @ _second_moments(np.array(given.inertia)) @ rotation.T
        raw[SECOND_MOMENT_INDEX] = (second + second.T) / 2.0
        # By the rounding of two products of (3, 3) matrices; the factor is chosen with a margin.
        rounding_error[SECOND_MOMENT_INDEX] = 16.0 * U * np.trace(given.inertia)
        findings.append(verdict.finding(GIVEN, quantity=INERTIA))
    center = np.asarray(center, np.float64)
    return Moments(raw, center, Measure.MASS, rounding_error, input_error), findings


def _second_moments(inertia: NDArray) -> Array:
    """Return the (3, 3) second moments of a body with this inertia tensor; ReadError if no body can
    have it.
    """
    # I = tr(S) 1 - S, and tr(I) = 2 tr(S); no second moment of a body is negative.
    second = np.trace(inertia) / 2.0 * np.eye(3) - inertia
    values, axes = np.linalg.eigh(second)
    if values[0] < -GIVEN_RTOL * np.trace(inertia) or not np.isfinite(values).all():
        raise verdict.ReadError(
            GIVEN_INERTIA_IMPOSSIBLE, moments=np.sort(np.linalg.eigvalsh(inertia)).tolist()
        )
    return (axes * np.maximum(values, 0.0)) @ axes.T


def with_given(body: Body, reading: bodies.Reading, request: Request) -> Body:
    """Return the body with the center and inertia of its settings, or raise ReadError if they are
    impossible.
    """
    if request.settings.mass is None or request.obj.body_moments.mass_from != "MASS":
        return body
    given = GivenPart.from_settings(request.obj.body_moments, request.settings.unit)
    if not given:
        return body
    # `find_extent` raises MeasureError if there is no volume, area or length.
    geometry = body.mass or find_extent(body, request.settings)
    location = reading.location * request.settings.unit
    mass, findings = given_moments(
        request.settings.mass, given, reading.rotation, location, geometry
    )
    if given.center is not None and _is_outside(mass.about, reading, request.settings.unit):
        findings.append(verdict.finding(GIVEN_CENTER, fault=CENTER_OUTSIDE))
    # The key must not change with the scene's unit.
    key = body.density_key + GivenPart.from_settings(request.obj.body_moments, 1.0).key
    return replace(body, mass=mass, density_key=key, findings=(*body.findings, *findings))


def _is_outside(point: NDArray, reading: bodies.Reading, unit: float) -> bool:
    """Return whether a point is outside every box around a part of the reading; False if there are
    no parts.
    """
    parts = getattr(reading, "parts", ())  # a grid has none
    for part in parts:
        center, half = moments.placed_boxes(part.surface.box, bodies.to_si(part.matrices, unit))
        if (np.abs(point - center) <= half * (1.0 + GIVEN_RTOL)).all(axis=1).any():
            return False
    return bool(parts)


def read_point(request: Request) -> bodies.Reading | None:
    """Return the frame of a point mass, or None for any other object; may raise MeasureError."""
    if not is_point_mass(request.obj):
        return None
    return locate(request.obj.original, request.depsgraph)


def point_measurement(reading: bodies.Reading, request: Request) -> tuple[Measurement, Body]:
    """Return the results of a part without geometry, and its body, or raise ReadError if it has no
    mass.
    """
    properties = request.obj.body_moments
    settings = request.settings
    given = GivenPart.from_settings(properties, settings.unit)
    location = reading.location * settings.unit
    # A point has no density, and therefore always its own mass or that of the options.
    mass = shortest_decimal(properties.mass) if settings.mass is None else settings.mass
    mass_moments, findings = given_moments(mass, given, reading.rotation, location, None)
    settings = replace(
        settings,
        kind=properties.kind.lower(),
        density=None,
        mass=mass,
        varying=GivenPart.from_settings(properties, 1.0).key,
    )
    measurement = measure_total(
        mass_moments,
        name=reading.name,
        type=reading.type,
        kind="point",
        method=verdict.Method(verdict.Procedure.GIVEN),
        findings=(*reading.findings, *findings),
        rotation=reading.rotation,
        location=location,
        fingerprint=fingerprint(
            mass_moments.raw.tobytes(), matrix_hash(request.obj), settings.digest
        ),
        density_from=DENSITY_FROM_MASS,
    )
    volume = measurement.volume_moments
    assert volume is not None
    return measurement, Body(
        volume,
        measurement.area_moments,
        measurement.health,
        measurement.method,
        tuple(findings),
        mass=mass_moments,
    )
