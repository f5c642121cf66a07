# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay's draw handler, which loads its engine and numpy when there is something to draw, and
its switches.

The switches are a section of the Overlays popover, and the button in the panel's header. Like
Blender's own overlay settings they make no undo step, and undo leaves them as they are: they are
drawn from a mirror of the scene's settings in the window manager, whose changes Blender does not
record.
"""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty
from bpy.types import (
    Context,
    Menu,
    Object,
    Panel,
    PropertyGroup,
    SpaceView3D,
    UILayout,
    WindowManager,
)

from ...blender import session, write
from ...blender.session.tracking import armatures, handlers
from ...blender.settings.scene import BodyMomentsOverlaySettings
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
    "show_level": "Levels",
    "show_waterline": "Waterline",
}
SETTINGS = BodyMomentsOverlaySettings.__annotations__
EQUIVALENTS = [item[0] for item in SETTINGS["equivalent"].keywords["items"]]
_handles: list[object] = []
_kept: dict[str, dict[str, bool | str]] = {}  # by scene, the settings before an undo
# Whether there was anything to draw: from then on numpy and the engine are loaded, and always draw.
_has_drawn = False


def _mirrored(name: str) -> object:
    """Return a property that reads and sets the active scene's setting of this name."""
    keywords = {key: value for key, value in SETTINGS[name].keywords.items() if key != "default"}

    # Blender reads and sets an enumeration by the index of its item.
    def get(_mirror: PropertyGroup) -> bool | int:
        value = getattr(bpy.context.scene.body_moments.overlay, name)
        return EQUIVALENTS.index(value) if name == "equivalent" else value

    def put(_mirror: PropertyGroup, value: bool | int) -> None:
        overlay_value = EQUIVALENTS[value] if name == "equivalent" else value
        setattr(bpy.context.scene.body_moments.overlay, name, overlay_value)

    return (EnumProperty if name == "equivalent" else BoolProperty)(**keywords, get=get, set=put)


class BodyMomentsOverlayMirror(PropertyGroup):
    """The overlay settings of the active scene."""

    __annotations__ = {name: _mirrored(name) for name in SETTINGS}


def _keep_settings() -> None:
    _kept.clear()
    for scene in bpy.data.scenes:
        # `overlay` is read only if it is set: Blender would store a group that is read in a group.
        if scene.body_moments.is_property_set("overlay"):
            settings = scene.body_moments.overlay
            _kept[scene.name_full] = {
                name: getattr(settings, name) for name in SETTINGS if settings.is_property_set(name)
            }


def _restore_settings() -> None:
    for scene in bpy.data.scenes:
        for name, value in _kept.get(scene.name_full, {}).items():
            if getattr(scene.body_moments.overlay, name) != value:
                setattr(scene.body_moments.overlay, name, value)


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
        has_paths = settings.show_path and any(
            write.properties.BALANCE_GROUP in obj for obj in scene.objects
        )
        _has_drawn = has_paths or bool(drawn_objects(context, settings.show_all))
    if _has_drawn:
        overlay.batches.draw_region(context)


def drawn_objects(context: Context, show_all: bool) -> list[Object]:
    """Return the objects with numbers to draw in a view: visible and, if not all, selected.

    In Pose Mode an armature represents its meshes. Characters that show their weight are drawn
    without selection, too.
    """
    layer, space = context.view_layer, context.space_data
    objects = dict.fromkeys(layer.objects if show_all else layer.objects.selected)
    objects.update(dict.fromkeys(filter(shows_weight, layer.objects)))
    return [
        obj
        for obj in objects
        if (
            "body_mass" in obj
            or obj in session.memory.levels
            or obj in session.memory.followed
            or armatures.stands_for_meshes(obj)
            or shows_weight(obj)
        )
        and obj.visible_in_viewport_get(space)
    ]


def shows_weight(obj: Object) -> bool:
    """Return whether an object is a character whose weight is shown."""
    return obj.type == "ARMATURE" and obj.body_moments_weight.show


def draw_texts() -> None:
    """Draw the overlay's texts into the region that Blender is drawing."""
    context = bpy.context
    if (
        _has_drawn
        and context.space_data.overlay.show_overlays
        and context.scene.body_moments.overlay.show
    ):
        overlay.batches.draw_texts(context)


def header_switch(layout: UILayout, context: Context) -> None:
    """Draw the overlay's button, for the header of the panel."""
    layout.prop(context.window_manager.body_moments_overlay, "show", text="", icon="OVERLAY")


def section(self: Panel | Menu, context: Context) -> None:
    """Draw the overlay's settings, at the end of Blender's Object section of the Overlays
    popover.
    """
    settings = context.window_manager.body_moments_overlay
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


POINTERS = {(WindowManager, "body_moments_overlay"): BodyMomentsOverlayMirror}
MENUS = ((bpy.types.VIEW3D_PT_overlay_object, section),)


def register() -> None:
    """Keep the settings during undo, and add the draw handler if there are windows."""
    handlers.before_undo.append(_keep_settings)
    handlers.on_undo.append(_restore_settings)
    if not bpy.app.background:
        for function, stage in ((draw, "POST_VIEW"), (draw_texts, "POST_PIXEL")):
            _handles.append(SpaceView3D.draw_handler_add(function, (), "WINDOW", stage))
        _redraw()


def unregister() -> None:
    """Remove the draw handler, and free the batches."""
    handlers.before_undo.remove(_keep_settings)
    handlers.on_undo.remove(_restore_settings)
    if _handles:
        while _handles:
            SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
        _redraw()
    if _has_drawn:
        overlay.batches.forget_regions()


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
