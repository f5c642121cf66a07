# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Import B-spline surfaces: IGES files, and .obj files with free-form surfaces, become surface objects."""

from pathlib import Path

import bpy
from bpy.props import CollectionProperty, FloatProperty, StringProperty
from bpy.types import Context, Object, Operator, OperatorFileListElement, UILayout
from bpy_extras.io_utils import ImportHelper

from ... import core
from ...blender import scene
from ...blender.write import reports
from ...core.verdict.finding import Finding, MeasureError
from .. import selection


class OBJECT_OT_body_moments_import_surfaces(selection.InObjectMode, Operator, ImportHelper):
    """Import the B-spline surfaces of IGES files, and of .obj files with surf, as they are"""

    bl_idname = "object.body_moments_import_surfaces"
    bl_label = "Import Surfaces"

    filter_glob: StringProperty(default="*.igs;*.iges;*.obj", options={"HIDDEN"})
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

    def draw(self, _context: Context) -> None:
        layout: UILayout = self.layout
        layout.use_property_split = True
        layout.prop(self, "unit")

    def execute(self, context: Context) -> set[str]:
        made: list[Object] = []
        parts: list[Finding | str] = []
        refusals: list[MeasureError] = []
        for path in self._paths():
            try:
                objects, found = self._import(context, path)
            except MeasureError as error:
                refusals.append(error.about(path.name))
            else:
                made += objects
                parts += found
        if not made:
            if not refusals:
                return selection.refuse(self, selection.NO_FILE)
            reports.report(self, *map(reports.refusal, refusals))
            return {"CANCELLED"}
        _select(context, made)
        for part in [*parts, *(reports.failure(error.subject, error) for error in refusals)]:
            reports.report(self, part)  # one line each: a refused file does not undo the others
        return {"FINISHED"}

    def _paths(self) -> list[Path]:
        names = [one.name for one in self.files if one.name]
        if names:
            return [Path(bpy.path.abspath(self.directory), name) for name in names]
        path = Path(bpy.path.abspath(self.filepath))
        return [] if path.is_dir() else [path]

    def _import(self, context: Context, path: Path) -> tuple[list[Object], list[Finding | str]]:
        """Return the objects of a file, and findings about the steps and decisions."""
        found = scene.import_surfaces(path, core.scans.limits.scan_limits(), self.unit, context)
        texts = (
            "Imported {count} patch of order {order} from {file}.",
            "Imported {count} patches of order {order} at most from {file}.",
        )
        done = reports.phrase(*texts, count=found.patches, order=found.order, file=path.name)
        return found.objects, [done, *found.findings]


def _select(context: Context, made: list[Object]) -> None:
    for previous in context.selected_objects:
        previous.select_set(False)
    visible = [obj for obj in made if obj.name in context.view_layer.objects]
    for obj in visible:
        obj.select_set(True)
    if visible:
        context.view_layer.objects.active = visible[0]


CLASSES = (OBJECT_OT_body_moments_import_surfaces,)
ENTRY = selection.menu_entry(*CLASSES, text="NURBS Surfaces (.igs/.iges, .obj with surf)")
MENUS = ((bpy.types.TOPBAR_MT_file_import, ENTRY),)
