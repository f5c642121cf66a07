# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The length of a scene's unit, for whatever converts Blender's numbers to SI."""

from bpy.types import Scene

from ..core.numerics import shortest_decimal


def meters_per_unit(scene: Scene) -> float:
    """Return meters per Blender unit of a scene, as the decimal that a person typed."""
    return shortest_decimal(scene.unit_settings.scale_length)
