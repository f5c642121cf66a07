# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cursor to Center of Mass, of one object or of all selected together."""

from collections.abc import Sequence

from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator, View3DCursor
from mathutils import Matrix

from ...blender import bodies
from ...blender.scene.findings import OPEN_OBJECT
from ...blender.write import reports
from ...core import inertia
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError
from ...core.verdict.method import Verdict
from .. import selection


class VIEW3D_OT_body_moments_cursor_to_center(selection.OnSelection, Operator):
    """Move the 3D cursor to the common center of mass of the selected objects"""

    bl_idname = "view3d.body_moments_cursor_to_center"
    bl_label = "Cursor to Center of Mass"

    rotate: BoolProperty(
        name="Rotate to Principal Axes",
        description="Align the 3D cursor with the principal axes",
    )

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        measured, bodies_measured = bodies.measured_in_turn(objects, context.evaluated_depsgraph_get()), []

        def add(obj: Object) -> None:
            measurement = measured(obj).measurement
            if measurement.method.verdict == Verdict.OPEN:
                raise EditRefusedError(OPEN_OBJECT)
            bodies_measured.append((measurement.mass_moments, measurement.mass_properties))

        added, failures = selection.apply_to_all(objects, add)
        findings = []
        if bodies_measured:
            # A single body keeps its measured frame, whose signs come from exact third moments.
            total = bodies_measured[0][1]
            if len(bodies_measured) > 1:
                total = inertia.combine([moments for moments, _ in bodies_measured])
            cursor = context.scene.cursor
            cursor.location = total.center / shortest_decimal(context.scene.unit_settings.scale_length)
            if self.rotate:
                turn_cursor(cursor, total.principal.axes.tolist())
                findings = [total.principal.finding] if total.principal.finding is not None else []
        done = reports.phrase(
            "Moved the 3D cursor to the center of mass of {count} object",
            "Moved the 3D cursor to the center of mass of {count} objects",
            count=len(added),
        )
        return selection.summarize(self, len(added), len(objects), done, failures, findings)


def turn_cursor(cursor: View3DCursor, axes: Sequence[Sequence[float]]) -> None:
    """Turn the 3D cursor to axes, the columns of a matrix, in its own rotation mode."""
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
