# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Align Object to World: turn the object and its children until its principal axes lie along the world's."""

from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator

from ...blender import scene, session
from ...blender.write import reports
from .. import selection
from . import base as snapping

# Targets of principal axes 1, 2 and 3. An odd order would mirror the body, so axis 3 is reversed in it.
ORDERS = ("XYZ", "YZX", "ZXY", "XZY", "YXZ", "ZYX")


class OBJECT_OT_body_moments_align_to_world(selection.OnSelectionInObjectMode, Operator):
    """Rotate the object so that its principal axes align with the world axes."""

    bl_idname = "object.body_moments_align_to_world"
    bl_label = "Align Object to World"
    bl_description = (
        "Rotate the object so that its principal axes align with the world axes, about its center of mass or at the "
        "world origin. Children follow"
    )
    bl_options = {"REGISTER", "UNDO"}

    order: EnumProperty(
        name="Axes",
        description="World axes for principal axes 1, 2 and 3 (smallest to largest moment)",
        items=[
            (
                order,
                "1 → {:s}, 2 → {:s}, 3 → {:s}{:s}".format(order[0], order[1], "" if i < 3 else "−", order[2]),
                "Smallest moment about {:s}, largest moment about {:s}".format(order[0], order[2]),
            )
            for i, order in enumerate(ORDERS)
        ],
        default="XYZ",
    )
    pivot: EnumProperty(
        name="Center of Mass",
        description="New location of the center of mass",
        items=(
            ("CENTER", "Keep", "Rotate about the center of mass"),
            ("ORIGIN", "World Origin", "Move the center of mass to the world origin"),
        ),
        default="CENTER",
    )

    strict: snapping.STRICT_PROPERTY

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)

        def align(obj: Object) -> bool:
            return scene.align_to_world(context, obj, self.order, self.pivot == "ORIGIN", self.strict)

        moved, failures = selection.apply_to_all(
            objects, align
        )  # one after the other, for a child moves with its parent
        session.remeasure(context, moved)
        done = reports.phrase(
            "Aligned {count} object to the world axes", "Aligned {count} objects to the world axes", count=len(moved)
        )
        idle = reports.phrase("already aligned")
        return selection.summarize(self, len(moved), len(objects), done, failures, idle=idle)


CLASSES = (OBJECT_OT_body_moments_align_to_world,)
