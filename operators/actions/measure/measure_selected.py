# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button: measure the selected objects and store what came out on them."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import bpy

from ....core.verdict import internal_error
from ....core.verdict.finding import Finding, Severity, finding
from ...bodies.many import Stacked, measure_many
from ...bodies.measure_object import Measured
from ...session import results
from ...session.staleness import mark_up_to_date
from ...settings.density import is_density_unset, unset_density
from ...settings.preferences import copy_defaults
from ...write import reports
from ...write.messages import of_severity
from ..modal import ModalSteps, redraw

DENSITY_KEPT = finding("density_default_kept")
MAX_OBJECTS_WITHOUT_REDRAW = 4  # up to so many objects are measured before the window is drawn again


class OBJECT_OT_body_moments_measure(ModalSteps, bpy.types.Operator):
    """Compute the exact mass properties of the selected objects and store them as custom properties"""

    bl_idname = "object.body_moments_measure"
    bl_label = "Measure"
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = finding("progress_measuring")
    CANCELED = finding("canceled_measuring")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.selected_objects:
            return reports.unavailable(cls, finding("poll_select_objects"))
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.run_all_steps(context, self._begin(context))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if len(context.selected_objects) <= MAX_OBJECTS_WITHOUT_REDRAW or context.window is None:
            return self.execute(context)
        return self.start_modal(context, self._begin(context))

    def _begin(self, context: bpy.types.Context) -> int:
        """Start with the selected objects, in edit mode those being edited; how many there are."""
        copy_defaults(context.scene)
        objects = list(context.selected_objects)
        self._results: list[tuple[bpy.types.Object, Measured | Stacked]] = []
        self._refusals: list[tuple[bpy.types.Object, Finding]] = []
        self._failures: list[Finding] = []
        self._steps = self._measure(objects, context.evaluated_depsgraph_get())
        return len(objects)

    def _measure(self, objects: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> Generator[int, None, None]:
        done = 0
        for together in measure_many(objects, depsgraph):
            for obj, outcome in together:
                if isinstance(outcome, Exception):
                    self._refusals.append((obj, internal_error.finding_of(outcome)))
                else:
                    self._results.append((obj, _with_default_density(obj, outcome, depsgraph.scene)))
            done += len(together)
            yield done

    def _finish(self, context: bpy.types.Context) -> set[str]:
        """Nothing is stored before everything is measured, so that a canceled run leaves nothing behind."""
        for obj, refusal in self._refusals:
            self._failures.append(reports.failure(obj.name_full, refusal))
            results.remember_failure(obj, refusal)
        stored = []
        for obj, refusal in results.store_many(self._results, context.scene):
            results.remember_failure(obj, None)
            if refusal is None:
                stored.append(obj)
            else:
                self._failures.append(reports.failure(obj.name_full, refusal))
        shapes = {obj: outcome.shape_digest for obj, outcome in self._results if isinstance(outcome, Stacked)}
        mark_up_to_date(context, stored, shapes)
        self._report(len(stored))
        redraw(context)
        return {"FINISHED"} if stored else {"CANCELLED"}

    def _report(self, stored: int) -> None:
        reported = [outcome.findings for _, outcome in self._results]
        warned = sum([bool(of_severity(findings, Severity.WARNING, Severity.ERROR)) for findings in reported])
        tried = stored + len(self._failures)
        done = [finding("measured_several", count=stored, total=tried)] if tried > 1 else []
        if tried == stored == 1:
            name = self._results[0][0].name
            done.append(finding("measured_one_with_warnings" if warned else "measured_one", object=name))
        elif warned:
            done.append(finding("with_warnings", count=warned))
        reports.report(self, *done, *(reports.first(self._failures) if self._failures else ()))


def _with_default_density(
    obj: bpy.types.Object, outcome: Measured | Stacked, scene: bpy.types.Scene
) -> Measured | Stacked:
    """With a note where nobody has set the density."""
    if isinstance(outcome, Stacked):
        if outcome.has_density and is_density_unset(obj.body_moments, scene):
            outcome.add_finding(DENSITY_KEPT)
        return outcome
    unset = unset_density(obj, outcome.measurement, scene)
    if unset is None:
        return outcome
    kept = DENSITY_KEPT if unset == "density" else finding("linear_density_default_kept")
    findings = (*outcome.measurement.findings, kept)
    return replace(outcome, measurement=replace(outcome.measurement, findings=findings))


CLASSES = (OBJECT_OT_body_moments_measure,)
