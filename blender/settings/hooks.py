# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions called when settings change, so that settings need not know the session: the session registers them."""

from __future__ import annotations

from collections.abc import Callable

from bpy.types import Context, PropertyGroup, Scene

Hook = Callable[[PropertyGroup, Context], None]

on_change: list[Hook] = []  # any setting of an object
on_density_change: list[Hook] = []  # an object's density or given mass, or the choice between them
on_wall_change: list[Hook] = []  # the side of a shell's material, or its thickness
on_threshold_change: list[Hook] = []  # the value from which on a grid's points are inside
on_default_density_change: list[Hook] = []  # the default of a scene's objects without density
on_part_change: list[Hook] = []  # the mass of an assembly or of a bone's part
LISTS = on_change, on_density_change, on_wall_change, on_threshold_change, on_default_density_change, on_part_change


def part_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of assemblies and of bones: Blender reports changes of their settings for no object."""
    _call(on_part_change, settings, context)


def changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of a changed setting of an object."""
    _call(on_change, settings, context)


def given_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of a changed given value of a part, an object or an assembly."""
    _call(on_change, settings, context)
    _call(on_part_change, settings, context)


def density_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of an object's changed density or mass."""
    _call(on_change, settings, context)
    _call(on_density_change, settings, context)


def wall_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of a shell's changed wall: its side or thickness."""
    _call(on_change, settings, context)
    _call(on_wall_change, settings, context)


def threshold_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of a grid's changed threshold."""
    _call(on_change, settings, context)
    _call(on_threshold_change, settings, context)


def default_density_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of a changed default density in a scene; the preferences have none."""
    if isinstance(settings.id_data, Scene):
        _call(on_default_density_change, settings, context)


def _call(hooks: list[Hook], settings: PropertyGroup, context: Context) -> None:
    for hook in hooks:
        hook(settings, context)
