# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/export`."""

from ...core.verdict.finding import error, note, warning

ROBOT_EXPORTED = note("robot_exported", "{count} link exported to {file}.", "{count} links exported to {file}.")
ROBOT_SHEARED = warning(
    "robot_sheared", "Bodies must not be sheared. Apply the scale of the parents of {links} (Object > Apply > Scale)."
)
ROBOT_NAMES_ALIKE = error("robot_names_alike", "Blender gives {names} one name in USD. Rename one of them.")
ROBOT_GEOMETRY_NOT_WRITTEN = error("robot_geometry_not_written", "Blender's exporter failed: {error}.")
ROBOT_NOT_WRITTEN = error("robot_not_written", "The file cannot be written: {error}.")
ROBOT_COPIED = note("robot_copied", "Inertial of {count} link copied.", "Inertials of {count} links copied.")
PRIMITIVES_ADDED = note("primitives_added", "{count} shape added", "{count} shapes added")
PRIMITIVE_HAS_PARENT = error("primitive_has_parent", "It has a parent, or is linked. Clear the parent to simulate it.")
AUDIT_TEXT = note("audit_text", "See the text “{text}” in the Text Editor")
