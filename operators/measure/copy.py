# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Getting numbers out: one value to the last digit, or the whole report as text."""

import sys
from typing import Any

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Operator, OperatorProperties

from ...blender import read, write
from ...blender.session.tracking import staleness
from ...blender.write import properties, reports
from ...blender.write.translations import localized
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
    """Copy a text, and report that it is done.

    Without a window there is no clipboard, and long reports are cut short: the text goes to the standard output.
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
    caveats = read.total_caveats.open_body_caveats((obj.name, properties.method(obj)) for obj in counted)
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


CLASSES = (OBJECT_OT_body_moments_copy_value, OBJECT_OT_body_moments_copy_report)
