# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an object's density comes from when it is not one number, as the settings say."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...core.density.polynomial import Polynomial, parse_polynomial
from ...core.measurement.findings import DENSITY_FROM_VALUE
from ...core.measurement.measurement import Measurement
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding, ReadError, finding
from .findings import (
    DENSITY_ATTRIBUTE_MISSING,
    DENSITY_FROM_COEFFICIENTS,
    DENSITY_FROM_POLYNOMIAL,
    DENSITY_VOLUME_MISSING,
    OBJECT_DENSITY_USED,
    OBJECT_DENSITY_USED_FOR_MATERIALS,
)
from .preferences import default_density

# Where the density comes from the object's one value, or that of some faces.
_BY_OBJECT = {DENSITY_FROM_VALUE, OBJECT_DENSITY_USED, OBJECT_DENSITY_USED_FOR_MATERIALS}


@dataclass(frozen=True, eq=False)
class DensityField:
    """kind: "materials", "polynomial", "attribute" or "volume". polynomial, in_world: kg/m³ of meters, along the
    world's axes or each surface's own; text: as it was typed. attribute: the name of that of the vertices."""

    kind: str
    polynomial: Polynomial | None = None
    in_world: bool = False
    text: str = ""
    attribute: str | None = None

    @property
    def frame(self) -> str:
        """Whose coordinates those of the polynomial are: "world" or "object"."""
        return "world" if self.in_world else "object"

    def polynomial_source(self) -> Finding:
        """Where a polynomial density comes from. Who meant a decimal comma sees here what it was taken for."""
        code = DENSITY_FROM_COEFFICIENTS if "," in self.text else DENSITY_FROM_POLYNOMIAL
        return finding(code, polynomial=self.text, frame=self.frame)


def density_field(settings: bpy.types.PropertyGroup) -> DensityField | None:
    """What the object's settings name; None for one value or a given mass. MeasureError where a polynomial cannot be
    read, or nothing is chosen."""
    if settings.mass_from != "DENSITY" or settings.density_from == "VALUE":
        return None
    if settings.density_from == "MATERIALS":
        return DensityField("materials")
    if settings.density_from == "POLYNOMIAL":
        text = settings.density_polynomial.strip()
        return DensityField("polynomial", parse_polynomial(text), settings.density_frame == "WORLD", text)
    if settings.density_from == "VOLUME":
        if settings.density_volume is None:
            raise ReadError(DENSITY_VOLUME_MISSING)
        return DensityField("volume")
    if not settings.density_attribute:
        raise ReadError(DENSITY_ATTRIBUTE_MISSING)
    return DensityField("attribute", attribute=settings.density_attribute)


def object_density(settings: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> float:
    """The one density in kg/m³ that an object's settings say: its own, else the scene's default."""
    default = None if settings.is_property_set("density") else default_density(scene)
    return shortest_decimal(settings.density) if default is None else default


def material_density(material: bpy.types.Material | None) -> float | None:
    """kg/m³; None where there is no material, or it has no density."""
    density = 0.0 if material is None else shortest_decimal(material.body_moments.density)
    return density if density > 0.0 else None


def unset_density(obj: bpy.types.Object, measurement: Measurement, scene: bpy.types.Scene) -> str | None:
    """Which density of the object's settings was used and set by nobody, neither for the object nor for the scene:
    "density" or "linear_density"; None where none was. measurement: of the object, with no density or mass from
    elsewhere."""
    settings = obj.body_moments
    used = {measurement.density_from.code, *(one.code for one in measurement.findings)}
    if not used & _BY_OBJECT:
        return None
    if measurement.kind == "wire":
        return None if settings.is_property_set("linear_density") else "linear_density"
    return "density" if is_density_unset(settings, scene) else None


def is_density_unset(settings: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> bool:
    """Whether nobody has set the density that `object_density` gives, neither for the object nor for the scene."""
    return not settings.is_property_set("density") and default_density(scene) is None


def density_anchor(obj: bpy.types.Object) -> str:
    """What the object's density is fixed to, where it changes as the object moves or gets other axes: "own" or "world"
    coordinates; "" else."""
    settings = obj.body_moments
    if settings.mass_from != "DENSITY" or settings.density_from != "POLYNOMIAL":
        return ""
    return "world" if settings.density_frame == "WORLD" else "own"
