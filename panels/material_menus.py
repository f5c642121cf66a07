# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Menus of materials by category, the user's own presets, and the densities of Blender's materials.

In a layout with the context pointer `body_moments_material` the menus set that material's density,
else the density of the selected objects.
"""

import bpy
from bl_ui.utils import PresetPanel
from bpy.types import Context, Material, Menu, Panel, Scene, UILayout

from ..blender.settings.chosen import chosen_objects
from ..blender.settings.properties import density_field_name
from ..core.density import CATEGORIES, FILAMENT, MATERIALS
from ..operators.setup.presets import PRESET_FOLDER
from . import places, texts


class OBJECT_MT_body_moments_materials(Menu):
    """Densities of materials by category. Type to search"""

    bl_label = "Materials"
    bl_options = {"SEARCH_ON_KEY_PRESS"}

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        _set_density(layout, context, text="Search...", icon="VIEWZOOM")
        layout.separator()
        layout.operator_context = "EXEC_DEFAULT"
        _entries(layout, context, FILAMENT)  # the most frequent choice, without a further menu
        layout.separator()
        for category in CATEGORIES:
            if category != FILAMENT:
                layout.menu(_menu_name(category))


def _menu_name(category: str) -> str:
    return "OBJECT_MT_body_moments_{:s}".format(category.lower().replace(" ", "_"))


def _set_density(layout: UILayout, context: Context, **options: str):
    """Draw the button that sets the density of a material, or of the selected objects, and return
    it.
    """
    target = getattr(context, "body_moments_material", None)
    if target is None:
        button = layout.operator("object.body_moments_set_material", **options)
        objects = chosen_objects(context)
        if len(objects) == 1:
            button.target = objects[0].name_full
        return button
    button = layout.operator("material.body_moments_set_density", **options)
    button.target = target.name
    return button


def density_row(layout: UILayout, scene: Scene, material: Material, label: str = "") -> None:
    """Draw a material's density with the menu of the table."""
    settings = material.body_moments
    row = layout.row(align=True)
    # the menu goes by names, which a local one may share with a linked one
    row.enabled = material.is_editable
    if label:
        split = row.split(factor=0.4, align=True)
        split.label(text=label, icon="MATERIAL", translate=False)
        row = split.row(align=True)
    row.prop(settings, density_field_name(scene), **({"text": ""} if label else {}))
    row.context_pointer_set("body_moments_material", material)
    row.menu(OBJECT_MT_body_moments_materials.__name__, text="", icon="DOWNARROW_HLT")


def _draw_category(self: Menu, context: Context) -> None:
    self.layout.operator_context = "EXEC_DEFAULT"
    _entries(self.layout, context, self.bl_label)


def _entries(layout: UILayout, context: Context, category: str) -> None:
    units = texts.scene_units()
    for material in MATERIALS:
        if material.category == category:
            text = "{:s}  ({:s})".format(material.name, units.text("density", material.density))
            _set_density(layout, context, text=text).material = material.name


CATEGORY_MENUS = tuple(
    type(
        _menu_name(category),
        (Menu,),
        {
            "__doc__": "{:s}, with their densities".format(category),
            "bl_idname": _menu_name(category),
            "bl_label": category,
            "draw": _draw_category,
        },
    )
    for category in CATEGORIES
)


class OBJECT_PT_body_moments_presets(PresetPanel, Panel):
    """Presets of the settings"""

    bl_label = "Body Moments Presets"
    preset_subdir = PRESET_FOLDER
    preset_operator = "object.body_moments_preset_apply"
    preset_add_operator = "object.body_moments_preset_add"

    def draw(self, context: Context) -> None:
        if bpy.utils.preset_paths(PRESET_FOLDER):
            PresetPanel.draw(self, context)
            return
        # Without a folder of presets, Blender's own drawing complains about missing paths.
        manager = context.window_manager
        self.layout.label(text="Save Settings As")
        row = self.layout.row()
        row.prop(manager, "preset_name", text="")
        row.operator(self.preset_add_operator, text="", icon="ADD").name = manager.preset_name


class MATERIAL_PT_body_moments(places.AmongProperties, Panel):
    """A material's density, for objects that take theirs from their materials"""

    bl_context = "material"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return getattr(context, "material", None) is not None

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        material = context.material
        density_row(layout, context.scene, material)
        column = layout.column()
        if material.body_moments.material:
            column.label(text=material.body_moments.material, icon="CHECKMARK", translate=False)
        elif not material.body_moments.density:
            texts.remark(column, "None: the object's density is used")


CLASSES = CATEGORY_MENUS
