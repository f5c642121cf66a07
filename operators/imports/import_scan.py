# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Import a scan: a file of samples becomes a Volume object."""

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntVectorProperty, StringProperty
from bpy.types import Context, Operator
from bpy_extras.io_utils import ImportHelper

from ... import core
from ...blender import read, scene
from ...blender.write import reports
from ...blender.write.findings import FILE_NOT_WRITTEN
from ...core.numerics.float32 import shortest_decimal
from ...core.scans.suffixes import SAMPLE_TYPES, SUFFIXES
from ...core.verdict.finding import FileError, Finding, MeasureError
from .. import selection
from ..findings import FILE_EXISTS


class OBJECT_OT_body_moments_import_scan(selection.InObjectMode, Operator, ImportHelper):
    """Import a scan or array of densities as a Volume object. A .vdb file is written beside it"""

    bl_idname = "object.body_moments_import_scan"
    bl_label = "Import Scan"

    filter_glob: StringProperty(default=";".join("*" + end for end in SUFFIXES), options={"HIDDEN"})
    use_spacing: BoolProperty(
        name="Set Spacing",
        description="Use the spacing below instead of the file's",
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
    )
    allow_outside: BoolProperty(
        name="Allow Outside",
        description="Read a file of samples that the header names outside of its own folder. Only for trusted headers",
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
        items=[(name, name, "") for name in SAMPLE_TYPES],
        default="uint8",
    )
    raw_big_endian: BoolProperty(
        name="Raw Big-Endian",
        description="The most significant byte comes first in a .raw file",
    )

    def execute(self, context: Context) -> set[str]:
        path = Path(bpy.path.abspath(self.filepath))
        if path.is_dir():
            return selection.refuse(self, selection.NO_FILE)
        module = read.vdb.openvdb()
        if module is None:
            return selection.refuse(self, "This Python has no openvdb module. Use Blender.")
        try:
            findings = self._import(context, module, path)
        except MeasureError as error:
            return selection.refuse(self, error.about(path.name))
        reports.report(self, *findings)
        return {"FINISHED"}

    def _import(self, context: Context, module: ModuleType, path: Path) -> list[Finding | str]:
        """Make the object, and return findings and texts about the steps and decisions."""
        limits = replace(core.scans.limits.scan_limits(), allow_outside=self.allow_outside)
        raw = (self.raw_shape, self.raw_type, self.raw_big_endian) if all(self.raw_shape) else None
        files = {"x": self.x_positions, "y": self.y_positions, "z": self.z_positions}
        files = {axis: bpy.path.abspath(file) for axis, file in files.items() if file}
        spacing = self.spacing if self.use_spacing else None
        placed = scene.read_placed(path, limits, raw, spacing, files, self.position_unit)
        target = placed.target
        if target.exists() and not self.overwrite:
            raise FileError(FILE_EXISTS, file=target.name)
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        try:
            low = scene.write_volume(module, placed, unit)
        except (OSError, RuntimeError) as error:  # OpenVDB's own errors are RuntimeErrors
            raise FileError(
                FILE_NOT_WRITTEN, file=target.name, error=getattr(error, "strerror", None) or str(error)
            ) from error
        obj = scene.add_volume(context, placed)
        samples = list(placed.scan.samples.shape)
        texts = [reports.phrase("Imported {samples:size} samples as “{file}”", samples=samples, file=target.name)]
        if files:
            text = (
                "Blender draws samples evenly. They are measured where they stand; the ends along {axes} are in their "
                "places."
            )
            texts.append(reports.phrase(text, axes=sorted(files)))
        if low < 0.0:
            obj.body_moments.values_from = "TABLE"
            texts.append(reports.phrase("Negative values are taken as CT numbers, by the transfer table."))
        return [*texts, *placed.findings]


CLASSES = (OBJECT_OT_body_moments_import_scan,)
ENTRY = selection.menu_entry(*CLASSES, text="Scan of Densities (.nii/.nrrd/.npy)")
MENUS = ((bpy.types.TOPBAR_MT_file_import, ENTRY),)
