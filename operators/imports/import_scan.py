# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Import a scan: a file of samples becomes a Volume object.

Blender takes voxels from .vdb files only, so one is written beside the scan.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntVectorProperty, StringProperty
from bpy.types import Context, Menu, Object, Operator
from bpy_extras.io_utils import ImportHelper
from numpy.typing import NDArray

from ...blender.read.grids.vdb import openvdb
from ...blender.settings.grid_values import positions_text
from ...blender.settings.limits import scan_limits
from ...blender.write import reports
from ...core.numerics.float32 import shortest_decimal
from ...core.scans.formats import SUFFIXES, read_scan, sample_matrix, scan_suffix
from ...core.scans.numpy_files import TYPES, read_raw
from ...core.scans.positions import Positions, place_samples, read_all_positions
from ...core.scans.scan import Scan
from ...core.streams.findings import FILE_UNREADABLE
from ...core.verdict.finding import FileError, Finding, MeasureError, finding, system_reason
from ..findings import (
    FILE_EXISTS,
    NO_IMPORT_FILE,
    OPENVDB_MISSING,
    SCAN_CT_NUMBERS,
    SCAN_DRAWN_EVENLY,
    SCAN_IMPORTED,
    SCAN_NON_FINITE,
    VOLUME_NOT_WRITTEN,
)

GRID_NAME = "density"
SAMPLES_PER_SLAB = 1 << 22  # samples at a time


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
    x_positions: StringProperty(
        name="X Positions",
        description="A .npy file with the position of each sample along x, ascending. Empty if they are even",
        subtype="FILE_PATH",
    )
    y_positions: StringProperty(
        name="Y Positions",
        description="A .npy file with the position of each sample along y, ascending. Empty if they are even",
        subtype="FILE_PATH",
    )
    z_positions: StringProperty(
        name="Z Positions",
        description="A .npy file with the position of each sample along z, ascending. Empty if they are even",
        subtype="FILE_PATH",
    )
    position_unit: FloatProperty(
        name="Unit of Positions",
        description="Meters per unit of the files of positions",
        default=1.0,
        min=1e-9,
        precision=6,
    )
    overwrite: BoolProperty(
        name="Overwrite",
        description="Replace an existing .vdb file beside the scan",
        default=False,
    )
    allow_outside: BoolProperty(
        name="Allow Outside",
        description="Read a file of samples that the header names outside of its own folder. Only for trusted headers",
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
            return reports.unavailable(cls, "Switch to Object Mode")
        return True

    def execute(self, context: Context) -> set[str]:
        try:
            findings = self._import(context)
        except MeasureError as error:
            reports.report(self, reports.refusal(error.about(Path(self.filepath).name)))
            return {"CANCELLED"}
        reports.report(self, *findings)
        return {"FINISHED"}

    def _import(self, context: Context) -> list[Finding]:
        """Make the object, and return findings about the steps and decisions."""
        module = openvdb()
        if module is None:
            raise FileError(OPENVDB_MISSING)
        path = Path(bpy.path.abspath(self.filepath))
        if path.is_dir():
            raise FileError(NO_IMPORT_FILE)
        target = path.with_name(path.name[: -len(scan_suffix(path))] + ".vdb")
        scan = self._scan(path)
        matrix, decided = sample_matrix(
            scan, tuple(map(shortest_decimal, self.spacing)) if self.use_spacing else None, None, None
        )
        files = self._position_files()
        positions = _read_positions(files, scan)
        matrix, positions = place_samples(matrix, positions, shortest_decimal(self.position_unit))
        for axis, row in enumerate(positions):
            if row is not None:  # Blender's voxels are even: the first and the last are where they belong
                matrix[:3, axis] *= row[-1] / (len(row) - 1)
        if target.exists() and not self.overwrite:
            raise FileError(FILE_EXISTS, file=target.name)
        matrix[:3] /= shortest_decimal(context.scene.unit_settings.scale_length)
        try:
            low = _write(module, target, scan, matrix)
        except (OSError, RuntimeError) as error:  # OpenVDB's own errors are RuntimeErrors
            raise FileError(VOLUME_NOT_WRITTEN, error=getattr(error, "strerror", None) or str(error)) from error
        obj = _object(context, target)
        obj.body_moments.sample_positions = positions_text(positions)
        findings = [finding(SCAN_IMPORTED, samples=list(scan.samples.shape), file=target.name), *decided]
        if files:
            findings.append(finding(SCAN_DRAWN_EVENLY, axes=sorted(files)))
        if low < 0.0:
            obj.body_moments.values_from = "TABLE"
            findings.append(finding(SCAN_CT_NUMBERS))
        return findings

    def _position_files(self) -> dict[str, str]:
        files = {"x": self.x_positions, "y": self.y_positions, "z": self.z_positions}
        return {axis: bpy.path.abspath(path) for axis, path in files.items() if path}

    def _scan(self, path: Path) -> Scan:
        limits = replace(scan_limits(), allow_outside=self.allow_outside)
        try:
            if scan_suffix(path) == ".raw" and all(self.raw_shape):
                return read_raw(path, self.raw_shape, self.raw_type, self.raw_big_endian, limits)
            return read_scan(path, limits)
        except OSError as error:
            raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error


def _read_positions(files: dict[str, str], scan: Scan) -> Positions:
    try:
        return read_all_positions(files, scan.samples.shape)
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error


def _write(module: ModuleType, target: Path, scan: Scan, matrix: NDArray) -> float:
    """Write the scan as a grid, whole or not at all, and return its least value.

    The background differs from every sample's value, so that none is lost, but is zero if no sample is negative.
    """
    least, exact = np.inf, True
    for _, slab in _slabs(scan):
        if not np.isfinite(slab.min()) or not np.isfinite(slab.max()):
            raise FileError(SCAN_NON_FINITE)
        least = min(least, float(slab.min()))
        exact = exact and np.array_equal(slab.astype(np.float32), slab)
    kind, grid_of = (np.float32, module.FloatGrid) if exact else (np.float64, module.DoubleGrid)
    grid = grid_of(0.0 if least >= 0.0 else float(np.nextafter(kind(least), kind(-np.inf))))
    grid.name, grid.gridClass = GRID_NAME, "fog volume"
    grid.transform = module.createLinearTransform(matrix.T.tolist())
    for start, slab in _slabs(scan):
        grid.copyFromArray(np.ascontiguousarray(slab), ijk=(start, 0, 0))
    partial = target.with_name("{:s}.{:d}.partial.vdb".format(target.stem, os.getpid()))
    try:
        module.write(str(partial), grid)
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)
    return least


def _slabs(scan: Scan) -> Iterator[tuple[int, NDArray[np.float64]]]:
    samples = scan.samples
    planes = max(1, SAMPLES_PER_SLAB // (samples.shape[1] * samples.shape[2]))
    for start in range(0, samples.shape[0], planes):
        yield start, samples[start : start + planes].astype(np.float64) * scan.slope + scan.intercept


def _object(context: Context, path: Path) -> Object:
    volume = bpy.data.volumes.new(path.stem)
    volume.filepath = str(path)
    obj = bpy.data.objects.new(path.stem, volume)
    obj.body_moments.grid = GRID_NAME
    context.collection.objects.link(obj)
    for previous in context.selected_objects:
        previous.select_set(False)
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
