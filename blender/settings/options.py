# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Overrides of the objects' own settings."""

from __future__ import annotations

from dataclasses import dataclass

from bpy.types import Scene

from ...core.numerics.float32 import shortest_decimal


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
