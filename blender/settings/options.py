# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that override objects' settings, and their resolution into the settings of a measurement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from bpy.types import Object, Scene

from ...core.measurement.settings import Settings
from ...core.numerics.float32 import shortest_decimal
from .density import object_density


@dataclass(frozen=True)
class MeasureOptions:
    """Overrides of the objects' own settings, in SI units; None leaves the setting.

    kind: "solid", "shell" or "wire"; density: kg/m³, of a wire kg/m; mass: kg; thickness: m; overlap: "signed" or
    "union"; wall: of a shell, "thin", "inward", "outward" or "centered"; unit_scale: meters per Blender unit, else the
    scene's. order: of the measurement's moments; None for the order that mass properties need. surface: moments of the
    area, too. pose: the principal frame follows the body's shape to sixth order, for any number of faces. compare:
    bodies that need no display mesh are compared with it. axes: moments above third order choose the principal axes if
    lower moments leave a choice; otherwise any of the possible axes may result.
    """

    kind: str | None = None
    density: float | None = None
    mass: float | None = None
    thickness: float | None = None
    overlap: str | None = None
    wall: str | None = None
    unit_scale: float | None = None
    threads: int = 1
    order: int | None = None
    surface: bool = False
    pose: bool = False
    compare: bool = True
    axes: bool = True

    def meters_per_unit(self, scene: Scene) -> float:
        """Return the length of a Blender unit in meters: the given one, else the scene's."""
        return self.unit_scale or shortest_decimal(scene.unit_settings.scale_length)


AS_SET = MeasureOptions()  # every object as its own settings say


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
