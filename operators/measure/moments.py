# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, section properties of what is flat, and the inertia about a
reference.
"""

from __future__ import annotations

import bmesh
from bpy.types import Context, Object, Operator
from mathutils import Vector

from ... import core
from ...blender import bodies, read, write
from ...blender.session import stored
from ...core.inertia import tensor_rows
from ...core.verdict import Severity, of_severity
from .. import selection


class OBJECT_OT_body_moments_compute_moments(selection.OnSubject, Operator):
    """Compute all moments of the active object's volume, surface and mass, or of the area of what
    is flat, up to the chosen order. A million triangles take about 1 second at order 4 and 20
    seconds at order 20
    """

    bl_label = "Compute Moments"
    bl_options = {"REGISTER"}

    def _change(self, context: Context, obj: Object) -> set[str]:
        order: int = context.scene.body_moments.moments_order
        computed, findings = stored.compute_moments(context, obj, order)
        if computed is None:
            write.reports.report(
                self,
                write.reports.phrase(
                    "{object}: a wire has no volume or surface. Set Kind to Solid or Shell; "
                    "measure --order gives moments of length.",
                    object=obj.name,
                ),
                level=Severity.WARNING,
            )
            return {"CANCELLED"}
        stored.moments.cache_moments(obj, computed, context.evaluated_depsgraph_get())
        # A flat shape has the moments of x^i y^j with i + j ≤ order: 1 + 2 + … + (order + 1).
        count = (
            (order + 1) * (order + 2) // 2 if computed.volume is None else len(computed.volume.raw)
        )
        summary = write.reports.phrase(
            "Computed {count} moments of {object}", count=count, object=obj.name
        )
        return selection.report(self, summary, *findings)


class OBJECT_OT_body_moments_measure_section(Operator):
    """Compute the section properties of the selected faces in Edit Mode, or of the selected flat
    meshes, 2D curves and texts, and store them on the objects
    """

    bl_label = "Measure Section"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return bool(_objects_with_sections(context)) or write.reports.unavailable(
            cls, "Select faces in Edit Mode, or a flat mesh, 2D curve or text"
        )

    def execute(self, context: Context) -> set[str]:
        depsgraph = context.evaluated_depsgraph_get()
        sections = []

        def measure(obj: Object) -> None:
            write.properties.require_storable(obj)
            sections.append((obj, bodies.section_of(obj, depsgraph)))

        measured, failures = selection.apply_to_all(_objects_with_sections(context), measure)
        stored.results.store_sections(context, sections)
        warned = [
            obj.name
            for obj, (_, _, findings) in sections
            if of_severity(findings, Severity.WARNING, Severity.ERROR)
        ]
        if len(measured) == 1:
            text = (
                "Measured the section of {object}, with warnings"
                if warned
                else "Measured the section of {object}"
            )
            summary = [write.reports.phrase(text, object=measured[0].name)]
        else:
            summary = (
                [
                    write.reports.phrase(
                        "Measured {count} section", "Measured {count} sections", count=len(measured)
                    )
                ]
                if measured
                else []
            )
            summary += selection.name_warned(warned)
        level = Severity.WARNING if warned else Severity.NOTE
        return selection.finish(self, summary, failures, level=level, is_changed=bool(measured))


def _objects_with_sections(context: Context) -> list[Object]:
    """Return edited meshes with selected faces (all if none has), else selected objects that may
    have a section.
    """
    if context.mode != "EDIT_MESH":
        return [
            obj
            for obj in context.view_layer.objects.selected
            if obj.type in read.visibility.SECTION_TYPES
        ]
    edited = [
        obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.data.is_editmode
    ]
    # If no mesh has selected faces, each is refused.
    return [obj for obj in edited if obj.data.total_face_sel] or edited


POINTS = 2  # An axis goes through two points.


class OBJECT_OT_body_moments_store_reference(selection.OnSelection, Operator):
    """Store the inertia of the selected objects about the chosen reference as custom properties"""

    bl_label = "Store Inertia about Reference"

    def execute(self, context: Context) -> set[str]:
        objects = [
            obj for obj in context.view_layer.objects.selected if write.properties.is_stored(obj)
        ]

        def store(obj: Object) -> None:
            stored.reference.store(obj, context.scene)
            write.properties.retrigger_drivers(obj)

        # The new properties change no result: an assembly that was up to date stays so.
        with stored.assembly.kept_up_to_date(context):
            return selection.change_all(
                self,
                objects,
                store,
                (
                    "Stored the inertia of {count} object about the reference",
                    "Stored the inertia of {count} objects about the reference",
                ),
                nothing=selection.NO_RESULTS,
            )


def reference_text(
    name: str, choice: stored.reference.ReferenceChoice, result: core.inertia.ReferredInertia
) -> str:
    """Return the text of an object's inertia about a reference, with its bounds."""
    # The reference lists its axes; they become the columns of a matrix.
    axes = [list(row) for row in zip(*result.reference.axes)]
    inertia = [list(row) for row in tensor_rows(result.inertia)]
    lines = [
        "{:s}, about {:s}".format(name, choice.text),
        "origin (m, world) {!r}".format(list(result.reference.origin)),
        "axes (columns, world) {!r}".format(axes),
        "mass (kg) {!r}".format(result.mass),
        "center of mass (m, from the origin, along the axes) {!r}".format(list(result.center)),
        "inertia (kg·m², about the origin, along the axes, Ixy = −∫xy dm) {!r}".format(inertia),
    ]
    if choice.about == "AXIS":
        lines.append("about the axis (kg·m²) {!r}".format(result.about_z))
        lines.append("radius of gyration (m) {!r}".format(result.radius_about_z))
        lines.append("distance of the center of mass (m) {!r}".format(result.distance_from_z))
    lines.append(
        "rounding, at most {!r}; float32 coordinates, at most {!r}".format(
            result.rounding_error, result.input_error
        )
    )
    return "\n".join(lines) + "\n"


class OBJECT_OT_body_moments_axis_from_selection(Operator):
    """Take the axis from two selected vertices in Edit Mode or from two objects' origins"""

    bl_label = "Axis from Selection"

    def execute(self, context: Context) -> set[str]:
        points = _selected_points(context)
        if len(points) != POINTS:
            return selection.refuse(
                self,
                "{count} points are selected. Select two vertices, or two objects.",
                count=len(points),
            )
        settings = context.scene.body_moments_reference
        settings.about = "AXIS"
        settings.first = points[0]
        settings.second = points[1]
        selection.redraw(context)
        return {"FINISHED"}


def _selected_points(context: Context) -> list[Vector]:
    """Return world positions: of vertices as selected in Edit Mode, else of objects' origins, the
    active one last.
    """
    if context.mode != "EDIT_MESH":
        objects = sorted(
            context.view_layer.objects.selected, key=lambda obj: (obj == context.object, obj.name)
        )
        return [obj.matrix_world.translation for obj in objects]
    points = []
    for obj in context.objects_in_mode_unique_data:
        mesh = bmesh.from_edit_mesh(obj.data)
        vertices = [
            vertex for vertex in mesh.select_history if isinstance(vertex, bmesh.types.BMVert)
        ]
        vertices += [vertex for vertex in mesh.verts if vertex.select and vertex not in vertices]
        points += [obj.matrix_world @ vertex.co for vertex in vertices]
    return points
