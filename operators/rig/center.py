# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Center of Mass to a character: an empty that follows its pose, and plays without the add-on."""

from bpy.types import Context, Operator

from ...blender import bodies, read, scene
from ...blender.read.tracking import tracking_paused
from ...blender.write import reports
from .. import selection
from .measure import OnArmature


class OBJECT_OT_body_moments_rig_center(OnArmature, Operator):
    """Add an empty that stays at the center of mass of the posed character."""

    bl_idname = "object.body_moments_rig_center"
    bl_label = "Add Center of Mass"
    bl_description = (
        "Add an empty that stays at the center of mass of the character in every pose, by constraints to the centers "
        "of the bones' parts. One added before is replaced"
    )
    bl_options = {"REGISTER", "UNDO"}

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        rig = bodies.measure_rig(context, read.rig.require_armature(context.object))
        with tracking_paused():
            scene.add_center(context, rig)
        text = "Added the center of mass of “{armature}”, which follows its pose"
        selection.report(self, reports.phrase(text, armature=rig.armature.name))
        selection.redraw(context)
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_rig_center,)
