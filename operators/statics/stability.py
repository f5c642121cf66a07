# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability: the standing state of the selected objects, drawn and listed, and the poses in which they rest."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object, Operator

from ...blender.bodies.measure_object import measure_body
from ...blender.bodies.mesh.hull import MAX_CORNERS
from ...blender.session.findings import OPEN_OBJECT
from ...blender.session.stored import results, stability
from ...blender.session.tracking import staleness
from ...blender.write import properties
from ...core.verdict.finding import EditRefusedError, Finding, finding
from ...core.verdict.method import Verdict
from .. import selection
from ..findings import HULL_SIMPLIFIED, OBJECTS_TIP, STABILITY_COMPUTED
from ..modal import redraw


class OBJECT_OT_body_moments_stability(Operator):
    """Compute whether the selected objects stand on the ground below them, and in which poses they rest."""

    bl_idname = "object.body_moments_stability"
    bl_label = "Check Stability"
    bl_description = (
        "Compute whether the selected objects stand on the ground below them, how far the ground can be tilted, and in "
        "which poses they rest. Objects are measured where their results are out of date"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context, any_mode=True)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        findings: list[Finding] = []
        measured: list[Object] = []

        def check(obj: Object) -> None:
            findings.extend(check_stability(context, obj, measured))

        known, failures = selection.apply_to_all(objects, check)
        staleness.mark_up_to_date(context, measured)
        standing = [obj for obj in objects if _stands(obj, context)]
        falling = [obj.name for obj in objects if stability.is_known(obj) and obj not in standing]
        if falling:
            findings.insert(0, finding(OBJECTS_TIP, count=len(falling), names=falling))
        redraw(context)
        done = finding(STABILITY_COMPUTED, count=len(standing), total=len(known))
        return selection.summarize(self, len(known), len(objects), done, failures, findings)


def check_stability(context: Context, obj: Object, measured: list[Object]) -> list[Finding]:
    """Remember the hull of an object, and return the findings.

    If the object's numbers are out of date, it is measured and added to `measured`. Raises MeasureError if it has no
    certain center or no surface.
    """
    depsgraph = context.evaluated_depsgraph_get()
    if properties.stored(obj) is None or staleness.stale_reason(obj, context.scene):
        result = measure_body(obj, depsgraph)
        if result.measurement.method.verdict == Verdict.OPEN:
            raise EditRefusedError(OPEN_OBJECT)
        results.store(obj, result, context.scene)
        measured.append(obj)
    hull = stability.compute(obj, depsgraph)
    extent = float(np.ptp(hull.points, axis=0).max())
    if len(hull.points) >= MAX_CORNERS:
        return [finding(HULL_SIMPLIFIED, object=obj.name, corners=len(hull.points), share=hull.gap / extent)]
    return []


def _stands(obj: Object, context: Context) -> bool:
    support = stability.support(obj, context.scene)
    return support is not None and support.stands


CLASSES = (OBJECT_OT_body_moments_stability,)
