# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the buttons that apply what was measured."""

from __future__ import annotations

from bpy.types import Context

from .places import in_both_places


class ApplyPanel:
    """Use the center of mass and the principal axes in the scene"""

    bl_label = "Apply to Object"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, obj = self.layout, context.object
        column = layout.column(align=True)
        column.operator("object.body_moments_origin_to_center", icon="OBJECT_ORIGIN")
        column.operator("object.body_moments_axes_to_principal", icon="EMPTY_AXIS")
        column.operator("object.body_moments_align_to_world", icon="ORIENTATION_GLOBAL")
        column = layout.column(align=True)
        column.operator("object.body_moments_add_empty", text="Add Empty", icon="OUTLINER_OB_EMPTY")
        column.operator("view3d.body_moments_cursor_to_center", icon="PIVOT_CURSOR")
        column.operator(
            "object.body_moments_create_orientation",
            text="Transform Orientation",
            icon="ORIENTATION_LOCAL",
        )
        text = "Set Rigid Body Mass" if obj.rigid_body else "Add Rigid Body with Mass"
        button = column.operator("object.body_moments_set_rigid_body_mass", text=text, icon="RIGID_BODY")
        button.add = not obj.rigid_body
        layout.operator("object.body_moments_add_nodes", icon="GEOMETRY_NODES")
        layout.operator("object.body_moments_sculpt_balance", icon="SCULPTMODE_HLT")


CLASSES = VIEW3D_PT_body_moments_apply, OBJECT_PT_body_moments_apply = in_both_places(ApplyPanel, "apply")
