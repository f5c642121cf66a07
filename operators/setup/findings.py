# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/setup`."""

from ...core.verdict.finding import error, note

LIBRARY_OVERRIDE_SETTINGS = error(
    "library_override_settings",
    "A library override, which would lose its settings. Use Object > Relations > Make Local.",
)
MATERIAL_NOT_LOCAL = error("material_not_local", "No local material “{material}”. Make it local.")
RIGID_BODIES_MADE = note(
    "rigid_bodies_made",
    "{count} rigid body of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
    "{count} rigid bodies of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
)
NODE_GROUP_ADDED = note("node_group_added", "Added the node group “{group}”")
NODE_MARKER_ADDED = note("node_marker_added", "Added the node group “{group}” and the marker “{object}”")
NODE_MARKER_IS_OF_SOLID = note("node_marker_is_of_solid", "nodes take the object as a solid of one density")
NO_REVERSED_FACES = note("no_reversed_faces", "no faces were measured as reversed")
FACES_REVERSED = note("faces_reversed", "Reversed {count} face", "Reversed {count} faces")
MATERIAL_SET = note("material_set", "Set {count} object to {material}", "Set {count} objects to {material}")
MATERIAL_SET_ALREADY = note("material_set_already", "already set to {material}")
BLENDER_MATERIAL_SET = note("blender_material_set", "Set “{target}” to {material}")
SETTINGS_COPIED = note(
    "settings_copied", "Copied the settings to {count} object", "Copied the settings to {count} objects"
)
SETTINGS_EQUAL = note("settings_equal", "the settings are equal")
POLL_SELECT_OTHERS = note("poll_select_others", "Select other objects besides the active one")
