# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Import B-spline surfaces: IGES files, and .obj files with free-form surfaces, become surface objects."""

from __future__ import annotations

from pathlib import Path

import bpy
from bpy.props import CollectionProperty, FloatProperty, StringProperty
from bpy.types import Context, Menu, Object, Operator, OperatorFileListElement, UILayout
from bpy_extras.io_utils import ImportHelper

from ...blender.scene.surface_objects import import_bodies
from ...blender.settings.limits import scan_limits
from ...blender.write import reports
from ...blender.write.findings import REFUSED
from ...command.findings import SURFACES_ROUNDED
from ...core.cad.surface_file import SUFFIXES, read_surfaces
from ...core.numerics.float32 import shortest_decimal
from ...core.streams.findings import FILE_UNREADABLE
from ...core.verdict.finding import FileError, Finding, MeasureError, finding, system_reason
from ..findings import NO_SURFACE_FILE, NOT_IMPORTED, SURFACES_IMPORTED


class OBJECT_OT_body_moments_import_surfaces(Operator, ImportHelper):
    """Import the B-spline surfaces of IGES files, and of .obj files with surf, as they are"""

    bl_idname = "object.body_moments_import_surfaces"
    bl_label = "Import Surfaces"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=";".join("*" + end for end in SUFFIXES), options={"HIDDEN"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    files: CollectionProperty(type=OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    unit: FloatProperty(
        name="Unit of .obj",
        description="Meters per unit of .obj files, which state no unit. IGES files state theirs",
        default=1.0,
        min=1e-9,
        soft_min=1e-3,
        soft_max=1.0,
        precision=6,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode != "OBJECT":
            return reports.unavailable(cls, "Switch to Object Mode")
        return True

    def draw(self, _context: Context) -> None:
        layout: UILayout = self.layout
        layout.use_property_split = True
        layout.prop(self, "unit")

    def execute(self, context: Context) -> set[str]:
        made: list[Object] = []
        findings: list[Finding] = []
        for path in self._paths():
            try:
                objects, found = self._import(context, path)
            except MeasureError as error:
                findings.append(reports.refusal(error.about(path.name)))
            else:
                made += objects
                findings += found
        if not made:
            reports.report(self, *(findings or [finding(NO_SURFACE_FILE)]))
            return {"CANCELLED"}
        _select(context, made)
        for found in findings:  # a line for each; what was refused of one file does not undo the others
            reports.report(self, _as_warning(found))
        return {"FINISHED"}

    def _paths(self) -> list[Path]:
        names = [one.name for one in self.files if one.name]
        if names:
            return [Path(bpy.path.abspath(self.directory), name) for name in names]
        path = Path(bpy.path.abspath(self.filepath))
        return [] if path.is_dir() else [path]

    def _import(self, context: Context, path: Path) -> tuple[list[Object], list[Finding]]:
        """Return the objects of a file, and findings about the steps and decisions."""
        try:
            file = read_surfaces(path, scan_limits())
        except OSError as error:
            raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
        scale = shortest_decimal(context.scene.unit_settings.scale_length)
        unit = shortest_decimal(self.unit) if file.unit is None else file.unit
        made = import_bodies(file.bodies, context.collection, unit / scale)
        moved = max(share for _, share in made)
        patches = [patch for body in file.bodies for patch in body.patches]
        order = max(space.order for patch in patches for space in patch.spaces)
        findings = [finding(SURFACES_IMPORTED, count=len(patches), order=order, file=path.name)]
        if moved:
            findings.append(finding(SURFACES_ROUNDED, share=moved))
        return [obj for obj, _ in made], [*findings, *file.refused, *file.notes]


def _as_warning(found: Finding) -> Finding:
    return finding(NOT_IMPORTED, cause=found.as_record()) if found.code == REFUSED else found


def _select(context: Context, made: list[Object]) -> None:
    for previous in context.selected_objects:
        previous.select_set(False)
    visible = [obj for obj in made if obj.name in context.view_layer.objects]
    for obj in visible:
        obj.select_set(True)
    if visible:
        context.view_layer.objects.active = visible[0]


def _menu(menu: Menu, _context: Context) -> None:
    menu.layout.operator(
        OBJECT_OT_body_moments_import_surfaces.bl_idname, text="NURBS Surfaces (.igs/.iges, .obj with surf)"
    )


def register() -> None:
    bpy.utils.register_class(OBJECT_OT_body_moments_import_surfaces)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    bpy.utils.unregister_class(OBJECT_OT_body_moments_import_surfaces)
