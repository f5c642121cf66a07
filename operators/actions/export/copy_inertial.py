# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertials as text on the clipboard, to be pasted into a robot description."""

from __future__ import annotations

from bpy.props import EnumProperty
from bpy.types import Context, Operator

from ....core.verdict.finding import finding
from ...write import reports
from ...write.robots.formats import robot_text
from .. import selection
from ..measure.copy import copy_text
from .links import left_out, measure_scene, object_links

FORMATS = (
    ("urdf", "URDF", "Tensor along the axes of the object"),
    ("sdf", "SDF", "Diagonal tensor in a rotated inertial frame"),
    ("mjcf", "MJCF", "Principal moments and a quaternion"),
    ("usd", "USD", "PhysicsMassAPI and NewtonMassAPI"),
)


class OBJECT_OT_body_moments_copy_inertial(Operator):
    """Measure the selected objects and copy mass, center and inertia along their own axes as text"""

    bl_idname = "object.body_moments_copy_inertial"
    bl_label = "Copy Inertial"
    bl_options = {"REGISTER"}

    format: EnumProperty(name="Format", description="What reads the text", items=FORMATS, default="urdf")

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        scene = measure_scene(context, objects)
        if not scene.measured:
            selection.report(self, *(reports.first(scene.failures) or [finding("nothing_measurable")]))
            return {"CANCELLED"}
        robot, findings, _ = object_links("robot", scene)
        text, _ = robot_text(robot, self.format, findings, inertial_only=True)
        copy_text(self, context, text, finding("robot_copied", count=len(robot.links)))
        if scene.failures:
            selection.report(self, *left_out(scene.failures, len(objects)))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_copy_inertial,)
