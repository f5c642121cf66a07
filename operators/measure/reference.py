# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about a reference: store it, copy it, and take an axis' points from the selection."""

from __future__ import annotations

import bmesh
import numpy as np
from bpy.types import Context, Object, Operator

from ...blender.read.reference import ReferenceChoice
from ...blender.session.stored import reference
from ...blender.write import properties, reports
from ...blender.write.findings import NO_STORED_RESULTS
from ...core.inertia.reference import ReferredInertia
from ...core.verdict.finding import MeasureError, QueryError, finding
from .. import selection
from ..findings import AXIS_NEEDS_TWO_POINTS, REFERENCE_STORED, REPORT_COPIED
from ..modal import redraw
from .copy import copy_text

POINTS = 2  # points of an axis


class OBJECT_OT_body_moments_store_reference(Operator):
    """Store the inertia of the selected objects about the chosen reference as custom properties"""

    bl_idname = "object.body_moments_store_reference"
    bl_label = "Store Inertia about Reference"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context, any_mode=True)

    def execute(self, context: Context) -> set[str]:
        objects = [obj for obj in context.view_layer.objects.selected if properties.is_stored(obj)]

        def store(obj: Object) -> None:
            reference.store(obj, context.scene)
            properties.retrigger_drivers(obj)

        stored, failures = selection.apply_to_all(objects, store)
        done = finding(REFERENCE_STORED, count=len(stored)) if objects else finding(NO_STORED_RESULTS)
        return selection.summarize(self, len(stored), len(objects), done, failures)


class OBJECT_OT_body_moments_copy_reference(Operator):
    """Copy the inertia of the active object about the chosen reference, with its bounds, as text in SI units"""

    bl_idname = "object.body_moments_copy_reference"
    bl_label = "Copy Inertia about Reference"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is None or not properties.is_stored(context.object):
            return reports.unavailable(cls, "Measure the selected objects first")
        return True

    def execute(self, context: Context) -> set[str]:
        result = reference.referred(context.object, context.scene)
        if not isinstance(result, ReferredInertia):
            selection.report(self, result or finding(NO_STORED_RESULTS))
            return {"CANCELLED"}
        text = _text(context.object.name, ReferenceChoice.from_settings(context.scene.body_moments_reference), result)
        copy_text(self, context, text, finding(REPORT_COPIED, count=1))
        return {"FINISHED"}


def _text(name: str, choice: ReferenceChoice, result: ReferredInertia) -> str:
    lines = [
        "{:s}, about {:s}".format(name, choice.text),
        "origin (m, world) {!r}".format(result.reference.origin.tolist()),
        "axes (columns, world) {!r}".format(result.reference.axes.tolist()),
        "mass (kg) {!r}".format(result.mass),
        "center of mass (m, from the origin, along the axes) {!r}".format(result.center.tolist()),
        "inertia (kg·m², about the origin, along the axes, Ixy = −∫xy dm) {!r}".format(result.inertia.tolist()),
    ]
    if choice.about == "AXIS":
        lines.append("about the axis (kg·m²) {!r}".format(result.about_z))
        lines.append("radius of gyration (m) {!r}".format(result.radius_about_z))
        lines.append("distance of the center of mass (m) {!r}".format(result.distance_from_z))
    lines.append(
        "rounding, at most {!r}; float32 coordinates, at most {!r}".format(result.rounding_error, result.input_error)
    )
    return "\n".join(lines) + "\n"


class OBJECT_OT_body_moments_axis_from_selection(Operator):
    """Take the axis from two selected vertices in Edit Mode, or from the origins of two selected objects"""

    bl_idname = "object.body_moments_axis_from_selection"
    bl_label = "Axis from Selection"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        try:
            points = _selected_points(context)
            if len(points) != POINTS:
                raise QueryError(AXIS_NEEDS_TWO_POINTS, count=len(points))
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        settings = context.scene.body_moments_reference
        settings.about, settings.first, settings.second = "AXIS", points[0], points[1]
        redraw(context)
        return {"FINISHED"}


def _selected_points(context: Context) -> list[np.ndarray]:
    """World positions: in Edit Mode in the order in which vertices were selected, else the active object last."""
    if context.mode != "EDIT_MESH":
        objects = sorted(context.view_layer.objects.selected, key=lambda obj: (obj == context.object, obj.name))
        return [np.array(obj.matrix_world.translation[:], np.float64) for obj in objects]
    points = []
    for obj in context.objects_in_mode_unique_data:
        mesh = bmesh.from_edit_mesh(obj.data)
        chosen = [vertex for vertex in mesh.select_history if isinstance(vertex, bmesh.types.BMVert)]
        chosen += [vertex for vertex in mesh.verts if vertex.select and vertex not in chosen]
        matrix = np.array(obj.matrix_world, np.float64)
        points += [matrix[:3, :3] @ np.array(vertex.co[:], np.float64) + matrix[:3, 3] for vertex in chosen]
    return points


CLASSES = (
    OBJECT_OT_body_moments_store_reference,
    OBJECT_OT_body_moments_copy_reference,
    OBJECT_OT_body_moments_axis_from_selection,
)
