# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay's draw handler, which loads its engine and numpy when there is something to draw, and its switches.

The switches are a section of the Overlays popover, and the button in the panel's header.
"""

from __future__ import annotations

import bpy
from bpy.types import Context, Menu, Object, Panel, SpaceView3D, UILayout

from ...blender.session.live.following import is_live
from ...blender.session.tracking.armatures import stands_for_meshes
from ...blender.write.properties import BALANCE_GROUP
from .. import overlay

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
_handle: object = None
_has_drawn = False


def draw() -> None:
    """Draw the overlay into the region that Blender is drawing."""
    global _has_drawn
    context = bpy.context
    space, scene = context.space_data, context.scene
    if space is None or scene is None or not space.overlay.show_overlays:
        return
    settings = scene.body_moments.overlay
    if not settings.show:
        return
    if not _has_drawn:
        has_paths = settings.show_path and any(BALANCE_GROUP in obj for obj in scene.objects)
        _has_drawn = has_paths or bool(drawn_objects(context, settings.show_all))
    if _has_drawn:
        overlay.batches.draw_region(context)


def drawn_objects(context: Context, show_all: bool) -> list[Object]:
    """Return the objects with numbers to draw in a view: visible and, if not all, selected.

    In Pose Mode an armature represents its meshes.
    """
    layer, space = context.view_layer, context.space_data
    return [
        obj
        for obj in (layer.objects if show_all else layer.objects.selected)
        if ("body_mass" in obj or is_live(obj) or stands_for_meshes(obj)) and obj.visible_in_viewport_get(space)
    ]


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
    """Add the section to Blender's popover, and the draw handler if there are windows."""
    global _handle
    bpy.types.VIEW3D_PT_overlay_object.append(section)
    if not bpy.app.background:
        _handle = SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")
        _redraw()


def unregister() -> None:
    """Remove the section and the draw handler, and free the batches."""
    global _handle
    bpy.types.VIEW3D_PT_overlay_object.remove(section)
    if _handle is not None:
        SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
        _redraw()
    if _has_drawn:
        overlay.batches.forget_regions()


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
