# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, computed by a button, and copied to the clipboard."""

from __future__ import annotations

from bpy.types import Context, Object, Operator

from ...blender.read.visibility import measurable
from ...blender.session import stored
from ...blender.write import reports
from ...core.verdict.finding import MeasureError, Severity
from .. import selection
from .copy import copy_text


def _active(cls: type[Operator], context: Context) -> Object | None:
    obj = context.object
    if obj is None or not measurable(obj):
        reports.unavailable(cls, "Make a measurable object active")
        return None
    return obj


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
        return _active(cls, context) is not None

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


class OBJECT_OT_body_moments_copy_moments(Operator):
    """Copy all computed moments and their error bounds to the clipboard as CSV"""

    bl_idname = "object.body_moments_copy_moments"
    bl_label = "Copy Moments as CSV"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = _active(cls, context)
        if obj is None:
            return False
        computed = stored.moments.computed_moments(obj)
        return computed is not None or reports.unavailable(cls, "Compute the moments first")

    def execute(self, context: Context) -> set[str]:
        settings, computed = context.scene.body_moments, stored.moments.computed_moments(context.object)
        assert computed is not None
        try:
            about = settings.moments_about
            reference = (
                stored.moments.reference_of(context.object, computed, context.scene) if about == "REFERENCE" else None
            )
            text = stored.moments.as_csv(computed, settings.moments_of, about, settings.frame, reference)
        except MeasureError as error:
            return selection.refuse(self, reports.failure(computed.name, error))
        copy_text(self, context, text, reports.phrase("Copied {count} moments", count=text.count("\n") - 2))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_compute_moments, OBJECT_OT_body_moments_copy_moments)
