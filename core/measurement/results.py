# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body of any kind as moments, and the results of measuring it: numbers, their methods and their
error bounds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from .. import inertia, mesh, verdict
from ..moments import Measure, Moments
from ..numerics import Array
from .findings import DENSITY_FROM_VALUE, UNIFORM_DENSITIES, WALL_UNSUPPORTED


@dataclass(frozen=True, eq=False)
class Body:
    """The moments of a whole object, in SI units and world axes; the base class knows them to third
    order only.

    `volume`: known to third order at least. `length`: of a wire. `wall`: the material of a shell of
    real thickness. `mass`: moments in kg of a body of varying density; `higher_mass`: these moments
    to the requested order, above third. `density_from`: source of a varying density, with a code
    ``density_from_…``. `density_key`: settings of a varying density, for the fingerprint;
    `materials`: full names of the materials read. `estimated`: true if the error bounds are
    estimates. `display_volume`: volume of the display mesh, m³, for a body that is measured without
    it. `face_count`: number of measured triangles and quads. `printed`: the entry `print` of the
    record of a printed body.
    """

    any_order: ClassVar[bool] = False  # true if `moments` gives any order
    has_surface: ClassVar[bool] = False  # true if `surfaces` yields any

    volume: Moments
    area: Moments
    health: verdict.MeshHealth
    method: verdict.Method
    findings: tuple[verdict.Finding, ...]
    mass: Moments | None = None
    higher_mass: Moments | None = None
    density_from: verdict.Finding | None = None
    density_key: str = ""
    materials: tuple[str, ...] = ()
    wall: Moments | None = None
    length: Moments | None = None
    estimated: bool = False
    display_volume: float | None = None
    face_count: int = 0
    printed: dict[str, Any] | None = None

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume, and of the area if wanted, to an order; ReadError if
        they are unknown.
        """
        raise verdict.ReadError(
            WALL_UNSUPPORTED, quantity="A moment above third order or of the area"
        )

    def third_order(self) -> Moments:
        """Return the moments of a solid or a wire that its principal frame is computed from, with
        exact third order.
        """
        return self.volume

    def surfaces(self, sheets: bool) -> Iterator[mesh.Surface]:
        """Yield the surfaces of the solid, or the unchanged sheets, in world coordinates as
        float64.
        """
        return iter(())


@dataclass(frozen=True, eq=False, kw_only=True)
class Measurement:
    """One object in SI units and world axes.

    In a stack, numbers have a leading axis; names, types, methods, fingerprints, findings and
    sources of density are lists; all have one kind, and health is None.

    kind: "solid", "shell", "printed" or "wire". method: the procedure and its source: polygons,
    B-spline patches measured instead of their display mesh, or a grid. density: kg/m³, 0 for a
    wire, which has mass per length, kg/m. thickness: of a shell, m, 0 for solids. volume: m³, of a
    shell area times thickness. area: m². volume_moments: to order 3, None for a thin shell;
    area_moments: to order 3 for a shell, else order 0; both to a higher order if requested.
    mass_moments: the moments that carry the mass, and the mass in kg per unit of them. higher_mass:
    moments in kg to the requested order, above third, if the density varies. rotation, location:
    (3, 3) and (3,), the object frame without scale. error_bound: absolute bounds "volume", "area",
    "center_of_mass", "inertia" of rounding, and the same under "input" for storing coordinates as
    float32; "estimated": True if those of rounding are estimates. findings: decisions during the
    measurement. fingerprint: of the input. length: of a wire, m, else None. display_volume: of the
    display mesh of B-spline patches, m³; None if not requested. density_from: the source of the
    density, with a code `density_from_…`. materials: names of the materials considered for it.
    place_error: how far the input's rounding may have moved the body as a whole, m. printed: as in
    `Body`.
    """

    name: str
    type: str
    kind: str
    method: verdict.Method
    density: float = 0.0
    thickness: float = 0.0
    volume: float
    area: float
    mass_properties: inertia.MassProperties
    volume_moments: Moments | None
    area_moments: Moments
    mass_moments: tuple[Moments, float]
    health: verdict.MeshHealth
    findings: tuple[verdict.Finding, ...]
    rotation: Array
    location: Array
    error_bound: dict
    fingerprint: str
    density_from: verdict.Finding = DENSITY_FROM_VALUE
    materials: tuple[str, ...] = ()
    length: float | None = None
    display_volume: float | None = None
    higher_mass: Moments | None = None
    place_error: float = 0.0
    printed: dict[str, Any] | None = None

    def at(self, which: int | list[int]) -> Measurement:
        """Return one measurement of a stack, without its health, or a stack of some of them."""

        def pick(value: Any) -> Any:
            if isinstance(value, (Moments, inertia.MassProperties)):
                return value.at(which)
            if isinstance(value, dict):
                return {name: pick(entry) for name, entry in value.items()}
            if isinstance(value, tuple):
                return tuple(map(pick, value))
            if isinstance(value, list):
                return [value[i] for i in which] if isinstance(which, list) else value[which]
            if isinstance(value, np.ndarray):
                return (
                    value[which]
                    if isinstance(which, list) or value.ndim > 1
                    else float(value[which])
                )
            return value

        return replace(self, **{name: pick(value) for name, value in vars(self).items()})

    def moments_of_mass(self, order: int) -> Moments | None:
        """Return the moments of the mass, kg, to an order; None if they are not known to that
        order.
        """
        moments, factor = self.mass_moments
        # A uniform density times moments of a higher order is the last resort.
        if order <= moments.order:
            return replace(moments.truncate(order), measure=Measure.MASS) * factor
        if self.higher_mass is not None:
            return self.higher_mass.truncate(order)
        extent = self.area_moments if self.volume_moments is None else self.volume_moments
        if (
            self.density_from not in UNIFORM_DENSITIES
            or self.length is not None
            or extent.order < order
        ):
            return None
        return replace(extent.truncate(order), measure=Measure.MASS) * factor

    @property
    def center_bounds(self) -> tuple[float, float]:
        """Bounds of the center of mass by rounding and by storing, m."""
        bound = self.error_bound
        return bound["center_of_mass"], bound["input"]["center_of_mass"]

    def in_object_frame(self) -> inertia.MassProperties:
        """Return the mass properties in the object's own frame."""
        return self.mass_properties.in_frame(self.rotation, self.location)
