# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of files that are read here as objects of the open scene, with the names that Blender's importers give."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

from ...core.streams.boxes import box_of_blocks
from ...core.streams.file_mesh import FileMesh
from ...core.streams.mesh_file import KINDS

# Numbers of vertices with a meaning of their own; Blender makes attributes of all others.
_KNOWN = {*("x", "y", "z", "nx", "ny", "nz", "s", "t"), *("red", "green", "blue", "alpha")}


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
