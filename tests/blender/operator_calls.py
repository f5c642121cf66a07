# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators, each called once on the selection."""

import bpy

OPERATORS = {
    "measure": lambda: bpy.ops.object.body_moments_measure(),
    "clear": lambda: bpy.ops.object.body_moments_clear(),
    "faults": lambda: bpy.ops.object.body_moments_select_faults(),
    "origin": lambda: bpy.ops.object.body_moments_origin_to_center(),
    "axes": lambda: bpy.ops.object.body_moments_axes_to_principal(),
    "align": lambda: bpy.ops.object.body_moments_align_to_world(),
    "match": lambda: bpy.ops.object.body_moments_match_pose(),
    "empty": lambda: bpy.ops.object.body_moments_add_empty(),
    "cursor": lambda: bpy.ops.view3d.body_moments_cursor_to_center(),
    "rigid body": lambda: bpy.ops.object.body_moments_set_rigid_body_mass(add=True),
    "balance": lambda: bpy.ops.object.body_moments_sculpt_balance(
        target="POINT", point=(1.3, 1.0, 0.36)
    ),
    "symmetry": lambda: bpy.ops.object.body_moments_find_symmetry(),
    "similar": lambda: bpy.ops.object.body_moments_find_similar(),
    "setting": lambda: setattr(bpy.context.object.body_moments, "density", 500.0),
}
