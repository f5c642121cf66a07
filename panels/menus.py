# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus, with names and places that users expect, and in its *Help*.

Blender's search finds entries of menus. The manual that the extension brings opens from *Help*, and from *Online
Manual* of buttons and settings. It is HTML beside the add-on's code, which the build makes of docs/; in a checkout
there is none, and so no entries.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import bpy
from bpy.types import Context, Menu

ORIGIN = ("object.body_moments_origin_to_center", "Origin to Exact Center of Mass", "OBJECT_ORIGIN")
MEASURE = ("object.body_moments_measure", "Measure Mass Properties", "PHYSICS")
AXES = ("object.body_moments_axes_to_principal", "Axes to Principal Axes", "EMPTY_AXIS")
ALIGN = ("object.body_moments_align_to_world", "Align to Principal Axes", "ORIENTATION_GLOBAL")
CURSOR = ("view3d.body_moments_cursor_to_center", "Cursor to Center of Mass", "PIVOT_CURSOR")
EMPTY = ("object.body_moments_add_empty", "Principal Frame of Selected", "EMPTY_ARROWS")
PIE_GAP = 8.0  # rows between the pie's lowest entry and ours
RIGID_BODY = ("object.body_moments_set_rigid_body_mass", "Set Exact Mass", "RIGID_BODY")

_PACKAGE = __package__.rpartition(".")[0]
_OBJECT, _SCENE = "bpy.types.bodymomentsobjectsettings.", "bpy.types.bodymomentsscenesettings."
_OPERATOR = "bpy.ops.object.body_moments_"

# Lower-case patterns of buttons and settings, and their pages of the manual; the first pattern that fits counts.
PAGES = (
    *((_OBJECT + name + "*", "walls.html") for name in ("wall", "thickness")),
    *(
        (_OBJECT + name + "*", "volumes-and-scans.html")
        for name in ("grid", "values_from", "value_", "transfer", "spline")
    ),
    *((_OBJECT + name + "*", "densities.html") for name in ("density", "material", "mass")),
    ("bpy.types.bodymomentsmaterialsettings*", "densities.html"),
    (_SCENE + "moments*", "moments.html"),
    *((_OPERATOR + name + "*", "moments.html") for name in ("compute_moments", "copy_moments")),
    *((_OPERATOR + name + "*", "sections.html") for name in ("measure_section", "copy_section")),
    *((_OPERATOR + name + "*", "shape.html") for name in ("find", "match", "select_found")),
    *((_OPERATOR + name + "*", "densities.html") for name in ("set_material", "preset")),
    ("bpy.ops.material.body_moments*", "densities.html"),
    (_OPERATOR + "fourier*", "fourier.html"),
    (_OPERATOR + "import_scan*", "volumes-and-scans.html"),
    *((_OPERATOR + name + "*", "reading-the-numbers.html") for name in ("measure", "clear", "copy", "select_faults")),
    ("bpy.ops.*.body_moments_*", "actions.html"),
    ("bpy.types.bodymoments*", "reading-the-numbers.html"),
)


class VIEW3D_MT_body_moments(Menu):
    """Mass properties of the selected objects"""

    bl_idname = "VIEW3D_MT_body_moments"
    bl_label = "Body Moments"

    def draw(self, _context: Context) -> None:
        groups = (
            (
                MEASURE,
                ("object.body_moments_select_faults", "Select Defects", "ZOOM_SELECTED"),
                ("object.body_moments_copy_report", "Copy Report", "COPYDOWN"),
                ("object.body_moments_clear", "Clear Results", "TRASH"),
            ),
            (ORIGIN, AXES, ALIGN),
            (
                EMPTY,
                CURSOR,
                ("object.body_moments_create_orientation", "Orientation from Principal Axes", "EMPTY_AXIS"),
            ),
            (
                ("object.body_moments_stability", "Check Stability", "CON_FLOOR"),
                ("object.body_moments_rest_on_ground", "Rest on Ground", "TRIA_DOWN_BAR"),
                ("object.body_moments_balance_group", "Balance Group...", "CON_FOLLOWPATH"),
            ),
            (
                ("object.body_moments_set_rigid_body_mass", "Set Rigid Body Mass", "RIGID_BODY"),
                ("object.body_moments_add_nodes", "Center of Mass Node Group", "GEOMETRY_NODES"),
                ("object.body_moments_sculpt_balance", "Sculpt Balance", "SCULPTMODE_HLT"),
            ),
            (
                ("object.body_moments_measure_section", "Measure Section", "FACESEL"),
                ("object.body_moments_compute_moments", "Compute Moments", "PHYSICS"),
                ("object.body_moments_fourier", "Fourier Transform...", "MOD_WAVE"),
                ("object.body_moments_find_symmetry", "Find Symmetry", "MOD_MIRROR"),
                ("object.body_moments_find_similar", "Find Similar", "VIEWZOOM"),
                ("object.body_moments_match_pose", "Match Pose", "SNAP_ON"),
            ),
            (
                ("object.body_moments_set_material", "Set Material", "MATERIAL"),
                ("object.body_moments_copy_settings", "Copy Settings to Selected", "PASTEDOWN"),
            ),
            (("object.body_moments_measure_library", "Measure Library...", "FILE_FOLDER"),),
        )
        self.layout.operator_context = "INVOKE_DEFAULT"
        for number, group in enumerate(groups):
            if number:
                self.layout.separator()
            for idname, text, icon in group:
                self.layout.operator(idname, text=text, icon=icon)


def _entries(*entries: tuple[str, str, str], separator: bool = True, mode: str = "OBJECT") -> Callable:
    """Return a function that adds entries to a menu, in one mode or, with "", in all of them."""

    def draw(menu: Menu, context: Context) -> None:
        if mode and context.mode != mode:
            return
        if separator:
            menu.layout.separator()
        for idname, text, icon in entries:
            menu.layout.operator(idname, text=text, icon=icon)

    return draw


def _object_menu(menu: Menu, _context: Context) -> None:
    layout = menu.layout
    layout.separator()
    layout.operator(ORIGIN[0], text=ORIGIN[1], icon=ORIGIN[2])
    layout.menu(VIEW3D_MT_body_moments.bl_idname, icon="PHYSICS")


def _snap_pie(menu: Menu, _context: Context) -> None:
    pie = menu.layout.menu_pie()  # a second pie, as all eight places of Blender's are taken
    pie.separator()  # west
    pie.separator()  # east
    south = pie.column()
    gap = south.column()
    gap.separator()
    gap.scale_y = PIE_GAP
    south.operator(CURSOR[0], text=CURSOR[1], icon=CURSOR[2])


def _rigid_body_panel(panel: Menu, context: Context) -> None:
    if context.object is not None and context.object.rigid_body is not None:
        panel.layout.operator(RIGID_BODY[0], text=RIGID_BODY[1], icon=RIGID_BODY[2])


def folder() -> Path:
    """Return the folder of the manual, which need not exist."""
    return Path(sys.modules[_PACKAGE].__path__[0]) / "manual"


def _map() -> tuple[str, tuple[tuple[str, str], ...]]:
    return folder().as_uri() + "/", PAGES


def _help_entry(self: Menu, _context: Context) -> None:
    page = folder() / "index.html"
    self.layout.separator()
    self.layout.operator("wm.url_open", text="Body Moments Manual", icon="HELP").url = page.as_uri()


def register_manual() -> None:
    """Add the manual to *Help* and *Online Manual*, if there is one."""
    if folder().is_dir():
        bpy.utils.register_manual_map(_map)
        bpy.types.TOPBAR_MT_help.append(_help_entry)


def unregister_manual() -> None:
    """Remove the manual from *Help* and *Online Manual*."""
    with suppress(ValueError):  # there was no manual
        bpy.utils.unregister_manual_map(_map)
        bpy.types.TOPBAR_MT_help.remove(_help_entry)


ADDED = (
    ("VIEW3D_MT_object", _object_menu),
    ("VIEW3D_MT_object_context_menu", _entries(MEASURE, ORIGIN)),
    ("VIEW3D_MT_transform_object", _entries(ALIGN, AXES)),
    ("VIEW3D_MT_snap", _entries(CURSOR)),
    ("VIEW3D_MT_snap_pie", _snap_pie),
    ("VIEW3D_MT_object_rigid_body", _entries(RIGID_BODY)),
    ("VIEW3D_MT_empty_add", _entries(EMPTY)),
    ("PHYSICS_PT_rigid_body", _rigid_body_panel),
)
CLASSES = (VIEW3D_MT_body_moments,)


def register() -> None:
    """Add the entries to Blender's menus."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for name, draw in ADDED:
        getattr(bpy.types, name).append(draw)
    register_manual()


def unregister() -> None:
    """Remove the entries from Blender's menus."""
    unregister_manual()
    for name, draw in reversed(ADDED):
        getattr(bpy.types, name).remove(draw)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
