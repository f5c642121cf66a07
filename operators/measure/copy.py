# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Getting numbers out: one value to the last digit, texts and tables, a file; and the list of
objects.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty
from bpy.types import Context, Menu, Operator, OperatorProperties, Scene
from bpy_extras.io_utils import ExportHelper

from ...blender import bodies, read, session, write
from ...blender.session import memory, selected, stored, tracking
from ...blender.write import properties, reports, translations
from ...core import measurement, robots, verdict
from ...core.robots import write as robot_formats
from .. import selection
from .moments import reference_text


def copy_text(operator: Operator, context: Context, text: str, summary: str) -> None:
    """Copy a text to the clipboard, and report the summary.

    In background mode there is no clipboard, and long reports are cut short: the text goes to the
    standard output.
    """
    if bpy.app.background:
        sys.stdout.write(text.removesuffix("\n") + "\n")
    else:
        context.window_manager.clipboard = text
        reports.report(operator, summary)


class OBJECT_OT_body_moments_copy_value(Operator):
    """Copy this value to the clipboard in SI units, with all digits"""

    bl_label = "Copy Value"
    bl_options = {"INTERNAL"}

    value: StringProperty(name="Value", options={"HIDDEN", "SKIP_SAVE"})
    unit: StringProperty(name="Unit", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, _context: Context, values: OperatorProperties) -> str:
        return translations.localized("Copy {:s}\n\nUnit: {:s}").format(
            values.value, values.unit or translations.localized("none")
        )

    def execute(self, context: Context) -> set[str]:
        if not self.value:
            reports.report(self, reports.phrase("No value to copy"), level=verdict.Severity.WARNING)
            return {"CANCELLED"}
        copy_text(self, context, self.value, reports.phrase("Copied {value}", value=self.value))
        return {"FINISHED"}


def selected_document(context: Context) -> dict[str, Any]:
    """Return the stored results of the selected objects and their total, with marks for outdated or
    doubtful ones.
    """
    objects = selection.selected_measurable(context)
    outdated = {obj.name for obj in objects if tracking.staleness.stale_reason(obj, context.scene)}
    counted = [obj for obj in objects if properties.is_stored(obj)]
    caveats = verdict.open_body_caveats((obj.name, properties.method(obj)) for obj in counted)
    caveats += read.assembly.total_caveats(counted, context.view_layer)
    caveats += bodies.overlap_caveats(counted, context.evaluated_depsgraph_get())
    version = ".".join(map(str, bpy.app.version))
    return write.text_report.stored_document(
        context,
        objects,
        outdated,
        caveats,
        bpy.data.filepath or None,
        version,
        read.places.place_error,
    )


# A text for the clipboard, and the sentence that says so. The functions of `COPIES` return them, or
# the reason why there is nothing to copy.
Copied = tuple[str, str]
MEASURE_FIRST = "Measure the selected objects first"


def has_stored(context: Context) -> bool:
    """Return whether a selected object has stored results."""
    return any(properties.is_stored(obj) for obj in context.view_layer.objects.selected)


def _report(context: Context) -> Copied | str:
    if not has_stored(context):
        return MEASURE_FIRST
    document = selected_document(context)
    count = len(document["objects"]) + len(document["errors"])
    return write.text_report.text(document), reports.phrase(
        "Copied the report of {count} object", "Copied the report of {count} objects", count=count
    )


def _table(context: Context) -> Copied | str:
    if not has_stored(context):
        return MEASURE_FIRST
    document = selected_document(context)
    summary = reports.phrase(
        "Copied {count} row.", "Copied {count} rows.", count=len(document["objects"])
    )
    return "".join(measurement.FORMATS["csv"]([document])), summary


def _reference(context: Context) -> Copied | str | verdict.Finding:
    obj, scene = selected.subject(context), context.scene
    if obj is None or not properties.is_stored(obj):
        return MEASURE_FIRST
    result = stored.reference.referred(obj, scene)
    if result is None or isinstance(result, verdict.Finding):
        return result or MEASURE_FIRST
    choice = stored.reference.ReferenceChoice.from_settings(scene.body_moments_reference)
    return reference_text(obj.name, choice, result), reports.phrase(
        "Copied the report of {count} object", count=1
    )


def _section(context: Context) -> Copied | str:
    obj = selected.subject(context)
    section = None if obj is None else write.section.stored(obj)
    if obj is None or section is None:
        return "Measure a section first"
    text = write.section.text(
        obj.name,
        section,
        tracking.staleness.stale_reason(obj, context.scene, tracking.stamps.Kind.SECTION),
    )
    return text, reports.phrase("Copied the section of {object}", object=obj.name)


def _moments(context: Context) -> Copied | str:
    obj, scene = selected.subject(context), context.scene
    computed = None if obj is None else memory.moments.get(obj)
    if obj is None or computed is None:
        return "Compute the moments first"
    settings = scene.body_moments
    about = scene.body_moments.moments_about
    reference = stored.moments.reference_of(obj, computed, scene) if about == "REFERENCE" else None
    text = stored.computed_moments.as_csv(
        computed, settings.moments_of, about, settings.frame, reference
    )
    count = text.count("\n") - 2  # lines without the description and the heading
    return text, reports.phrase("Copied {count} moments", count=count)


# Copied texts: the name, its tooltip, and the function that returns it or the reason why there is
# nothing to copy.
COPIES = {
    "REPORT": (
        "Report",
        "The stored mass properties of the selected objects and their total, as text",
        _report,
    ),
    "TABLE": (
        "Table (CSV)",
        "The stored mass properties of the selected objects, as comma-separated values",
        _table,
    ),
    "REFERENCE": (
        "Inertia about Reference",
        "The inertia of the active object about the reference",
        _reference,
    ),
    "SECTION": ("Section", "The stored section properties of the active object, as text", _section),
    "MOMENTS": (
        "Moments (CSV)",
        "All computed moments of the active object and their error bounds",
        _moments,
    ),
}
ITEMS = (
    *((name, label, tip) for name, (label, tip, _) in COPIES.items()),
    *(
        (form.name, "Inertial as {:s}".format(form.short), form.copy_tip)
        for form in robots.FORMATS.values()
    ),
)


class OBJECT_OT_body_moments_copy(Operator):
    """Copy numbers to the clipboard as text in SI units, with all digits"""

    bl_label = "Copy"
    bl_options = {"REGISTER"}

    what: EnumProperty(name="Numbers", description="What is copied", items=ITEMS)

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        findings: list[verdict.Finding] = []
        if self.what in COPIES:
            _label, _tip, read_text = COPIES[self.what]
            copied = read_text(context)
        elif not (objects := selection.selected_measurable(context)) or context.mode != "OBJECT":
            copied = "Select objects in Object Mode"
        else:
            links = session.robots.object_links(context, "robot", objects)
            text, _ = robot_formats.texts.robot_text(
                links.robot, self.what, links.findings, inertial_only=True
            )
            copied = (
                text,
                reports.phrase(
                    "Inertial of {count} link copied.",
                    "Inertials of {count} links copied.",
                    count=len(links.robot.links),
                ),
            )
            findings = links.findings
        if not isinstance(copied, tuple):
            return selection.refuse(self, copied)
        copy_text(self, context, *copied)
        if findings:
            selection.report(self, *findings)
        return {"FINISHED"}


class VIEW3D_MT_body_moments_copy(Menu):
    """Numbers as text on the clipboard"""

    bl_label = "Copy"

    def draw(self, _context: Context) -> None:
        self.layout.operator_enum("object.body_moments_copy", "what")


SUFFIXES = {".csv": "csv", ".json": "json", ".jsonl": "jsonl"}


class OBJECT_OT_body_moments_save_numbers(Operator, ExportHelper):
    """Save the selected objects' results and their total, in SI units, as .csv, .json or .jsonl"""

    bl_label = "Save CSV or JSON"
    bl_options = {"REGISTER"}

    filter_glob: StringProperty(default="*.csv;*.json;*.jsonl", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: Context) -> bool:
        return has_stored(context) or reports.unavailable(cls, MEASURE_FIRST)

    @property
    def filename_ext(self) -> str:
        suffix = Path(self.filepath).suffix.lower()
        return suffix if suffix in SUFFIXES else ".csv"

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        if not self.filepath:
            return selection.refuse(self, selection.NO_FILE)
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix.lower() not in SUFFIXES:
            return selection.refuse(
                self, "The format is unknown. Let the file's name end in .csv, .json or .jsonl."
            )
        document = selected_document(context)
        selection.write_file(path, measurement.FORMATS[SUFFIXES[path.suffix.lower()]]([document]))
        return selection.report(
            self,
            reports.phrase(
                "Saved {count} object to “{file}”.",
                "Saved {count} objects to “{file}”.",
                count=len(document["objects"]),
                file=path.name,
            ),
        )


def _active_index(_scene: Scene) -> int:
    objects = bpy.context.view_layer.objects
    return -1 if objects.active is None else objects.find(objects.active.name)


def _select(_scene: Scene, index: int) -> None:
    """Select only the object with this index in the view layer, and make it active; only in Object
    Mode.
    """
    layer = bpy.context.view_layer
    if bpy.context.mode != "OBJECT" or not 0 <= index < len(layer.objects):
        return
    selection.select_only(bpy.context, [layer.objects[index]], layer.objects[index])


def register() -> None:
    """Add the property with the index of the list's active line."""
    Scene.body_moments_listed = IntProperty(
        name="Object",
        description="Select this object",
        get=_active_index,
        set=_select,
        options={"SKIP_SAVE"},
    )


def unregister() -> None:
    """Remove the property."""
    del Scene.body_moments_listed
