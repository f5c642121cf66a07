# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the inertia about any reference."""

from __future__ import annotations

from bpy.types import Context

from ...blender.session import stored
from ...blender.write.properties import ENTRIES, is_stored, tensor_entries
from ...blender.write.units import Units
from ...core.verdict.finding import Finding
from .. import rows
from ..places import in_both_places
from ..settings import setting
from .numbers import AXIS_LABELS


class ReferencePanel:
    """Inertia about a point, a frame or an axis"""

    bl_label = "Inertia about Reference"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, scene = self.layout, context.scene
        layout.use_property_decorate = False
        settings = scene.body_moments_reference
        column = layout.column()
        setting(column, settings, "about")
        if settings.about == "OBJECT":
            setting(column, settings, "object")
        elif settings.about == "AXIS":
            setting(column, settings, "first")
            setting(column, settings, "second")
            rows.button(
                layout, context, "object.body_moments_axis_from_selection", "EYEDROPPER", short="From Selection"
            )
        result = stored.reference.referred(context.object, scene) if is_stored(context.object) else None
        if result is None:
            return
        if isinstance(result, Finding):
            rows.message(layout, context, result)
            return
        units = Units.from_settings(scene.unit_settings)
        if settings.about == "AXIS":
            column = layout.column(align=True)
            rows.value(column, units, "About Axis", "inertia", result.about_z)
            distances = result.radius_about_z, result.distance_from_z
            rows.values(column, units, ("Radius of Gyration", "Distance of Center"), "length", distances)
        column = layout.column(align=True)
        rows.heading(column, "Center of Mass from There", "length", result.center)
        rows.values(column, units, AXIS_LABELS, "length", result.center, max(map(abs, result.center)))
        column = layout.column(align=True)
        entries = tensor_entries(result.inertia)
        rows.heading(column, "Inertia, Ixy = −∫xy dm", "inertia", entries)
        rows.values(column, units, ["I" + name for name in ENTRIES], "inertia", entries)
        column = layout.column(align=True)
        size = max(map(abs, entries))
        bounds = {
            label: error["inertia"]
            for label, error in (("Rounding, at Most", result.rounding_error), ("Float32, at Most", result.input_error))
        }
        rows.table(
            column,
            [(label, units.bound("inertia", bound, size), repr(bound), "kg·m²") for label, bound in bounds.items()],
        )
        row = layout.row(align=True)
        rows.button(row, context, "object.body_moments_store_reference", "FILE_TICK", text="Store")
        rows.button(row, context, "object.body_moments_copy_reference", "COPYDOWN", text="Copy")


CLASSES = VIEW3D_PT_body_moments_reference, OBJECT_PT_body_moments_reference = in_both_places(
    ReferencePanel, "reference", parent="inertia"
)
