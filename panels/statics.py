# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of stability: the object's standing state, margin, tipping angle, and resting
poses.
"""

from __future__ import annotations

from math import atan2, degrees
from typing import TYPE_CHECKING

from bpy.types import Context, Object, UILayout

from ..blender.read.visibility import measurable
from ..blender.scale import meters_per_unit
from ..blender.session import stored
from ..blender.session.displayed import shown_objects
from ..blender.session.selected import subject
from ..blender.session.tracking import armatures
from ..core.lazy import loaded_module
from ..core.verdict import Finding
from . import rows
from .places import in_both_places

if TYPE_CHECKING:
    from ..core.statics import Support

MAX_POSES = 6  # limit of the list: round bodies have thousands


class StabilityPanel:
    """Whether the object stands on the ground below it, and the poses in which it rests"""

    bl_label = "Stability"

    def draw(self, context: Context) -> None:
        layout = self.layout
        objects = shown_objects(context)
        obj = objects[0] if len(objects) == 1 else subject(context)
        stability = loaded_module(stored, "stability")
        is_known = stability is not None and obj is not None and stability.is_known(obj)
        support = stability.support(obj, context.scene) if is_known else None
        tips_over_edge = support is not None and not support.stands and len(support.polygon) > 2
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_stability", "CON_FLOOR", short="Check")
        row = column.row(align=True)
        row.enabled = tips_over_edge
        balance = rows.button(row, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")
        if tips_over_edge:
            edge = support.foot + support.margin * support.direction
            balance.target = "POINT"
            balance.point = (edge + support.polygon.mean(axis=0)) / 2.0
        rows.button(
            column, "object.body_moments_balance_group", "CON_FOLLOWPATH", text="Follow Center..."
        )
        if support is not None:
            _support(layout, context, support)
            _poses(layout, context, obj)
        elif is_known:
            rows.remark(layout, "The geometry has changed. Check again.", icon="FILE_REFRESH")
        else:
            rows.remark(layout, "Stability has not been computed.")


def _support(layout: UILayout, context: Context, support: Support) -> None:
    unit = meters_per_unit(context.scene)
    column = layout.column(align=True)
    if support.stands:
        column.label(text="Stands", icon="CHECKMARK")
    else:
        column.label(text="Tips Over", icon="ERROR")
        if len(support.polygon) < 3:
            text = (
                "It touches the ground along an edge or at a corner, on which nothing stands: "
                "there is no area to balance over. Lay it on a face with Rest on Ground."
            )
            rows.remark(column, text)
    margin = support.margin * unit
    angle = degrees(support.tipping_angle)
    toward = degrees(atan2(support.direction[1], support.direction[0]))
    rows.table(
        column,
        [
            ("Margin", rows.scene_units().text("length", margin), repr(margin), "m"),
            ("Tipping Angle", _degrees(angle), repr(angle), "°"),
            ("Toward, from X", _degrees(toward), repr(toward), "°"),
        ],
    )


def _degrees(angle: float) -> str:
    return "{:.2f}°".format(round(angle, 2) + 0.0).replace("-", "−")


def _poses(layout: UILayout, context: Context, obj: Object) -> None:
    poses = stored.stability.poses(obj, context.scene)
    layout.label(text="Resting Poses")
    if isinstance(poses, Finding):
        rows.message(layout, poses)
    if poses is None or isinstance(poses, Finding):
        return
    narrow = rows.is_narrow()
    column = layout.column(align=True)
    heading = column.row()
    heading.label(text="Share" if narrow else "Probability")
    cell = heading.row()
    cell.alignment = "RIGHT"
    cell.label(text="Tips at")
    if not narrow:
        cell.label(icon="BLANK1")
    for place, (share, angle) in enumerate(zip(poses.shares[:MAX_POSES], poses.tipping_angles)):
        row = column.row(align=True)
        number = "" if narrow else "{:d}: ".format(place + 1)
        row.label(text="{:s}{:.1f}%".format(number, 100.0 * share), translate=False)
        rows.right(row, "{:.1f}°".format(degrees(angle)))
        row.operator("object.body_moments_rest_on_ground", text="", icon="TRIA_DOWN_BAR").pose = (
            place + 1
        )
    more = len(poses.tipping_angles) - MAX_POSES
    if more > 0:
        rows.filled(column, "{:d} more", more)
    rows.button(
        layout, "object.body_moments_rest_on_ground", "TRIA_DOWN_BAR", short="Rest"
    ).pose = 1


CLASSES = in_both_places(
    StabilityPanel,
    "stability",
    shown_for=lambda obj: measurable(obj) or armatures.stands_for_meshes(obj),
    of_all=True,
)
