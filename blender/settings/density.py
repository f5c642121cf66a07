# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The density in an object's settings, one number or a varying field, and its key for the
fingerprint.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

import bpy

from ...core import density as density_engine
from ...core import numerics, verdict
from ...core.measurement import DENSITY_FROM_VALUE
from .findings import (
    DENSITY_FROM_POLYNOMIAL,
    DENSITY_SOURCE_MISSING,
    OBJECT_DENSITY_USED,
)
from .given import GivenPart
from .preferences import default_density

if TYPE_CHECKING:
    from ...core.density import Polynomial
    from ...core.measurement import Measurement


class DensityField(NamedTuple):
    """A density that varies over a body.

    kind: "materials", "polynomial", "attribute" or "volume". polynomial: kg/m³ of meters, along the
    world's axes if `in_world`, else each surface's own; text: as it was typed. attribute: the name
    of the vertex attribute.
    """

    kind: str
    polynomial: Polynomial | None = None
    in_world: bool = False
    text: str = ""
    attribute: str | None = None

    @property
    def frame(self) -> str:
        """Frame of the polynomial's coordinates: "world" or "object"."""
        return "world" if self.in_world else "object"

    def polynomial_source(self) -> verdict.Finding:
        """Return the source of a polynomial density; a text with commas is shown as a list, as one
        may be mistaken.
        """
        text = "({}) · (1, x, y, z, …)".format(self.text) if "," in self.text else self.text
        return verdict.finding(DENSITY_FROM_POLYNOMIAL, polynomial=text, frame=self.frame)


def density_field(settings: bpy.types.PropertyGroup) -> DensityField | None:
    """Return the density field of the settings, None for one value or a given mass, or raise
    MeasureError.
    """
    if settings.mass_from != "DENSITY" or settings.density_from == "VALUE":
        return None
    if settings.density_from == "MATERIALS":
        return DensityField("materials")
    if settings.density_from == "POLYNOMIAL":
        text = settings.density_polynomial.strip()
        return DensityField(
            "polynomial",
            density_engine.polynomial.parse_polynomial(text),
            settings.density_frame == "WORLD",
            text,
        )
    if settings.density_from == "VOLUME":
        if settings.density_volume is None:
            raise verdict.ReadError(DENSITY_SOURCE_MISSING, source="Volume Object")
        return DensityField("volume")
    if not settings.density_attribute:
        raise verdict.ReadError(DENSITY_SOURCE_MISSING, source="Vertex Attribute")
    return DensityField("attribute", attribute=settings.density_attribute)


def object_density(settings: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> float:
    """Return an object's uniform density in kg/m³: its own if it is set or the scene has none, else
    the scene's.
    """
    default = None if settings.is_property_set("density") else default_density(scene)
    return numerics.shortest_decimal(settings.density) if default is None else default


def material_density(material: bpy.types.Material | None) -> float | None:
    """Return a material's density in kg/m³; None if there is no material, or it has no density."""
    density = 0.0 if material is None else numerics.shortest_decimal(material.body_moments.density)
    return density if density > 0.0 else None


def unset_density(
    obj: bpy.types.Object, measurement: Measurement, scene: bpy.types.Scene
) -> str | None:
    """Return the density setting that a measurement uses and nobody has set, or None."""
    settings = obj.body_moments
    is_used_for_some = any(each.code == OBJECT_DENSITY_USED for each in measurement.findings)
    if measurement.density_from != DENSITY_FROM_VALUE and not is_used_for_some:
        return None
    if measurement.kind == "wire":
        return None if settings.is_property_set("linear_density") else "linear_density"
    return "density" if is_density_unset(settings, scene) else None


def is_density_unset(settings: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> bool:
    """Return whether neither the object nor the scene has set the density that `object_density`
    returns.
    """
    return not settings.is_property_set("density") and default_density(scene) is None


def density_anchor(obj: bpy.types.Object) -> str:
    """Return the coordinates to which the object's density is fixed: "own", "world" or ""."""
    settings = obj.body_moments
    if settings.mass_from != "DENSITY" or settings.density_from != "POLYNOMIAL":
        return ""
    return "world" if settings.density_frame == "WORLD" else "own"


def grid_key(obj: bpy.types.Object, density: float | None = None) -> str:
    """Return a key of the density of a Volume object, "" if its grid is measured as a solid."""
    grid = density_engine.grid_options.GridOptions.from_settings(obj.body_moments, density)
    return "" if grid.solid else repr(grid.key)


def density_key(obj: bpy.types.Object, used: Iterable[str], scene: bpy.types.Scene) -> str:
    """Return the settings and materials behind the density, as a text; "" for one value, a given
    mass or a wire.

    used: the full names of the materials that the last measurement met, beside the ones in the
    object's slots.
    """
    settings = obj.body_moments
    given = GivenPart.from_settings(settings, 1.0).key if settings.mass_from == "MASS" else ""
    if obj.type == "VOLUME":
        return grid_key(obj) + given
    if settings.mass_from == "MASS":
        return given
    if settings.kind == "WIRE" or settings.density_from == "VALUE":
        return ""
    if settings.density_from == "VOLUME":
        source = settings.density_volume
        if source is None:
            return ""
        options = density_engine.grid_options.GridOptions.from_settings(source.body_moments)
        return repr((options.key, [tuple(row) for row in source.matrix_world]))
    if settings.density_from == "POLYNOMIAL":
        return repr((settings.density_frame, settings.density_polynomial.strip()))
    if settings.density_from == "ATTRIBUTE":
        return repr(settings.density_attribute)
    slots = [slot.material for slot in obj.material_slots]
    names = {*used, *(material.name_full for material in slots if material)}
    densities = {
        material.name_full: material_density(material)
        for material in bpy.data.materials
        if material.name_full in names
    }
    return repr((object_density(settings, scene), sorted(names), sorted(densities.items())))
