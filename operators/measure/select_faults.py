# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure and Select Faults: the defects of a mesh, selected in Edit Mode."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator

from ... import core
from ...blender import bodies, read, scene, session, write
from ...blender.session.tracking import staleness
from ...core.verdict import FLIPPED_FACES, finding
from .. import findings, selection

KINDS = (
    (FLIPPED_FACES, "Flipped Faces", "Faces that were measured as reversed"),
    ("boundary_edges", "Boundary Edges", "Edges of one face, around holes"),
    ("non_manifold_edges", "Non-Manifold Edges", "Edges of more than two faces"),
    ("inconsistent_edges", "Opposite Normals", "Edges whose two faces point to opposite sides"),
    ("duplicate_faces", "Duplicate Faces", "Later copies of faces"),
    ("degenerate_faces", "Zero-Area Faces", "Faces without area"),
)


class OBJECT_OT_body_moments_select_faults(Operator):
    """Measure the selected meshes and select their defects in Edit Mode: boundary and non-manifold
    edges, and flipped, duplicate and zero-area faces. Objects without defects are deselected
    """

    bl_label = "Select Defects"

    kinds: EnumProperty(
        name="Defects",
        description="Kinds of defects that are selected",
        options={"ENUM_FLAG"},
        items=KINDS,
        default={kind for kind, *_ in KINDS},
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            return write.reports.unavailable(cls, "Switch to Object Mode")
        if not any(obj.type == "MESH" for obj in context.view_layer.objects.selected):
            return write.reports.unavailable(cls, "Select mesh objects")
        return True

    def execute(self, context: Context) -> set[str]:
        editing = context.mode == "EDIT_MESH"
        if editing:
            bpy.ops.object.mode_set(mode="OBJECT")
        objects = [obj for obj in context.view_layer.objects.selected if obj.type == "MESH"]
        depsgraph = context.evaluated_depsgraph_get()
        measurements: dict[Object, core.measurement.Measurement] = {}
        faults: dict[Object, dict[str, Any]] = {}

        def measure(obj: Object) -> None:
            scene.require_editable_mesh(obj)
            measurements[obj] = bodies.measured_in_turn([obj], depsgraph)(obj).measurement

        def store(obj: Object) -> None:
            staleness.note_edits(obj)
            write.properties.store(
                obj, session.stored.density.noted(obj, measurements[obj], context.scene)
            )
            wrong = {
                kind: indices
                for kind, indices in scene.defects_by_kind(measurements[obj]).items()
                if kind in self.kinds
            }
            if wrong:
                faults[obj] = wrong

        # All objects are measured before any is stored: otherwise Blender would evaluate the scene
        # for each of them.
        _, failures = selection.apply_to_all(objects, measure)
        checked, unstored = selection.apply_to_all(list(measurements), store)
        failures += unstored
        if faults:
            _show_defects(context, faults)
        elif editing:
            bpy.ops.object.mode_set(mode="EDIT")
        staleness.mark_up_to_date(context, checked)
        if faults:
            text = write.reports.phrase(
                "{count} of {total} measured objects has defects",
                "{count} of {total} measured objects have defects",
                count=len(faults),
                total=len(checked),
            )
        else:
            text = write.reports.phrase(
                "Measured {count} object: no defects",
                "Measured {count} objects: no defects",
                count=len(checked),
            )
        defects = [
            finding(findings.OBJECT_WARNINGS, object=obj.name, causes=_counts(object_faults))
            for obj, object_faults in faults.items()
        ]
        return selection.summarize(self, len(checked), len(objects), text, failures, defects)


def _counts(faults: dict[str, Any]) -> list[dict]:
    names = {kind: name for kind, name, _ in KINDS}
    return [
        finding(read.findings.KIND_COUNT, kind=names[kind], count=len(indices)).as_record()
        for kind, indices in faults.items()
    ]


def _show_defects(context: Context, faults: dict[Object, dict[str, Any]]) -> None:
    """Enter Edit Mode on the faulty objects alone, and select their faults.

    faults: by object and kind, (n,) indices of faces or (n, 2) vertices of edges.
    """
    for obj in list(context.view_layer.objects.selected):
        if obj not in faults:
            obj.select_set(False)
    if context.view_layer.objects.active not in faults:
        context.view_layer.objects.active = next(iter(faults))
    dimensions = {indices.ndim for elements in faults.values() for indices in elements.values()}
    context.tool_settings.mesh_select_mode = (False, 2 in dimensions, 1 in dimensions)
    # The undo step of Edit Mode that follows holds meshes only, not the stored results.
    bpy.ops.ed.undo_push(message="Measure")
    bpy.ops.object.mode_set(mode="EDIT")
    for obj, elements in faults.items():
        scene.select_elements(obj, elements)
