# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Section properties: of selected faces, of flat objects, of 2-D curves and text; kept on the object."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Depsgraph, Object, Operator

from ...blender.bodies.flat.flat import area_findings, flat_region
from ...blender.read.fingerprint import fingerprint, matrix_hash, settings_hash
from ...blender.read.visibility import SECTION_TYPES
from ...blender.session.stored import outcome
from ...blender.session.tracking import staleness, stamps
from ...blender.write import properties, reports
from ...blender.write import section as record
from ...core.flat.section import Section, measure_section
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding, Severity, finding
from ...core.verdict.sentences import of_severity
from ..findings import (
    MEASURED_SECTION,
    MEASURED_SECTION_WITH_WARNINGS,
    MEASURED_SECTIONS,
    SECTION_COPIED,
    WITH_WARNINGS,
)
from ..modal import redraw
from .copy import copy_text


def section_of(obj: Object, depsgraph: Depsgraph) -> tuple[Section, str, tuple[Finding, ...]]:
    """Return an object's section in SI units and world axes, a description of the measured part, and the findings.

    Raises MeasureError if there is no section.
    """
    found = flat_region(obj, depsgraph, exact=False)
    section = measure_section(found.plane, found.spatial, found.edges, found.stored, found.shared)
    return section, found.description, (*found.findings, *area_findings(found, section.area))


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
        if not _objects_with_sections(context):
            return reports.unavailable(cls, "Select faces in Edit Mode, or a flat mesh, 2D curve or text")
        return True

    def execute(self, context: Context) -> set[str]:
        depsgraph = context.evaluated_depsgraph_get()
        sections, failures = [], []
        for obj in _objects_with_sections(context):
            try:
                properties.require_storable(obj)
                sections.append((obj, *section_of(obj, depsgraph)))
            except Exception as error:
                failures.append(reports.failure(obj.name_full, error))
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        for obj, section, what, findings in sections:
            numbers = np.concatenate(
                [
                    section.plane.origin,
                    section.plane.axes.ravel(),
                    section.second,
                    section.centroid,
                    [section.area, section.perimeter],
                ]
            )
            mark = fingerprint(numbers.tobytes(), matrix_hash(obj), settings_hash(obj, context.scene))
            record.store(obj, section, what, findings, mark, unit)
        staleness.mark_stamps(context, [(obj, stamp) for obj, *_ in sections if (stamp := stamps.of_section(obj))])
        redraw(context)
        warned = [obj.name for obj, *_, found in sections if of_severity(found, Severity.WARNING, Severity.ERROR)]
        if len(sections) > 1:
            done = [finding(MEASURED_SECTIONS, count=len(sections))]
            done += [finding(WITH_WARNINGS, count=len(warned), objects=warned)] if warned else []
        else:
            code = MEASURED_SECTION_WITH_WARNINGS if warned else MEASURED_SECTION
            done = [finding(code, object=obj.name) for obj, *_ in sections]
        outcome.remember(self.bl_label, failures)
        reports.report(self, *done, *reports.first(failures))
        return {"FINISHED"} if sections else {"CANCELLED"}


class OBJECT_OT_body_moments_copy_section(Operator):
    """Copy the stored section properties of the active object to the clipboard, as text in SI units"""

    bl_idname = "object.body_moments_copy_section"
    bl_label = "Copy Section Report"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is None or record.stored(context.object) is None:
            return reports.unavailable(cls, "Measure a section first")
        return True

    def execute(self, context: Context) -> set[str]:
        obj = context.object
        stored = record.stored(obj)
        assert stored is not None
        text = record.text(obj.name, stored, staleness.stale_reason(obj, context.scene, stamps.of_section))
        copy_text(self, context, text, finding(SECTION_COPIED, object=obj.name))
        return {"FINISHED"}


def _objects_with_sections(context: Context) -> list[Object]:
    """Return the meshes being edited, else the selected objects that may have a section."""
    if context.mode != "EDIT_MESH":
        return [obj for obj in context.view_layer.objects.selected if obj.type in SECTION_TYPES]
    edited = [obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.data.is_editmode]
    # If no mesh has selected faces, each is refused.
    return [obj for obj in edited if obj.data.total_face_sel] or edited


CLASSES = (OBJECT_OT_body_moments_measure_section, OBJECT_OT_body_moments_copy_section)
