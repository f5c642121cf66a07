# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay's switches: a section of the Overlays popover, and the button in the panel's header."""

from __future__ import annotations

import bpy
from bpy.types import Context, Menu, Panel, UILayout

# settings → labels that fit into half of the popover
SWITCHES = {
    "show_axes": "Principal Axes",
    "show_drop_line": "Drop Line",
    "show_all": "All Objects",
    "show_sum": "Total",
    "show_support": "Support",
    "show_faults": "Faults",
    "show_path": "Paths",
}


def header_switch(layout: UILayout, context: Context) -> None:
    """Draw the overlay's button, for the header of the panel."""
    layout.prop(context.scene.body_moments.overlay, "show", text="", icon="OVERLAY")


def section(self: Panel | Menu, context: Context) -> None:
    """Draw the overlay's settings, at the end of Blender's Object section of the Overlays popover."""
    settings = context.scene.body_moments.overlay
    layout = self.layout
    layout.separator()
    column = layout.column()
    column.active = context.space_data.overlay.show_overlays
    column.prop(settings, "show")
    column = column.column()
    column.active = settings.show
    grid = column.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    for name, text in SWITCHES.items():
        grid.prop(settings, name, text=text)
    column.label(text="Equal Inertia")
    column.row(align=True).prop(settings, "equivalent", expand=True)


def register() -> None:
    """Add the section to Blender's popover."""
    bpy.types.VIEW3D_PT_overlay_object.append(section)


def unregister() -> None:
    """Remove the section."""
    bpy.types.VIEW3D_PT_overlay_object.remove(section)
