# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators on characters: the parts of their bones, rigid bodies for them, and their center of mass."""

from bpy.types import Context, Operator

from ..blender import bodies, read, scene
from ..blender.bodies.findings import BONE_PARTS_IMPOSSIBLE
from ..blender.read.tracking import tracking_paused
from ..blender.session import stored
from ..blender.write import reports
from ..core.verdict.finding import Severity, finding
from ..core.verdict.sentences import of_severity
from . import selection
from .assembly import report_cleared


class OnArmature:
    """Base of operators that need an active armature."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        is_armature = context.object is not None and context.object.type == "ARMATURE"
        return is_armature or reports.unavailable(cls, "The active object is not an armature. Select one.")


class OBJECT_OT_body_moments_measure_bones(OnArmature, Operator):
    """Measure the part of each bone of the active armature in rest pose, and store it on the pose bone"""

    bl_idname = "object.body_moments_measure_bones"
    bl_label = "Measure Bones"
    bl_options = {"REGISTER", "UNDO"}

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        rig = bodies.measure_rig(context, read.rig.require_armature(context.object))
        failures = stored.rig.store(rig)
        done = reports.phrase(
            "{armature}: {mass:.7g} kg in the parts of {count} bone",
            "{armature}: {mass:.7g} kg in the parts of {count} bones",
            armature=rig.armature.name,
            count=sum(part.measurement is not None for part in rig.parts),
            mass=rig.measurement.mass_properties.mass,
        )
        findings = of_severity(rig.measurement.findings, Severity.WARNING, Severity.ERROR)
        findings += [reports.failure(name, reason) for name, reason in failures]
        selection.report(self, done, *reports.first(findings))
        selection.redraw(context)
        return {"FINISHED"}


class OBJECT_OT_body_moments_clear_bones(OnArmature, Operator):
    """Remove the stored results of the active armature and its bones. Settings are kept"""

    bl_idname = "object.body_moments_clear_bones"
    bl_label = "Clear Results of Bones"
    bl_options = {"REGISTER", "UNDO"}

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        return report_cleared(self, context, stored.rig.clear(context.object))


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


CLASSES = (
    OBJECT_OT_body_moments_measure_bones,
    OBJECT_OT_body_moments_clear_bones,
    OBJECT_OT_body_moments_physics_rig,
    OBJECT_OT_body_moments_rig_center,
)
