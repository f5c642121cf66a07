# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Menus of materials by category, and the user's own presets."""

import bpy
from bl_ui.utils import PresetPanel
from bpy.types import Context, Menu, Panel

from ..core.materials import CATEGORIES, MATERIALS
from ..operators.presets import (
    PRESETS,
    OBJECT_OT_body_moments_preset_add,
    OBJECT_OT_body_moments_set_material,
)


class OBJECT_MT_body_moments_materials(Menu):
    """Materials by category. Typing searches them"""

    bl_idname = "OBJECT_MT_body_moments_materials"
    bl_label = "Materials"
    bl_options = {"SEARCH_ON_KEY_PRESS"}

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(
            OBJECT_OT_body_moments_set_material.bl_idname, text="Search...", icon="VIEWZOOM"
        )
        layout.separator()
        for category in CATEGORIES:
            layout.menu(_menu_name(category))


def _menu_name(category: str) -> str:
    return "OBJECT_MT_body_moments_{:s}".format(category.lower().replace(" ", "_"))


def _draw_category(self: Menu, _context: Context) -> None:
    layout = self.layout
    layout.operator_context = "EXEC_DEFAULT"
    for material in MATERIALS:
        if material.category == self.bl_label:
            text = "{:s}  ({:.5g})".format(material.name, material.density)
            layout.operator(
                OBJECT_OT_body_moments_set_material.bl_idname, text=text
            ).material = material.name


CATEGORY_MENUS = tuple(
    type(
        _menu_name(category),
        (Menu,),
        {
            "__doc__": "{:s}, with their densities in kg/m³".format(category),
            "bl_idname": _menu_name(category),
            "bl_label": category,
            "draw": _draw_category,
        },
    )
    for category in CATEGORIES
)


class OBJECT_PT_body_moments_presets(PresetPanel, Panel):
    """Presets of the user's own"""

    bl_label = "Body Presets"
    preset_subdir = PRESETS
    preset_operator = "script.execute_preset"
    preset_add_operator = OBJECT_OT_body_moments_preset_add.bl_idname

    def draw(self, context: Context) -> None:
        if bpy.utils.preset_paths(PRESETS):
            super().draw(context)
            return
        # Without a folder of presets, Blender's own drawing complains about missing paths.
        manager = context.window_manager
        self.layout.label(text="Keep these settings as")
        row = self.layout.row()
        row.prop(manager, "preset_name", text="")
        row.operator(self.preset_add_operator, text="", icon="ADD").name = manager.preset_name


CLASSES = (*CATEGORY_MENUS, OBJECT_MT_body_moments_materials, OBJECT_PT_body_moments_presets)
