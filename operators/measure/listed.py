# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of measured objects: a click selects; the numbers of the selection as a table or a document."""

from __future__ import annotations

from pathlib import Path

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator, Scene

from ...blender.write import reports
from ...core import measurement
from .. import selection
from .copy import OnStored, copy_text, selected_document

SUFFIXES = {".csv": "csv", ".json": "json", ".jsonl": "jsonl"}


class OBJECT_OT_body_moments_copy_csv(OnStored, Operator):
    """Copy the stored mass properties of the selected objects to the clipboard as a table, in SI units"""

    bl_idname = "object.body_moments_copy_csv"
    bl_label = "Copy as CSV"
    bl_options = {"REGISTER"}

    def execute(self, context: Context) -> set[str]:
        document = selected_document(context)
        done = reports.phrase("Copied {count} row.", "Copied {count} rows.", count=len(document["objects"]))
        copy_text(self, context, "".join(measurement.FORMATS["csv"]([document])), done)
        return {"FINISHED"}


class OBJECT_OT_body_moments_save_numbers(OnStored, Operator):
    """Save the stored mass properties of the selected objects and their total, in SI units, as .csv, .json or .jsonl"""

    bl_idname = "object.body_moments_save_numbers"
    bl_label = "Save CSV or JSON"
    bl_options = {"REGISTER"}

    filepath: StringProperty(name="File Path", description="File to write", subtype="FILE_PATH")
    check_existing: BoolProperty(name="Check Existing", default=True, options={"HIDDEN"})
    filter_glob: StringProperty(default="*.csv;*.json;*.jsonl", options={"HIDDEN"})

    def invoke(self, context: Context, _event: Event) -> set[str]:
        return selection.ask_for_table(self, context)

    def check(self, _context: Context) -> bool:
        return selection.ensure_suffix(self, ".csv", SUFFIXES)

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        if not self.filepath:
            return selection.refuse(self, selection.NO_FILE)
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix.lower() not in SUFFIXES:
            return selection.refuse(self, "The format is unknown. Let the file's name end in .csv, .json or .jsonl.")
        document = selected_document(context)
        selection.write_file(path, measurement.FORMATS[SUFFIXES[path.suffix.lower()]]([document]))
        texts = ("Saved {count} object to “{file}”.", "Saved {count} objects to “{file}”.")
        selection.report(self, reports.phrase(*texts, count=len(document["objects"]), file=path.name))
        return {"FINISHED"}


def _active_index(_scene: Scene) -> int:
    objects = bpy.context.view_layer.objects
    active = objects.active
    return -1 if active is None else objects.find(active.name)


def _select(_scene: Scene, index: int) -> None:
    """Select the object of the list's line alone, and make it active; in Object Mode."""
    layer = bpy.context.view_layer
    if bpy.context.mode != "OBJECT" or not 0 <= index < len(layer.objects):
        return
    for obj in layer.objects.selected:
        obj.select_set(False)
    chosen = layer.objects[index]
    chosen.select_set(True)
    layer.objects.active = chosen


CLASSES = (OBJECT_OT_body_moments_copy_csv, OBJECT_OT_body_moments_save_numbers)


def register() -> None:
    """Register the operators, and the line of the list that is the active object's."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Scene.body_moments_listed = IntProperty(
        name="Object", description="Select this object", get=_active_index, set=_select, options={"SKIP_SAVE"}
    )


def unregister() -> None:
    """Remove them."""
    del Scene.body_moments_listed
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
