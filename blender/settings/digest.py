# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Digests of the settings of a density, for the fingerprint."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from .density import material_density, object_density
from .given import GivenPart
from .grid import GridOptions


def grid_key(obj: bpy.types.Object, density: float | None = None) -> str:
    """Return a key of the density of a Volume object.

    density: as for `GridOptions.from_settings`.
    """
    grid = GridOptions.from_settings(obj.body_moments, density)
    return "" if grid.solid else repr(grid.key)


def density_key(obj: bpy.types.Object, used: Iterable[str], scene: bpy.types.Scene) -> str:
    """Return the settings and materials behind the density, as a text; "" for one value, a given mass or a wire.

    used: the full names of the materials that the last measurement met, beside the ones in the object's slots.
    scene: its default density counts if the object has none.
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
        place = None if source is None else [tuple(row) for row in source.matrix_world]
        return "" if source is None else repr((GridOptions.from_settings(source.body_moments).key, place))
    if settings.density_from == "POLYNOMIAL":
        return repr((settings.density_frame, settings.density_polynomial.strip()))
    if settings.density_from == "ATTRIBUTE":
        return repr(settings.density_attribute)
    slots = [slot.material for slot in obj.material_slots]
    names = {*used, *(material.name_full for material in slots if material)}
    densities = {
        material.name_full: material_density(material) for material in bpy.data.materials if material.name_full in names
    }
    return repr((object_density(settings, scene), sorted(names), sorted(densities.items())))
