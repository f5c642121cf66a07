# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/files`: what may be wrong with a file of any format."""

from ..verdict import error, note, warning

FILE_MISSING = error("file_missing", "No such file.")
FILE_TYPE = error("file_type", "Unsupported file type. Supported: {suffixes}.")
FILE_UNRECOGNIZED = error(
    "file_unrecognized", "This is no {format} file, or its header is damaged. Export it again."
)
FILE_DAMAGED = error(
    "file_damaged", "The file “{file}” is damaged: {cause}. Obtain it again, or export it again."
)
DAMAGE_CUT_SHORT = error("damage_cut_short", "it ends within its {part:word}")
DAMAGE_SIZE = error("damage_size", "it has {bytes} bytes of data, and its sizes require {total}")
DAMAGE_INCOMPLETE = error("damage_incomplete", "it is not a complete {kind:word} ({error})")
FILE_EXCEEDS_LIMIT = error(
    "file_exceeds_limit",
    "“{file}” exceeds a limit: {count} {name} of at most {limit}. If you trust the file, set the "
    "environment "
    "variable BODY_MOMENTS_LIMITS to {name}={next}.",
)
LIMITS_UNRECOGNIZED = error(
    "limits_unrecognized",
    "The environment variable BODY_MOMENTS_LIMITS has “{text}”, which is no limit. Use "
    "NAME=NUMBER, with a NAME "
    "of {names}.",
)
HEADER_FIELD = error(
    "header_field",
    "The {format} field “{field}” must be {wanted:word}, not “{text:.60s}”. Correct the header.",
)
NAMED_FILE_MISSING = error(
    "named_file_missing", "The file “{file:.80s}” is missing, which has the {content:word}."
)
OTHERS_LEFT_OUT = warning(
    "others_left_out", "The {kind:word} “{name}” was measured; left out: {others}."
)
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
MISSING_REFERENCES = error(
    "missing_references",
    "The file refers to what cannot be found: {names}. Restore these files, or make linked data "
    "local.",
)
XML_ENTITIES = error(
    "xml_entities",
    "The file declares a document type, with which entities could be declared. Remove it.",
)
