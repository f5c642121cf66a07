# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the buttons that apply measurements."""

from __future__ import annotations

from bpy.types import Context

from .. import rows
from ..places import in_both_places


class ApplyPanel:
    """Use the center of mass and the principal axes in the scene"""

    bl_label = "Apply to Object"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, obj = self.layout, context.object
        column = layout.column(align=True)
        rows.button(column, context, "object.body_moments_origin_to_center", "OBJECT_ORIGIN")
        rows.button(column, context, "object.body_moments_axes_to_principal", "EMPTY_AXIS")
        rows.button(column, context, "object.body_moments_align_to_world", "ORIENTATION_GLOBAL")
        column = layout.column(align=True)
        rows.button(column, context, "object.body_moments_add_empty", "OUTLINER_OB_EMPTY", text="Add Empty")
        rows.button(column, context, "view3d.body_moments_cursor_to_center", "PIVOT_CURSOR")
        rows.button(
            column, context, "object.body_moments_create_orientation", "ORIENTATION_LOCAL", text="Transform Orientation"
        )
        rows.button(column, context, "object.body_moments_rigid_bodies", "RIGID_BODY")
        text = "Set Rigid Body Mass" if obj.rigid_body else "Add Rigid Body with Mass"
        button = rows.button(column, context, "object.body_moments_set_rigid_body_mass", "RIGID_BODY", text=text)
        button.add = not obj.rigid_body
        rows.button(layout, context, "object.body_moments_add_nodes", "GEOMETRY_NODES")
        rows.button(layout, context, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")


CLASSES = VIEW3D_PT_body_moments_apply, OBJECT_PT_body_moments_apply = in_both_places(ApplyPanel, "apply")
