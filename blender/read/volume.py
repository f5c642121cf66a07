# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The grid of voxels that an object shows: a Volume object, or an object that nodes turn into a
volume.

Blender's openvdb module reads unchanged grids from their .vdb file, and others from a temporary
file.
"""

import os
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.bodies import Reading, name_subject
from ...core.files import OTHERS_LEFT_OUT
from ...core.mesh import Surface
from ...core.numerics import Array, NDArray, shortest_decimal
from ...core.verdict import Finding, ReadError, finding
from .decisions import modifier_findings
from .findings import (
    GRID_MISSING,
    GRID_NAMES_REPEATED,
    GRID_SIMPLIFIED,
    GRID_UNREADABLE,
    GRID_UNSUPPORTED,
    HIDDEN_OBJECT_MEASURED,
    KIND_COUNT,
    NO_SCALAR_GRID,
    NO_SCALARS,
    SURFACELESS_LEFT_OUT,
    TEMPORARY_FOLDER_FULL,
)
from .objects import locate
from .vdb import VdbGrid
from .visibility import evaluated_geometry, hidden_reason

SCALARS = {"BOOLEAN", "MASK", "FLOAT", "DOUBLE", "INT", "INT64"}
PREFERRED = "density"


@dataclass(kw_only=True)
class VolumeReading(Reading):
    """One grid, and its place.

    grid: its name. level_set: True if it is marked as one, None if unknown. to_object: (4, 4)
    float64 from voxels to the object. shape: (3,) of the box that holds its voxels; low: (3,) its
    offset. background: value outside all voxels. blocks: yields the stored voxels, (offset in the
    box, array). polygons: gives the surface of a level set.
    """

    grid: str
    level_set: bool | None
    to_object: Array
    low: NDArray[np.int64]
    shape: tuple[int, int, int]
    background: float
    blocks: Callable[[], Iterable[tuple[tuple[int, int, int], NDArray]]]
    polygons: Callable[[], Surface]


@contextmanager
def volume_reading(obj, depsgraph, grid: str = "") -> Iterator[VolumeReading | None]:
    """Yield the named grid, else “density” or the first scalar grid; None if polygons or no volume
    are shown.
    """
    obj = obj.original
    evaluated = _volume_and_geometry(obj, depsgraph)
    if evaluated is None:
        yield None
        return
    # The geometry set is kept, because it may own the volume.
    volume, geometry = evaluated
    located = locate(obj, depsgraph)
    findings = located.findings
    name = _choose_grid(obj, volume, grid, findings)
    findings.extend(_volume_findings(obj, geometry, depsgraph))
    with name_subject(obj.name), _open_grid(obj, volume, name, depsgraph, findings) as vdb_grid:
        yield VolumeReading(
            **vars(located),
            grid=name,
            level_set=vdb_grid.level_set,
            to_object=vdb_grid.to_object,
            low=vdb_grid.low,
            shape=tuple(vdb_grid.shape.tolist()),
            background=vdb_grid.background,
            blocks=vdb_grid.blocks,
            polygons=vdb_grid.polygons,
        )


def _volume_findings(obj, geometry: bpy.types.GeometrySet, depsgraph) -> Iterator[Finding]:
    """Yield the findings about an object that shows a volume, and perhaps instances beside it."""
    hidden = hidden_reason(obj, depsgraph)
    if hidden:
        yield finding(HIDDEN_OBJECT_MEASURED, cause=hidden.as_record())
    yield from modifier_findings(obj, depsgraph.scene)
    instances = geometry.instances_pointcloud()
    if instances is not None:
        beside = finding(
            KIND_COUNT, kind="instances beside the volume", count=len(instances.points)
        )
        yield finding(SURFACELESS_LEFT_OUT, kinds=[beside.as_record()])


def _volume_and_geometry(obj, depsgraph) -> tuple[bpy.types.Volume, bpy.types.GeometrySet] | None:
    """Return the evaluated volume, its grids loaded, and its geometry set; None if polygons or no
    volume are shown.
    """
    if obj.type not in {"VOLUME", "MESH", "CURVE", "FONT", "SURFACE", "POINTCLOUD", "CURVES"}:
        return None
    geometry = evaluated_geometry(obj, depsgraph, obj)
    data = obj.evaluated_get(depsgraph).data
    # An object's own volume lives as long as the object, that of a geometry set as long as the set.
    volume = data if isinstance(data, bpy.types.Volume) else geometry.volume
    has_faces = geometry.mesh is not None and len(geometry.mesh.polygons)
    if has_faces or volume is None:
        return None
    # A saved file turns an empty path into that of a folder.
    is_folder = os.path.isdir(bpy.path.abspath(volume.filepath, library=obj.data.library))
    if not volume.grids.load() and not is_folder:
        error = volume.grids.error_message.rstrip(".") or bpy.path.basename(volume.filepath)
        raise ReadError(GRID_UNREADABLE, subject=obj.name, grid=volume.name, error=error)
    if not len(volume.grids):
        if obj.type != "VOLUME" or geometry.instances_pointcloud() is not None:
            return None
        raise ReadError(NO_SCALAR_GRID, subject=obj.name, grids="none")
    return volume, geometry


def _choose_grid(obj, volume: bpy.types.Volume, name: str, findings: list[Finding]) -> str:
    """Return the name of the scalar grid to read: `name`, or if it is empty “density”, else the
    first one. Findings about repeated names and about grids left out are added to `findings`.
    """
    types = {grid.name: grid.data_type for grid in volume.grids}
    if len(types) < len(volume.grids):
        findings.append(finding(GRID_NAMES_REPEATED))
    scalars = [grid for grid, data_type in types.items() if data_type in SCALARS]
    if name:
        if name not in types:
            raise ReadError(GRID_MISSING, subject=obj.name, grid=name, grids=list(types))
        if name not in scalars:
            raise ReadError(GRID_UNSUPPORTED, fault=NO_SCALARS, subject=obj.name, grid=name)
        return name
    if not scalars:
        raise ReadError(NO_SCALAR_GRID, subject=obj.name, grids=list(types))
    chosen = PREFERRED if PREFERRED in scalars else scalars[0]
    left_out = [other for other in types if other != chosen]
    if left_out:
        findings.append(finding(OTHERS_LEFT_OUT, kind="grid", name=chosen, others=left_out))
    return chosen


@contextmanager
def _open_grid(
    obj, volume: bpy.types.Volume, name: str, depsgraph, findings: list[Finding]
) -> Iterator[VdbGrid]:
    is_changed = any(modifier.show_viewport for modifier in obj.modifiers)
    path = volume.grids.frame_filepath
    if not is_changed and obj.data.packed_file is None and os.path.isfile(path):
        yield VdbGrid(path, name)
        return
    render = depsgraph.scene.render
    if render.use_simplify and render.simplify_volumes < 1.0:
        findings.append(finding(GRID_SIMPLIFIED, share=shortest_decimal(render.simplify_volumes)))
    with tempfile.TemporaryDirectory(prefix="body_moments_", dir=bpy.app.tempdir) as folder:
        path = os.path.join(folder, "volume.vdb")
        try:
            volume.grids.save(filepath=path)
        except RuntimeError:
            raise ReadError(TEMPORARY_FOLDER_FULL) from None
        yield VdbGrid(path, name)
