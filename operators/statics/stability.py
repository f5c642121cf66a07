# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability: the standing state of the selected objects, drawn and listed, and the poses in which they rest."""

from bpy.types import Context, Object, Operator

from ...blender import session
from ...blender.session import stored
from ...blender.session.tracking import staleness
from ...blender.write import reports
from ...core.verdict.finding import Finding, finding
from .. import selection
from ..findings import OBJECTS_TIP


class OBJECT_OT_body_moments_stability(selection.OnSelection, Operator):
    """Compute whether the selected objects stand on the ground below them, and in which poses they rest."""

    bl_idname = "object.body_moments_stability"
    bl_label = "Check Stability"
    bl_description = (
        "Compute whether the selected objects stand on the ground below them, how far the ground can be tilted, and in "
        "which poses they rest. Objects are measured where their results are out of date"
    )
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        measured: list[Object] = []
        notes: list[Finding | str] = []

        def check(obj: Object) -> None:
            notes.extend(session.check_stability(context, obj, measured))

        known, failures = selection.apply_to_all(objects, check)
        staleness.mark_up_to_date(context, measured)
        supports = {obj: stored.stability.support(obj, context.scene) for obj in objects}
        standing = [obj for obj, support in supports.items() if support is not None and support.stands]
        falling = [obj.name for obj in objects if stored.stability.is_known(obj) and obj not in standing]
        if falling:
            notes.insert(0, finding(OBJECTS_TIP, count=len(falling), names=falling))
        selection.redraw(context)
        texts = ("{count} of {total} object stands", "{count} of {total} objects stand")
        done = reports.phrase(*texts, count=len(standing), total=len(known))
        return selection.summarize(self, len(known), len(objects), done, failures, notes)


CLASSES = (OBJECT_OT_body_moments_stability,)
