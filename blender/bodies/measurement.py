# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body becomes a measurement: mass properties, frame, bounds, fingerprint."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...core.inertia.canonical_frame import MAX_ORDER
from ...core.inertia.findings import MOMENTS_OVERFLOW
from ...core.inertia.mass_properties import MassProperties
from ...core.inertia.principal_frames import OwnMoments
from ...core.measurement.measurement import DENSITY_FROM_MASS, DENSITY_FROM_VALUE, Measurement
from ...core.moments.exponents import KNOWN_ORDER
from ...core.moments.moments import Moments
from ...core.verdict.finding import ReadError, finding
from ...core.verdict.findings import OBJECT_TOO_LARGE
from ...core.verdict.method import Method, Verdict
from ...core.wall.findings import NO_FACE_AREA
from ..read.fingerprint import effective_hash, fingerprint, transform_key
from ..read.grids.volume import VolumeReading
from ..read.reading import Reading
from ..settings.accepted import with_acceptance
from ..settings.options import ResolvedOptions
from .body import Body
from .findings import AXES_FROM_THIRD_ORDER, NO_THICKNESS, NO_VOLUME, WALL_ORDER, ZERO_DENSITY, ZERO_MASS
from .request import Request

# faces up to which moments of higher order, for a frame that needs them, take no time to speak of
MAX_FACES_HIGH_ORDER = 20_000


def measurement_of(reading: Reading | VolumeReading, body: Body, request: Request) -> Measurement:
    """Return the results of measuring a body, with its moments to the requested order.

    Raise MeasureError if the body has no mass, or no moments of that order.
    """
    options = request.options
    shell, wire = options.kind == "shell", options.kind == "wire"
    thin, solid = shell and body.wall is None, body.wall or body.volume
    measured = extent(body, options)
    volume = body.volume if wire else measured
    moments, factor, density = _weighed(body, measured, solid, thin, options)
    rotation = np.asarray(reading.rotation, np.float64)
    higher = _higher(body, shell)
    uses_high_order = options.axes and (options.pose or body.face_count <= MAX_FACES_HIGH_ORDER)
    properties = MassProperties.from_moments(
        moments,
        factor,
        preferred_axes=rotation,
        refine=None if shell or body.mass is not None else body.third_order,
        higher=higher if uses_high_order else None,
    )
    left_open = options.axes and not uses_high_order and higher is not None and not properties.principal.is_unique
    frame = (finding(AXES_FROM_THIRD_ORDER),) if left_open else ()
    given = DENSITY_FROM_VALUE if options.mass is None else DENSITY_FROM_MASS
    volume_moments, area_moments = None if thin else solid, body.area
    if options.order is not None:
        volume_moments, area_moments = _to_order(body, options, options.order) or (volume_moments, area_moments)
    rounding, moved = properties.rounding_error, properties.input_error
    return Measurement(
        name=reading.name,
        type=reading.type,
        kind=options.kind,
        method=Method(Verdict.SHELL, body.method.source) if shell else body.method,
        density=0.0 if wire else density,
        thickness=options.thickness if shell else 0.0,
        volume=float(volume.raw[0]),
        area=float(body.area.raw[0]),
        mass_properties=properties,
        volume_moments=volume_moments,
        area_moments=area_moments,
        mass_moments=(moments, factor),
        higher_mass=None if body.higher_mass is None else body.higher_mass * factor,
        health=body.health,
        findings=with_acceptance((*reading.findings, *body.findings, *frame), request.accepted),
        rotation=rotation,
        location=np.asarray(reading.location, np.float64) * request.unit,
        length=float(measured.raw[0]) if wire else None,
        display_volume=body.display_volume,
        error_bound={
            **_bounds(volume.rounding_error, body.area.rounding_error, rounding),
            "input": _bounds(volume.input_error, body.area.input_error, moved),
            **({"estimated": True} if body.estimated else {}),
        },
        fingerprint=_fingerprint(body, request),
        density_from=body.density_from or given,
        materials=body.materials,
    )


def extent(body: Body, options: ResolvedOptions) -> Moments:
    """Return the moments that the density multiplies: of the volume, a shell's sheet or wall, or a wire's length.

    Raise ReadError if that volume is not positive.
    """
    if body.length is not None:
        return body.length
    shell = options.kind == "shell"
    volume = body.area * options.thickness if shell and body.wall is None else body.wall or body.volume
    if not volume.raw[0] > 0.0:
        if body.face_count and not body.area.total > 0.0:
            raise ReadError(NO_FACE_AREA)
        raise ReadError(NO_THICKNESS if shell and body.area.total > 0.0 else NO_VOLUME)
    return volume


def _weighed(
    body: Body, measured: Moments, solid: Moments, thin: bool, options: ResolvedOptions
) -> tuple[Moments, float, float]:
    """Return the moments that carry the mass, the mass in kg per unit of them, and the density."""
    if body.mass is not None:
        factor = 1.0 if options.mass is None else options.mass / body.mass.total
        moments, density = body.mass, body.mass.total * factor / measured.total
    else:
        density = options.density or 0.0 if options.mass is None else options.mass / measured.total
        moments, factor = (body.area, density * options.thickness) if thin else (body.length or solid, density)
    if not density > 0.0:
        raise ReadError(ZERO_DENSITY if options.mass is None else ZERO_MASS)
    return moments, factor, density


def _higher(body: Body, shell: bool) -> Callable[[], Moments | OwnMoments] | None:
    """Return a function for the higher moments of the principal frame, None if they are not known."""
    if not body.any_order or body.mass is not None or body.length is not None or body.wall is not None:
        return None  # walls have none either, because their axes follow a slider
    return partial(_frame_moments, body, shell)


def _frame_moments(body: Body, shell: bool) -> Moments | OwnMoments:
    with np.errstate(over="ignore", invalid="ignore"):
        found = body.moments_for_axes(MAX_ORDER, shell)
    moments = found.moments if isinstance(found, OwnMoments) else found
    if not (np.isfinite(moments.raw).all() and np.isfinite(moments.rounding_error).all()):
        raise ReadError(OBJECT_TOO_LARGE)
    return found


def _to_order(body: Body, options: ResolvedOptions, order: int) -> tuple[Moments | None, Moments] | None:
    """Return the moments of volume and area to the requested order; None if a body has them anyway."""
    shell = options.kind == "shell"
    thin = shell and body.wall is None
    if order < KNOWN_ORDER and (shell or not options.surface):
        return None
    if not body.any_order:
        if order > KNOWN_ORDER or (options.surface and not shell):
            raise ReadError(WALL_ORDER, order=KNOWN_ORDER)
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        volume, area = body.moments(order, shell or options.surface)
    for moments in (volume, area):
        if moments is not None and not np.isfinite([moments.raw, moments.rounding_error, moments.input_error]).all():
            raise ReadError(MOMENTS_OVERFLOW, order=order)
    return None if thin else volume, area or body.area


def _bounds(volume: NDArray, area: NDArray, of_mass: dict[str, float]) -> dict[str, float]:
    return {
        "volume": float(volume[0]),
        "area": float(area[0]),
        "center_of_mass": of_mass["center"],
        "inertia": of_mass["inertia"],
    }


def _fingerprint(body: Body, request: Request) -> str:
    options = request.options
    settings = effective_hash(
        options.kind.upper(),
        options.density,
        options.mass,
        options.thickness,
        options.overlap.upper(),
        request.unit,
        options.wall.upper(),
        body.density_key,
    )
    digested = [moments for moments in (body.volume, body.area, body.mass, body.length) if moments is not None]
    geometry = b"".join([moments.raw.tobytes() for moments in digested])
    return fingerprint(geometry, "" if request.obj is None else transform_key(request.obj), settings)
