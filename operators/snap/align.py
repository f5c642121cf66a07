# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Align Object to World: turn the object and its children until its principal axes lie along the world's."""

import numpy as np
from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator
from numpy.typing import NDArray

from ...blender.scene import reframe
from ...blender.scene.transforms import world
from ...core.verdict.finding import finding
from .. import selection
from ..findings import ALIGNED_TO_WORLD, ALREADY_ALIGNED
from . import base as snapping

# Targets of principal axes 1, 2 and 3. An odd order would mirror the body, so axis 3 is reversed in it.
ORDERS = ("XYZ", "YZX", "ZXY", "XZY", "YXZ", "ZYX")


def directions(order: str) -> NDArray[np.float64]:
    """Return the (3, 3) rotation: the target directions of principal axes 1, 2, 3 in the world, as columns."""
    frame = np.eye(3)[:, ["XYZ".index(letter) for letter in order]]
    if np.linalg.det(frame) < 0.0:
        frame[:, 2] = -frame[:, 2]
    return frame


class OBJECT_OT_body_moments_align_to_world(Operator):
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

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        frame = directions(self.order)
        # one after the other, for a child moves with its parent
        moved, failures = selection.apply_to_all(objects, lambda obj: self._align(context, obj, frame))
        snapping.remeasure(context, moved)
        done = finding(ALIGNED_TO_WORLD, count=len(moved))
        return selection.summarize(self, len(moved), len(objects), done, failures, idle=finding(ALREADY_ALIGNED))

    def _align(self, context: Context, obj: Object, frame: NDArray) -> bool:
        """Align the object, and return whether it had to be moved."""
        reframe.check_movable(obj)
        body = snapping.snap_target(context, obj, self.strict)
        goal = body.center if self.pivot == "CENTER" else np.zeros(3)
        aligned = body.is_principal(frame)
        is_there = aligned and np.abs(body.center - goal).max() <= reframe.location_tolerance(obj, body.size)
        if not is_there:
            turn = np.eye(3) if aligned else frame @ body.axes.T
            target = world(obj)
            target[:3, :3] = turn @ target[:3, :3]
            target[:3, 3] = goal + turn @ (target[:3, 3] - body.center)
            reframe.move(context, reframe.Plan(obj, target, body.size, move_only=aligned))
        return not is_there


CLASSES = (OBJECT_OT_body_moments_align_to_world,)
