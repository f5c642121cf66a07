# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay's draw handler. Its engine and numpy are loaded when there is something to draw."""

from __future__ import annotations

import bpy
from bpy.types import Context, Object, SpaceView3D

from ...blender.session.live.following import is_live
from ...blender.session.tracking.posed import stands_for_meshes
from .. import overlay

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
    _has_drawn = _has_drawn or settings.show_path or bool(drawn_objects(context, settings.show_all))
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


def register() -> None:
    """Draw from now on, if there are windows."""
    global _handle
    if not bpy.app.background:
        _handle = SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")
        _redraw()


def unregister() -> None:
    """Draw no more, and free the batches."""
    global _handle
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
