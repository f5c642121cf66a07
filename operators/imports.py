# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports: a scan becomes a Volume object; B-spline surfaces of IGES and .obj files, and solids of
STEP files become surface objects.
"""

from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntVectorProperty,
    StringProperty,
)
from bpy.types import Context, Object, Operator, OperatorFileListElement
from bpy_extras.io_utils import ImportHelper

from .. import core
from ..blender import read, scale, scene, write
from ..core import scans, verdict
from . import selection
from .findings import FILE_EXISTS


def _positions(name: str) -> Any:
    """Declare the file with the positions of samples along an axis."""
    return StringProperty(
        name=name,
        description="A .npy file with the position of each sample along the axis, ascending. Empty "
        "if they are even",
        subtype="FILE_PATH",
    )


class OBJECT_OT_body_moments_import_scan(selection.InObjectMode, Operator, ImportHelper):
    """Import a scan or array of densities as a Volume object. A .vdb file is written beside it"""

    bl_label = "Import Scan"

    filter_glob: StringProperty(
        default=";".join("*" + end for end in scans.SUFFIXES), options={"HIDDEN"}
    )
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
    x_positions: _positions("X Positions")
    y_positions: _positions("Y Positions")
    z_positions: _positions("Z Positions")
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
        description="Read a file of samples that the header names outside of its own folder. Only "
        "for trusted headers",
    )
    raw_shape: IntVectorProperty(
        name="Raw Size",
        description="Number of samples of a .raw file along x, y and z, x fastest. 0 if the file "
        "name states it",
        default=(0, 0, 0),
        min=0,
    )
    raw_type: EnumProperty(
        name="Raw Type",
        description="Sample type of a .raw file",
        items=[(name, name, "") for name in scans.SAMPLE_TYPES],
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
        except verdict.MeasureError as error:
            return selection.refuse(self, error.about(path.name))
        return write.reports.report(self, *findings)

    def _import(
        self, context: Context, module: ModuleType, path: Path
    ) -> list[verdict.Finding | str]:
        """Make the object, and return findings and texts about the steps and decisions."""
        limits = replace(core.files.limits.file_limits(), allow_outside=self.allow_outside)
        # None if the file's name states the size
        raw = (self.raw_shape, self.raw_type, self.raw_big_endian) if all(self.raw_shape) else None
        files = {"x": self.x_positions, "y": self.y_positions, "z": self.z_positions}
        files = {axis: bpy.path.abspath(file) for axis, file in files.items() if file}
        spacing = self.spacing if self.use_spacing else None
        placed = scene.read_placed(path, limits, raw, spacing, files, self.position_unit)
        target = placed.target
        if target.exists() and not self.overwrite:
            raise verdict.FileError(FILE_EXISTS, file=target.name)
        unit = scale.meters_per_unit(context.scene)
        try:
            lowest_value = scene.write_volume(module, placed, unit)
        except (OSError, RuntimeError) as error:  # OpenVDB's own errors are RuntimeErrors
            raise verdict.FileError(
                write.findings.FILE_NOT_WRITTEN,
                file=target.name,
                error=getattr(error, "strerror", None) or str(error),
            ) from error
        obj = scene.add_volume(context, placed)
        samples = list(placed.scan.samples.shape)
        texts = [
            write.reports.phrase(
                "Imported {samples:size} samples as “{file}”", samples=samples, file=target.name
            )
        ]
        if files:
            texts.append(
                write.reports.phrase(
                    "Blender draws samples evenly. They are measured where they stand; the ends "
                    "along {axes} are in their places.",
                    axes=sorted(files),
                )
            )
        if lowest_value < 0.0:
            obj.body_moments.values_from = "TABLE"
            texts.append(
                write.reports.phrase(
                    "Negative values are taken as CT numbers, by the transfer table."
                )
            )
        return [*texts, *placed.findings]


class OBJECT_OT_body_moments_import_surfaces(selection.InObjectMode, Operator, ImportHelper):
    """Import the solids of STEP and IGES files, and the surfaces of .obj files with surf"""

    bl_label = "Import CAD"

    filter_glob: StringProperty(default="*.step;*.stp;*.igs;*.iges;*.obj", options={"HIDDEN"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    files: CollectionProperty(type=OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    unit: FloatProperty(
        name="Unit of .obj",
        description="Meters per unit of .obj files, which state no unit. Others state theirs",
        default=1.0,
        min=1e-9,
        soft_min=1e-3,
        soft_max=1.0,
        precision=6,
    )

    def draw(self, _context: Context) -> None:
        selection.draw_properties(self, "unit")

    def execute(self, context: Context) -> set[str]:
        imported: list[Object] = []
        parts: list[verdict.Finding | str] = []
        refusals: list[verdict.MeasureError] = []
        for path in self._paths():
            try:
                objects, file_findings = self._import(context, path)
            except verdict.MeasureError as error:
                refusals.append(error.about(path.name))
            else:
                imported += objects
                parts += file_findings
        if not imported:
            if not refusals:
                return selection.refuse(self, selection.NO_FILE)
            write.reports.report(self, *map(write.reports.refusal, refusals))
            return {"CANCELLED"}
        context.view_layer.update()  # it takes in the new objects
        visible = [obj for obj in imported if obj.name in context.view_layer.objects]
        if visible:
            selection.select_only(context, visible, visible[0])
        # One report each: a refused file does not undo the others.
        for part in [*parts, *(write.reports.failure(error.subject, error) for error in refusals)]:
            write.reports.report(self, part)
        return {"FINISHED"}

    def _paths(self) -> list[Path]:
        names = [file.name for file in self.files if file.name]
        if names:
            return [Path(bpy.path.abspath(self.directory), name) for name in names]
        path = Path(bpy.path.abspath(self.filepath))
        return [] if path.is_dir() else [path]

    def _import(
        self, context: Context, path: Path
    ) -> tuple[list[Object], list[verdict.Finding | str]]:
        """Return the objects of a file, and findings about the steps and decisions."""
        surfaces = scene.import_surfaces(path, core.files.limits.file_limits(), self.unit, context)
        texts = (
            "Imported {count} patch of order {order} from {file}.",
            "Imported {count} patches of order {order} at most from {file}.",
        )
        if not surfaces.order:  # solids have no order
            texts = "Imported {count} solid from {file}.", "Imported {count} solids from {file}."
        summary = write.reports.phrase(
            *texts, count=surfaces.patches, order=surfaces.order, file=path.name
        )
        return surfaces.objects, [summary, *surfaces.findings]
