# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/shape`."""

from ...core.verdict.finding import error, note, warning

MIRROR_IMAGE = error("mirror_image", "A mirror image of the active object, which no rotation can match.")
FLAT_MIRROR_IMAGE = error(
    "flat_mirror_image", "A mirror image of the active object, seen from the front. Turn it over, or mirror it."
)
FLAT_AND_BODY = error(
    "flat_and_body", "A flat shape and a body cannot match. Select objects of one kind, or set Kind to Shell."
)
LIBRARY_OVERRIDE_SYMMETRY = error(
    "library_override_symmetry",
    "A library override, which would lose its symmetry. Use Object > Relations > Make Local.",
)
ACTIVE_IS_CHILD = error(
    "active_is_child", "The active object is a child of this one and would move along. Clear the parent."
)
POSES_MATCHED = note("poses_matched", "Moved {count} object onto {object}", "Moved {count} objects onto {object}")
POSE_DISTANCE = note("pose_distance", "{object}: surfaces at most {maximum:length} apart, {mean:length} on average")
POSE_NOT_A_COPY = warning(
    "pose_not_a_copy",
    "{object}: surfaces at most {maximum:length} apart, {mean:length} on average; not a copy, or cut off",
)
SHAPES_COMPARED = note("shapes_compared", "Compared {count} shape", "Compared {count} shapes")
SHAPE_COUNTS = note("shape_counts", "{counts}")
SHAPES_COPY = note("shapes_copy", "{count} copy", "{count} copies")
SHAPES_SCALED_COPY = note("shapes_scaled_copy", "{count} scaled copy", "{count} scaled copies")
SHAPES_MIRROR = note("shapes_mirror", "{count} mirror image", "{count} mirror images")
SHAPES_SCALED_MIRROR = note("shapes_scaled_mirror", "{count} scaled mirror image", "{count} scaled mirror images")
SHAPES_COPY_OR_MIRROR = note("shapes_copy_or_mirror", "{count} copy or mirror image", "{count} copies or mirror images")
SHAPES_SCALED_COPY_OR_MIRROR = note(
    "shapes_scaled_copy_or_mirror", "{count} scaled copy or mirror image", "{count} scaled copies or mirror images"
)
SHAPES_SIMILAR = note("shapes_similar", "{count} similar")
NONE_SIMILAR = note("none_similar", "none is similar")
NEAREST_SHAPE = note("nearest_shape", "nearest is {object}, at {distance:.2e}")
OBJECT_NOT_IN_VIEW_LAYER = error("object_not_in_view_layer", "No object {object} in the view layer")
RECORDS_LEFT_OUT = warning("records_left_out", "Left out: {causes}")
LIBRARY_FILE_UNREADABLE = error("library_file_unreadable", "{file} cannot be read: {error}")
SYMMETRY_FOUND = note("symmetry_found", "{object}: {group}, {description}")
SYMMETRY_FOUND_OF_DISPLAY_MESH = note(
    "symmetry_found_of_display_mesh", "{object}: {group}, {description}, of the display mesh"
)
SYMMETRY_SEARCHED = note("symmetry_searched", "Searched {count} object", "Searched {count} objects")
SYMMETRY_SPHERE = note("symmetry_sphere", "sphere")
SYMMETRY_REVOLUTION = note("symmetry_revolution", "body of revolution")
SYMMETRY_REVOLUTION_REVERSIBLE = note("symmetry_revolution_reversible", "body of revolution, symmetric end to end")
SYMMETRY_AXES = note(
    "symmetry_axes", "{count} rotation axis, {order}-fold", "{count} rotation axes, up to {order}-fold"
)
SYMMETRY_PLANES = note("symmetry_planes", "{count} mirror plane", "{count} mirror planes")
SYMMETRY_INVERSION = note("symmetry_inversion", "center of inversion")
SYMMETRY_NONE = note("symmetry_none", "no symmetry")
CANCELED_SEARCH = note("canceled_search", "Search canceled; nothing was changed")
CANCELED_MATCH_POSE = note("canceled_match_pose", "Match Pose canceled; nothing was moved")
PROGRESS_COMPARING = note("progress_comparing", "Comparing: {share:.0%}. Esc to cancel")
PROGRESS_SYMMETRY = note("progress_symmetry", "Finding symmetry: {share:.0%}. Esc to cancel")
POLL_ACTIVE_WANTED = note("poll_active_wanted", "Make an object active to compare with")
POLL_MATCH_SELECTION = note("poll_match_selection", "Select the objects to move, then the object to match")
