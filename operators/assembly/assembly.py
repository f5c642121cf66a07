# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Assembly: a collection, or an empty with its children, as one body; and Clear for its results."""

from typing import TYPE_CHECKING

from bpy.props import EnumProperty
from bpy.types import Context, Operator

from ...blender import bodies, read
from ...blender.session import stored
from ...blender.settings.assembly import Root, is_assembly
from ...blender.write import properties, reports
from ...core.verdict.finding import MeasureError, Severity
from ...core.verdict.sentences import of_severity
from .. import selection
from ..findings import NO_ACTIVE_ASSEMBLY
from ..modal import ModalSteps

if TYPE_CHECKING:
    from ...blender.bodies.assembly.assembly import Assembly, Results

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
    data = context.collection if target == "COLLECTION" else context.object
    if data is None or target == "OBJECT" and not is_assembly(data):
        raise MeasureError(NO_ACTIVE_ASSEMBLY)
    return data


def measured_assembly(context: Context, target: str) -> "Assembly":
    """Measure an operator's assembly as it is now. MeasureError if it has no mass."""
    depsgraph = context.evaluated_depsgraph_get()
    return bodies.measure_assembly(target_of(context, target), depsgraph)


class OBJECT_OT_body_moments_measure_assembly(ModalSteps, Operator):
    """Measure all members of a collection, or all children of an empty, and store the total on it"""

    bl_idname = "object.body_moments_measure_assembly"
    bl_label = "Measure Assembly"
    bl_options = {"REGISTER", "UNDO"}
    MAX_AT_ONCE = selection.MAX_OBJECTS_WITHOUT_REDRAW

    target: TARGET

    def _begin(self, context: Context) -> int:
        """Start with the members; return the number of objects."""
        depsgraph = context.evaluated_depsgraph_get()
        data = target_of(context, self.target)
        properties.require_storable(data)
        self._member = read.assembly.members_of(data, depsgraph)
        self._results: Results = {}
        self._steps = bodies.measure_members(self._member, depsgraph, self._results)
        return sum(member.is_measured for member in self._member.walk())

    def _finish(self, context: Context) -> set[str]:
        assembly = bodies.assemble(self._member, self._results, context.evaluated_depsgraph_get())
        failures = stored.assembly.store(context, assembly)
        findings = [*of_severity(assembly.measurement.findings, Severity.WARNING, Severity.ERROR)]
        done = [
            reports.phrase(
                "{assembly}: {mass:.7g} kg from {count} object",
                "{assembly}: {mass:.7g} kg from {count} objects",
                assembly=assembly.measurement.name,
                count=sum(part.measurement is not None for part in assembly.root.walk()),
                mass=assembly.measurement.mass_properties.mass,
            )
        ]
        if failures:
            names = [name for name, _ in failures]
            done.append(reports.phrase("Results not stored on {names}.", names=names))
        selection.report(self, *done, *reports.first(findings))
        selection.redraw(context)
        return {"FINISHED"}


class OBJECT_OT_body_moments_clear_assembly(Operator):
    """Remove the stored results of the assembly. Its settings and the results of its members are kept"""

    bl_idname = "object.body_moments_clear_assembly"
    bl_label = "Clear Assembly Results"
    bl_options = {"REGISTER", "UNDO"}

    target: TARGET

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        return report_cleared(self, context, stored.assembly.clear(target_of(context, self.target)))


def report_cleared(operator: Operator, context: Context, is_cleared: bool) -> set[str]:
    """Report that results were removed, or that there were none; return the result of `execute`."""
    texts = ("Removed the results of {count} object", "Removed the results of {count} objects")
    done = reports.phrase(*texts, count=1) if is_cleared else reports.phrase("The selected objects have no results")
    selection.report(operator, done)
    selection.redraw(context)
    return {"FINISHED"} if is_cleared else {"CANCELLED"}


CLASSES = (OBJECT_OT_body_moments_measure_assembly, OBJECT_OT_body_moments_clear_assembly)
