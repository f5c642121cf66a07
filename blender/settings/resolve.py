# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a measurement, resolved from the options, the object's properties and the scene's defaults."""

from __future__ import annotations

from typing import Any

from bpy.types import Object, Scene

from ...core.measurement.settings import Settings
from ...core.numerics.float32 import shortest_decimal
from .density import object_density
from .options import AS_SET, MeasureOptions


def with_options(options: MeasureOptions, **values: Any) -> Settings:
    """Return settings with these values, and with the options for which objects have no settings."""
    return Settings(
        order=options.order,
        surface=options.surface,
        pose=options.pose,
        compare=options.compare,
        axes=options.axes,
        threads=options.threads,
        **values,
    )


def object_settings(
    obj: Object, scene: Scene, options: MeasureOptions = AS_SET, unit: float | None = None, varying: str = ""
) -> Settings:
    """Return the options with gaps filled from the object's, and the scene's, settings; varying: as in `Settings`."""
    properties = obj.body_moments
    density, mass = options.density, options.mass
    unit = unit or options.meters_per_unit(scene)
    # Volume objects do not show the setting Kind
    kind = options.kind or ("solid" if obj.type == "VOLUME" else properties.kind.lower())
    if density is None and mass is None:
        if properties.mass_from == "MASS":
            mass = shortest_decimal(properties.mass)
        else:
            density = given_density(obj, scene, kind)
    return with_options(
        options,
        kind=kind,
        density=density,
        mass=mass,
        thickness=shortest_decimal(properties.thickness) * unit if options.thickness is None else options.thickness,
        overlap=options.overlap or properties.overlap.lower(),
        wall=options.wall or properties.wall.lower(),
        unit=unit,
        varying=varying,
    )


def given_density(obj: Object, scene: Scene, kind: str) -> float:
    """Return the uniform density in the object's properties, in kg/m³, or for a wire in kg/m."""
    properties = obj.body_moments
    return shortest_decimal(properties.linear_density) if kind == "wire" else object_density(properties, scene)
