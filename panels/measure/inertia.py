# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the inertia: principal moments and axes, radii of gyration, tensor."""

from __future__ import annotations

from bpy.types import Context

from ...blender.session.displayed import displayed
from ...blender.write import properties
from ...blender.write.units import Units
from .. import rows
from ..places import in_both_places
from .numbers import PRINCIPAL_LABELS

ERROR_OF_A_DIFFERENCE = 6.0  # each principal moment is off by at most 3 times the error of a tensor entry
EQUAL_MOMENTS = {  # by whether 1 and 2, and 2 and 3, are equal
    (True, True): "All principal moments are equal",
    (True, False): "Principal moments 1 and 2 are equal",
    (False, True): "Principal moments 2 and 3 are equal",
}


class InertiaPanel:
    """Principal moments and axes, radii of gyration and inertia tensor"""

    bl_label = "Inertia"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.object is not None and displayed(context.object, context.scene) is not None

    def draw(self, context: Context) -> None:
        layout, scene = self.layout, context.scene
        layout.use_property_decorate = False
        units = Units.from_settings(scene.unit_settings)
        current = displayed(context.object, scene)
        if current is None:
            return
        shown = current.in_frame(scene.body_moments.frame)
        layout.row().prop(scene.body_moments, "frame", expand=True)
        column = layout.column(align=True)
        moments = shown.moments
        rows.heading(column, "Principal Moments", "inertia", moments)
        rows.values(column, units, PRINCIPAL_LABELS, "inertia", moments)
        column = layout.column(align=True)
        rows.heading(column, "Principal Axes", "", shown.axes)
        for label, axis in zip(PRINCIPAL_LABELS, shown.axes):
            rows.direction(column, label, axis)
        error = shown.error_bound["inertia"] + shown.error_bound["input"]["inertia"]
        equal = [b - a <= ERROR_OF_A_DIFFERENCE * error for a, b in zip(moments, moments[1:])]
        text = EQUAL_MOMENTS.get(tuple(equal))
        if text:
            rows.remark(column, context, text)
        column = layout.column(align=True)
        rows.heading(column, "Radii of Gyration", "length", shown.gyration)
        rows.values(column, units, PRINCIPAL_LABELS, "length", shown.gyration)
        header, body = layout.panel("body_moments_tensor")
        header.label(text="Inertia Tensor")
        if body is not None:
            column = body.column(align=True)
            rows.heading(column, "About the center of mass, Ixy = −∫xy dm", "inertia", shown.inertia)
            rows.values(column, units, ["I" + name for name in properties.ENTRIES], "inertia", shown.inertia)


CLASSES = VIEW3D_PT_body_moments_inertia, OBJECT_PT_body_moments_inertia = in_both_places(InertiaPanel, "inertia")
