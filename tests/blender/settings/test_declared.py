# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings as they are declared: names, ranges, units, defaults, choices, and the hooks that they call."""

import bpy

from tests.blender import declared


def test_settings_are_declared_as_they_are_kept(registered, kept):
    groups = declared.text(bpy.types.PropertyGroup, "operators")
    kept("settings.txt", "\n".join([*declared.pointers("operators"), groups]))
    kept("preferences.txt", declared.text(bpy.types.AddonPreferences, "operators"))
