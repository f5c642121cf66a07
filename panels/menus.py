# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The menus of the add-on, its entries in Blender's own menus where users expect them, and in its
*Help*.

Blender's search finds entries of menus. The manual that the extension brings opens from *Help*, and
from *Online Manual* of buttons and settings.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

import bpy
from bpy.types import Context, Menu, UILayout

from ..blender.settings.preferences import manual_folder, shows_advanced

Entry = tuple[str, str]  # an operator, which has one name wherever it stands, and its icon
MEASURE: Entry = ("object.body_moments_measure", "PHYSICS")
ORIGIN: Entry = ("object.body_moments_origin_to_center", "OBJECT_ORIGIN")
AXES: Entry = ("object.body_moments_axes_to_principal", "EMPTY_AXIS")
ALIGN: Entry = ("object.body_moments_align_to_world", "ORIENTATION_GLOBAL")
CURSOR: Entry = ("view3d.body_moments_cursor_to_center", "PIVOT_CURSOR")
EMPTY: Entry = ("object.body_moments_add_empty", "EMPTY_ARROWS")
RIGID_BODY: Entry = ("object.body_moments_rigid_bodies", "RIGID_BODY")
MASS: Entry = ("object.body_moments_set_rigid_body_mass", "RIGID_BODY")
COLLIDERS: Entry = ("object.body_moments_make_colliders", "MESH_ICOSPHERE")
EQUAL_INERTIA: Entry = ("object.body_moments_equal_inertia", "MESH_CUBE")
EXPORT_MENU = "TOPBAR_MT_body_moments_export"
IMPORTS = {
    "object.body_moments_import_scan": "Scan of Densities (.nii/.nrrd/.npy)",
    "object.body_moments_import_surfaces": "CAD (.step/.stp, .igs/.iges, .obj with surf)",
    "import_scene.body_moments_audit": "Robot Description for Audit (.urdf/.sdf/.xml/.usda)",
}
PIE_GAP = 8.0  # rows between the pie's lowest entry and ours

_OBJECT = "bpy.types.bodymomentsobjectsettings."
_SCENE = "bpy.types.bodymomentsscenesettings."
_OPERATOR = "bpy.ops.object.body_moments_"

# Lower-case patterns of buttons and settings, and their pages of the manual; the first pattern that
# fits counts.
PAGES = (
    *((_OBJECT + name + "*", "walls.html") for name in ("wall", "thickness")),
    *(
        (_OBJECT + name + "*", "volumes-and-scans.html")
        for name in ("grid", "values_from", "value_", "transfer", "spline")
    ),
    *((_OBJECT + name + "*", "densities.html") for name in ("density", "material", "mass")),
    ("bpy.types.bodymomentsmaterialsettings*", "densities.html"),
    (_SCENE + "moments*", "moments.html"),
    (_OPERATOR + "compute_moments*", "moments.html"),
    (_OPERATOR + "measure_section*", "sections.html"),
    *((_OPERATOR + name + "*", "shape.html") for name in ("find", "match", "select_found")),
    *((_OPERATOR + name + "*", "densities.html") for name in ("set_material", "preset")),
    ("bpy.ops.material.body_moments*", "densities.html"),
    (_OPERATOR + "fourier*", "fourier.html"),
    *((_OPERATOR + name + "*", "floating.html") for name in ("float", "righting_arms")),
    *(
        ("bpy.types.bodymoments" + name + "settings*", "floating.html")
        for name in ("liquid", "tank")
    ),
    *(
        (_OPERATOR + name + "*", "colliders.html")
        for name in ("make_colliders", "remove_colliders", "equal_inertia")
    ),
    (_OPERATOR + "import_scan*", "volumes-and-scans.html"),
    *(
        (_OPERATOR + name + "*", "reading-the-numbers.html")
        for name in ("measure", "clear", "copy", "select_faults")
    ),
    ("bpy.ops.*.body_moments_*", "actions.html"),
    ("bpy.types.bodymoments*", "reading-the-numbers.html"),
)


class _Groups:
    layout: UILayout
    GROUPS: tuple[tuple[Entry, ...], ...] = ()

    def draw(self, _context: Context) -> None:
        self.layout.operator_context = "INVOKE_DEFAULT"
        for number, group in enumerate(self.GROUPS):
            if number:
                self.layout.separator()
            for idname, icon in group:
                self.layout.operator(idname, icon=icon)


class VIEW3D_MT_body_moments_shape(_Groups, Menu):
    """Placing, standing and comparing"""

    bl_label = "Shape"
    GROUPS = (
        (ALIGN, EMPTY, CURSOR, ("object.body_moments_create_orientation", "ORIENTATION_LOCAL")),
        (
            ("object.body_moments_stability", "CON_FLOOR"),
            ("object.body_moments_rest_on_ground", "TRIA_DOWN_BAR"),
            ("object.body_moments_balance_group", "CON_FOLLOWPATH"),
            ("object.body_moments_sculpt_balance", "SCULPTMODE_HLT"),
            ("object.body_moments_make_it_stand", "MOD_THICKNESS"),
        ),
        (
            ("object.body_moments_float", "MOD_OCEAN"),
            ("object.body_moments_float_positions", "VIEWZOOM"),
            ("object.body_moments_righting_arms", "FCURVE"),
        ),
        (
            ("object.body_moments_find_symmetry", "MOD_MIRROR"),
            ("object.body_moments_find_similar", "VIEWZOOM"),
            ("object.body_moments_match_pose", "SNAP_ON"),
            ("object.body_moments_link_copies", "LINKED"),
            EQUAL_INERTIA,
        ),
    )


class VIEW3D_MT_body_moments_advanced(_Groups, Menu):
    """Analyses, for which the preferences have a switch"""

    bl_label = "Advanced"
    GROUPS = (
        (
            ("object.body_moments_compute_moments", "PHYSICS"),
            ("object.body_moments_fourier", "MOD_WAVE"),
            ("object.body_moments_measure_section", "FACESEL"),
        ),
        (
            ("object.body_moments_find_in_library", "FILEBROWSER"),
            ("object.body_moments_measure_library", "FILE_FOLDER"),
            ("object.body_moments_add_nodes", "GEOMETRY_NODES"),
        ),
    )


class VIEW3D_MT_body_moments(_Groups, Menu):
    """Mass properties of the selected objects"""

    bl_label = "Body Moments"
    GROUPS = (
        (MEASURE, ("object.body_moments_live", "REC")),
        (ORIGIN, AXES),
        (RIGID_BODY, COLLIDERS),
    )

    def draw(self, context: Context) -> None:
        _Groups.draw(self, context)
        layout = self.layout
        layout.separator()
        layout.menu(EXPORT_MENU, text="Export", icon="EXPORT")
        layout.operator("import_scene.body_moments_audit", icon="VIEWZOOM")
        layout.separator()
        layout.menu(VIEW3D_MT_body_moments_shape.__name__)
        if shows_advanced():
            layout.menu(VIEW3D_MT_body_moments_advanced.__name__)


def _entries(*entries: Entry, separator: bool = True, mode: str = "OBJECT") -> Callable:
    """Return a function that adds entries to a menu, in one mode or, with "", in all of them."""

    def draw(menu: Menu, context: Context) -> None:
        if mode and context.mode != mode:
            return
        if separator:
            menu.layout.separator()
        for idname, icon in entries:
            menu.layout.operator(idname, icon=icon)

    return draw


def _imports(menu: Menu, _context: Context) -> None:
    for idname, text in IMPORTS.items():
        menu.layout.operator(idname, text=text)


def _object_menu(menu: Menu, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.menu(VIEW3D_MT_body_moments.__name__, icon="PHYSICS")


def _snap_pie(menu: Menu, _context: Context) -> None:
    pie = menu.layout.menu_pie()  # a second pie, as all eight places of Blender's are taken
    pie.separator()  # west
    pie.separator()  # east
    south = pie.column()
    gap = south.column()
    gap.separator()
    gap.scale_y = PIE_GAP
    south.operator(CURSOR[0], icon=CURSOR[1])


def _rigid_body_panel(panel: Menu, context: Context) -> None:
    if context.object is not None and context.object.rigid_body is not None:
        panel.layout.operator(MASS[0], icon=MASS[1])


def _map() -> tuple[str, tuple[tuple[str, str], ...]]:
    # Blender asks for the manual's address and its pages.
    return manual_folder().as_uri() + "/", PAGES


def _help_entry(self: Menu, _context: Context) -> None:
    self.layout.separator()
    self.layout.operator("wm.body_moments_manual", icon="HELP")


MENUS = (
    (bpy.types.VIEW3D_MT_object, _object_menu),
    (bpy.types.VIEW3D_MT_object_context_menu, _entries(MEASURE, ORIGIN)),
    (bpy.types.VIEW3D_MT_transform_object, _entries(ALIGN, AXES)),
    (bpy.types.VIEW3D_MT_snap, _entries(CURSOR)),
    (bpy.types.VIEW3D_MT_snap_pie, _snap_pie),
    (
        bpy.types.VIEW3D_MT_object_rigid_body,
        _entries(
            RIGID_BODY,
            MASS,
            COLLIDERS,
            ("object.body_moments_remove_colliders", "X"),
            EQUAL_INERTIA,
        ),
    ),
    (bpy.types.TOPBAR_MT_file_export, lambda menu, _context: menu.layout.menu(EXPORT_MENU)),
    (bpy.types.TOPBAR_MT_file_import, _imports),
    (bpy.types.VIEW3D_MT_empty_add, _entries(EMPTY)),
    (bpy.types.PHYSICS_PT_rigid_body, _rigid_body_panel),
    (bpy.types.TOPBAR_MT_help, _help_entry),
)


def register() -> None:
    """Add the pages of the manual to *Online Manual*, if they are there."""
    if manual_folder().is_dir():
        bpy.utils.register_manual_map(_map)


def unregister() -> None:
    """Remove the pages of the manual from *Online Manual*."""
    with suppress(ValueError):  # there were none
        bpy.utils.unregister_manual_map(_map)
