# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/rig`."""

from ...core.verdict.finding import error, note

BONES_MEASURED = note(
    "bones_measured",
    "{armature}: {mass:.7g} kg in the parts of {count} bone",
    "{armature}: {mass:.7g} kg in the parts of {count} bones",
)
PHYSICS_RIG_CREATED = note("physics_rig_created", "Rigid bodies created: {count}, joints: {joints}")
PHYSICS_RIG_TOO_LIGHT = error(
    "physics_rig_too_light",
    "Rigid bodies weigh {limit:.3g} kg at least, and these parts less: {names}. Scale the character, or set masses.",
)
RIG_CENTER_ADDED = note("rig_center_added", "Added the center of mass of “{armature}”, which follows its pose")
