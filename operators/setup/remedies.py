# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of the buttons beside warnings: each applies a remedy, and most measure the objects
again.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Object, Operator

from ...blender import bodies, scene, settings, write
from ...blender.session import displayed, stored
from ...core import solid, verdict
from .. import selection

# Findings that list the reversed faces; an empty list means all faces.
REVERSED = (verdict.FLIPPED_FACES, solid.INVERTED_COMPONENTS)
MILLIMETER = 0.001


def measure_anew(context: Context, objects: list[Object]) -> None:
    """Measure objects by the operator of the Measure button, with its reports."""
    with context.temp_override(selected_objects=objects):
        bpy.ops.object.body_moments_measure()


class OBJECT_OT_body_moments_remedy(selection.OnSubject, Operator):
    """Repair the active object and measure it again"""

    bl_label = "Repair"

    remedy: EnumProperty(
        name="Remedy",
        description="What is changed before the object is measured again",
        items=[
            (key, remedy.name, remedy.description)
            for key, remedy in write.remedies.REMEDIES.items()
        ],
        options={"SKIP_SAVE"},
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of the shell. At 0, that of the object's settings",
        min=0.0,
        precision=6,
        unit="LENGTH",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, _context: Context, values) -> str:
        text = write.translations.localized("{:s}, and measure the object again").format(
            write.translations.localized(write.remedies.REMEDIES[values.remedy].description)
        )
        warning = ". " + write.translations.localized("Other objects that use the mesh change too")
        return text + warning if values.remedy in write.remedies.EDITS else text

    def draw(self, _context: Context) -> None:
        if self.remedy == write.remedies.SHELL:
            self.layout.prop(self, "thickness")

    def _change(self, context: Context, obj: Object) -> set[str]:
        text = write.reports.phrase(write.remedies.REMEDIES[self.remedy].name)
        if self.remedy in write.remedies.EDITS:
            if obj.type != "MESH":
                return selection.refuse(self, "Make a mesh object active")
            if context.mode != "OBJECT":
                return selection.refuse(self, "Switch to Object Mode")
            count = self._edit(context, obj)
            if not count:
                cause = write.reports.phrase("the mesh has nothing to repair in this way")
                write.reports.report(
                    self, write.reports.phrase("Nothing to do: {cause}", cause=cause)
                )
                return {"CANCELLED"}
            text = "{:s}: {:d}".format(text, count)
        else:
            scene.changes.require_storable_data(obj)
            if self.remedy == write.remedies.UNION:
                obj.body_moments.overlap = "UNION"
            else:
                obj.body_moments.kind = "SHELL"
                obj.body_moments.thickness = self.thickness or obj.body_moments.thickness
        measure_anew(context, [obj])
        return write.reports.report(self, text)

    def _edit(self, context: Context, obj: Object) -> int:
        """Edit the mesh of an object; return the number of changed elements."""
        # These two need no indices of elements: modifiers may change the elements.
        by_shape = {
            write.remedies.FILL: scene.fill_holes,
            write.remedies.MERGE: scene.merge_by_distance,
        }
        if self.remedy in by_shape:
            return by_shape[self.remedy](obj.data)
        scene.require_editable_mesh(obj)
        depsgraph = context.evaluated_depsgraph_get()
        measurement = bodies.measured_in_turn([obj], depsgraph)(obj).measurement
        if self.remedy == write.remedies.DUPLICATES:
            return scene.delete_faces(
                obj.data, scene.defects_by_kind(measurement).get("duplicate_faces", ())
            )
        return scene.reverse_faces(
            obj.data,
            [reported.elements for reported in measurement.findings if reported.code in REVERSED],
        )


class SCENE_OT_body_moments_set_millimeters(Operator):
    """Let one unit of the scene be a millimeter, and measure again what was measured"""

    bl_label = "Set Units to Millimeters"

    remeasure: BoolProperty(
        name="Measure Again",
        description="Measure the objects of the view layer that were measured, as all their "
        "numbers change",
        default=True,
    )

    def execute(self, context: Context) -> set[str]:
        settings.preferences.copy_defaults(context.scene)
        context.scene.body_moments.units_answered = True
        units = context.scene.unit_settings
        units.system = "METRIC"
        units.scale_length = MILLIMETER
        units.length_unit = "MILLIMETERS"
        measured = [
            obj
            for obj in context.view_layer.objects
            if write.properties.is_stored(obj) and obj.is_editable
        ]
        if self.remeasure and measured:
            measure_anew(context, measured)
        return {"FINISHED"}


class OBJECT_OT_body_moments_accept(selection.OnSubject, Operator):
    """Accept this warning: it becomes a note, also when the object is measured again"""

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
        """Accept a code, or every warning without one, on the objects that the panel is about."""
        changed = False
        for shown_object in displayed.shown_objects(context):
            warnings = verdict.of_severity(
                write.properties.findings(shown_object), verdict.Severity.WARNING
            )
            codes = {self.code} if self.code else {reported.code for reported in warnings}
            # The button is about the active object; others count if they have such a finding.
            if shown_object != obj and not codes & {
                reported.code for reported in write.properties.findings(shown_object)
            }:
                continue
            scene.changes.require_storable_data(shown_object)
            if not any(  # a list: every code has to be set
                [
                    settings.accepted.set_accepted(shown_object, code, self.accepted)
                    for code in codes
                ]
            ):
                continue
            changed = True
            if write.properties.is_stored(shown_object):
                accepted_findings = settings.accepted.with_acceptance(
                    write.properties.findings(shown_object),
                    settings.accepted.accepted_codes(shown_object),
                )
                write.properties.store_findings(shown_object, accepted_findings)
        return {"FINISHED"} if changed else {"CANCELLED"}


class OBJECT_OT_body_moments_select_refused(selection.InObjectMode, Operator):
    """Select the objects that this line is about; by default, those that the last action refused"""

    bl_label = "Select These Objects"
    bl_options = {"INTERNAL", "UNDO"}

    code: StringProperty(name="Code", options={"HIDDEN", "SKIP_SAVE"})
    listed: StringProperty(  # lines, of a finding that names the objects itself
        name="Objects", options={"HIDDEN", "SKIP_SAVE"}
    )

    def execute(self, context: Context) -> set[str]:
        last = stored.outcome.last()
        refused = last.groups if last is not None else ()
        groups = (*displayed.total(context).groups, *refused) if self.code else refused
        chosen_findings = [
            (group.finding, group.objects)
            for group in groups
            if self.code in ("", group.finding.code)
        ]
        if self.code:
            chosen_findings += [
                (reported, ())
                for reported in displayed.total(context).findings
                if reported.code == self.code
            ]
        names = {
            name if isinstance(name, str) else name[0]  # an operand is listed with its object
            for reported, owners in chosen_findings
            for name in reported.values.get("objects", owners)
        }
        names = {*self.listed.split("\n")} if self.listed else names
        objects = [obj for obj in context.view_layer.objects if names & {obj.name_full, obj.name}]
        if not objects:
            return {"CANCELLED"}
        selection.select_only(context, objects, objects[0])
        return {"FINISHED"}


class WM_OT_body_moments_dismiss(Operator):
    """Hide what the last action refused"""

    bl_label = "Dismiss"
    bl_options = {"INTERNAL"}

    def execute(self, _context: Context) -> set[str]:
        stored.outcome.forget()
        return {"FINISHED"}
