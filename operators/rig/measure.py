# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Bones: mass, center and inertia of every bone of a character, in rest pose; and to clear them."""

from bpy.types import Context, Operator

from ...blender import bodies, read
from ...blender.session import stored
from ...blender.write import reports
from ...core.verdict.finding import Severity
from ...core.verdict.sentences import of_severity
from .. import selection
from ..assembly.assembly import report_cleared


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


CLASSES = (OBJECT_OT_body_moments_measure_bones, OBJECT_OT_body_moments_clear_bones)
