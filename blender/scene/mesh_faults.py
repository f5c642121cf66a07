# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults of meshes: their elements, selected in Edit Mode or repaired."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields

import bmesh
import bpy
import numpy as np
from bpy.types import Object

from ...core.measurement import Measurement
from ...core.verdict import LINKED_OBJECT, EditRefusedError, welding_tolerance
from ..read.mesh import vertex_points
from .findings import SHAPE_NOT_OF_MESH

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


def require_editable_mesh(obj: Object) -> None:
    """Raise EditRefusedError if the mesh is linked, or modifiers give the measured mesh other
    elements.
    """
    if not obj.data.is_editable:  # true of linked objects, too
        raise EditRefusedError(LINKED_OBJECT)
    changing = [
        modifier.name
        for modifier in obj.modifiers
        if modifier.show_viewport and modifier.type not in DEFORMING_MODIFIERS
    ]
    if changing:
        raise EditRefusedError(SHAPE_NOT_OF_MESH, makers=changing)


def defects_by_kind(measurement: Measurement) -> dict[str, np.ndarray]:
    """Return the elements of each kind of defect that a mesh has: (k, 2) vertices of edges, or (k,)
    faces.
    """
    elements = measurement.health.defective_elements
    arrays = {
        field.name: np.asarray(getattr(elements, field.name), np.int64)
        for field in fields(elements)
    }
    return {name: indices for name, indices in arrays.items() if len(indices)}


def select_elements(obj: Object, elements: dict[str, np.ndarray]) -> None:
    """Select exactly these elements of a mesh in Edit Mode."""
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


@contextmanager
def _edited(mesh: bpy.types.Mesh) -> Iterator[bmesh.types.BMesh]:
    """Yield a copy of a mesh to edit, and write it back. EditRefusedError if the mesh is linked."""
    if not mesh.is_editable:
        raise EditRefusedError(LINKED_OBJECT)
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        edited.faces.ensure_lookup_table()
        yield edited
        edited.to_mesh(mesh)
        mesh.update()
    finally:
        edited.free()


def reverse_faces(mesh: bpy.types.Mesh, elements: Sequence[Sequence[int]]) -> int:
    """Reverse the faces in several lists of indices, or all faces if one list is empty; return the
    number.
    """
    if not all(map(len, elements)):
        elements = [range(len(mesh.polygons))]
    indices = sorted({int(index) for part in elements for index in part})
    if indices:
        with _edited(mesh) as edited:
            faces = [edited.faces[index] for index in indices]
            bmesh.ops.reverse_faces(edited, faces=faces, flip_multires=True)
    return len(indices)


def delete_faces(mesh: bpy.types.Mesh, indices: Sequence[int]) -> int:
    """Delete faces, with edges and vertices that nothing else uses; return the number."""
    if len(indices):
        with _edited(mesh) as edited:
            bmesh.ops.delete(
                edited, geom=[edited.faces[index] for index in indices], context="FACES"
            )
    return len(indices)


def fill_holes(mesh: bpy.types.Mesh) -> int:
    """Close the holes of a mesh with faces; return the number of new faces."""
    with _edited(mesh) as edited:
        return len(bmesh.ops.holes_fill(edited, edges=edited.edges[:], sides=0)["faces"])


def merge_by_distance(mesh: bpy.types.Mesh) -> int:
    """Merge vertices that count as one when a body is measured; return the number of vertices that
    are gone.
    """
    points = vertex_points(mesh)
    with _edited(mesh) as edited:
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
        error = float(np.spacing(np.abs(points).max()))
        bmesh.ops.remove_doubles(edited, verts=edited.verts[:], dist=welding_tolerance(size, error))
    return len(points) - len(mesh.vertices)
