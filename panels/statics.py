# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of stability: the object's standing state, margin, tipping angle, and resting
poses.
"""

from __future__ import annotations

from math import atan2, degrees

from bpy.types import Context, UILayout

from ..blender import read, scale, session, write
from ..core import statics, verdict
from . import places, rows, texts

MAX_POSES = 6  # limit of the list: round bodies have thousands


class StabilityPanel:
    """Whether the object stands on the ground below it, and the poses in which it rests"""

    bl_label = "Stability"

    def draw(self, context: Context) -> None:
        layout = self.layout
        objects = session.displayed.shown_objects(context)
        obj = objects[0] if len(objects) == 1 else session.selected.subject(context)
        is_known = obj is not None and obj in session.memory.hulls
        support = session.stored.stability.support(obj, context.scene) if is_known else None
        tips_over_edge = support is not None and not support.stands and len(support.polygon) > 2
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_stability", "CON_FLOOR", short="Check")
        row = column.row(align=True)
        row.enabled = tips_over_edge
        balance = rows.button(row, "object.body_moments_sculpt_balance", "SCULPTMODE_HLT")
        if tips_over_edge:
            # halfway from the foot's nearest point of the edge to the middle of the polygon
            edge = support.foot + support.margin * support.direction
            balance.target = "POINT"
            balance.point = (edge + support.polygon.mean(axis=0)) / 2.0
        if obj is not None and obj.body_moments.kind == "PRINTED":
            rows.button(column, "object.body_moments_make_it_stand", "MOD_THICKNESS")
        rows.button(
            column, "object.body_moments_balance_group", "CON_FOLLOWPATH", text="Follow Center..."
        )
        rest = rows.button(
            column, "object.body_moments_rest_on_ground", "TRIA_DOWN_BAR", short="Rest"
        )
        rest.pose = 1
        _support(layout, context, support, is_known)
        _poses(
            layout,
            session.stored.stability.poses(obj, context.scene) if support is not None else None,
        )


def _support(
    layout: UILayout, context: Context, support: statics.Support | None, is_known: bool
) -> None:
    """Draw the standing state, margin and angles, in as many rows before they are known."""
    cells = [(name, "–", "", "") for name in ("Margin", "Tipping Angle", "Toward, from X")]
    column = layout.column(align=True)
    if support is None:
        text = "Changed since: check again" if is_known else "Not checked yet"
        texts.state(
            column, write.translations.localized(text), "FILE_REFRESH" if is_known else "INFO"
        )
    elif support.stands:
        texts.state(column, write.translations.localized("Stands"), "CHECKMARK")
    else:
        is_on_area = len(support.polygon) > 2
        text = "Tips Over" if is_on_area else "On an edge or corner: lay it down"
        texts.state(column, write.translations.localized(text), "ERROR")
    if support is not None:
        margin = support.margin * scale.meters_per_unit(context.scene)
        toward = atan2(support.direction[1], support.direction[0])
        cells = [
            rows.quantity_cell("Margin", "length", margin),
            rows.angle_cell("Tipping Angle", support.tipping_angle),
            rows.angle_cell("Toward, from X", toward),
        ]
    rows.table(column, cells)


def _poses(layout: UILayout, poses: statics.RestingPoses | verdict.Finding | None) -> None:
    """Draw the most probable poses, in as many rows before they are known."""
    narrow = texts.is_narrow()
    column = layout.column(align=True)
    column.label(text="Resting Poses")
    heading = column.row()
    heading.label(text="Share" if narrow else "Probability")
    cell = rows.right(heading)
    cell.label(text="Tips at")
    if not narrow:
        cell.label(icon="BLANK1")
    angles = () if poses is None or isinstance(poses, verdict.Finding) else poses.tipping_angles
    for place in range(MAX_POSES):
        row = column.row(align=True)
        row.enabled = place < len(angles)
        share = "–"
        angle = ""
        if place < len(angles):
            share = "{:.1f}%".format(100.0 * poses.shares[place])
            angle = "{:.1f}°".format(degrees(angles[place]))
        number = "" if narrow else "{:d}: ".format(place + 1)
        row.label(text=number + share, translate=False)
        rows.right(row, angle)
        row.operator("object.body_moments_rest_on_ground", text="", icon="TRIA_DOWN_BAR").pose = (
            place + 1
        )
    further_count = len(angles) - MAX_POSES
    texts.state(
        column,
        write.translations.localized("{:d} more").format(further_count)
        if further_count > 0
        else "",
    )
    if isinstance(poses, verdict.Finding):
        texts.message(layout, poses)


CLASSES = places.in_both_places(
    StabilityPanel,
    "stability",
    shown_for=lambda obj: (
        read.visibility.measurable(obj) or session.tracking.armatures.stands_for_meshes(obj)
    ),
    for_any=True,
)
