# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Section properties: of selected faces, of flat objects, of 2-D curves and text; kept on the object."""

from __future__ import annotations

from bpy.types import Context, Object, Operator

from ...blender import bodies
from ...blender.read.visibility import SECTION_TYPES
from ...blender.session import stored
from ...blender.session.stored import outcome
from ...blender.write import properties, reports
from ...core.verdict.finding import Severity
from ...core.verdict.sentences import of_severity
from .. import selection


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
            sections.append((obj, bodies.section_of(obj, depsgraph)))

        measured, failures = selection.apply_to_all(_objects_with_sections(context), measure)
        stored.results.store_sections(context, sections)
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


CLASSES = (OBJECT_OT_body_moments_measure_section,)
