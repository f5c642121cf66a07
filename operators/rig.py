# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators on characters: the parts of their bones, rigid bodies for them, their center of mass
and balance.
"""

from bpy.props import EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Operator

from ..blender import bodies, read, scene, session, write
from ..blender.session.selected import armature_of
from ..blender.session.tracking.armatures import stands_for_meshes
from ..core.verdict import Severity, of_severity
from . import assembly, selection

NOTABLE = Severity.WARNING, Severity.ERROR
BALANCED = "Nothing to do: the center of mass is over its target"


class OnArmature:
    """Base of operators on the armature that the panel of bones shows."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        return armature_of(context) is not None or write.reports.unavailable(
            cls, "No armature is selected, or several are. Select one."
        )


class InPoseMode:
    """Base of operators that need an armature in Pose Mode."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        is_posed = context.object is not None and stands_for_meshes(context.object)
        return is_posed or write.reports.unavailable(
            cls, "Select an armature, and switch to Pose Mode"
        )


class OBJECT_OT_body_moments_measure_bones(OnArmature, Operator):
    """Measure each bone's part of the selected armature at rest; store it on the pose bone"""

    bl_label = "Measure Bones"

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        rig = bodies.measure_rig(context, read.rig.require_armature(armature_of(context)))
        failures = session.stored.results.store_rig(rig)
        summary = write.reports.phrase(
            "{armature}: {mass:.7g} kg in the parts of {count} bone",
            "{armature}: {mass:.7g} kg in the parts of {count} bones",
            armature=rig.armature.name,
            count=sum(part.measurement is not None for part in rig.parts),
            mass=rig.measurement.mass_properties.mass,
        )
        findings = of_severity(rig.measurement.findings, *NOTABLE)
        findings += [write.reports.failure(name, reason) for name, reason in failures]
        return selection.report(self, summary, *findings)


class OBJECT_OT_body_moments_clear_bones(OnArmature, Operator):
    """Remove the stored results of the selected armature and its bones. Settings are kept"""

    bl_label = "Clear Results of Bones"

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        return assembly.report_cleared(self, session.stored.results.clear_rig(armature_of(context)))


class OBJECT_OT_body_moments_physics_rig(OnArmature, Operator):
    """Create a rigid body for the part of each bone, in rest pose, with its exact mass, its origin
    at its center of mass and its axes along its principal axes, and a joint at each bone. One
    created before is replaced
    """

    bl_label = "Create Physics Rig"

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        rig = bodies.measure_rig(context, read.rig.require_armature(armature_of(context)))
        with read.tracking.tracking_paused():
            count, joints = scene.create_physics_rig(context, rig)
        text = "Rigid bodies created: {count}, joints: {joints}"
        return selection.report(
            self,
            write.reports.phrase(text, count=count, joints=joints),
            *[
                failure
                for failure in rig.measurement.findings
                if failure.code == bodies.findings.BONE_PARTS_IMPOSSIBLE
            ],
        )


class OBJECT_OT_body_moments_rig_center(OnArmature, Operator):
    """Add an empty that stays at the center of mass of the character in every pose, by constraints
    to the centers of the bones' parts. One added before is replaced
    """

    bl_label = "Add Center of Mass"

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        rig = bodies.measure_rig(context, read.rig.require_armature(armature_of(context)))
        with read.tracking.tracking_paused():
            scene.add_center(context, rig)
        return selection.report(
            self,
            write.reports.phrase(
                "Added the center of mass of “{armature}”, which follows its pose",
                armature=rig.armature.name,
            ),
        )


class POSE_OT_body_moments_show_weight(InPoseMode, Operator):
    """Show or hide center of mass and support of the selected characters while they are posed"""

    bl_label = "Show Weight"

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        armatures = [obj for obj in context.selected_objects if stands_for_meshes(obj)] or [
            context.object
        ]
        is_shown = not context.object.body_moments_weight.show
        prepare = session.character.weight.prepare
        rigs = [rig for armature in armatures if (rig := prepare(context, armature)) is not None]
        is_shown = is_shown or bool(rigs)  # numbers that were out of date are shown anew
        for armature in armatures:
            armature.body_moments_weight.show = is_shown
        findings = [finding for rig in rigs for finding in rig.measurement.findings]
        names = ", ".join(armature.name for armature in armatures)
        text = "Showing the weight of {names}" if is_shown else "Hid the weight of {names}"
        summary = write.reports.phrase(text, names=names)
        return selection.report(self, summary, *of_severity(findings, *NOTABLE))


class POSE_OT_body_moments_balance_pose(InPoseMode, Operator):
    """Move a bone as little as brings the center of mass over the support; held feet stay"""

    bl_label = "Balance Pose"

    bone: StringProperty(
        name="Bone",
        description="Bone to move. If empty, the active one or the first one that leaves the "
        "contacts in place",
    )
    target: EnumProperty(
        name="Target",
        description="Where the center of mass shall be",
        items=(
            ("MIDDLE", "Middle", "Over the middle of the support polygon"),
            ("INSIDE", "Inside", "Over the nearest point with the margin from the edge"),
        ),
        default="INSIDE",
    )
    margin: FloatProperty(
        name="Margin",
        description="Distance from the edge of the support polygon",
        default=0.05,
        min=0.0,
        unit="LENGTH",
    )

    def draw(self, context: Context) -> None:
        margin = ("margin",) if self.target == "INSIDE" else ()
        column = selection.draw_properties(self, "target", *margin)
        column.prop_search(self, "bone", context.object.pose, "bones", icon="BONE_DATA")

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        margin = self.margin if self.target == "INSIDE" else None
        # values of the report; none if the center was over its target already
        values = session.balance_pose(context, context.object, self.bone, margin)
        summary = write.reports.phrase(
            "Moved “{bone}”: the center is {gap} from its target, {margin} inside the support"
            if values
            else BALANCED,
            **values,
        )
        return selection.finish(self, [summary], is_changed=bool(values))
