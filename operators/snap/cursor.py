# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cursor to Center of Mass, of one object or of all selected together."""

import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator, View3DCursor
from mathutils import Matrix

from ...blender.bodies.stacks.many import measured_in_turn
from ...blender.session.findings import OPEN_OBJECT
from ...core.inertia.mass_properties import combine
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError, finding
from ...core.verdict.method import Verdict
from .. import selection
from ..findings import CURSOR_MOVED, NOTHING_MEASURABLE


class VIEW3D_OT_body_moments_cursor_to_center(Operator):
    """Move the 3D cursor to the common center of mass of the selected objects"""

    bl_idname = "view3d.body_moments_cursor_to_center"
    bl_label = "Cursor to Center of Mass"
    bl_options = {"REGISTER", "UNDO"}

    rotate: BoolProperty(
        name="Rotate to Principal Axes",
        description="Align the 3D cursor with the principal axes",
        default=False,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context, any_mode=True)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        measured, bodies = measured_in_turn(objects, context.evaluated_depsgraph_get()), []

        def add(obj: Object) -> None:
            measurement = measured(obj).measurement
            if measurement.method.verdict == Verdict.OPEN:
                raise EditRefusedError(OPEN_OBJECT)
            bodies.append((measurement.mass_moments, measurement.mass_properties))

        added, failures = selection.apply_to_all(objects, add)
        findings = []
        if bodies:
            # One body keeps its measured frame, with the signs by its own exact third moments.
            total = bodies[0][1] if len(bodies) == 1 else combine([moments for moments, _ in bodies])
            cursor = context.scene.cursor
            cursor.location = total.center / shortest_decimal(context.scene.unit_settings.scale_length)
            if self.rotate:
                _rotate_cursor(cursor, total.principal.axes)
                findings = [total.principal.finding] if total.principal.finding is not None else []
        done = finding(CURSOR_MOVED, count=len(added)) if objects else finding(NOTHING_MEASURABLE)
        return selection.summarize(self, len(added), len(objects), done, failures, findings)


def _rotate_cursor(cursor: View3DCursor, axes: np.ndarray) -> None:
    mode = cursor.rotation_mode
    rotation = Matrix(axes).to_quaternion()
    if mode == "QUATERNION":
        cursor.rotation_quaternion = rotation
    elif mode == "AXIS_ANGLE":
        axis, angle = rotation.to_axis_angle()
        cursor.rotation_axis_angle = (angle, *axis)
    else:
        cursor.rotation_euler = rotation.to_euler(mode)


CLASSES = (VIEW3D_OT_body_moments_cursor_to_center,)
