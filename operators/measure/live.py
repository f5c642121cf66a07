# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that lets the numbers of objects follow their changes."""

from __future__ import annotations

from bpy.types import Context, Object, Operator

from ...blender.read.visibility import measurable
from ...blender.session import live
from ...blender.session.tracking import armatures
from ...blender.write import reports
from .. import selection


class OBJECT_OT_body_moments_live(Operator):
    """Let the numbers of the selected objects follow what happens to them."""

    bl_idname = "object.body_moments_live"
    bl_label = "Live"
    bl_description = (
        "Update the numbers of the selected objects while they are edited, sculpted, posed or animated, until the file "
        "is closed. In Pose Mode, those of the meshes that the armature deforms. Press Measure to store them"
    )
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        active = context.object is not None and bool(_subjects(context))
        return active or reports.unavailable(cls, "Select objects")

    def execute(self, context: Context) -> set[str]:
        objects = _subjects(context)
        if any(live.following.is_live(obj) for obj in armatures.subjects([context.object])):
            for obj in objects:
                live.live.stop(obj)
            selection.redraw(context)
            return {"FINISHED"}
        depsgraph = context.evaluated_depsgraph_get()
        refusals = []
        for obj in objects:
            result = live.live.start(obj, depsgraph)
            if result.refusal is not None:
                refusals.append(reports.failure(obj.name, result.refusal))
        if refusals:
            selection.report(self, *reports.first(refusals))
        selection.redraw(context)
        return {"FINISHED"}


def _subjects(context: Context) -> list[Object]:
    """Return the measurable objects among the active and selected ones, with the meshes of posed armatures."""
    objects = armatures.subjects([context.object, *context.view_layer.objects.selected])
    return [obj for obj in objects if measurable(obj)]


CLASSES = (OBJECT_OT_body_moments_live,)
