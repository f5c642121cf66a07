# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that lets an object's numbers follow its edits."""

from __future__ import annotations

from bpy.types import Context, Operator

from ....core.verdict.finding import finding
from ...session import live
from ...write import reports


class OBJECT_OT_body_moments_live(Operator):
    """Update the numbers while control points are edited or animated"""

    bl_idname = "object.body_moments_live"
    bl_label = "Live"
    bl_description = (
        "Update the numbers while control points are edited or animated, until the file is closed. Press Measure to "
        "store them"
    )
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is None or context.object.type != "SURFACE":
            return reports.unavailable(cls, finding("poll_nurbs_only"))
        return True

    def execute(self, context: Context) -> set[str]:
        obj = context.object
        if live.is_live(obj):
            live.stop(obj)
            return {"FINISHED"}
        result = live.start(obj, context.evaluated_depsgraph_get())
        if result.refusal is not None:
            reports.report(self, reports.failure(obj.name, result.refusal))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_live,)
