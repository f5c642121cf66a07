# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that measures the selected objects and stores the results on them."""

from __future__ import annotations

from collections.abc import Generator

import bpy
from bpy.props import EnumProperty

from ...blender.bodies.measure_object import Measured
from ...blender.bodies.stacks.many import measure_many
from ...blender.bodies.stacks.stack import Stacked
from ...blender.session import displayed
from ...blender.session.stored import outcome, results
from ...blender.session.tracking.staleness import mark_up_to_date
from ...blender.settings.preferences import MATERIAL_ITEMS, copy_defaults
from ...blender.write import reports
from ...core.density.materials import BY_NAME
from ...core.verdict import internal_error
from ...core.verdict.finding import Finding, Severity, finding
from ...core.verdict.sentences import of_severity
from ..findings import (
    MEASURED_ONE,
    MEASURED_ONE_WITH_WARNINGS,
    MEASURED_SEVERAL,
    OBJECT_WARNINGS,
    WITH_WARNINGS,
)
from ..modal import MAX_OBJECTS_WITHOUT_REDRAW, ModalSteps, redraw

AS_SET = "AS_SET"


class OBJECT_OT_body_moments_measure(ModalSteps, bpy.types.Operator):
    """Compute the exact mass properties of the selected objects and store them as custom properties"""

    bl_idname = "object.body_moments_measure"
    bl_label = "Measure"
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = "Measuring: {share:.0%}. Esc to cancel"
    CANCELED = "Measuring canceled; nothing was changed"

    # Settings for the redo panel; by default the objects keep their own settings.
    material: EnumProperty(
        name="Material",
        description="Material to give the objects before they are measured",
        items=[(AS_SET, "As Set", "The density that each object's settings say"), *MATERIAL_ITEMS],
        default=AS_SET,
        options={"SKIP_SAVE"},
    )
    kind: EnumProperty(
        name="Kind",
        description="What the geometry of the objects represents",
        items=(
            (AS_SET, "As Set", "As each object's settings say"),
            ("SOLID", "Solid", "The surface bounds a volume filled with material"),
            ("SHELL", "Shell", "The surface is a sheet or wall of the given thickness"),
        ),
        default=AS_SET,
        options={"SKIP_SAVE"},
    )
    overlap: EnumProperty(
        name="Overlaps",
        description="How overlapping or nested components of an object count",
        items=(
            (AS_SET, "As Set", "As each object's settings say"),
            ("SIGNED", "Count Each Shell", "Every component counts fully"),
            ("UNION", "Count as Union", "Components are united first"),
        ),
        default=AS_SET,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.selected_objects:
            return reports.unavailable(cls, "Select objects")
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.run_all_steps(context, self._begin(context))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if len(context.selected_objects) <= MAX_OBJECTS_WITHOUT_REDRAW or context.window is None:
            return self.execute(context)
        return self.start_modal(context, self._begin(context))

    def _begin(self, context: bpy.types.Context) -> int:
        """Start with the selected objects, in edit mode the edited ones; return their number."""
        copy_defaults(context.scene)
        self._objects = objects = list(context.selected_objects)
        for obj in objects:
            self._change_settings(obj)
        self._results: list[tuple[bpy.types.Object, Measured | Stacked]] = []
        self._refusals: dict[bpy.types.Object, Finding] = {}
        self._steps = self._measure(objects, context.evaluated_depsgraph_get())
        return len(objects)

    def _change_settings(self, obj: bpy.types.Object) -> None:
        """Apply the settings of the redo panel; library overrides and linked objects keep theirs."""
        if not obj.is_editable or obj.override_library is not None:
            return
        settings = obj.body_moments
        if self.kind != AS_SET:
            settings.kind = self.kind
        if self.overlap != AS_SET:
            settings.overlap = self.overlap
        if self.material != AS_SET:
            settings.mass_from, settings.density_from = "DENSITY", "VALUE"
            settings.density, settings.material = BY_NAME[self.material].density, self.material

    def _measure(self, objects: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> Generator[int, None, None]:
        done = 0
        for together in measure_many(objects, depsgraph):
            for obj, found in together:
                if isinstance(found, Exception):
                    self._refusals[obj] = internal_error.finding_of(found)
                else:
                    self._results.append((obj, found))
            done += len(together)
            yield done

    def _finish(self, context: bpy.types.Context) -> set[str]:
        """Nothing is stored before everything is measured, so that a canceled run leaves nothing behind."""
        stored: list[bpy.types.Object] = []
        refusals: dict[bpy.types.Object, Finding | Exception] = {**self._refusals}
        for obj, refusal in results.store_many(self._results, context.scene):
            displayed.remember_failure(obj, None)
            if refusal is None:
                stored.append(obj)
            else:
                refusals[obj] = refusal
        for obj, refusal in self._refusals.items():
            displayed.remember_failure(obj, refusal)
        self._failures = [reports.failure(obj.name_full, refusals[obj]) for obj in self._objects if obj in refusals]
        shapes = {obj: found.shape_digest for obj, found in self._results if isinstance(found, Stacked)}
        mark_up_to_date(context, stored, shapes)
        self._report(len(stored))
        redraw(context)
        return {"FINISHED"} if stored else {"CANCELLED"}

    def _report(self, stored: int) -> None:
        warnings = [
            finding(OBJECT_WARNINGS, object=obj.name_full, causes=[cause.as_record() for cause in causes])
            for obj, measured in self._results
            if (causes := of_severity(measured.findings, Severity.WARNING, Severity.ERROR))
        ]
        tried = stored + len(self._failures)
        done = [finding(MEASURED_SEVERAL, count=stored, total=tried)] if tried > 1 else []
        if tried == stored == 1:
            name = self._results[0][0].name
            done.append(finding(MEASURED_ONE_WITH_WARNINGS if warnings else MEASURED_ONE, object=name))
        elif warnings:
            names = [warning.values["object"] for warning in warnings]
            done.append(finding(WITH_WARNINGS, count=len(names), objects=names))
        outcome.remember(self.bl_label, [*self._failures, *warnings] if tried > 1 else [])
        reports.report(self, *done, *(reports.first(self._failures) if self._failures else ()))


CLASSES = (OBJECT_OT_body_moments_measure,)
