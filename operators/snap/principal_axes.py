# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Axes to Principal Axes.

Physics engines take an object's origin as its center of mass and a diagonal inertia along its axes.
After this they are right to do so.
"""

from bpy.types import Context, Operator

from .. import selection
from . import base as snapping


class OBJECT_OT_body_moments_axes_to_principal(selection.OnSelectionInObjectMode, Operator):
    """Make the principal frame the frame of the object."""

    bl_idname = "object.body_moments_axes_to_principal"
    bl_label = "Axes to Principal Axes"
    bl_description = (
        "Move the origin to the center of mass and align the local X, Y and Z axes with the principal axes, from the "
        "smallest moment to the largest, with unit scale. Nothing visible moves"
    )
    bl_options = {"REGISTER", "UNDO"}

    strict: snapping.STRICT_PROPERTY

    def execute(self, context: Context) -> set[str]:
        done = (
            "Aligned the axes of {count} object to its principal axes",
            "Aligned the axes of {count} objects to their principal axes",
        )
        return snapping.reframe_selected(self, context, True, done, self.strict)


CLASSES = (OBJECT_OT_body_moments_axes_to_principal,)
