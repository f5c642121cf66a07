# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that measures the selected objects and stores the results on them."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import bpy
from bpy.props import EnumProperty

from ...blender import bodies, session
from ...blender.session.stored import outcome
from ...blender.session.tracking import armatures
from ...blender.settings.preferences import MATERIAL_ITEMS, copy_defaults
from ...blender.write import reports
from ...core.density.materials import BY_NAME
from ...core.verdict import internal_error
from ...core.verdict.finding import Finding, Severity, finding
from ...core.verdict.sentences import of_severity
from .. import selection
from ..findings import OBJECT_WARNINGS
from ..modal import ModalSteps

AS_SET = "AS_SET"


class OBJECT_OT_body_moments_measure(ModalSteps, bpy.types.Operator):
    """Compute the exact mass properties of the selected objects and store them as custom properties"""

    bl_idname = "object.body_moments_measure"
    bl_label = "Measure"
    MAX_AT_ONCE = selection.MAX_OBJECTS_WITHOUT_REDRAW

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
        return bool(context.selected_objects) or reports.unavailable(cls, "Select objects")

    def _begin(self, context: bpy.types.Context) -> int:
        """Apply the settings of the redo panel and prepare the steps; return the number of selected objects."""
        copy_defaults(context.scene)
        self._objects = objects = armatures.subjects(context.selected_objects)
        for obj in objects:
            self._change_settings(obj)
        self._results: list[tuple[bpy.types.Object, Any]] = []
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
        for together in bodies.measure_many(objects, depsgraph):
            for obj, found in together:
                if isinstance(found, Exception):
                    self._refusals[obj] = internal_error.finding_of(found)
                else:
                    self._results.append((obj, found))
            done += len(together)
            yield done

    def _finish(self, context: bpy.types.Context) -> set[str]:
        """Store the results of all objects at the end, so that a canceled run leaves none behind."""
        failed = session.store_measured(context, self._results)
        refusals = {**self._refusals, **failed}
        self._failures = [reports.failure(obj.name_full, refusals[obj]) for obj in self._objects if obj in refusals]
        count = len(self._results) - len(failed)
        self._report(count)
        selection.redraw(context)
        return {"FINISHED"} if count else {"CANCELLED"}

    def _report(self, count: int) -> None:
        warnings = [
            finding(OBJECT_WARNINGS, object=obj.name_full, causes=[cause.as_record() for cause in causes])
            for obj, measured in self._results
            if (causes := of_severity(measured.findings, Severity.WARNING, Severity.ERROR))
        ]
        tried = count + len(self._failures)
        names = [warning.values["object"] for warning in warnings]
        if tried == count == 1:
            text = "Measured {object}, with warnings" if warnings else "Measured {object}"
            done = [reports.phrase(text, object=self._results[0][0].name)]
        else:
            done = (
                [reports.phrase("Measured {count} of {total} objects", count=count, total=tried)] if tried > 1 else []
            )
            if warnings:
                done.append(reports.phrase("{count} with warnings: {objects}", count=len(names), objects=names))
        outcome.remember(self.bl_label, self._failures)
        level = Severity.WARNING if warnings else Severity.NOTE
        reports.report(self, *done, *reports.first(self._failures), level=level)


CLASSES = (OBJECT_OT_body_moments_measure,)
