# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Bones: mass, center and inertia of every bone of a character, in rest pose; and to clear them."""

from bpy.types import Context, Operator

from ...blender.bodies.rig import measure_rig
from ...blender.read.rig import require_armature
from ...blender.session.stored import rig as stored_rig
from ...blender.write import reports
from ...core.verdict.finding import MeasureError, Severity, finding
from ...core.verdict.sentences import of_severity
from .. import selection
from ..findings import BONES_MEASURED, NO_RESULTS_TO_REMOVE, RESULTS_REMOVED
from ..modal import redraw


def poll_armature(cls: type[Operator], context: Context) -> bool:
    """Return whether the active object is an armature; report why not."""
    if context.object is None or context.object.type != "ARMATURE":
        return reports.unavailable(cls, "The active object is not an armature. Select one.")
    return True


class OBJECT_OT_body_moments_measure_bones(Operator):
    """Measure the part of each bone of the active armature in rest pose, and store it on the pose bone"""

    bl_idname = "object.body_moments_measure_bones"
    bl_label = "Measure Bones"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_armature(cls, context)

    def execute(self, context: Context) -> set[str]:
        try:
            rig = measure_rig(context, require_armature(context.object))
            failures = stored_rig.store(rig)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        count = sum(part.measurement is not None for part in rig.parts)
        mass = rig.measurement.mass_properties.mass
        findings = of_severity(rig.measurement.findings, Severity.WARNING, Severity.ERROR)
        findings += [reports.failure(name, reason) for name, reason in failures]
        done = finding(BONES_MEASURED, armature=rig.armature.name, count=count, mass=mass)
        selection.report(self, done, *reports.first(findings))
        redraw(context)
        return {"FINISHED"}


class OBJECT_OT_body_moments_clear_bones(Operator):
    """Remove the stored results of the active armature and its bones. Settings are kept"""

    bl_idname = "object.body_moments_clear_bones"
    bl_label = "Clear Results of Bones"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_armature(cls, context)

    def execute(self, context: Context) -> set[str]:
        try:
            cleared = stored_rig.clear(context.object)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        selection.report(self, finding(RESULTS_REMOVED, count=1) if cleared else finding(NO_RESULTS_TO_REMOVE))
        redraw(context)
        return {"FINISHED"} if cleared else {"CANCELLED"}


CLASSES = (OBJECT_OT_body_moments_measure_bones, OBJECT_OT_body_moments_clear_bones)
