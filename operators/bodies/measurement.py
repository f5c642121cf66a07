# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body becomes a measurement: mass properties, frame, bounds, fingerprint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import bpy
import numpy as np

from ...core.inertia.canonical_frame import MAX_ORDER
from ...core.inertia.mass_properties import MassProperties
from ...core.measurement import Measurement
from ...core.moments.moments import Moments
from ...core.verdict.finding import ReadError, finding
from ..read import Reading
from ..read.fingerprint import effective_hash, fingerprint, matrix_hash
from ..read.volume import VolumeReading
from ..settings.digest import density_key
from ..settings.options import MeasureOptions
from .body import MeasuredBody
from .mass import MassResult

# faces up to which moments of higher order, for a frame that needs them, take no time to speak of
MAX_FACES_HIGH_ORDER = 20_000


KNOWN_ORDER = 3  # the order to which every measurement has its moments


def with_moments(measurement: Measurement, body: MeasuredBody, options: MeasureOptions) -> Measurement:
    """With moments to the order that was asked for. What a measurement holds anyway is not measured again."""
    shell, order = options.kind == "shell", options.order
    if order is None or (order < KNOWN_ORDER and (shell or not options.surface)):
        return measurement
    if body.moments is None:
        if order > KNOWN_ORDER or (options.surface and not shell):
            raise ReadError("wall_order", order=KNOWN_ORDER)
        return measurement
    with np.errstate(over="ignore", invalid="ignore"):
        volume, area = body.moments(order, shell or options.surface)
    for moments in (volume, area):
        if moments is not None and not np.isfinite([moments.raw, moments.rounding_error, moments.input_error]).all():
            raise ReadError("moments_overflow", order=order)
    return replace(measurement, volume_moments=None if shell else volume, area_moments=area or measurement.area_moments)


def _higher_order_moments(body: MeasuredBody, shell: bool) -> Callable[[], Moments] | None:
    """What gives the moments of higher order of what the principal frame is made from, where they are known."""
    if body.moments is None or body.mass is not None or body.length is not None:
        return None

    def higher() -> Moments:
        with np.errstate(over="ignore", invalid="ignore"):
            moments = body.moments(MAX_ORDER, shell)[1 if shell else 0]
        if not np.isfinite([moments.raw, moments.rounding_error]).all():
            raise ReadError("object_too_large")
        return moments

    return higher


def _require_volume(body: MeasuredBody, options: MeasureOptions) -> Moments:
    """The volume, of a shell that of its sheet or wall."""
    shell = options.kind == "shell"
    volume = body.area * options.thickness if shell and body.wall is None else body.wall or body.volume
    if not volume.total > 0.0:
        if body.solids and not body.area.total > 0.0:
            raise ReadError("no_face_area")
        raise ReadError("no_thickness" if shell and body.area.total > 0.0 else "no_volume")
    return volume


def as_measurement(
    obj: bpy.types.Object | None,
    reading: Reading | VolumeReading,
    body: MeasuredBody,
    options: MeasureOptions,
    unit: float,
    mass_result: MassResult | None = None,
    key: str | None = None,
) -> Measurement:
    """The results of measuring a body. obj: None for what is in a file only. options: resolved. key: in place of
    `density_key`. MeasureError where it has no mass."""
    shell = options.kind == "shell"
    wire = options.kind == "wire"
    thin, solid = shell and body.wall is None, body.wall or body.volume
    volume = body.volume if wire else _require_volume(body, options)
    extent = body.length if wire else volume  # what the density is of
    density = options.density if options.mass is None else options.mass / extent.total
    if body.mass is not None:
        moments, factor = body.mass, 1.0 if options.mass is None else options.mass / body.mass.total
        density = body.mass.total * factor / volume.total
    else:
        moments, factor = (body.area, density * options.thickness) if thin else (body.length or solid, density)
    if not density > 0.0:
        raise ReadError("zero_density" if options.mass is None else "zero_mass")
    rotation, location = np.asarray(reading.rotation, np.float64), np.asarray(reading.location, np.float64) * unit
    higher = _higher_order_moments(body, shell)
    uses_high_order = options.pose or body.face_count <= MAX_FACES_HIGH_ORDER
    properties = MassProperties.from_moments(
        moments,
        factor,
        preferred_axes=rotation,
        refine=None if shell or body.mass is not None else body.third_order,
        higher=higher if uses_high_order else None,
    )
    frame = (
        ()
        if uses_high_order or higher is None or properties.principal.is_unique
        else (finding("axes_from_third_order"),)
    )
    given = finding("density_from_value" if options.mass is None else "density_from_mass")

    def bounds(of: str, delta: dict[str, float]) -> dict[str, float]:
        return {
            "volume": float(getattr(volume, of)[0]),
            "area": float(getattr(body.area, of)[0]),
            "center_of_mass": delta["center"],
            "inertia": delta["inertia"],
        }

    settings = effective_hash(
        options.kind.upper(),
        options.density,
        options.mass,
        options.thickness,
        options.overlap.upper(),
        unit,
        options.wall.upper(),
        (density_key(obj, mass_result.materials) if mass_result else "") if key is None else key,
    )
    digested = [body.volume, body.area, *(moments for moments in (body.mass, body.length) if moments is not None)]
    of_surface = "shell" if shell and not body.method.endswith("shell") else body.method
    return Measurement(
        name=reading.name,
        type=reading.type,
        kind=options.kind,
        method=of_surface,
        density=0.0 if wire else density,
        thickness=options.thickness if shell else 0.0,
        volume=volume.total,
        area=body.area.total,
        mass_properties=properties,
        volume_moments=None if thin else solid,
        area_moments=body.area,
        mass_moments=(moments, factor),
        health=body.health,
        findings=(*reading.findings, *body.findings, *frame),
        rotation=rotation,
        location=location,
        length=body.length.total if wire else None,
        display_volume=body.display_volume,
        error_bound={
            **bounds("rounding_error", properties.rounding_error),
            "input": bounds("input_error", properties.input_error),
            **({"estimated": True} if body.estimated else {}),
        },
        fingerprint=fingerprint(
            b"".join(moments.raw.tobytes() for moments in digested), "" if obj is None else matrix_hash(obj), settings
        ),
        density_from=mass_result.source if mass_result else given,
        materials=mass_result.materials if mass_result else (),
    )
