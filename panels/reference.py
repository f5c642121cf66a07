# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the inertia about any reference."""

from __future__ import annotations

import numpy as np
from bpy.types import Context

from ..core.inertia.reference import ReferredInertia
from ..operators.session import reference
from ..operators.write import properties
from ..operators.write.units import Units
from . import rows
from .numbers import AXIS_LABELS
from .places import in_both_places


class ReferencePanel:
    """Inertia about a point, a frame or an axis"""

    bl_label = "Inertia about Reference"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, scene = self.layout, context.scene
        layout.use_property_decorate = False
        settings = scene.body_moments_reference
        column = layout.column()
        column.use_property_split = True
        column.prop(settings, "about")
        if settings.about == "OBJECT":
            column.prop(settings, "object")
        elif settings.about == "AXIS":
            column.prop(settings, "first")
            column.prop(settings, "second")
            layout.operator("object.body_moments_axis_from_selection", icon="EYEDROPPER")
        result = reference.referred(context.object, scene)
        if result is None:
            return
        if not isinstance(result, ReferredInertia):
            rows.message(layout, context, result)
            return
        units = Units.of(scene.unit_settings)
        if settings.about == "AXIS":
            column = layout.column(align=True)
            rows.value(column, units, "About Axis", "inertia", result.about_z)
            rows.value(column, units, "Radius", "length", result.radius_about_z)
            rows.value(column, units, "Distance", "length", result.distance_from_z)
        column = layout.column(align=True)
        rows.heading(column, "Center of Mass from There", "length", result.center)
        rows.values(column, units, AXIS_LABELS, "length", result.center, float(np.abs(result.center).max()))
        column = layout.column(align=True)
        entries = properties.tensor_entries(result.inertia)
        rows.heading(column, "Inertia, Ixy = −∫xy dm", "inertia", entries)
        rows.values(column, units, ["I" + name for name in properties.ENTRIES], "inertia", entries)
        column = layout.column(align=True)
        size = float(np.abs(result.inertia).max())
        for label, bounds in (("Rounding, at Most", result.rounding_error), ("Float32, at Most", result.input_error)):
            text = units.bound("inertia", bounds["inertia"], size)
            rows.texts(column, label, text, repr(bounds["inertia"]), "kg·m²")
        row = layout.row(align=True)
        row.operator("object.body_moments_store_reference", text="Store", icon="FILE_TICK")
        row.operator("object.body_moments_copy_reference", text="Copy", icon="COPYDOWN")


CLASSES = VIEW3D_PT_body_moments_reference, OBJECT_PT_body_moments_reference = in_both_places(
    ReferencePanel, "reference", parent="inertia"
)
