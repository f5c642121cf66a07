# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The button: measure the selected objects and store what came out on them."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ....core.verdict import internal_error
from ...bodies.measure_object import Measured, measure_body
from ...read import Unreadable
from ...session import results
from ...session.staleness import settle
from ...write.alarms import alarms
from .. import selection
from ..modal import Stepwise

AT_ONCE = 4  # up to so many objects are measured before the window is drawn again


class OBJECT_OT_body_moments_measure(Stepwise, bpy.types.Operator):
    """Compute the exact mass properties of the selected objects and store them on each"""

    bl_idname = "object.body_moments_measure"
    bl_label = "Measure"
    bl_options = {"REGISTER", "UNDO"}
    DOING = "Measuring: {:.0%}. Esc cancels"
    CANCELLED = "Measuring was cancelled; nothing was changed"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not _chosen(context):
            cls.poll_message_set("Select the objects to measure")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        self._begin(context)
        return self.all_at_once(context, len(_chosen(context)))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        count = len(_chosen(context))
        if count <= AT_ONCE or context.window is None:
            return self.execute(context)
        self._begin(context)
        return self.begin_modal(context, count)

    def _begin(self, context: bpy.types.Context) -> None:
        self._found: list[tuple[bpy.types.Object, Measured]] = []
        self._refused: list[tuple[bpy.types.Object, str]] = []
        self._failed: list[str] = []
        self._steps = self._measure(_chosen(context), context.evaluated_depsgraph_get())

    def _measure(self, objects: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> Iterator[int]:
        for done, obj in enumerate(objects, 1):
            try:
                self._found.append((obj, measure_body(obj, depsgraph)))
            except Exception as error:
                self._refused.append((obj, internal_error.reason(error, (Unreadable,))))
            yield done

    def _finish(self, context: bpy.types.Context) -> set[str]:
        """Nothing is stored before everything is measured, so that a cancelled run leaves nothing behind."""
        for obj, reason in self._refused:
            self._failed.append("{:s}: {:s}".format(obj.name_full, reason))
            results.refuse(obj, reason)
        stored = []
        for obj, measured in self._found:
            results.refuse(obj, None)
            try:
                results.store(obj, measured, context.scene)
            except Exception as error:
                self._failed.append("{:s}: {:s}".format(obj.name_full, internal_error.reason(error, (RuntimeError,))))
                continue
            stored.append(obj)
        settle(context, stored)
        self._say(len(stored))
        selection.redraw(context)
        return {"FINISHED"} if stored else {"CANCELLED"}

    def _say(self, stored: int) -> None:
        warned = sum(bool(alarms(measured.measurement.warnings)) for _, measured in self._found)
        tried = stored + len(self._failed)
        parts = ["Measured {:d} of {:d} objects".format(stored, tried)] if tried > 1 else []
        if tried == stored == 1:
            name = self._found[0][0].name
            parts.append(("Measured {:s}, with warnings" if warned else "Measured {:s}").format(name))
        elif warned:
            parts.append("{:d} with warnings".format(warned))
        parts += selection.listed(self._failed)
        self.report({"WARNING"} if self._failed or warned else {"INFO"}, selection.in_a_row(parts))


def _chosen(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects; in edit mode the ones being edited."""
    return list(context.selected_objects)


CLASSES = (OBJECT_OT_body_moments_measure,)
