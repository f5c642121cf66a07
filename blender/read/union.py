# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The union of overlapping shells, by Blender's own exact boolean, in a scene made for the call."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...core.mesh.surface import Surface
from .mesh import mesh_surface


def union_surface(surface: Surface) -> Surface:
    """Return the surface around the union of all shells, in float32; measured about their middle at unit size."""
    points, faces = surface.points.astype(np.float64), surface.all_triangles()[0]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    scale = 2.0 ** np.ceil(np.log2(np.abs(points - middle).max()))  # a power of two rounds nothing

    made = []
    try:
        mesh = _mesh((points - middle) / scale, faces)
        made.append(mesh)
        body = bpy.data.objects.new(mesh.name, mesh)
        made.append(body)
        nothing = bpy.data.collections.new("")  # with no operand the solver still unites the object with itself
        made.append(nothing)
        scene = bpy.data.scenes.new("")
        made.append(scene)
        scene.collection.objects.link(body)
        boolean = body.modifiers.new("", "BOOLEAN")
        boolean.operation, boolean.solver, boolean.use_self = "UNION", "EXACT", True
        boolean.operand_type, boolean.collection = "COLLECTION", nothing
        scene.view_layers[0].update()
        depsgraph = scene.view_layers[0].depsgraph
        evaluated = body.evaluated_get(depsgraph)
        united = mesh_surface(evaluated.to_mesh())
        evaluated.to_mesh_clear()
    finally:
        for data in reversed(made):
            _remove(data)
    # Blender rounds the points to float32 before its boolean and after it, and the points themselves were rounded once.
    united = united.transform(scale * np.eye(3), middle)
    return replace(united, displacement=2.0 * united.coordinate_error + surface.coordinate_error)


def _mesh(points: np.ndarray, triangles: np.ndarray) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new("")
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.update()
    return mesh


def _remove(data: bpy.types.ID) -> None:
    collection = {
        "Mesh": bpy.data.meshes,
        "Object": bpy.data.objects,
        "Collection": bpy.data.collections,
        "Scene": bpy.data.scenes,
    }[data.bl_rna.identifier]
    collection.remove(data)
