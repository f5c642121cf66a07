# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/streams`."""

from ..verdict.finding import error, note

DAMAGE_PLY_HEADER = error("damage_ply_header", "its header is not that of a PLY file")
DAMAGE_PLY_ROWS = error(
    "damage_ply_rows", "it ends, or has something else than numbers, before its {count} rows of “{name}” do"
)
DAMAGE_PLY_INDEX = error("damage_ply_index", "a face has a vertex that is not among its {vertices}")
FILE_WITHOUT_OBJECTS = error("file_without_objects", "No object in the file. Check that it is a {suffix} file.")
FILE_TYPE = error("file_type", "Unsupported file type. Supported: {suffixes}.")
FILE_UNREADABLE = error("file_unreadable", "The file cannot be read: {error}.")
NON_FINITE_COORDINATES = error(
    "non_finite_coordinates",
    "{count} number in the file is not finite (NaN or infinity), at {place}. Repair the file, or export it again.",
    "{count} numbers in the file are not finite (NaN or infinity), the first at {place}. Repair the file, or "
    "export it again.",
)
LINE_MISREAD = error("line_misread", "Line {line} would be misread: {cause}. Repair the file, or export it again.")
FIELD_NOT_NUMBER = note("field_not_number", "“{text}” is not a finite decimal number")
FIELD_NOT_WHOLE = note("field_not_whole", "“{text}” is not a whole number")
FIELD_NOT_VERTEX = note("field_not_vertex", "“{text}” refers to a vertex that is not there")
FIELD_NOT_WORD = note("field_not_word", "“{text}” stands in the place of “{expected}”")
FIELD_COUNT = note("field_count", "“{text}” has too few numbers or too many")
AT_VERTEX = note("at_vertex", "vertex {vertex}")
AT_TRIANGLE = note("at_triangle", "triangle {triangle}")
THREEMF_DAMAGED = error("threemf_damaged", "The 3MF file is damaged: {error}. Export it again.")
THREEMF_FIELD = error(
    "threemf_field", "The 3MF file has “{text}” in <{element}> on line {line}, which cannot be read. Export it again."
)
THREEMF_EXTENSION = error(
    "threemf_extension",
    "The 3MF file needs an extension that changes its shape and is not read: {name}. Export it as plain meshes.",
)
THREEMF_INSTANCES = error("threemf_instances", "The 3MF file places more than {limit} meshes. Join some of them.")
STL_SIZE = error("stl_size", "The STL file is cut short or damaged: its size does not match its number of triangles.")
STL_CUT_SHORT = error("stl_cut_short", "The STL file is cut short: “endsolid” is missing.")
PLY_CONCAVE_POLYGONS = error(
    "ply_concave_polygons",
    "{count} polygon of the PLY file is concave. Triangulate it, or import it with --stream never.",
    "{count} polygons of the PLY file are concave. Triangulate them, or import them with --stream never.",
)
FILE_WITHOUT_FACES = error("file_without_faces", "The file has no faces.")
