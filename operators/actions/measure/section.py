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
from ....core.verdict import internal_error
from ...read import Unreadable
from ...read.fingerprint import fingerprint, matrix_hash, settings_hash
from ...read.section import SECTION_TYPES, SectionReading, read_section
from ...session import staleness
from ...write import properties
from ...write import section as record
from ...write.alarms import alarms
from .. import selection
from .copy import to_clipboard

FILLED = 1e-4  # Blender's fill and the outlines differ by more than this share: the fill is wrong


def section_of(obj: Object, depsgraph: Depsgraph) -> tuple[Section, str, tuple[str, ...]]:
    """The section of one object in SI units and world axes, what of it was measured, and what was decided.

    Raises Unreadable with the reason and the remedy.
    """
    reading = read_section(obj, depsgraph)
    unit = decimal(depsgraph.scene.unit_settings.scale_length)
    try:
        section, warnings = _measured(reading, unit)
    except ValueError as error:
        raise Unreadable(obj.name, str(error)) from error
    return section, reading.what, (*reading.warnings, *warnings)


def _measured(reading: SectionReading, unit: float) -> tuple[Section, list[str]]:
    points, error, warnings = reading.points * unit, reading.error * unit, []
    plane = fit_plane(points, reading.triangles, reading.rotation, reading.location * unit, error, reading.facing)
    flat = plane.flat(points)
    if reading.loops is not None:
        edges = nested(flat, reading.loops)
    else:
        edges, turned = region(plane, points, reading.triangles, reading.faces, error)
        if turned:
            warnings.append("{:d} of its faces look the other way and count with the others.".format(turned))
    found = flaws(flat, edges, error)
    if reading.loops is not None and (found.crossings or found.doubled):
        raise ValueError(
            "Its outlines cross or overlap{:s}, so that it is open what is inside; move them apart, or convert it to a "
            "mesh and unite its faces.".format(
                " at one place"
                if found.crossings == 1
                else " at {:d} places".format(found.crossings)
                if found.crossings
                else ""
            )
        )
    if found.negative:
        raise ValueError(
            "Some of its faces cross themselves, so that a part of them would count negative; cut them "
            "where they cross."
        )
    section = measure_section(plane, points, edges, error, found.shared)
    if found.crossings or found.doubled:
        warnings.append("Its faces overlap or cross themselves; what they share counts once for each of them.")
    if found.lost:
        warnings.append("It has too many edges to compare all of them; overlaps may have been missed.")
    if plane.off > 4.0 * error:
        warnings.append(
            "Its points are up to {:.2g} of its size off one plane; they were projected on it.".format(
                plane.off / np.sqrt(section.area)
            )
        )
    if reading.drawn is not None and abs(reading.drawn * unit**2 - section.area) > FILLED * section.area:
        warnings.append(
            "Blender fills its outlines wrongly and draws {:.3g} % of the area; the outlines count.".format(
                100.0 * reading.drawn * unit**2 / section.area
            )
        )
    return section, warnings


def outdated(obj: Object, scene: bpy.types.Scene, found: record.StoredSection) -> str:
    """Why the stored section is out of date, "" where it is not."""
    if found.unit != decimal(scene.unit_settings.scale_length):
        return "Unit Scale Changed"
    return staleness.section_reason(obj)


class OBJECT_OT_body_moments_measure_section(Operator):
    """Compute the section properties of what is selected"""

    bl_idname = "object.body_moments_measure_section"
    bl_label = "Measure Section"
    bl_description = (
        "Compute the section properties of the selected faces in Edit Mode, or of the selected flat objects, 2-D "
        "curves and texts, and store them on each"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if not _chosen(context):
            cls.poll_message_set("Select faces of a mesh in Edit Mode, or a flat mesh, a 2-D curve or a text")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        depsgraph = context.evaluated_depsgraph_get()
        found, failed = [], []
        for obj in _chosen(context):
            try:
                properties.require_storable(obj)
                found.append((obj, *section_of(obj, depsgraph)))
            except Exception as error:
                reason = internal_error.reason(error, (Unreadable, RuntimeError))
                failed.append("{:s}: {:s}".format(obj.name_full, reason))
        unit = decimal(context.scene.unit_settings.scale_length)
        for obj, section, what, warnings in found:
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
            record.store(obj, section, what, warnings, mark, unit)
        staleness.settle_marks(context, [(obj, record.fingerprint(obj)) for obj, *_ in found])
        selection.redraw(context)
        warned = sum(bool(alarms(warnings)) for *_, warnings in found)
        one = "Measured the section of {:s}, with warnings" if warned else "Measured the section of {:s}"
        told = (
            ["Measured {:d} sections".format(len(found))]
            if len(found) > 1
            else [one.format(obj.name) for obj, *_ in found]
        )
        if warned and len(found) > 1:
            told.append("{:d} with warnings".format(warned))
        self.report({"WARNING"} if failed or warned else {"INFO"}, selection.in_a_row(told + selection.listed(failed)))
        return {"FINISHED"} if found else {"CANCELLED"}


class OBJECT_OT_body_moments_copy_section(Operator):
    """Copy the stored section properties of the active object to the clipboard, as text in SI units"""

    bl_idname = "object.body_moments_copy_section"
    bl_label = "Copy Report"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is None or record.stored(context.object) is None:
            cls.poll_message_set("Measure a section first")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        obj = context.object
        found = record.stored(obj)
        text = record.text(obj.name, found, outdated(obj, context.scene, found))
        to_clipboard(self, context, text, "Copied the section of {:s}".format(obj.name))
        return {"FINISHED"}


def _chosen(context: Context) -> list[Object]:
    """The meshes being edited, else the selected objects that may have a section."""
    if context.mode != "EDIT_MESH":
        return [obj for obj in context.view_layer.objects.selected if obj.type in SECTION_TYPES]
    edited = [obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.data.is_editmode]
    # Where none has selected faces, each is told so.
    return [obj for obj in edited if obj.data.total_face_sel] or edited


CLASSES = (OBJECT_OT_body_moments_measure_section, OBJECT_OT_body_moments_copy_section)
