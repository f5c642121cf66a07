# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Export Bill of Masses: an assembly's tree as a table, measured as it is now."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Event, Operator

from ...blender.bodies.assembly.assembly import MemberBody
from ...blender.bodies.findings import ASSEMBLY_MASS_GIVEN
from ...blender.write import reports
from ...blender.write.bill import BillRow, bill_csv
from ...core.files.whole_file import whole_file
from ...core.measurement.builder import find_properties
from ...core.verdict.finding import FileError, MeasureError, finding, system_reason
from .. import files, selection
from ..findings import BILL_WRITTEN, FILE_NOT_WRITTEN, NO_EXPORT_FILE
from .assembly import TARGET, measured_assembly


def bill_rows(part: MemberBody, mass: float, level: int = 0, counted: bool = True) -> Iterator[BillRow]:
    """Yield the rows of a member and of all below it.

    `mass` is that of the whole in kg, `level` the number of assemblies around the member; `counted` is True if its
    mass is part of the whole.
    """
    moments = part.mass
    measurement = part.measurement
    findings = part.findings if measurement is None else measurement.findings
    reason = part.member.left_out or part.refusal
    row = BillRow(
        level=level,
        name=part.member.name,
        type=part.member.kind.value.lower(),
        counted=counted and moments is not None,
        method="" if measurement is None else str(measurement.method),
        findings=findings,
        left_out=reason,
    )
    if moments is not None:
        row = replace(
            row,
            share=moments.total / mass if counted else None,
            density=moments.total / part.volume[0] if part.volume[0] else None,
            volume=part.volume[0],
            area=part.area[0],
            properties=find_properties(moments, np.eye(3)),
        )
    yield row
    given = any(found.code == ASSEMBLY_MASS_GIVEN for found in part.findings)
    for member in part.parts:
        yield from bill_rows(member, mass, level + 1, counted and not given)


class OBJECT_OT_body_moments_export_bill(Operator):
    """Write the masses, centers and inertia of all members of an assembly as a table (.csv), in SI units"""

    bl_idname = "object.body_moments_export_bill"
    bl_label = "Export Bill of Masses"
    bl_options = {"REGISTER"}

    target: TARGET
    filepath: StringProperty(name="File Path", description="File to write", subtype="FILE_PATH")
    check_existing: BoolProperty(name="Check Existing", default=True, options={"HIDDEN"})
    filter_glob: StringProperty(default="*.csv", options={"HIDDEN"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        return files.ask_for_table(self, context)

    def check(self, _context: Context) -> bool:
        return files.ensure_suffix(self, ".csv")

    def execute(self, context: Context) -> set[str]:
        try:
            assembly = measured_assembly(context, self.target)
            if not self.filepath:
                raise FileError(NO_EXPORT_FILE)
            path = Path(bpy.path.abspath(self.filepath))
            rows = list(bill_rows(assembly.root, assembly.measurement.mass_properties.mass))
            try:
                with whole_file(path) as file:
                    file.write(bill_csv(rows).encode())
            except OSError as error:
                raise FileError(FILE_NOT_WRITTEN, error=system_reason(error)) from error
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        selection.report(self, finding(BILL_WRITTEN, count=len(rows) - 1, file=path.name))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_export_bill,)
