# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions called after a change of a setting; the session registers them, so that settings need
not import it.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import chain

from bpy.types import Context, PropertyGroup, Scene

Hook = Callable[[PropertyGroup, Context], None]

on_change: list[Hook] = []  # any setting of an object
on_density_change: list[Hook] = []  # an object's density or given mass, or the choice between them
on_wall_change: list[Hook] = []  # the side of a shell's material, or its thickness
on_threshold_change: list[Hook] = []  # the value from which on a grid's points are inside
on_default_density_change: list[Hook] = []  # the default of a scene's objects without density
on_part_change: list[
    Hook
] = []  # the mass of an assembly or of a bone's part, which Blender reports for no object
LISTS = (
    on_change,
    on_density_change,
    on_wall_change,
    on_threshold_change,
    on_default_density_change,
    on_part_change,
)


def _update(*hooks: list[Hook]) -> Hook:
    def call(settings: PropertyGroup, context: Context) -> None:
        for hook in chain(*hooks):
            hook(settings, context)

    return call


changed = _update(on_change)
part_changed = _update(on_part_change)
density_changed = _update(on_change, on_density_change)
wall_changed = _update(on_change, on_wall_change)
threshold_changed = _update(on_change, on_threshold_change)
_call_default_density = _update(on_default_density_change)


def default_density_changed(settings: PropertyGroup, context: Context) -> None:
    """Call the hooks of a changed default density in a scene; the preferences have none."""
    if isinstance(settings.id_data, Scene):
        _call_default_density(settings, context)
