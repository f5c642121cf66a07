# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, and section properties: of selected faces, of flat objects, of 2-D curves and text."""

from __future__ import annotations

from bpy.types import Context, Object, Operator

from ...blender.read.visibility import SECTION_TYPES, measurable
from ...blender.session import stored
from ...blender.session.stored import outcome
from ...blender.write import properties, reports
from ...core.verdict.finding import MeasureError, Severity
from ...core.verdict.sentences import of_severity
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
        return reports.report(self, done, *reports.first(findings))


class OBJECT_OT_body_moments_measure_section(Operator):
    """Compute the section properties of the selection."""

    bl_idname = "object.body_moments_measure_section"
    bl_label = "Measure Section"
    bl_description = (
        "Compute the section properties of the selected faces in Edit Mode, or of the selected flat meshes, 2D "
        "curves and texts, and store them on the objects"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        reason = "Select faces in Edit Mode, or a flat mesh, 2D curve or text"
        return bool(_objects_with_sections(context)) or reports.unavailable(cls, reason)

    def execute(self, context: Context) -> set[str]:
        depsgraph = context.evaluated_depsgraph_get()
        sections = []

        def measure(obj: Object) -> None:
            properties.require_storable(obj)
            sections.append((obj, stored.sections.section_of(obj, depsgraph)))

        measured, failures = selection.apply_to_all(_objects_with_sections(context), measure)
        stored.sections.store_sections(context, sections)
        selection.redraw(context)
        warned = [obj.name for obj, found in sections if of_severity(found[2], Severity.WARNING, Severity.ERROR)]
        if len(measured) == 1:
            text = "Measured the section of {object}, with warnings" if warned else "Measured the section of {object}"
            done = [reports.phrase(text, object=measured[0].name)]
        else:
            texts = ("Measured {count} section", "Measured {count} sections")
            done = [reports.phrase(*texts, count=len(measured))] if measured else []
            if warned:
                done.append(reports.phrase("{count} with warnings: {objects}", count=len(warned), objects=warned))
        outcome.remember(self.bl_label, failures)
        level = Severity.WARNING if warned else Severity.NOTE
        reports.report(self, *done, *reports.first(failures), level=level)
        return {"FINISHED"} if measured else {"CANCELLED"}


def _objects_with_sections(context: Context) -> list[Object]:
    """Return edited meshes with selected faces (all if none has), else selected objects that may have a section."""
    if context.mode != "EDIT_MESH":
        return [obj for obj in context.view_layer.objects.selected if obj.type in SECTION_TYPES]
    edited = [obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.data.is_editmode]
    # If no mesh has selected faces, each is refused.
    return [obj for obj in edited if obj.data.total_face_sel] or edited


CLASSES = (
    OBJECT_OT_body_moments_compute_moments,
    OBJECT_OT_body_moments_measure_section,
)
