# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of stability: whether the object stands, margin and tipping angle, the poses in which it rests."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object, UILayout

from ..core.numerics.float32 import shortest_decimal
from ..core.statics.resting import RestingPoses
from ..core.statics.support import Support
from ..core.verdict.finding import Finding, finding
from ..operators.session import stability
from ..operators.write.units import Units
from . import rows
from .places import in_both_places

MAX_POSES = 6  # that are listed: round bodies have thousands


class StabilityPanel:
    """Whether the object stands on the ground below it, and the poses in which it rests"""

    bl_label = "Stability"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, obj = self.layout, context.object
        layout.use_property_decorate = False
        if not stability.is_known(obj):
            rows.message(layout, context, finding("panel_stability_unknown"))
        elif stability.is_stale(obj):
            rows.message(layout, context, finding("panel_stability_stale"), icon="FILE_REFRESH")
        layout.operator("object.body_moments_stability", icon="CON_FLOOR")
        support = stability.support(obj, context.scene)
        if support is not None:
            _support(layout, context, support)
            _poses(layout, context, obj)
        layout.operator("object.body_moments_balance_group", text="Balance Group...", icon="CON_FOLLOWPATH")


def _support(layout: UILayout, context: Context, support: Support) -> None:
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    column = layout.column(align=True)
    if support.stands:
        column.label(text="Stands", icon="CHECKMARK")
    else:
        column.label(text="Tips Over", icon="ERROR")
    rows.value(column, Units.of(context.scene.unit_settings), "Margin", "length", support.margin * unit)
    angle = float(np.degrees(support.tipping_angle))
    rows.texts(column, "Tips at", "{:.2f}°".format(angle).replace("-", "−"), repr(angle), "°")
    toward = float(np.degrees(np.arctan2(support.direction[1], support.direction[0])))
    rows.texts(column, "Toward", "{:.1f}° (X → Y)".format(toward + 0.0).replace("-", "−"), repr(toward), "°")


def _poses(layout: UILayout, context: Context, obj: Object) -> None:
    poses = stability.poses(obj, context.scene)
    layout.label(text="Resting Poses")
    if isinstance(poses, Finding):
        rows.message(layout, context, poses)
    if not isinstance(poses, RestingPoses):
        return
    column = layout.column(align=True)
    heading = column.row()
    heading.label(text="Probability")
    cell = heading.row()
    cell.alignment = "RIGHT"
    cell.label(text="Tips at")
    cell.label(icon="BLANK1")
    angles = np.degrees(poses.tipping_angles)
    for place, (share, angle) in enumerate(zip(poses.shares[:MAX_POSES], angles)):
        row = column.row(align=True)
        row.label(text="{:d}: {:.1f}%".format(place + 1, 100.0 * share), translate=False)
        cell = row.row(align=True)
        cell.alignment = "RIGHT"
        cell.label(text="{:.1f}°".format(angle), translate=False)
        row.operator("object.body_moments_rest_on_ground", text="", icon="TRIA_DOWN_BAR").pose = place + 1
    if len(angles) > MAX_POSES:
        rows.filled(column, "{:d} more", len(angles) - MAX_POSES)
    layout.operator("object.body_moments_rest_on_ground", icon="TRIA_DOWN_BAR").pose = 1


CLASSES = VIEW3D_PT_body_moments_stability, OBJECT_PT_body_moments_stability = in_both_places(
    StabilityPanel, "stability"
)
