# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators`."""

from ..core.verdict.finding import error, note, warning

LIBRARY_OVERRIDE_MASS = error(
    "library_override_mass",
    "A library override, which would lose its rigid body mass. Use Object > Relations > Make Local.",
)
RIGID_BODY_NEEDS_MESH = error("rigid_body_needs_mesh", "Only meshes can be rigid bodies. Use Object > Convert > Mesh.")
RIGID_BODY_MASS_TOO_SMALL = error(
    "rigid_body_mass_too_small", "The mass {mass:.3g} kg is below the {limit:.3g} kg of a rigid body. Raise Density."
)
RIGID_BODY_DISPLAY_SCALED = note(
    "rigid_body_display_scaled",
    "Physics properties show masses times {factor:.6g} (unit scale cubed); the physics engine uses kilograms.",
)
FILE_EXISTS = error("file_exists", "The file “{file}” exists. Turn on Overwrite.")
NO_EXPORT_FILE = error("no_export_file", "No file is named. Choose one.")
FILE_NOT_WRITTEN = error("file_not_written", "The file cannot be written: {error}")
NOTHING_MEASURABLE = note("nothing_measurable", "Nothing selected can be measured")
NOTHING_TO_DO = note("nothing_to_do", "Nothing to do: {cause}")
LEFT_UNCHANGED = warning("left_unchanged", "{count} of {total} left unchanged: {causes}")
RESULTS_REMOVED = note(
    "results_removed", "Removed the results of {count} object", "Removed the results of {count} objects"
)
NO_RESULTS_TO_REMOVE = note("no_results_to_remove", "The selected objects have no results")
CANCELED_MEASURING = note("canceled_measuring", "Measuring canceled; nothing was changed")
PROGRESS_MEASURING = note("progress_measuring", "Measuring: {share:.0%}. Esc to cancel")
POLL_OBJECT_MODE = note("poll_object_mode", "Switch to Object Mode")
POLL_SELECT_OBJECTS = note("poll_select_objects", "Select objects")
POLL_ACTIVE_MEASURABLE = note("poll_active_measurable", "Make a measurable object active")
POLL_ACTIVE_MESH = note("poll_active_mesh", "Make a mesh object active")
