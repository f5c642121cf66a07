# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume objects to test with, made by the openvdb module or by Blender."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.read.vdb import openvdb
from body_moments.blender.settings.options import MeasureOptions

GRIDS = {
    "f4": "FloatGrid",
    "f8": "DoubleGrid",
    "i4": "Int32Grid",
    "i8": "Int64Grid",
    "b1": "BoolGrid",
}


def vdb_grid(
    values: np.ndarray,
    name: str = "density",
    matrix: np.ndarray | None = None,
    offset=(0, 0, 0),
    background=0,
):
    """An OpenVDB grid of the values' own type. matrix: (4, 4) from voxels, column vectors."""
    module = openvdb()
    cls = getattr(module, GRIDS[values.dtype.str[1:]])
    grid = cls(background) if background else cls()
    grid.copyFromArray(np.ascontiguousarray(values), ijk=tuple(offset))
    grid.name = name
    if matrix is not None:
        grid.transform = module.createLinearTransform(np.asarray(matrix, float).T.tolist())
    return grid


def volume_object(path: Path | str, *grids, name: str = "Cloud"):
    """A Volume object in the scene that shows a file of these grids."""
    openvdb().write(str(path), list(grids))
    volume = bpy.data.volumes.new(name)
    volume.filepath = str(path)
    return linked(bpy.data.objects.new(name, volume))


def linked(obj):
    bpy.context.scene.collection.objects.link(obj)
    return obj


def mesh_to_volume(source, voxels: int = 32):
    """A Volume object with a fog made by Blender's modifier from a mesh object."""
    obj = linked(bpy.data.objects.new("Fog", bpy.data.volumes.new("Fog")))
    modifier = obj.modifiers.new("Mesh to Volume", "MESH_TO_VOLUME")
    modifier.object, modifier.voxel_amount = source, voxels
    modifier.interior_band_width = 100.0
    return obj


SHEARED = np.array(
    [[0.5, 0.125, 0.0, 3.0], [0.0, -0.25, 0.0625, -2.0], [0.25, 0.0, 1.0, 0.5], [0, 0, 0, 1]]
)


def depsgraph():
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def measure(obj, **options):
    return measure_object(obj, depsgraph(), MeasureOptions(**options))
