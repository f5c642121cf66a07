# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings call when they change, so that they need not know who remembers results: the session registers it."""

from __future__ import annotations

from collections.abc import Callable

from bpy.types import Context, PropertyGroup

Hook = Callable[[PropertyGroup, Context], None]

on_wall_change: list[Hook] = []  # the side of a shell's material, or its thickness


def wall_changed(settings: PropertyGroup, context: Context) -> None:
    """The update function of the settings that say where the material of a shell is."""
    for hook in on_wall_change:
        hook(settings, context)
