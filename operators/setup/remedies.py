# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of the buttons beside warnings: each applies a remedy, and most measure the objects again."""

import bpy
from bpy.props import BoolProperty, FloatProperty, StringProperty
from bpy.types import Context, Object, Operator

from ...blender import bodies, scene
from ...blender.read.visibility import measurable
from ...blender.scene.changes import require_storable_data
from ...blender.session.stored import outcome
from ...blender.settings.accepted import accepted_codes, set_accepted, with_acceptance
from ...blender.settings.preferences import copy_defaults
from ...blender.write import properties, reports
from ...core.solid.findings import INVERTED_COMPONENTS
from ...core.verdict.finding import MeasureError
from ...core.verdict.findings import FLIPPED_FACES
from .. import selection

# Findings that list the reversed faces; an empty list means all faces.
REVERSED = (FLIPPED_FACES, INVERTED_COMPONENTS)
MILLIMETER = 0.001


def measure_anew(context: Context, objects: list[Object]) -> None:
    """Measure objects by the operator of the Measure button, with its reports."""
    with context.temp_override(selected_objects=objects):
        bpy.ops.object.body_moments_measure()


class _OnActive:
    """Base of operators that change the settings of the active object, if it can keep them."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = context.object
        is_measurable = obj is not None and measurable(obj)
        return is_measurable or reports.unavailable(cls, "Make a measurable object active")

    def execute(self, context: Context) -> set[str]:
        obj = context.object
        try:
            return self._change(context, obj)
        except MeasureError as refusal:
            return selection.refuse(self, reports.failure(obj.name_full, refusal))

    def _change(self, context: Context, obj: Object) -> set[str]:
        raise NotImplementedError


class OBJECT_OT_body_moments_count_as_union(_OnActive, Operator):
    """Unite the overlapping components of the active object before it is measured, and measure it again"""

    bl_idname = "object.body_moments_count_as_union"
    bl_label = "Count as Union"

    def _change(self, context: Context, obj: Object) -> set[str]:
        require_storable_data(obj)
        obj.body_moments.overlap = "UNION"
        measure_anew(context, [obj])
        return {"FINISHED"}


class OBJECT_OT_body_moments_measure_as_shell(_OnActive, Operator):
    """Measure the active object as a sheet of the given thickness"""

    bl_idname = "object.body_moments_measure_as_shell"
    bl_label = "Measure as Shell"

    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of the sheet. At 0, that of the object's settings",
        default=0.0,
        min=0.0,
        precision=6,
        unit="LENGTH",
    )

    def _change(self, context: Context, obj: Object) -> set[str]:
        require_storable_data(obj)
        obj.body_moments.kind = "SHELL"
        if self.thickness:
            obj.body_moments.thickness = self.thickness
        measure_anew(context, [obj])
        return {"FINISHED"}


class OBJECT_OT_body_moments_recalculate_outside(_OnActive, Operator):
    """Reverse the faces of the active mesh that were measured as reversed, and measure it again."""

    bl_idname = "object.body_moments_recalculate_outside"
    bl_label = "Recalculate Outside"
    bl_description = (
        "Reverse the faces of the active mesh that were measured as reversed: flipped ones, and those of components "
        "that are inside out. Cavities keep facing inward. Other objects that use the mesh change too"
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is not None and context.object.type != "MESH":
            return reports.unavailable(cls, "Make a mesh object active")
        return super().poll(context) and selection.poll_object_mode(cls, context)

    def _change(self, context: Context, obj: Object) -> set[str]:
        scene.require_editable_mesh(obj)
        measurement = bodies.measure_body(obj, context.evaluated_depsgraph_get()).measurement
        found = [shown.elements for shown in measurement.findings if shown.code in REVERSED]
        count = scene.reverse_faces(obj.data, found)
        if not count:
            cause = reports.phrase("no faces were measured as reversed")
            reports.report(self, reports.phrase("Nothing to do: {cause}", cause=cause))
            return {"CANCELLED"}
        measure_anew(context, [obj])
        reports.report(self, reports.phrase("Reversed {count} face", "Reversed {count} faces", count=count))
        return {"FINISHED"}


class SCENE_OT_body_moments_set_millimeters(Operator):
    """Let one unit of the scene be a millimeter, and measure again what was measured"""

    bl_idname = "scene.body_moments_set_millimeters"
    bl_label = "Set Units to Millimeters"
    bl_options = {"REGISTER", "UNDO"}

    remeasure: BoolProperty(
        name="Measure Again",
        description="Measure the objects of the view layer that were measured, as all their numbers change",
        default=True,
    )

    def execute(self, context: Context) -> set[str]:
        copy_defaults(context.scene)
        context.scene.body_moments.units_answered = True
        units = context.scene.unit_settings
        units.system, units.scale_length, units.length_unit = "METRIC", MILLIMETER, "MILLIMETERS"
        measured = [obj for obj in context.view_layer.objects if properties.is_stored(obj) and obj.is_editable]
        if self.remeasure and measured:
            measure_anew(context, measured)
        return {"FINISHED"}


class SCENE_OT_body_moments_keep_units(Operator):
    """Keep the units of the scene, and do not ask again"""

    bl_idname = "scene.body_moments_keep_units"
    bl_label = "Keep Units"
    bl_options = {"INTERNAL", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        context.scene.body_moments.units_answered = True
        return {"FINISHED"}


class OBJECT_OT_body_moments_accept(_OnActive, Operator):
    """Accept this warning for the active object: it becomes a note, also when the object is measured again"""

    bl_idname = "object.body_moments_accept"
    bl_label = "Accept Warning"
    bl_options = {"INTERNAL", "UNDO"}

    code: StringProperty(name="Code", options={"HIDDEN", "SKIP_SAVE"})
    accepted: BoolProperty(name="Accepted", default=True, options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, _context: Context, values) -> str:
        if values.accepted:
            return cls.__doc__ or ""
        return "Show this note as a warning again"

    def _change(self, context: Context, obj: Object) -> set[str]:
        require_storable_data(obj)
        if not self.code or not set_accepted(obj, self.code, self.accepted):
            return {"CANCELLED"}
        if properties.is_stored(obj):
            properties.store_findings(obj, with_acceptance(properties.findings(obj), accepted_codes(obj)))
        return {"FINISHED"}


class OBJECT_OT_body_moments_select_refused(Operator):
    """Select the objects that the last action refused or warned of"""

    bl_idname = "object.body_moments_select_refused"
    bl_label = "Select These Objects"
    bl_options = {"INTERNAL", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_object_mode(cls, context) and outcome.last() is not None

    def execute(self, context: Context) -> set[str]:
        last = outcome.last()
        assert last is not None
        objects = [obj for obj in context.view_layer.objects if obj.name_full in last.objects]
        if not objects:
            return {"CANCELLED"}
        for obj in context.view_layer.objects:
            obj.select_set(obj in objects)
        context.view_layer.objects.active = objects[0]
        return {"FINISHED"}


class WM_OT_body_moments_dismiss(Operator):
    """Hide what the last action refused or warned of"""

    bl_idname = "wm.body_moments_dismiss"
    bl_label = "Dismiss"
    bl_options = {"INTERNAL"}

    def execute(self, _context: Context) -> set[str]:
        outcome.forget()
        return {"FINISHED"}


CLASSES = (
    OBJECT_OT_body_moments_count_as_union,
    OBJECT_OT_body_moments_measure_as_shell,
    OBJECT_OT_body_moments_recalculate_outside,
    SCENE_OT_body_moments_set_millimeters,
    SCENE_OT_body_moments_keep_units,
    OBJECT_OT_body_moments_accept,
    OBJECT_OT_body_moments_select_refused,
    WM_OT_body_moments_dismiss,
)
