# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Construction of every `Measurement` from a body, or from arrays: mass properties, frame and error
bounds.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import mesh, wall
from ..inertia import (
    CHOICES,
    MOMENTS_OVERFLOW,
    NO_CERTAIN_VOLUME,
    MassProperties,
    PrincipalFrame,
    has_certain_total,
)
from ..moments import (
    KNOWN_ORDER,
    Measure,
    Moments,
    U,
    monomial_count,
)
from ..numerics import IDENTITY_3, Array, ArrayLike, NDArray, PerBody
from ..polyhedron import MAX_TRIANGLES_EXACT_THIRD
from ..solid.measure import SolidIntegrals, measure_solid
from ..verdict import Finding, MeshHealth, Method, Procedure, ReadError, finding
from .findings import (
    DENSITY_FROM,
    DENSITY_FROM_MASS,
    DENSITY_FROM_VALUE,
    LARGE_BOUND,
    NO_VOLUME,
    WALL_UNSUPPORTED,
    ZERO_QUANTITY,
)
from .results import Body, Measurement
from .settings import Settings

NO_AXES_FIXED = "isotropic"
MAX_CENTER_BOUND = (
    1e-3  # relative to the largest radius of gyration: the center is uncertain above it
)
# Error bounds are compared with these sizes, and shown as shares of them.
BOUNDED = (
    ("volume", "value"),
    ("area", "value"),
    ("smallest principal moment", "value"),
    ("center of mass", "size"),
)
# a volume or area, and the bounds of rounding and of float32 coordinates
Extent = tuple[float, float, float]


def build_measurement(
    *,
    volume: Moments,
    area: Moments,
    mass_properties: MassProperties,
    estimated: bool = False,
    **fields: Any,
) -> Measurement:
    """Return a measurement, or a stack, with volume, area and bounds from the moments and
    properties; other fields as given.
    """
    rounding = mass_properties.rounding_error
    moved = mass_properties.input_error
    known: dict[str, Any] = {"volume_moments": volume, "area_moments": area}
    return Measurement(
        volume=volume.total,
        area=area.total,
        mass_properties=mass_properties,
        error_bound={
            **_bounds(volume.rounding_error, area.rounding_error, rounding),
            "input": _bounds(volume.input_error, area.input_error, moved),
            **({"estimated": True} if estimated else {}),
        },
        **(known | fields),
    )


def measure_body(
    body: Body, settings: Settings, *, findings: tuple[Finding, ...] = (), **fields: Any
) -> Measurement:
    """Return the measurement of a body, with moments to the order of the settings; fields: the
    name, type, rotation, location and fingerprint of a `Measurement`, and others if they are known.
    """
    is_shell = settings.kind == "shell"
    is_wire = settings.kind == "wire"
    extent = find_extent(body, settings)
    moments, factor, density = _weigh(body, extent, settings)
    # Bodies of few faces, of two triangles at most each, have exact third moments already.
    is_exact = 2 * body.face_count <= MAX_TRIANGLES_EXACT_THIRD and not is_wire
    refine = None if is_shell or is_exact or body.mass is not None else body.third_order
    properties = MassProperties.of_body(moments, factor, fields["rotation"], refine)
    volume_moments = None if _is_thin(body, settings) else body.wall or body.volume
    area_moments = body.area
    if settings.order is not None:
        volume_moments, area_moments = _to_order(body, settings, settings.order) or (
            volume_moments,
            area_moments,
        )
    uniform = DENSITY_FROM_VALUE if settings.mass is None else DENSITY_FROM_MASS
    return build_measurement(
        kind=settings.kind,
        method=Method(Procedure.SHELL, body.method.source) if is_shell else body.method,
        density=0.0 if is_wire else density,
        thickness=settings.thickness if is_shell else 0.0,
        volume=body.volume if is_wire else extent,
        area=body.area,
        mass_properties=properties,
        volume_moments=volume_moments,
        area_moments=area_moments,
        mass_moments=(moments, factor),
        higher_mass=None if body.higher_mass is None else body.higher_mass * factor,
        health=body.health,
        findings=(
            *findings,
            *body.findings,
            *find_large_bounds(extent.at(None), body.area.at(None), properties)[0],
        ),
        length=float(extent.raw[0]) if is_wire else None,
        display_volume=body.display_volume,
        estimated=body.estimated,
        density_from=body.density_from or uniform,
        materials=body.materials,
        printed=body.printed,
        **fields,
    )


def measure_total(
    mass: Moments,
    *,
    rotation: Array,
    volume: Extent = (0.0, 0.0, 0.0),
    area: Extent = (0.0, 0.0, 0.0),
    health: MeshHealth | None = None,
    **fields: Any,
) -> Measurement:
    """Return the measurement of several bodies from the sum of their mass moments, in kg, to third
    order, world axes.

    `volume`, m³, and `area`, m², come with their bounds. `rotation` (3, 3), axes as columns,
    belongs to the frame in which the results are stored. Raise MeasureError if no mass is certain,
    or if the second moments are impossible for a body.
    """
    return build_measurement(
        density=mass.total / volume[0] if volume[0] > 0.0 else 0.0,
        volume=_total_moments(volume, mass.about, Measure.VOLUME),
        area=_total_moments(area, mass.about, Measure.AREA),
        mass_properties=find_properties(mass, rotation),
        mass_moments=(mass, 1.0),
        health=health or MeshHealth(closed=False, components=0),
        rotation=rotation,
        **(
            {
                "method": Method(Procedure.ASSEMBLY),
                "density_from": finding(DENSITY_FROM, source="members"),
            }
            | fields
        ),
    )


def find_large_bounds(
    volume: Moments, area: Moments, properties: MassProperties
) -> list[tuple[Finding, ...]]:
    """Return for each of n stacked bodies the findings about error bounds that are large for its
    values.
    """
    errors = (properties.rounding_error, properties.input_error)
    principal = properties.principal.moments.reshape(-1, 3)
    inertia, center = (
        sum([np.atleast_1d(bounds[name]) for bounds in errors]) for name in ("inertia", "center")
    )
    # Shares and limits are in the order of BOUNDED.
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = [
            (each.rounding_error + each.input_error)[:, 0] / each.raw[:, 0]
            for each in (volume, area)
        ]
        shares += [inertia / principal[:, 0], center / np.sqrt(principal[:, 2] / properties.mass)]
    # A sheet's volume is as uncertain as its area; a straight wire has no moment about its axis.
    limits = [1.0 if volume.measure == Measure.VOLUME else np.inf, 1.0]
    limits += [np.inf if volume.measure == Measure.LENGTH else 1.0, MAX_CENTER_BOUND]
    findings: list[tuple[Finding, ...]] = [()] * len(volume.raw)
    for body, i in np.argwhere(np.greater(np.transpose(shares), limits)).tolist():
        quantity, whole = BOUNDED[i]
        findings[body] += (
            finding(LARGE_BOUND, quantity=quantity, whole=whole, share=float(shares[i][body])),
        )
    return findings


def _total_moments(extent: Extent, about: Array, measure: Measure) -> Moments:
    """Return moments with a known total and its bounds; all others are zero."""
    raw, rounding, inputs = np.zeros((3, monomial_count(KNOWN_ORDER)))
    raw[0], rounding[0], inputs[0] = extent
    return Moments(raw, about, measure, rounding, inputs)


def extent_of(measurement: Measurement, name: str) -> Extent:
    """Return the "volume" or "area" of a measurement, with its bounds of rounding and input."""
    bound = measurement.error_bound
    return getattr(measurement, name), bound[name], bound["input"][name]


def add_extents(extents: list[Extent]) -> Extent:
    """Return the sum of volumes or areas, with its bounds."""
    values, rounding, inputs = np.array(extents, np.float64).reshape(-1, 3).T
    bound = rounding.sum() + len(values) * U * np.abs(values).sum()
    return float(values.sum()), float(bound), float(inputs.sum())


def find_extent(body: Body, settings: Settings) -> Moments:
    """Return the moments of volume, sheet, wall or length that density multiplies; ReadError if
    they are zero.
    """
    if body.length is not None:
        return body.length
    volume = (
        body.area * settings.thickness if _is_thin(body, settings) else body.wall or body.volume
    )
    if not volume.raw[0] > 0.0:
        if body.face_count and not body.area.total > 0.0:
            raise ReadError(wall.NO_FACE_AREA)
        if settings.kind == "shell" and body.area.total > 0.0:
            raise ReadError(ZERO_QUANTITY, quantity="thickness")
        raise ReadError(NO_VOLUME)
    if not has_certain_total(volume):
        raise ReadError(NO_CERTAIN_VOLUME)
    return volume


def _is_thin(body: Body, settings: Settings) -> bool:
    """Return whether a body is a shell with its mass by area, not by the volume of a real wall."""
    return settings.kind == "shell" and body.wall is None


def _weigh(body: Body, extent: Moments, settings: Settings) -> tuple[Moments, float, float]:
    """Return the moments that carry the mass, the mass in kg per unit of them, and the density.

    extent: the result of `find_extent`.
    """
    if body.mass is not None:
        moments = body.mass
        factor = 1.0 if settings.mass is None else settings.mass / body.mass.total
        density = body.mass.total * factor / extent.total
    else:
        density = settings.density or 0.0
        if settings.mass is not None:
            density = settings.mass / extent.total
        moments, factor = extent, density
        if _is_thin(body, settings):
            moments, factor = body.area, density * settings.thickness
    if not density > 0.0:
        raise ReadError(ZERO_QUANTITY, quantity="density" if settings.mass is None else "mass")
    return moments, factor, density


def _to_order(body: Body, settings: Settings, order: int) -> tuple[Moments | None, Moments] | None:
    """Return moments of volume and area to an order; None if the body's own suffice; ReadError if
    they are unknown.
    """
    shell = settings.kind == "shell"
    if order < KNOWN_ORDER and (shell or not settings.surface):
        return None
    if not body.any_order:
        if order > KNOWN_ORDER or (settings.surface and not shell):
            raise ReadError(WALL_UNSUPPORTED, quantity="A moment above third order or of the area")
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        volume, area = body.moments(order, shell or settings.surface)
    for moments in (volume, area):
        if (
            moments is not None
            and not np.isfinite([moments.raw, moments.rounding_error, moments.input_error]).all()
        ):
            raise ReadError(MOMENTS_OVERFLOW, order=order)
    return None if _is_thin(body, settings) else volume, area or body.area


def _bounds(volume: NDArray, area: NDArray, of_mass: dict[str, PerBody]) -> dict[str, PerBody]:
    """Return the entries of an error bound. volume, area: (..., K) bounds of moments; of_mass:
    bounds of mass properties.
    """
    volume_bound, area_bound = (
        bounds[:, 0] if bounds.ndim > 1 else float(bounds[0]) for bounds in (volume, area)
    )
    return {
        "volume": volume_bound,
        "area": area_bound,
        "center_of_mass": of_mass["center"],
        "inertia": of_mass["inertia"],
    }


def find_properties(mass: Moments, preferred_axes: NDArray) -> MassProperties:
    """Return the mass properties of moments in kg; if all mass is at a point, zero inertia and no
    unique axes.
    """
    if not mass.total > 0.0:  # A bone of flat faces alone; from_moments refuses it.
        return MassProperties.from_moments(mass, preferred_axes=preferred_axes)
    # Second moments of more than their rounding, with a margin of four, belong to an extended body.
    central = mass.truncate(2).about_center()
    if np.abs(central.raw[4:]).max() > 4.0 * central.rounding_error[4:].max():
        return MassProperties.from_moments(mass, preferred_axes=preferred_axes)
    bounds = {
        "mass": float(mass.rounding_error[0]),
        "center": 4.0 * U * float(np.abs(central.about).sum()),
    }
    return MassProperties(
        mass=mass.total,
        center=central.about,
        inertia=np.zeros((3, 3)),
        principal=PrincipalFrame(
            np.zeros(3),
            np.asarray(preferred_axes, np.float64),
            NO_AXES_FIXED,
            False,
            CHOICES["isotropic"],
        ),
        rounding_error=(bounds | {"inertia": float(central.rounding_error[4:].sum())}),
        input_error={"mass": 0.0, "center": 0.0, "inertia": float(central.input_error[4:].sum())},
    )


@dataclass(frozen=True, eq=False)
class _SurfaceBody(Body):
    """The body that one surface bounds."""

    solid: SolidIntegrals = field(kw_only=True)

    def third_order(self) -> Moments:
        """Return the moments of the volume with exact third order."""
        return self.solid.exact_third_order()


def mass_properties(points: ArrayLike, triangles: ArrayLike, *, density: float) -> Measurement:
    """Measure the solid that triangles bound: mass, center, inertia, axes, bounds and findings.

    Holes are capped and flipped faces turned on a copy, and both are reported, as for objects in
    Blender.

    Parameters
    ----------
    points : (n, 3) array_like
        In meters.
    triangles : (m, 3) array_like of int
        Corners, counterclockwise as seen from outside.
    density : float
        In kg/m³; 1 makes the mass the volume.

    Returns
    -------
    Measurement
        `mass_properties` has mass, center, inertia about the center and principal axes; `method`
        tells how.

    Raises
    ------
    MeasureError
        If the triangles bound no volume, or the density is not positive.

    Examples
    --------
    >>> from body_moments.core import mass_properties
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> body = mass_properties(np.eye(4, 3, -1), faces, density=6000.0)
    >>> found = body.mass_properties
    >>> str(body.method), round(found.mass, 9), found.center.round(9).tolist()
    ('exact', 1000.0, [0.25, 0.25, 0.25])
    """
    surface = mesh.Surface.from_triangles(points, triangles)
    solid = measure_solid(surface)
    body = _SurfaceBody(
        solid.volume,
        solid.area,
        solid.health,
        Method(solid.method),
        solid.findings,
        face_count=solid.face_count,
        solid=solid,
    )
    place = {
        "name": "",
        "type": "MESH",
        "fingerprint": "",
        "rotation": IDENTITY_3.copy(),
        "location": np.zeros(3),
    }
    return measure_body(body, Settings(density=float(density)), **place)
