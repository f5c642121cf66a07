# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/measure`."""

from ...core.verdict.finding import error, note, warning

FOURIER_FOLDER_MISSING = error(
    "fourier_folder_missing", "The folder “{folder}” does not exist. Choose another File Path."
)
FOURIER_PATH_MISSING = error("fourier_path_missing", "No file is chosen. Set File Path.")
MODIFIED_MESH = error(
    "modified_mesh",
    "Modifiers change the mesh, so its defects are not those of what is measured. Apply or hide {modifiers}.",
)
AXIS_NEEDS_TWO_POINTS = error(
    "axis_needs_two_points", "{count} points are selected. Select two vertices, or two objects."
)
REFERENCE_STORED = note(
    "reference_stored",
    "Stored the inertia of {count} object about the reference",
    "Stored the inertia of {count} objects about the reference",
)
STALE_UNIT_SCALE = warning("stale_unit_scale", "Unit scale changed")
MEASURED_ONE = note("measured_one", "Measured {object}")
MEASURED_ONE_WITH_WARNINGS = warning("measured_one_with_warnings", "Measured {object}, with warnings")
MEASURED_SEVERAL = note("measured_several", "Measured {count} of {total} objects")
WITH_WARNINGS = warning("with_warnings", "{count} with warnings: {objects}")
OBJECT_WARNINGS = warning("object_warnings", "{object}: {causes}")
MEASURED_SECTION = note("measured_section", "Measured the section of {object}")
MEASURED_SECTION_WITH_WARNINGS = warning(
    "measured_section_with_warnings", "Measured the section of {object}, with warnings"
)
MEASURED_SECTIONS = note("measured_sections", "Measured {count} section", "Measured {count} sections")
NO_DEFECTS = note("no_defects", "Measured {count} object: no defects", "Measured {count} objects: no defects")
WITH_DEFECTS = warning(
    "with_defects",
    "{count} of {total} measured objects has defects",
    "{count} of {total} measured objects have defects",
)
OBJECT_DEFECTS = warning("object_defects", "{object}: {defects}")
VALUE_COPIED = note("value_copied", "Copied {value}")
NO_VALUE_TO_COPY = warning("no_value_to_copy", "No value to copy")
CSV_COPIED = note("csv_copied", "Copied {count} row.", "Copied {count} rows.")
NUMBERS_SAVED = note("numbers_saved", "Saved {count} object to “{file}”.", "Saved {count} objects to “{file}”.")
NUMBERS_SUFFIX = error(
    "numbers_suffix", "The format of “{file}” is unknown. Let its name end in .csv, .json or .jsonl."
)
REPORT_COPIED = note("report_copied", "Copied the report of {count} object", "Copied the report of {count} objects")
SECTION_COPIED = note("section_copied", "Copied the section of {object}")
MOMENTS_COMPUTED = note("moments_computed", "Computed {count} moments of {object}")
MOMENTS_COPIED = note("moments_copied", "Copied {count} moments")
WIRE_WITHOUT_MOMENTS = warning(
    "wire_without_moments",
    "{object}: a wire has no volume or surface. Set Kind to Solid or Shell; measure --order gives moments of length.",
)
FOURIER_WRITTEN = note(
    "fourier_written", "Wrote {count} frequencies to {file}; the image {image} shows slices of their magnitude"
)
CANCELED_FOURIER = note("canceled_fourier", "Fourier transform canceled; nothing was written")
PROGRESS_LIBRARY = note("progress_library", "Measuring the library: {share:.0%}. Esc to stop")
CANCELED_LIBRARY = warning("canceled_library", "Stopped. The files measured so far stand in the journal")
LIBRARY_NOT_STARTED = error("library_not_started", "No process can be started: {error}.")
LIBRARY_FAILED = error(
    "library_failed", "Measuring the library failed with exit code {code}. Use the command line to see why."
)
LIBRARY_MEASURED = note(
    "library_measured", "{count} file measured; report: {file}", "{count} files measured; report: {file}"
)
LIBRARY_MEASURED_WITH_FAILURES = warning(
    "library_measured_with_failures",
    "{count} file measured, {failed} without a result; report: {file}",
    "{count} files measured, {failed} of them not or not fully; report: {file}",
)
PROGRESS_FOURIER = note("progress_fourier", "Fourier transform: {share:.0%}. Esc to cancel")
POLL_SELECT_MESHES = note("poll_select_meshes", "Select mesh objects")
POLL_MEASURE_SELECTED = note("poll_measure_selected", "Measure the selected objects first")
POLL_MEASURE_SECTION = note("poll_measure_section", "Measure a section first")
POLL_COMPUTE_MOMENTS = note("poll_compute_moments", "Compute the moments first")
POLL_ACTIVE_SURFACE = note("poll_active_surface", "Make an object with a surface active")
POLL_SECTION = note("poll_section", "Select faces in Edit Mode, or a flat mesh, 2D curve or text")
PANEL_FOURIER_DEFAULT = note("panel_fourier_default", "0 rad/m: from the object's size")
