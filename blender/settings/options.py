# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that override objects' settings, and their resolution into the settings of a
measurement.
"""

from __future__ import annotations

from dataclasses import dataclass

from bpy.types import Object, Scene

from ...core import measurement, numerics
from ..scale import meters_per_unit
from .density import object_density
from .prints import print_settings


@dataclass(frozen=True)
class MeasureOptions:
    """Overrides of the objects' own settings, as in `Settings`; None leaves the setting.

    unit_scale: meters per Blender unit, else the scene's. printed: pairs of a field of
    `PrintSettings` and its value.
    """

    kind: str | None = None
    density: float | None = None
    mass: float | None = None
    thickness: float | None = None
    overlap: str | None = None
    wall: str | None = None
    unit_scale: float | None = None
    printed: tuple[tuple[str, float], ...] = ()
    order: int | None = None
    surface: bool = False
    compare: bool = True
    threads: int = 1

    def meters_per_unit(self, scene: Scene) -> float:
        """Return the length of a Blender unit in meters: the given one, else the scene's."""
        return self.unit_scale or meters_per_unit(scene)


AS_SET = MeasureOptions()  # every object as its own settings say


def object_settings(
    obj: Object, scene: Scene, options: MeasureOptions = AS_SET
) -> measurement.Settings:
    """Return the options with gaps filled from the object's, and the scene's, settings."""
    properties = obj.body_moments
    unit = options.meters_per_unit(scene)
    # Volume objects do not show the setting Kind
    kind = options.kind or ("solid" if obj.type == "VOLUME" else properties.kind.lower())
    density = options.density
    mass = options.mass
    if density is None and mass is None:
        if properties.mass_from == "MASS":
            mass = numerics.shortest_decimal(properties.mass)
        elif kind == "wire":
            density = numerics.shortest_decimal(properties.linear_density)
        else:
            density = object_density(properties, scene)
    thickness = options.thickness
    if thickness is None:
        thickness = numerics.shortest_decimal(properties.thickness) * unit
    printed = measurement.PrintSettings()
    if kind == "printed":
        printed = print_settings(properties)._replace(**dict(options.printed))
    return measurement.Settings(
        kind=kind,
        density=density,
        mass=mass,
        thickness=thickness,
        overlap=options.overlap or properties.overlap.lower(),
        wall=options.wall or properties.wall.lower(),
        unit=unit,
        printed=printed,
        order=options.order,
        surface=options.surface,
        compare=options.compare,
        threads=options.threads,
    )
