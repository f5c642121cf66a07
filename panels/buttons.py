# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons that apply what was measured."""

from __future__ import annotations

from bpy.types import Object, UILayout


def actions(layout: UILayout, obj: Object) -> None:
    header, body = layout.panel("body_moments_snap", default_closed=False)
    header.label(text="Apply to Object")
    if body is None:
        return
    column = body.column(align=True)
    column.operator("object.body_moments_origin_to_center", icon="OBJECT_ORIGIN")
    column.operator("object.body_moments_axes_to_principal", icon="EMPTY_AXIS")
    column.operator("object.body_moments_align_to_world", icon="ORIENTATION_GLOBAL")
    column = body.column(align=True)
    column.operator("object.body_moments_add_empty", text="Add Empty", icon="OUTLINER_OB_EMPTY")
    column.operator("view3d.body_moments_cursor_to_center", icon="PIVOT_CURSOR")
    column.operator(
        "object.body_moments_create_orientation",
        text="Transform Orientation",
        icon="ORIENTATION_LOCAL",
    )
    text = "Set Rigid Body Mass" if obj.rigid_body else "Add Rigid Body with Mass"
    column.operator("object.body_moments_set_rigid_body_mass", text=text, icon="RIGID_BODY").add = not obj.rigid_body
    body.operator("object.body_moments_sculpt_balance", icon="SCULPTMODE_HLT")


def analysis(layout: UILayout) -> None:
    header, body = layout.panel("body_moments_analysis", default_closed=True)
    header.label(text="Analysis")
    if body is not None:
        body.operator("object.body_moments_fourier", text="Fourier Transform...", icon="MOD_WAVE")
