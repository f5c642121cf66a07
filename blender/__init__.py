# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's side of the add-on: settings, reading, measured bodies, changes of the scene, session,
stored results.
"""

# The modules with the settings of objects, materials, scenes, assemblies, bones and liquids.
SETTINGS = ("settings.properties", "settings.scene", "settings.assembly", "settings.floating")
# The modules that are registered, in this order.
MODULES = (
    "write.translations",
    *SETTINGS,
    "session.selected",
    "session.tracking.handlers",
)
