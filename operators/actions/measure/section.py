# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Section properties: of selected faces, of flat objects, of 2-D curves and text; kept on the object."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.types import Context, Depsgraph, Object, Operator

from ....core.numerics.float32 import decimal
from ....core.plane.polygon import flaws, nested
from ....core.plane.section import Section, fit_plane, measure_section, region
from ....core.verdict.finding import Finding, MeasureError, ReadError, Severity, finding
from ....core.verdict.tolerances import NEGLIGIBLE
from ...read.fingerprint import fingerprint, matrix_hash, settings_hash
from ...read.section import SECTION_TYPES, SectionReading, read_section
from ...session import staleness
from ...write import properties, reports
from ...write import section as record
from ...write.messages import of_severity
from .. import selection
from .copy import to_clipboard

FILLED = 1e-4  # Blender's fill and the outlines differ by more than this share: the fill is wrong


def section_of(obj: Object, depsgraph: Depsgraph) -> tuple[Section, str, tuple[Finding, ...]]:
    """The section of one object in SI units and world axes, what of it was measured, and what was decided.

    Raises MeasureError where there is none.
    """
    reading = read_section(obj, depsgraph)
    unit = decimal(depsgraph.scene.unit_settings.scale_length)
    try:
        section, findings = _measured(reading, unit)
    except MeasureError as error:
        error.about(obj.name)
        raise
    return section, reading.what, (*reading.findings, *findings)


def _measured(reading: SectionReading, unit: float) -> tuple[Section, list[Finding]]:
    points, error, findings = reading.points * unit, reading.error * unit, []
    plane = fit_plane(points, reading.triangles, reading.rotation, reading.location * unit, error, reading.facing)
    flat = plane.flat(points)
    if reading.loops is not None:
        edges = nested(flat, reading.loops)
    else:
        edges, turned = region(plane, points, reading.triangles, reading.faces, error)
        if turned:
            findings.append(finding("section_faces_reversed", count=turned))
    found = flaws(flat, edges, error)
    if reading.loops is not None and found.crossings:
        raise ReadError("outlines_cross_at", count=found.crossings)
    if reading.loops is not None and found.doubled:
        raise ReadError("outlines_cross")
    if found.negative:
        raise ReadError("section_face_crosses_itself")
    section = measure_section(plane, points, edges, error, found.shared)
    if found.crossings or found.doubled:
        findings.append(finding("section_faces_overlap"))
    if found.lost:
        findings.append(finding("section_overlap_unchecked"))
    if plane.off > 4.0 * error:
        share = float(plane.off / np.sqrt(section.area))
        findings.append(
            finding("section_projected_slightly" if share < NEGLIGIBLE else "section_projected", share=share)
        )
    if reading.drawn is not None and abs(reading.drawn * unit**2 - section.area) > FILLED * section.area:
        findings.append(finding("section_fill_wrong", share=float(reading.drawn * unit**2 / section.area)))
    return section, findings


def outdated(obj: Object, scene: bpy.types.Scene, found: record.StoredSection) -> str | None:
    """The code of why the stored section is out of date, None where it is not."""
    if found.unit != decimal(scene.unit_settings.scale_length):
        return "stale_unit_scale"
    return staleness.section_reason(obj)


class OBJECT_OT_body_moments_measure_section(Operator):
    """Compute the section properties of the selection"""

    bl_idname = "object.body_moments_measure_section"
    bl_label = "Measure Section"
    bl_description = (
        "Compute the section properties of the selected faces in Edit Mode, or of the selected flat meshes, 2D "
        "curves and texts, and store them on the objects"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if not _chosen(context):
            return reports.unavailable(cls, finding("poll_section"))
        return True

    def execute(self, context: Context) -> set[str]:
        depsgraph = context.evaluated_depsgraph_get()
        found, failures = [], []
        for obj in _chosen(context):
            try:
                properties.require_storable(obj)
                found.append((obj, *section_of(obj, depsgraph)))
            except Exception as error:
                failures.append(reports.failure(obj.name_full, error))
        unit = decimal(context.scene.unit_settings.scale_length)
        for obj, section, what, findings in found:
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
        staleness.settle_marks(context, [(obj, record.fingerprint(obj)) for obj, *_ in found])
        selection.redraw(context)
        warned = sum(bool(of_severity(findings, Severity.WARNING, Severity.ERROR)) for *_, findings in found)
        if len(found) > 1:
            done = [finding("measured_sections", count=len(found))]
            done += [finding("with_warnings", count=warned)] if warned else []
        else:
            code = "measured_section_with_warnings" if warned else "measured_section"
            done = [finding(code, object=obj.name) for obj, *_ in found]
        reports.report(self, *done, *reports.first(failures))
        return {"FINISHED"} if found else {"CANCELLED"}


class OBJECT_OT_body_moments_copy_section(Operator):
    """Copy the stored section properties of the active object to the clipboard, as text in SI units"""

    bl_idname = "object.body_moments_copy_section"
    bl_label = "Copy Section Report"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is None or record.stored(context.object) is None:
            return reports.unavailable(cls, finding("poll_measure_section"))
        return True

    def execute(self, context: Context) -> set[str]:
        obj = context.object
        found = record.stored(obj)
        code = outdated(obj, context.scene, found)
        text = record.text(obj.name, found, None if code is None else Finding(code))
        to_clipboard(self, context, text, finding("section_copied", object=obj.name))
        return {"FINISHED"}


def _chosen(context: Context) -> list[Object]:
    """The meshes being edited, else the selected objects that may have a section."""
    if context.mode != "EDIT_MESH":
        return [obj for obj in context.view_layer.objects.selected if obj.type in SECTION_TYPES]
    edited = [obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.data.is_editmode]
    # Where none has selected faces, each is refused.
    return [obj for obj in edited if obj.data.total_face_sel] or edited


CLASSES = (OBJECT_OT_body_moments_measure_section, OBJECT_OT_body_moments_copy_section)
