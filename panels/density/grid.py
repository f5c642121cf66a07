# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows for a grid of voxels: its choice, and the meaning of its values."""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from .. import rows
from ..settings import setting


def settings_rows(layout: UILayout, context: Context, obj: Object) -> bool:
    """Draw the settings of an object's grid, and return whether the mass comes from the grid, not from a material."""
    settings = obj.body_moments
    column = layout.column()
    setting(column, settings, "grid")
    setting(column, settings, "grid_as", expand=True)
    if settings.grid_as == "SOLID":
        return False
    if settings.grid_as == "THRESHOLD":
        setting(column, settings, "threshold")
        setting(column, settings, "threshold_fill", expand=True)
    setting(column, settings, "spline_order")
    if settings.sample_positions:
        column.label(text="Samples at their own positions", icon="SNAP_INCREMENT")
    if settings.grid_as == "THRESHOLD" and settings.threshold_fill == "MATERIAL":
        return False
    setting(column, settings, "mass_from", expand=True)
    setting(column, settings, "values_from", expand=True)
    if settings.values_from == "FACTOR":
        setting(column, settings, "value_density", text="Value 1 (kg/m³)")
    else:
        setting(column, settings, "transfer_table", text="Table")
        rows.sentence(layout.column(), context, settings.transfer_table.replace(", ", " · "))
    if settings.mass_from == "MASS":
        setting(column, settings, "mass", text="Mass (kg)")
    return True
