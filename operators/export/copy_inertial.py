# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertials as text on the clipboard, to be pasted into a robot description."""

from __future__ import annotations

from bpy.props import EnumProperty
from bpy.types import Context, Operator

from ...blender.session.robots import object_links
from ...blender.write import reports
from ...core.robots.formats import FORMATS
from ...core.robots.write.texts import robot_text
from ...core.verdict.finding import MeasureError, finding
from .. import selection
from ..findings import ROBOT_COPIED
from ..measure.copy import copy_text

ITEMS = tuple((form.name, form.short, form.copy_tip) for form in FORMATS.values())


class OBJECT_OT_body_moments_copy_inertial(Operator):
    """Measure the selected objects and copy mass, center and inertia along their own axes as text"""

    bl_idname = "object.body_moments_copy_inertial"
    bl_label = "Copy Inertial"
    bl_options = {"REGISTER"}

    format: EnumProperty(name="Format", description="What reads the text", items=ITEMS, default="urdf")

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        try:
            made = object_links(context, "robot", selection.selected_measurable(context))
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        text, _ = robot_text(made.robot, self.format, made.findings, inertial_only=True)
        copy_text(self, context, text, finding(ROBOT_COPIED, count=len(made.robot.links)))
        if made.findings:
            selection.report(self, *made.findings)
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_copy_inertial,)
