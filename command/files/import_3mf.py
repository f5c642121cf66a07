# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A .3mf file as objects of the open scene, in its own unit: Blender has no importer for it."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Matrix

from ...blender.settings.limits import scan_limits
from ...core.streams.file_mesh import FileMesh
from ...core.streams.threemf import Placed, read_3mf
from ...core.verdict.finding import Finding, finding
from ..findings import FILE_HIDES
from .import_mesh import blender_mesh
from .references import Opened

_SHEAR = 1e-6  # relative to the largest entry of a matrix; larger than the rounding of float32


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
