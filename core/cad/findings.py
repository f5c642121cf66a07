# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/cad`."""

from ..verdict.finding import error, note, warning

IGES_UNRECOGNIZED = error(
    "iges_unrecognized", "Not an IGES file in fixed ASCII form: a line has no section in column 73."
)
IGES_NOT_ASCII = error("iges_not_ascii", "The IGES file is binary or compressed. Save it in fixed ASCII form.")
IGES_DAMAGED = error("iges_damaged", "The IGES file is damaged: {cause}. Export it again.")
IGES_GLOBAL_SECTION = note("iges_global_section", "its global section is not complete or not possible")
IGES_DIRECTORY = note("iges_directory", "its directory entry {number} is not two lines of whole numbers")
IGES_UNIT = error("iges_unit", "The IGES file has the unknown unit “{unit}”. Export it in millimeters or meters.")
OBJ_CALL = error("obj_call", "The file runs another one by “call”, which is not followed. Insert the other file.")
SURFACE_FILE_TYPE = error("surface_file_type", "Unsupported file type. Supported files of surfaces: {suffixes}.")
FILE_WITHOUT_SURFACES = error(
    "file_without_surfaces", "The file has no B-spline surfaces. Export surfaces, or import a mesh."
)
NO_SURFACE_KEPT = error("no_surface_kept", "No surface of the file can be kept: {causes}")
TOO_MANY_SURFACES = error("too_many_surfaces", "The file places more than {limit} surfaces. Export fewer at a time.")
TOO_MANY_CONTROL_POINTS = error(
    "too_many_control_points", "The file's surfaces need more than {limit} control points. Export fewer at a time."
)
SURFACE_TRIMMED = warning(
    "surface_trimmed",
    "Not imported, because it is trimmed: {kind} {names}. Untrim it, or export a mesh.",
    "Not imported, because they are trimmed: {count} of the kind {kind}: {names}. Untrim them, or export a mesh.",
)
SURFACE_TYPE_UNSUPPORTED = warning(
    "surface_type_unsupported",
    "Not imported, because Blender's surfaces cannot be it: {kind} {names}. Convert it to a B-spline surface, or "
    "export a mesh.",
    "Not imported, because Blender's surfaces cannot be them: {count} of the kind {kind}: {names}. Convert them to "
    "B-spline surfaces, or export a mesh.",
)
SURFACE_OF_UNSUPPORTED = warning(
    "surface_of_unsupported",
    "Not imported, because Blender's surfaces cannot be “{base}”: {kind} {names}. Convert it to a B-spline "
    "surface, or export a mesh.",
    "Not imported, because Blender's surfaces cannot be “{base}”: {count} of the kind {kind}: {names}. Convert "
    "them to B-spline surfaces, or export a mesh.",
)
SURFACE_ORDER = warning(
    "surface_order",
    "Not imported, because its order is {order}, and {limit} is the highest: {kind} {names}. Lower its degree, or "
    "export a mesh.",
    "Not imported, because their order is {order}, and {limit} is the highest: {count} of the kind {kind}: "
    "{names}. Lower their degree, or export a mesh.",
)
SURFACE_TOO_LARGE = warning(
    "surface_too_large",
    "Not imported, because it needs {points} control points, and {limit} is the limit: {kind} {names}. Split it.",
    "Not imported, because they need {points} control points each, and {limit} is the limit: {count} of the kind "
    "{kind}: {names}. Split them.",
)
SURFACE_POINTS = warning(
    "surface_points",
    "Not imported: {kind} {names}. {cause}",
    "Not imported: {count} of the kind {kind}: {names}. {cause}",
)
SURFACE_DAMAGED = warning(
    "surface_damaged",
    "Not imported, because its numbers are missing or not possible: {kind} {names}. Export it again.",
    "Not imported, because their numbers are missing or not possible: {count} of the kind {kind}: {names}. Export "
    "them again.",
)
SURFACE_RECURSIVE = warning(
    "surface_recursive",
    "Not imported, because it refers to itself, or too deeply: {kind} {names}. Export it again.",
    "Not imported, because they refer to themselves, or too deeply: {count} of the kind {kind}: {names}. Export "
    "them again.",
)
SURFACE_FLATTENED = warning(
    "surface_flattened",
    "Not imported, because its transformation flattens it: {kind} {names}. Export it again.",
    "Not imported, because their transformations flatten them: {count} of the kind {kind}: {names}. Export them again.",
)
SURFACES_HIDDEN = note(
    "surfaces_hidden", "{count} hidden surface was left out.", "{count} hidden surfaces were left out."
)
CURVES_LEFT_OUT = note(
    "curves_left_out",
    "{count} curve or point, which bounds nothing, was left out.",
    "{count} curves and points, which bound nothing, were left out.",
)
