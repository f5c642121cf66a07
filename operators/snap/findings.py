# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/snap`."""

from ...core.verdict.finding import error, note, warning

SCALE_ZERO_AXIS_OF_PARENT_TARGET = error(
    "scale_zero_axis_of_parent_target", "The scale is zero along an axis. Set the scale, or turn off Parent to Object."
)
EMPTY_FOLLOWED = error(
    "empty_followed", "The object follows its empty “{empty}” and would move along. Clear that parent or constraint."
)
EMPTY_CONSTRAINED = error("empty_constrained", "A constraint holds the empty “{empty}”. Remove it.")
NOT_A_RIGID_BODY = error("not_a_rigid_body", "Not a rigid body. Turn on Add Rigid Bodies.")
RIGID_BODY_CENTER_ELSEWHERE = warning(
    "rigid_body_center_elsewhere",
    "Physics uses the origin as center of mass, which differs for {objects}. Use Axes to Principal Axes.",
)
BALANCE_NO_SELECTION = error("balance_no_selection", "No vertex is selected. Select the vertices that may move.")
BALANCE_NO_GROUP = error("balance_no_group", "No vertex group “{group}”. Choose one in Vertex Group.")
BALANCE_NO_ACTIVE_GROUP = error("balance_no_active_group", "No vertex group. Add one with the vertices that may move.")
BALANCE_GROUP_EMPTY = error(
    "balance_group_empty", "No vertex has a weight in the vertex group “{group}”. Assign the vertices that may move."
)
BALANCE_TRIANGULATION_VARIES = error(
    "balance_triangulation_varies", "The triangulation changes with every move. Use Face > Triangulate Faces."
)
BALANCE_LINKED_MESH = error("balance_linked_mesh", "The mesh is linked from another file. Make it local.")
BALANCE_SHAPE_KEYS = error("balance_shape_keys", "The mesh has shape keys. Apply or remove them.")
BALANCE_WALL = error("balance_wall", "Balancing needs a thin shell. Set Wall to Thin.")
BALANCE_VARYING_DENSITY = error(
    "balance_varying_density", "Balancing needs uniform density. Set Density From to One Value."
)
BALANCE_UNCLEAN = error(
    "balance_unclean",
    "The mesh is not closed with all faces outward. Merge by distance, fill holes and recalculate normals, or"
    " set Kind to Shell.",
)
BALANCE_ZERO_SCALE = error("balance_zero_scale", "A zero scale flattens the object. Set the scale.")
BALANCE_INSTANCES = error("balance_instances", "The object shows instances. Use Object > Apply > Make Instances Real.")
BALANCE_MODIFIED = error("balance_modified", "The measured shape is made by {modifiers}. Apply or hide them.")
BALANCE_MODIFIED_UNKNOWN = error(
    "balance_modified_unknown", "The measured shape is made by animation, constraints or instances. Apply them."
)
BALANCE_MESH_SHARED = note("balance_mesh_shared", "Other objects use this mesh and changed too.")
BALANCE_ONLY_ACTIVE = note(
    "balance_only_active", "Only “{object}” was balanced; the other meshes in Edit Mode are unchanged."
)
ORIENTATION_NEEDS_VIEWPORT = warning("orientation_needs_viewport", "A transform orientation needs an open 3D Viewport.")
ALIGNED_TO_WORLD = note(
    "aligned_to_world", "Aligned {count} object to the world axes", "Aligned {count} objects to the world axes"
)
ALREADY_ALIGNED = note("already_aligned", "already aligned")
CURSOR_MOVED = note(
    "cursor_moved",
    "Moved the 3D cursor to the center of mass of {count} object",
    "Moved the 3D cursor to the center of mass of {count} objects",
)
EMPTIES_PLACED = note(
    "empties_placed",
    "Placed an empty at the principal frame of {count} object",
    "Placed empties at the principal frames of {count} objects",
)
EMPTIES_IN_PLACE = note("empties_in_place", "the empties are in place")
ORIGINS_MOVED = note(
    "origins_moved",
    "Moved the origin of {count} object to the center of mass",
    "Moved the origins of {count} objects to the center of mass",
)
AXES_MADE_PRINCIPAL = note(
    "axes_made_principal",
    "Aligned the axes of {count} object to its principal axes",
    "Aligned the axes of {count} objects to their principal axes",
)
ALREADY_IN_PLACE = note("already_in_place", "already in place")
ORIENTATION_CREATED = note("orientation_created", "Created the transform orientation “{name}”")
RIGID_BODY_MASSES_SET = note(
    "rigid_body_masses_set", "Set the rigid body mass of {count} object", "Set the rigid body mass of {count} objects"
)
RIGID_BODY_MASSES_EQUAL = note("rigid_body_masses_equal", "the masses are equal")
BALANCED = note(
    "balanced",
    "Moved {count} vertex by at most {distance:length}; the center of mass went from {start:point} to {end:point}",
    "Moved {count} vertices by at most {distance:length}; the center of mass went from {start:point} to {end:point}",
)
POLL_ACTIVE_SELECTED = note("poll_active_selected", "Make an object active and select it")
POLL_EDIT_VERTICES = note("poll_edit_vertices", "Switch to Edit Mode and select the vertices that may move")
POLL_VERTICES_OR_GROUP = note(
    "poll_vertices_or_group", "Select the vertices that may move in Edit Mode, or add a vertex group"
)
