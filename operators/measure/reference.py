# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about a reference: store it, write it, and take an axis' points from the selection."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bmesh
from bpy.types import Context, Object, Operator
from mathutils import Vector

from ...blender.session import stored
from ...blender.write import properties, reports
from ...core.inertia.plain_body import tensor_rows
from .. import selection

if TYPE_CHECKING:
    from ...blender.session.stored.reference import ReferenceChoice
    from ...core.inertia.reference import ReferredInertia

POINTS = 2  # points of an axis


class OBJECT_OT_body_moments_store_reference(selection.OnSelection, Operator):
    """Store the inertia of the selected objects about the chosen reference as custom properties"""

    bl_idname = "object.body_moments_store_reference"
    bl_label = "Store Inertia about Reference"

    def execute(self, context: Context) -> set[str]:
        objects = [obj for obj in context.view_layer.objects.selected if properties.is_stored(obj)]

        def store(obj: Object) -> None:
            stored.reference.store(obj, context.scene)
            properties.retrigger_drivers(obj)

        with stored.assembly.kept_up_to_date(context):  # the results are bound to their places, and stay the same
            changed, failures = selection.apply_to_all(objects, store)
        texts = (
            "Stored the inertia of {count} object about the reference",
            "Stored the inertia of {count} objects about the reference",
        )
        done, nothing = reports.phrase(*texts, count=len(changed)), "The selected objects have no results"
        return selection.summarize(self, len(changed), len(objects), done, failures, nothing=nothing)


def reference_text(name: str, choice: ReferenceChoice, result: ReferredInertia) -> str:
    """Return the text of an object's inertia about a reference, with its bounds."""
    axes, inertia = (list(map(list, rows)) for rows in (zip(*result.reference.axes), tensor_rows(result.inertia)))
    lines = [
        "{:s}, about {:s}".format(name, choice.text),
        "origin (m, world) {!r}".format(list(result.reference.origin)),
        "axes (columns, world) {!r}".format(axes),
        "mass (kg) {!r}".format(result.mass),
        "center of mass (m, from the origin, along the axes) {!r}".format(list(result.center)),
        "inertia (kg·m², about the origin, along the axes, Ixy = −∫xy dm) {!r}".format(
            list(map(list, tensor_rows(result.inertia)))
        ),
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
        points = _selected_points(context)
        if len(points) != POINTS:
            text = "{count} points are selected. Select two vertices, or two objects."
            return selection.refuse(self, text, count=len(points))
        settings = context.scene.body_moments_reference
        settings.about, settings.first, settings.second = "AXIS", points[0], points[1]
        selection.redraw(context)
        return {"FINISHED"}


def _selected_points(context: Context) -> list[Vector]:
    """Return world positions: of vertices as selected in Edit Mode, else of objects' origins, the active one last."""
    if context.mode != "EDIT_MESH":
        objects = sorted(context.view_layer.objects.selected, key=lambda obj: (obj == context.object, obj.name))
        return [obj.matrix_world.translation for obj in objects]
    points = []
    for obj in context.objects_in_mode_unique_data:
        mesh = bmesh.from_edit_mesh(obj.data)
        chosen = [vertex for vertex in mesh.select_history if isinstance(vertex, bmesh.types.BMVert)]
        chosen += [vertex for vertex in mesh.verts if vertex.select and vertex not in chosen]
        points += [obj.matrix_world @ vertex.co for vertex in chosen]
    return points


CLASSES = (
    OBJECT_OT_body_moments_store_reference,
    OBJECT_OT_body_moments_axis_from_selection,
)
