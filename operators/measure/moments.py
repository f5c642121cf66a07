# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, computed by a button."""

from __future__ import annotations

from bpy.types import Context, Operator

from ...blender.read.visibility import measurable
from ...blender.session import stored
from ...blender.write import reports
from ...core.verdict.finding import MeasureError, Severity
from .. import selection


class OBJECT_OT_body_moments_compute_moments(Operator):
    """Compute all moments of the active object up to the chosen order."""

    bl_idname = "object.body_moments_compute_moments"
    bl_label = "Compute Moments"
    bl_description = (
        "Compute all moments of the active object's volume, surface and mass, or of the area of what is flat, up to "
        "the chosen order. A million triangles take about 1 second at order 4 and 20 seconds at order 20"
    )
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        is_measurable = context.object is not None and measurable(context.object)
        return is_measurable or reports.unavailable(cls, "Make a measurable object active")

    def execute(self, context: Context) -> set[str]:
        obj = context.object
        order: int = context.scene.body_moments.moments_order
        try:
            computed, findings = stored.compute_moments(context, obj, order)
        except MeasureError as error:
            return selection.refuse(self, reports.failure(obj.name, error))
        if computed is None:
            text = (
                "{object}: a wire has no volume or surface. Set Kind to Solid or Shell; measure --order gives moments "
                "of length."
            )
            reports.report(self, reports.phrase(text, object=obj.name), level=Severity.WARNING)
            return {"CANCELLED"}
        stored.moments.cache_moments(obj, computed, context.evaluated_depsgraph_get())
        count = (order + 1) * (order + 2) // 2 if computed.volume is None else len(computed.volume.raw)
        done = reports.phrase("Computed {count} moments of {object}", count=count, object=obj.name)
        reports.report(self, done, *reports.first(findings))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_compute_moments,)
