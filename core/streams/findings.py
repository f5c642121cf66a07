# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/streams`."""

from ..verdict.finding import error, note

FILE_UNREADABLE = error("file_unreadable", "The file cannot be read: {error}.")
FILE_WITHOUT_OBJECTS = error(
    "file_without_objects",
    "No {content:word} in the file. Check that it is of the type that its name says.",
)
FILE_TOO_LARGE = error(
    "file_too_large", "The file has more than {limit} {content:word}. Export less at a time."
)
NON_FINITE_COORDINATES = error(
    "non_finite_coordinates",
    "{count} number in the file is not finite (NaN or infinity), at {place}. Repair the file, or "
    "export it again.",
    "{count} numbers in the file are not finite (NaN or infinity), the first at {place}. Repair "
    "the file, or "
    "export it again.",
)
AT_ROW = note("at_row", "{element:word} {row}")
LINE_MISREAD = error(
    "line_misread",
    "Line {line} would be misread: it has “{text}” in the place of {expected:word}. Repair the "
    "file, or export it "
    "again.",
)
DAMAGE_PLY_ROWS = error(
    "damage_ply_rows",
    "it ends, or has something else than numbers, before its {count} rows of “{name}” do",
)
DAMAGE_INDEX = error("damage_index", "a face has a vertex that is not among its {vertices}")
STL_CUT_SHORT = error(
    "stl_cut_short", "The STL file is cut short or damaged: it does not end {end:word}."
)
THREEMF_EXTENSION = error(
    "threemf_extension",
    "The 3MF file needs an extension that changes its shape and is not read: {name}. Export it as "
    "plain meshes.",
)
