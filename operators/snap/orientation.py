# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Transform Orientation from Principal Axes: move, turn and scale along these without changing any data.

Blender makes orientations only from a 3D view; without one, as in background mode, the operator only warns.
"""

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Operator
from mathutils import Matrix

from ...blender import scene
from ...blender.write import reports
from ...core.verdict.finding import MeasureError, Severity
from .. import selection


class OBJECT_OT_body_moments_create_orientation(Operator):
    """Create a transform orientation along the principal axes of the active object"""

    bl_idname = "object.body_moments_create_orientation"
    bl_label = "Orientation from Principal Axes"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(
        name="Name",
        description="Name of the orientation. If empty, the object's name. An orientation of this name is replaced",
    )
    use: BoolProperty(
        name="Use After Creation",
        description="Make it the current transform orientation",
        default=True,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = context.view_layer.objects.active
        if obj is None or not obj.select_get():
            return reports.unavailable(cls, "Make an object active and select it")
        return selection.poll_object_mode(cls, context)

    def execute(self, context: Context) -> set[str]:
        obj = context.view_layer.objects.active
        try:
            body = scene.snap_target(context, obj)
        except MeasureError as error:
            return selection.refuse(self, reports.failure(obj.name_full, error))
        place = _view_3d(context)
        if place is None:
            reports.report(
                self, reports.phrase("A transform orientation needs an open 3D Viewport."), level=Severity.WARNING
            )
            return {"CANCELLED"}
        name = self.name or "{:s} Principal".format(obj.name)
        slot = context.scene.transform_orientation_slots[0]
        before = slot.type
        with context.temp_override(**place):
            bpy.ops.transform.create_orientation(name=name, use=True, overwrite=True)
        slot.custom_orientation.matrix = Matrix(body.axes.tolist())
        if not self.use:
            slot.type = before
        free = [body.finding] if body.finding is not None else []
        reports.report(self, reports.phrase("Created the transform orientation “{name}”", name=name), *free)
        return {"FINISHED"}


def _view_3d(context: Context) -> dict | None:
    """Return a 3D view to create orientations from: the operator's own, or the first that is open."""
    windows = [context.window] if context.window else []
    windows += [window for window in context.window_manager.windows if window not in windows]
    for window in windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                regions = [region for region in area.regions if region.type == "WINDOW"]
                return {"window": window, "area": area, "region": regions[0]}
    return None


CLASSES = (OBJECT_OT_body_moments_create_orientation,)
