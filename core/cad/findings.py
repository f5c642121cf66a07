# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/cad`."""

from ..verdict import error, note, warning

IGES_DAMAGED = error(
    "iges_damaged",
    "The IGES file is damaged: its {section:word} has “{text}”, which is not complete or not "
    "possible. Export it "
    "again.",
)
NO_SURFACE_KEPT = error("no_surface_kept", "No surface of the file can be kept: {causes}")
SURFACE_TRIMMED = warning(
    "surface_trimmed",
    "Not imported, because it is trimmed: {kind} {names}. Untrim it, or export a mesh.",
    "Not imported, because they are trimmed: {count} of the kind {kind}: {names}. Untrim them, or "
    "export a mesh.",
)
SURFACE_UNSUPPORTED = warning(
    "surface_unsupported",
    "Not imported, because “{base}” cannot be read: {kind} {names}. Convert it to a B-spline "
    "surface, or export a mesh.",
    "Not imported, because “{base}” cannot be read: {count} of the kind {kind}: {names}. Convert "
    "them to B-spline surfaces, or export a mesh.",
)
SURFACE_BEYOND_LIMIT = warning(
    "surface_beyond_limit",
    (
        "Not imported, because its {quantity:word} is {value}, and {limit} is the "
        "highest: {kind} {names}. Lower its degree, split it, or export a mesh."
    ),
    (
        "Not imported, because the {quantity:word} of each is {value}, and {limit} is "
        "the highest: {count} {kind} {names}. Lower their degrees, split them, or export "
        "meshes."
    ),
)
SURFACE_POINTS = warning(
    "surface_points",
    "Not imported: {kind} {names}. {cause}",
    "Not imported: {count} of the kind {kind}: {names}. {cause}",
)
SURFACE_DAMAGED = warning(
    "surface_damaged",
    "Not imported, because of {fault:word}: {kind} {names}. Export it again.",
    "Not imported, because of {fault:word}: {count} of the kind {kind}: {names}. Export them "
    "again.",
)
FACES_NOT_READ = warning(
    "faces_not_read",
    "{count} face was not read, so the body is not the whole of the file; the file's errors name "
    "it.",
    "{count} faces were not read, so the body is not the whole of the file; the file's errors name "
    "them.",
)
SURFACES_HIDDEN = note(
    "surfaces_hidden",
    "{count} hidden shape was left out.",
    "{count} hidden shapes were left out.",
)
CURVES_LEFT_OUT = note(
    "curves_left_out",
    "{count} curve or point, which bounds nothing, was left out.",
    "{count} curves and points, which bound nothing, were left out.",
)
