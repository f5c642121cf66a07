# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass, center and inertia of links as text on the clipboard, to be pasted into a robot description."""

from bpy.props import EnumProperty
from bpy.types import Context, Operator

from ...blender import session
from ...blender.write import reports
from ...core.robots import write
from ...core.robots.formats import FORMATS
from .. import selection
from ..measure.copy import copy_text

ITEMS = tuple((form.name, form.short, form.copy_tip) for form in FORMATS.values())


class OBJECT_OT_body_moments_copy_inertial(selection.OnSelectionInObjectMode, Operator):
    """Measure the selected objects and copy mass, center and inertia along their own axes as text"""

    bl_idname = "object.body_moments_copy_inertial"
    bl_label = "Copy Inertial"
    bl_options = {"REGISTER"}

    format: EnumProperty(name="Format", description="What reads the text", items=ITEMS, default="urdf")

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        made = session.robots.object_links(context, "robot", selection.selected_measurable(context))
        text, _ = write.texts.robot_text(made.robot, self.format, made.findings, inertial_only=True)
        done = "Inertial of {count} link copied.", "Inertials of {count} links copied."
        copy_text(self, context, text, reports.phrase(*done, count=len(made.robot.links)))
        if made.findings:
            selection.report(self, *made.findings)
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_copy_inertial,)
