# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Assembly: a collection, or an empty with its children, as one body; and Clear for its results."""

from bpy.props import EnumProperty
from bpy.types import Context, Event, Operator

from ...blender.bodies.assembly.assembly import Assembly, Results, assemble, measure_members
from ...blender.read.assembly import Root, is_assembly, members_of
from ...blender.session.stored import assembly as stored_assembly
from ...blender.write import properties, reports
from ...core.verdict.finding import Finding, MeasureError, Severity, finding
from ...core.verdict.sentences import of_severity
from .. import selection
from ..findings import (
    ASSEMBLY_MEASURED,
    MEMBERS_NOT_STORED,
    NO_ACTIVE_ASSEMBLY_EMPTY,
    NO_ACTIVE_COLLECTION,
    NO_RESULTS_TO_REMOVE,
    RESULTS_REMOVED,
)
from ..modal import MAX_OBJECTS_WITHOUT_REDRAW, ModalSteps, redraw

TARGET = EnumProperty(
    name="Assembly",
    description="What is measured as one body",
    items=(
        ("COLLECTION", "Collection", "The active collection with its nested collections"),
        ("OBJECT", "Empty", "The active empty with its children"),
    ),
    default="COLLECTION",
)


def target_of(context: Context, target: str) -> Root:
    """Return the assembly that an operator works on. MeasureError if there is none."""
    if target == "COLLECTION":
        if context.collection is None:
            raise MeasureError(NO_ACTIVE_COLLECTION)
        return context.collection
    obj = context.object
    if obj is None or not is_assembly(obj):
        raise MeasureError(NO_ACTIVE_ASSEMBLY_EMPTY)
    return obj


def measured_assembly(context: Context, target: str) -> Assembly:
    """Measure an operator's assembly as it is now. MeasureError if it has no mass."""
    depsgraph = context.evaluated_depsgraph_get()
    root = members_of(target_of(context, target), depsgraph)
    results: Results = {}
    for _ in measure_members(root, depsgraph, results):
        pass
    return assemble(root, results, depsgraph)


class OBJECT_OT_body_moments_measure_assembly(ModalSteps, Operator):
    """Measure all members of a collection, or all children of an empty, and store the total on it"""

    bl_idname = "object.body_moments_measure_assembly"
    bl_label = "Measure Assembly"
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = "Measuring: {share:.0%}. Esc to cancel"
    CANCELED = "Measuring canceled; nothing was changed"

    target: TARGET

    def execute(self, context: Context) -> set[str]:
        count = self._begin(context)
        return {"CANCELLED"} if count is None else self.run_all_steps(context, count)

    def invoke(self, context: Context, event: Event) -> set[str]:
        count = self._begin(context)
        if count is None:
            return {"CANCELLED"}
        if count <= MAX_OBJECTS_WITHOUT_REDRAW or context.window is None:
            return self.run_all_steps(context, count)
        return self.start_modal(context, count)

    def _begin(self, context: Context) -> int | None:
        """Start with the members; return the number of objects, or None if nothing can be measured."""
        depsgraph = context.evaluated_depsgraph_get()
        try:
            data = target_of(context, self.target)
            properties.require_storable(data)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return None
        self._member = members_of(data, depsgraph)
        self._results: Results = {}
        self._steps = measure_members(self._member, depsgraph, self._results)
        return sum(member.is_measured for member in self._member.walk())

    def _finish(self, context: Context) -> set[str]:
        try:
            assembly = assemble(self._member, self._results, context.evaluated_depsgraph_get())
            failures = stored_assembly.store(context, assembly)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        findings: list[Finding] = of_severity(assembly.measurement.findings, Severity.WARNING, Severity.ERROR)
        if failures:
            findings.append(finding(MEMBERS_NOT_STORED, count=len(failures), names=[name for name, _ in failures]))
        counted = sum(part.measurement is not None for part in assembly.root.walk())
        name, mass = assembly.measurement.name, assembly.measurement.mass_properties.mass
        selection.report(
            self, finding(ASSEMBLY_MEASURED, assembly=name, count=counted, mass=mass), *reports.first(findings)
        )
        redraw(context)
        return {"FINISHED"}


class OBJECT_OT_body_moments_clear_assembly(Operator):
    """Remove the stored results of the assembly. Its settings and the results of its members are kept"""

    bl_idname = "object.body_moments_clear_assembly"
    bl_label = "Clear Assembly Results"
    bl_options = {"REGISTER", "UNDO"}

    target: TARGET

    def execute(self, context: Context) -> set[str]:
        try:
            data = target_of(context, self.target)
            cleared = stored_assembly.clear(data)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        selection.report(self, finding(RESULTS_REMOVED, count=1) if cleared else finding(NO_RESULTS_TO_REMOVE))
        redraw(context)
        return {"FINISHED"} if cleared else {"CANCELLED"}


CLASSES = (OBJECT_OT_body_moments_measure_assembly, OBJECT_OT_body_moments_clear_assembly)
