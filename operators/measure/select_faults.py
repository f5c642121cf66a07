# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure and Select Faults: the defects of a mesh, selected in Edit Mode."""

from __future__ import annotations

from dataclasses import fields

import bmesh
import bpy
import numpy as np
from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator

from ...blender.bodies.measure_object import measure_object
from ...blender.scene.findings import LINKED_OBJECT
from ...blender.session.stored import density
from ...blender.session.tracking import staleness
from ...blender.write import properties, reports
from ...core.measurement.measurement import Measurement
from ...core.verdict.finding import EditRefusedError, finding
from ...core.verdict.findings import FLIPPED_FACES
from ...core.verdict.health import DefectiveElements
from .. import selection
from ..findings import MODIFIED_MESH, NO_DEFECTS, OBJECT_DEFECTS, WITH_DEFECTS

DEFECTS = {field.name: "defect_" + field.name for field in fields(DefectiveElements)}
# Modifiers that only move vertices: the faults' indices are those of the mesh itself.
DEFORMING_MODIFIERS = {
    "ARMATURE",
    "CAST",
    "CORRECTIVE_SMOOTH",
    "CURVE",
    "DISPLACE",
    "HOOK",
    "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH",
    "LATTICE",
    "MESH_DEFORM",
    "NORMAL_EDIT",
    "SHRINKWRAP",
    "SIMPLE_DEFORM",
    "SMOOTH",
    "SURFACE_DEFORM",
    "UV_PROJECT",
    "UV_WARP",
    "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX",
    "VERTEX_WEIGHT_PROXIMITY",
    "VOLUME_DISPLACE",
    "WARP",
    "WAVE",
    "WEIGHTED_NORMAL",
    "DATA_TRANSFER",
}


class OBJECT_OT_body_moments_select_faults(Operator):
    """Measure the selected meshes and select their defects in Edit Mode."""

    bl_idname = "object.body_moments_select_faults"
    bl_label = "Select Defects"
    bl_description = (
        "Measure the selected meshes and select their defects in Edit Mode: boundary and non-manifold edges, and "
        "flipped, duplicate and zero-area faces. Objects without defects are deselected"
    )
    bl_options = {"REGISTER", "UNDO"}

    kinds: EnumProperty(
        name="Defects",
        description="Kinds of defects that are selected",
        options={"ENUM_FLAG"},
        items=(
            (FLIPPED_FACES, "Flipped Faces", "Faces that were measured as reversed"),
            ("boundary_edges", "Boundary Edges", "Edges of one face, around holes"),
            ("non_manifold_edges", "Non-Manifold Edges", "Edges of more than two faces"),
            ("inconsistent_edges", "Opposite Normals", "Edges whose two faces point to opposite sides"),
            ("duplicate_faces", "Duplicate Faces", "Later copies of faces"),
            ("degenerate_faces", "Zero-Area Faces", "Faces without area"),
        ),
        default={*DEFECTS},
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            return reports.unavailable(cls, "Switch to Object Mode")
        if not any(obj.type == "MESH" for obj in context.view_layer.objects.selected):
            return reports.unavailable(cls, "Select mesh objects")
        return True

    def execute(self, context: Context) -> set[str]:
        editing = context.mode == "EDIT_MESH"
        if editing:
            bpy.ops.object.mode_set(mode="OBJECT")
        objects = [obj for obj in context.view_layer.objects.selected if obj.type == "MESH"]
        depsgraph = context.evaluated_depsgraph_get()
        measurements: dict[Object, Measurement] = {}
        faults: dict[Object, dict[str, np.ndarray]] = {}

        def measure(obj: Object) -> None:
            require_editable_mesh(obj)
            measurements[obj] = measure_object(obj, depsgraph)

        def store(obj: Object) -> None:
            staleness.note_edits(obj)
            properties.store(obj, density.noted(obj, measurements[obj], context.scene))
            wrong = {kind: found for kind, found in _defects_by_kind(measurements[obj]).items() if kind in self.kinds}
            if wrong:
                faults[obj] = wrong

        # Not each stored as it is measured: Blender would evaluate the scene again for every one of them.
        _, failures = selection.apply_to_all(objects, measure)
        stored, unstored = selection.apply_to_all(list(measurements), store)
        failures += unstored
        if faults:
            _show_defects(context, faults)
        elif editing:
            bpy.ops.object.mode_set(mode="EDIT")
        staleness.mark_up_to_date(context, stored)
        done = finding(NO_DEFECTS, count=len(stored))
        if faults:
            done = finding(WITH_DEFECTS, count=len(faults), total=len(stored))
        defects = [
            finding(OBJECT_DEFECTS, object=obj.name, defects=_counts(measurements))
            for obj, measurements in faults.items()
        ]
        return selection.summarize(self, len(stored), len(objects), done, failures, defects)


def require_editable_mesh(obj: Object) -> None:
    """Raise EditRefusedError if the measured mesh is not the editable one."""
    if not obj.data.is_editable:  # nor is it then of a linked object
        raise EditRefusedError(LINKED_OBJECT)
    changing = [
        modifier.name
        for modifier in obj.modifiers
        if modifier.show_viewport and modifier.type not in DEFORMING_MODIFIERS
    ]
    if changing:
        raise EditRefusedError(MODIFIED_MESH, modifiers=changing)


def _defects_by_kind(measurement: Measurement) -> dict[str, np.ndarray]:
    """By kind, without the kinds that have none."""
    elements = measurement.health.defective_elements
    arrays = {field.name: np.asarray(getattr(elements, field.name), np.int64) for field in fields(elements)}
    return {name: indices for name, indices in arrays.items() if len(indices)}


def _counts(found: dict[str, np.ndarray]) -> list[dict]:
    return [finding(DEFECTS[kind], count=len(indices)).as_record() for kind, indices in found.items()]


def _show_defects(context: Context, faults: dict[Object, dict[str, np.ndarray]]) -> None:
    """Edit Mode on the faulty objects alone, with their faults selected."""
    for obj in list(context.view_layer.objects.selected):
        if obj not in faults:
            obj.select_set(False)
    if context.view_layer.objects.active not in faults:
        context.view_layer.objects.active = next(iter(faults))
    dimensions = {indices.ndim for elements in faults.values() for indices in elements.values()}
    context.tool_settings.mesh_select_mode = (False, 2 in dimensions, 1 in dimensions)
    bpy.ops.ed.undo_push(message="Measure")  # the undo step of Edit Mode that follows holds meshes only
    bpy.ops.object.mode_set(mode="EDIT")
    for obj, elements in faults.items():
        _select_elements(obj, elements)


def _select_elements(obj: Object, elements: dict[str, np.ndarray]) -> None:
    """Select exactly the faults: (k, 2) arrays are edges by their vertices, (k,) arrays are faces."""
    edges = [indices for indices in elements.values() if indices.ndim == 2]
    faces = [indices for indices in elements.values() if indices.ndim == 1]
    mesh = bmesh.from_edit_mesh(obj.data)
    for sequence in (mesh.verts, mesh.edges, mesh.faces):
        sequence.ensure_lookup_table()
    for sequence in (mesh.faces, mesh.edges, mesh.verts):
        for element in sequence:
            element.select = False
    for start, end in (pair for indices in edges for pair in indices.tolist()):
        edge = mesh.edges.get((mesh.verts[start], mesh.verts[end]))
        if edge is not None:  # the diagonals of a tessellation are no edges of the mesh
            edge.hide_set(False)
            edge.select_set(True)
    for index in (index for indices in faces for index in indices.tolist()):
        mesh.faces[index].hide_set(False)
        mesh.faces[index].select_set(True)
    bmesh.update_edit_mesh(obj.data)


CLASSES = (OBJECT_OT_body_moments_select_faults,)
