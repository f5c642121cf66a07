# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Import a scan: a file of samples becomes a Volume object.

Blender takes voxels from .vdb files only, so one is written beside the scan.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatVectorProperty, IntVectorProperty, StringProperty
from bpy.types import Context, Menu, Object, Operator
from bpy_extras.io_utils import ImportHelper
from numpy.typing import NDArray

from ....core.numerics.float32 import decimal
from ....core.scans.formats import SUFFIXES, placed, read_scan, suffix
from ....core.scans.numpy_files import TYPES, read_raw
from ....core.scans.scan import Scan
from ...read.vdb import openvdb
from .. import selection

GRID = "density"
SLAB = 1 << 22  # samples at a time


class OBJECT_OT_body_moments_import_scan(Operator, ImportHelper):
    """Import a scan or array of densities as a Volume object. A .vdb file is written beside it"""

    bl_idname = "object.body_moments_import_scan"
    bl_label = "Import Scan"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=";".join("*" + end for end in SUFFIXES), options={"HIDDEN"})
    use_spacing: BoolProperty(
        name="Set Spacing",
        description="Use the spacing below instead of the file's",
        default=False,
    )
    spacing: FloatVectorProperty(
        name="Spacing",
        description="Distance between samples along x, y and z in meters",
        default=(0.001, 0.001, 0.001),
        min=1e-9,
        precision=6,
    )
    overwrite: BoolProperty(
        name="Overwrite",
        description="Replace an existing .vdb file beside the scan",
        default=False,
    )
    raw_shape: IntVectorProperty(
        name="Raw Size",
        description="Number of samples of a .raw file along x, y and z, x fastest. 0 if the file name states it",
        default=(0, 0, 0),
        min=0,
    )
    raw_type: EnumProperty(
        name="Raw Type",
        description="Sample type of a .raw file",
        items=[(name, name, "") for name in TYPES],
        default="uint8",
    )
    raw_big_endian: BoolProperty(
        name="Raw Big-Endian",
        description="The most significant byte comes first in a .raw file",
        default=False,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Switch to Object Mode first")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        module = openvdb()
        if module is None:
            self.report(
                {"ERROR"}, "This Python has no openvdb module, without which no volume can be made; use Blender itself"
            )
            return {"CANCELLED"}
        path = Path(bpy.path.abspath(self.filepath))
        if not path.name or path.is_dir():
            self.report({"ERROR"}, "Choose a file to import")
            return {"CANCELLED"}
        target = path.with_name(path.name[: -len(suffix(path)) or None] + ".vdb")
        try:
            scan = self._scan(path)
            matrix, notes = placed(scan, tuple(map(decimal, self.spacing)) if self.use_spacing else None, None, None)
            if target.exists() and not self.overwrite:
                raise ValueError("There is a file “{:s}” already; allow overwriting it.".format(target.name))
            matrix[:3] /= decimal(context.scene.unit_settings.scale_length)
            low = _write(module, target, scan, matrix)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except (OSError, RuntimeError) as error:
            self.report({"ERROR"}, "The volume cannot be written: {:s}".format(str(error)))
            return {"CANCELLED"}
        obj = _object(context, target)
        if low < 0.0:
            obj.body_moments.values_from = "TABLE"
            notes += ("Its negative values are taken as CT numbers, by the transfer table.",)
        told = "Imported {:d} x {:d} x {:d} samples by way of “{:s}”".format(*scan.samples.shape, target.name)
        self.report({"WARNING"} if notes else {"INFO"}, selection.one_line([told, *notes]))
        return {"FINISHED"}

    def _scan(self, path: Path) -> Scan:
        if suffix(path) == ".raw" and all(self.raw_shape):
            return read_raw(path, self.raw_shape, self.raw_type, self.raw_big_endian)
        return read_scan(path)


def _write(module: ModuleType, target: Path, scan: Scan, matrix: NDArray) -> float:
    """Write the scan as a grid, whole or not at all, and tell its least value. The background is no sample's value, so
    that none is lost, but zero where no sample is negative."""
    least, exact = np.inf, True
    for _, slab in _slabs(scan):
        if not np.isfinite(slab.min()) or not np.isfinite(slab.max()):
            raise ValueError("It has samples that are not finite.")
        least = min(least, float(slab.min()))
        exact = exact and np.array_equal(slab.astype(np.float32), slab)
    background = 0.0 if least >= 0.0 else float(np.floor(least) - 1.0)
    grid = (module.FloatGrid if exact else module.DoubleGrid)(background)
    grid.name, grid.gridClass = GRID, "fog volume"
    grid.transform = module.createLinearTransform(matrix.T.tolist())
    for start, slab in _slabs(scan):
        grid.copyFromArray(np.ascontiguousarray(slab, np.float32 if exact else np.float64), ijk=(start, 0, 0))
    partial = target.with_name("{:s}.{:d}.partial.vdb".format(target.stem, os.getpid()))
    try:
        module.write(str(partial), grid)
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)
    return least


def _slabs(scan: Scan) -> Iterator[tuple[int, NDArray[np.float64]]]:
    samples = scan.samples
    planes = max(1, SLAB // (samples.shape[1] * samples.shape[2]))
    for start in range(0, samples.shape[0], planes):
        yield start, samples[start : start + planes].astype(np.float64) * scan.slope + scan.intercept


def _object(context: Context, path: Path) -> Object:
    volume = bpy.data.volumes.new(path.stem)
    volume.filepath = str(path)
    obj = bpy.data.objects.new(path.stem, volume)
    obj.body_moments.grid = GRID
    context.collection.objects.link(obj)
    for other in context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    return obj


def _menu(menu: Menu, _context: Context) -> None:
    menu.layout.operator(OBJECT_OT_body_moments_import_scan.bl_idname, text="Scan of Densities (.nii/.nrrd/.npy)")


def register() -> None:
    bpy.utils.register_class(OBJECT_OT_body_moments_import_scan)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    bpy.utils.unregister_class(OBJECT_OT_body_moments_import_scan)
