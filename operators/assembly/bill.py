# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Export Bill of Masses: an assembly's tree as a table, measured as it is now."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Event, Operator

from ...blender import session, write
from ...blender.write import reports
from .. import selection
from .assembly import TARGET, measured_assembly


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
        return selection.ask_for_table(self, context)

    def check(self, _context: Context) -> bool:
        return selection.ensure_suffix(self, ".csv")

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        assembly = measured_assembly(context, self.target)
        if not self.filepath:
            return selection.refuse(self, selection.NO_FILE)
        path = Path(bpy.path.abspath(self.filepath))
        rows = list(session.bill_rows(assembly.root, assembly.measurement.mass_properties.mass))
        selection.write_file(path, [write.bill.bill_csv(rows)])
        texts = ("Wrote the masses of {count} member to “{file}”", "Wrote the masses of {count} members to “{file}”")
        selection.report(self, reports.phrase(*texts, count=len(rows) - 1, file=path.name))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_export_bill,)
