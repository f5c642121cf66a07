# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of .stl, .ply and .3mf files as objects of the open scene, with the names that Blender's importers give."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from ...core.scans.limits import scan_limits
from ...core.streams.boxes import box_of_blocks
from ...core.streams.file_mesh import FileMesh
from ...core.streams.mesh_file import KINDS
from ...core.streams.threemf import Placed, read_3mf
from ...core.verdict.finding import Finding, finding
from ..findings import FILE_HIDES
from .references import Opened

# Numbers of vertices with a meaning of their own; Blender makes attributes of all others.
_KNOWN = {*("x", "y", "z", "nx", "ny", "nz", "s", "t"), *("red", "green", "blue", "alpha")}
_SHEAR = 1e-6  # relative to the largest entry of a matrix; larger than the rounding of float32


def import_mesh(path: str) -> None:
    """Add the mesh of an .stl or .ply file to the scene. Raises FileError."""
    mesh = KINDS[Path(path).suffix.lower()](Path(path)).mesh()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(mesh.name, blender_mesh(mesh)))
    bpy.context.view_layer.update()


def blender_mesh(found: FileMesh) -> bpy.types.Mesh:
    """Return a file's mesh as data of Blender. FileError if a coordinate is too large for it."""
    with np.errstate(over="ignore"):
        points = found.points.astype(np.float32)
    box_of_blocks([points], "vertex")
    mesh = bpy.data.meshes.new(found.name)
    mesh.vertices.add(len(points))
    if len(points):  # Attributes are set several times faster than properties.
        mesh.attributes["position"].data.foreach_set("vector", points.ravel())
    mesh.edges.add(len(found.edges))
    mesh.edges.foreach_set("vertices", found.edges.astype(np.int32).ravel())
    mesh.loops.add(len(found.corners))
    if len(found.corners):
        mesh.attributes[".corner_vert"].data.foreach_set("value", found.corners.astype(np.int32))
    mesh.polygons.add(len(found.sides))
    mesh.polygons.foreach_set("loop_start", (np.cumsum(found.sides) - found.sides).astype(np.int32))
    for name, values in found.values.items():
        if name not in _KNOWN:
            mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values)
    mesh.update(calc_edges=True)
    return mesh


def import_3mf(path: str) -> Opened:
    """Add the file's objects to the scene, and set its unit to the file's. Raises FileError."""
    placed, unit = read_3mf(path, scan_limits())
    hidden: dict[str, Finding] = {}
    bpy.context.scene.unit_settings.scale_length = unit
    meshes: dict[tuple[str, str], bpy.types.Mesh] = {}
    for one in placed:
        if one.key not in meshes:
            meshes[one.key] = _mesh(one)
        obj = bpy.data.objects.new(one.name, meshes[one.key])
        bpy.context.scene.collection.objects.link(obj)
        if one.hidden:
            obj.hide_render = True
            hidden[obj.name] = finding(FILE_HIDES, cause=one.hidden)
        obj.matrix_basis = Matrix(one.matrix)
        if np.abs(np.array(obj.matrix_basis) - one.matrix).max() > _SHEAR * np.abs(one.matrix).max():
            obj.matrix_basis = Matrix()  # an object's own channels hold no shear
            obj.data = _mesh(replace(one, points=one.points @ one.matrix[:3, :3].T + one.matrix[:3, 3]))
    bpy.context.view_layer.update()
    return Opened(hidden=hidden)


def _mesh(one: Placed) -> bpy.types.Mesh:
    """Return the mesh as stored in the file, without repair."""
    return blender_mesh(FileMesh(one.name, one.points, one.triangles.ravel(), np.full(len(one.triangles), 3)))
