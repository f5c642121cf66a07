# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Axes to Principal Axes.

Physics engines take an object's origin as its center of mass and a diagonal inertia along its axes.
After this they are right to do so.
"""

import numpy as np
from bpy.types import Context, Object, Operator

from ...blender.scene import reframe
from ...blender.scene.transforms import world
from ...core.verdict.finding import finding
from .. import selection
from ..findings import AXES_MADE_PRINCIPAL
from . import base as snapping

UNIT_SCALE = 1e-6  # by how much the products of an object's axes may differ from 1 and 0


class OBJECT_OT_body_moments_axes_to_principal(Operator):
    """Make the principal frame the frame of the object."""

    bl_idname = "object.body_moments_axes_to_principal"
    bl_label = "Axes to Principal Axes"
    bl_description = (
        "Move the origin to the center of mass and align the local X, Y and Z axes with the principal axes, from the "
        "smallest moment to the largest, with unit scale. Nothing visible moves"
    )
    bl_options = {"REGISTER", "UNDO"}

    strict: snapping.STRICT_PROPERTY

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        return snapping.reframe_selected(
            self,
            context,
            matrix_along_axes,
            finding(AXES_MADE_PRINCIPAL),
            move_only=False,
            strict=self.strict,
        )


def matrix_along_axes(obj: Object, body: snapping.SnapTarget) -> np.ndarray | None:
    """Return the object's matrix with its axes along the body's, or None if they are already."""
    if _is_there(obj, body):
        return None
    target = np.eye(4)
    target[:3, :3], target[:3, 3] = body.axes, body.center
    return target


def _is_there(obj: Object, body: snapping.SnapTarget) -> bool:
    now = world(obj)
    linear = now[:3, :3]
    if np.abs(linear.T @ linear - np.eye(3)).max() > UNIT_SCALE or np.linalg.det(linear) < 0.0:
        return False
    at_center = np.abs(now[:3, 3] - body.center).max() <= reframe.location_tolerance(obj, body.size)
    return bool(at_center and body.is_principal(linear))


CLASSES = (OBJECT_OT_body_moments_axes_to_principal,)
