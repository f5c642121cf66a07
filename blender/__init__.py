# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender in, Blender out: settings, reading, bodies, changes of the scene, the session and stored results."""

# The modules with the settings of objects, materials, scenes, assemblies and bones.
SETTINGS = ("settings.properties", "settings.scene", "settings.assembly")
# The modules that are registered, in this order.
MODULES = (
    "write.translations",
    *SETTINGS,
    "session.tracking.handlers",
)
