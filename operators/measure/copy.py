# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Getting numbers out: one value to the last digit, the report as text, or a table; and the list of objects."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator, OperatorProperties, Scene

from ...blender import read, write
from ...blender.session.tracking import staleness
from ...blender.write import properties, reports
from ...blender.write.translations import localized
from ...core import measurement
from ...core.measurement.trust import open_body_caveats
from ...core.verdict.finding import Severity
from .. import selection


class OnStored:
    """Base of operators that need a selected object with stored results."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        if not selection.poll_selection(cls, context):
            return False
        stored = any(properties.is_stored(obj) for obj in context.view_layer.objects.selected)
        return stored or reports.unavailable(cls, "Measure the selected objects first")


def copy_text(operator: Operator, context: Context, text: str, done: str) -> None:
    """Copy a text to the clipboard, and report `done`.

    In background mode there is no clipboard, and long reports are cut short: the text goes to the standard output.
    """
    if bpy.app.background:
        sys.stdout.write(text.removesuffix("\n") + "\n")
    else:
        context.window_manager.clipboard = text
        reports.report(operator, done)


class OBJECT_OT_body_moments_copy_value(Operator):
    """Copy this value to the clipboard in SI units, with all digits"""

    bl_idname = "object.body_moments_copy_value"
    bl_label = "Copy Value"
    bl_options = {"INTERNAL"}

    value: StringProperty(name="Value", options={"HIDDEN", "SKIP_SAVE"})
    unit: StringProperty(name="Unit", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, _context: Context, values: OperatorProperties) -> str:
        return localized("Copy {:s}\n\nUnit: {:s}").format(values.value, values.unit or localized("none"))

    def execute(self, context: Context) -> set[str]:
        if not self.value:
            reports.report(self, reports.phrase("No value to copy"), level=Severity.WARNING)
            return {"CANCELLED"}
        copy_text(self, context, self.value, reports.phrase("Copied {value}", value=self.value))
        return {"FINISHED"}


def selected_document(context: Context) -> dict[str, Any]:
    """Return the stored results of the selected objects and their total, with marks for outdated or doubtful ones."""
    objects = selection.selected_measurable(context)
    outdated = {obj.name for obj in objects if staleness.stale_reason(obj, context.scene)}
    counted = [obj for obj in objects if properties.is_stored(obj)]
    caveats = open_body_caveats((obj.name, properties.method(obj)) for obj in counted)
    caveats += read.total_caveats.total_caveats(counted, context.view_layer)
    version = ".".join(map(str, bpy.app.version))
    return write.text_report.stored_document(context, objects, outdated, caveats, bpy.data.filepath or None, version)


class OBJECT_OT_body_moments_copy_report(OnStored, Operator):
    """Copy the stored mass properties of the selected objects."""

    bl_idname = "object.body_moments_copy_report"
    bl_label = "Copy Report"
    bl_description = (
        "Copy the stored mass properties of the selected objects and their total to the clipboard, as text in SI units"
    )
    bl_options = {"REGISTER"}

    def execute(self, context: Context) -> set[str]:
        document = selected_document(context)
        count = len(document["objects"]) + len(document["errors"])
        done = reports.phrase(
            "Copied the report of {count} object", "Copied the report of {count} objects", count=count
        )
        copy_text(self, context, write.text_report.text(document), done)
        return {"FINISHED"}


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
    """Select only the object with this index in the view layer, and make it active; only in Object Mode."""
    layer = bpy.context.view_layer
    if bpy.context.mode != "OBJECT" or not 0 <= index < len(layer.objects):
        return
    for obj in layer.objects.selected:
        obj.select_set(False)
    chosen = layer.objects[index]
    chosen.select_set(True)
    layer.objects.active = chosen


def register() -> None:
    """Register the operators, and the property with the index of the list's active line."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Scene.body_moments_listed = IntProperty(
        name="Object", description="Select this object", get=_active_index, set=_select, options={"SKIP_SAVE"}
    )


def unregister() -> None:
    """Remove the property and the operators."""
    del Scene.body_moments_listed
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)


CLASSES = (
    OBJECT_OT_body_moments_copy_value,
    OBJECT_OT_body_moments_copy_report,
    OBJECT_OT_body_moments_copy_csv,
    OBJECT_OT_body_moments_save_numbers,
)
