# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/imports`."""

from ...core.verdict.finding import error, note, warning

SCAN_NON_FINITE = error("scan_non_finite", "Some samples are not finite. Remove them.")
SCAN_DRAWN_EVENLY = note(
    "scan_drawn_evenly",
    "Blender draws samples evenly. They are measured where they stand; the ends along {axes} are in their places.",
)
SCAN_CT_NUMBERS = note("scan_ct_numbers", "Negative values are taken as CT numbers, by the transfer table.")
SURFACES_IMPORTED = note(
    "surfaces_imported",
    "Imported {count} patch of order {order} from {file}.",
    "Imported {count} patches of order {order} at most from {file}.",
)
NOT_IMPORTED = warning("not_imported", "Not imported: {cause}")
NO_SURFACE_FILE = error("no_surface_file", "No file is chosen. Choose IGES or .obj files.")
VOLUME_NOT_WRITTEN = error("volume_not_written", "The volume cannot be written: {error}")
OPENVDB_MISSING = error("openvdb_missing", "This Python has no openvdb module. Use Blender.")
NO_IMPORT_FILE = error("no_import_file", "No file is chosen. Choose a scan.")
SCAN_IMPORTED = note("scan_imported", "Imported {samples:size} samples as “{file}”")
