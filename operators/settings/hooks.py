# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings call when they change, so that they need not know who remembers results: the session registers it."""

from __future__ import annotations

from collections.abc import Callable

from bpy.types import Context, PropertyGroup

Hook = Callable[[PropertyGroup, Context], None]

on_change: list[Hook] = []  # any setting of an object
on_density_change: list[Hook] = []  # what an object's mass is multiplied by: a density, a given mass, which of them
on_wall_change: list[Hook] = []  # the side of a shell's material, or its thickness
on_material_change: list[Hook] = []  # a material's density


def changed(settings: PropertyGroup, context: Context) -> None:
    """The update function of an object's settings."""
    _call(on_change, settings, context)


def density_changed(settings: PropertyGroup, context: Context) -> None:
    """The update function of the settings that say how much an object weighs."""
    _call(on_change, settings, context)
    _call(on_density_change, settings, context)


def wall_changed(settings: PropertyGroup, context: Context) -> None:
    """The update function of the settings that say where the material of a shell is."""
    _call(on_change, settings, context)
    _call(on_wall_change, settings, context)


def material_changed(settings: PropertyGroup, context: Context) -> None:
    """The update function of a material's density."""
    _call(on_material_change, settings, context)


def _call(hooks: list[Hook], settings: PropertyGroup, context: Context) -> None:
    for hook in hooks:
        hook(settings, context)
