# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Create Physics Rig: a rigid body with the exact mass for each bone's part, and a joint at each bone."""

from bpy.types import Context, Operator

from ...blender import bodies, read, scene
from ...blender.bodies.findings import BONE_PARTS_IMPOSSIBLE
from ...blender.read.tracking import tracking_paused
from ...blender.write import reports
from ...core.verdict.finding import finding
from .. import selection
from .measure import OnArmature


class OBJECT_OT_body_moments_physics_rig(OnArmature, Operator):
    """Create rigid bodies with the exact masses of the bones' parts, joined at the bones."""

    bl_idname = "object.body_moments_physics_rig"
    bl_label = "Create Physics Rig"
    bl_description = (
        "Create a rigid body for the part of each bone, in rest pose, with its exact mass, its origin at its center of "
        "mass and its axes along its principal axes, and a joint at each bone. One created before is replaced"
    )
    bl_options = {"REGISTER", "UNDO"}

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        rig = bodies.measure_rig(context, read.rig.require_armature(context.object))
        with tracking_paused():
            count, joints = scene.create_physics_rig(context, rig)
        missing = [part.name for part in rig.parts if part.measurement is None]
        more = [finding(BONE_PARTS_IMPOSSIBLE, count=len(missing), names=missing)] if missing else []
        done = reports.phrase("Rigid bodies created: {count}, joints: {joints}", count=count, joints=joints)
        selection.report(self, done, *more)
        selection.redraw(context)
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_physics_rig,)
