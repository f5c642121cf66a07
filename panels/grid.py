# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows for a grid of voxels: which one, and what its values stand for."""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from . import rows


def settings_rows(layout: UILayout, context: Context, obj: Object) -> bool:
    """The settings of an object's grid; whether the mass comes from the grid, not from a material."""
    settings = obj.body_moments
    column = layout.column()
    column.use_property_split = True
    column.prop(settings, "grid")
    column.row().prop(settings, "grid_as", expand=True)
    if settings.grid_as == "SOLID":
        return False
    if settings.grid_as == "THRESHOLD":
        column.prop(settings, "threshold")
        column.row().prop(settings, "threshold_fill", expand=True)
    column.prop(settings, "spline_order")
    if settings.sample_positions:
        column.label(text="Samples at their own positions", icon="SNAP_INCREMENT")
    if settings.grid_as == "THRESHOLD" and settings.threshold_fill == "MATERIAL":
        return False
    column.row().prop(settings, "mass_from", expand=True)
    column.row().prop(settings, "values_from", expand=True)
    if settings.values_from == "FACTOR":
        column.prop(settings, "value_density", text="Value 1 (kg/m³)")
    else:
        column.prop(settings, "transfer_table", text="Table")
        rows.sentence(layout.column(), context, settings.transfer_table.replace(", ", " · "))
    if settings.mass_from == "MASS":
        column.prop(settings, "mass", text="Mass (kg)")
    return True
