# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials for all selected objects at once, users' presets, and copies of settings from one
object to others.
"""

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import EnumProperty, StringProperty
from bpy.types import Context, Object, Operator, PropertyGroup

from ...blender import scene, session, write
from ...blender.settings import given, preferences, properties
from ...blender.settings.chosen import chosen_objects
from ...core.density import BY_NAME
from .. import selection

PRESET_FOLDER = "body_moments"  # folder of the user's presets
PRESET_PANEL = "OBJECT_PT_body_moments_presets"


class OBJECT_OT_body_moments_set_material(Operator):
    """Set the density of the selected objects to that of a material. With Density From set to
    Materials, it applies to faces whose material has no density
    """

    bl_label = "Set Material"
    bl_property = "material"

    material: EnumProperty(
        name="Material",
        description="Material to take the density from",
        items=preferences.MATERIAL_ITEMS,
    )
    target: StringProperty(
        name="Object",
        description="Object to set. If empty, the selected ones",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def invoke(self, context: Context, _event) -> set[str]:
        context.window_manager.invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        preferences.copy_defaults(context.scene)
        material = BY_NAME[self.material]
        named_objects = [obj for obj in context.view_layer.objects if obj.name_full == self.target]
        objects = session.selected.objects_with_settings(
            named_objects or context.view_layer.objects.selected
        )
        if not objects or not given.has_density(objects[0]):
            return selection.refuse(self, "Select objects")

        def set_density(obj: Object) -> bool:
            scene.changes.require_storable_data(obj)
            settings = obj.body_moments
            before = _density_of(settings)
            settings.mass_from = "DENSITY"
            if settings.density_from != "MATERIALS":
                settings.density_from = "VALUE"
            settings.density = material.density
            settings.material = material.name
            return before != _density_of(settings)

        texts = ("Set {count} object to {material}", "Set {count} objects to {material}")
        return selection.change_all(
            self, objects, set_density, texts, "already set to {material}", material=material.name
        )


def _density_of(settings: PropertyGroup) -> tuple[str, str, float, str]:
    return settings.mass_from, settings.density_from, settings.density, settings.material


class MATERIAL_OT_body_moments_set_density(Operator):
    """Set the density of a Blender material from the material table"""

    bl_label = "Set Material Density"
    bl_property = "material"

    material: EnumProperty(
        name="Material",
        description="Entry of the material table to take the density from",
        items=preferences.MATERIAL_ITEMS,
    )
    target: StringProperty(
        name="Blender Material",
        description="Material to set the density of",
        options={"HIDDEN"},
    )

    def invoke(self, context: Context, _event) -> set[str]:
        context.window_manager.invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, _context: Context) -> set[str]:
        target = bpy.data.materials.get((self.target, None))  # None: from no library
        if target is None:
            return selection.refuse(
                self, "No local material “{material}”. Make it local.", material=self.target
            )
        entry = BY_NAME[self.material]
        target.body_moments.density = entry.density
        target.body_moments.material = entry.name
        return write.reports.report(
            self,
            write.reports.phrase(
                "Set “{target}” to {material}", target=target.name, material=entry.name
            ),
        )


class OBJECT_OT_body_moments_copy_settings(Operator):
    """Copy kind, material, density or mass, wall and overlaps from the active object to the other
    selected objects
    """

    bl_label = "Copy Settings to Selected"

    @classmethod
    def poll(cls, context: Context) -> bool:
        active = context.view_layer.objects.active
        has_others = active is not None and any(
            obj != active for obj in context.view_layer.objects.selected
        )
        return has_others or write.reports.unavailable(
            cls, "Select other objects besides the active one"
        )

    def execute(self, context: Context) -> set[str]:
        active = context.view_layer.objects.active
        objects = [obj for obj in context.view_layer.objects.selected if obj != active]

        def copy(obj: Object) -> bool:
            scene.changes.require_storable_data(obj)
            return properties.copy_settings(active.body_moments, obj.body_moments)

        return selection.change_all(
            self,
            objects,
            copy,
            ("Copied the settings to {count} object", "Copied the settings to {count} objects"),
            "the settings are equal",
        )


class OBJECT_OT_body_moments_preset_add(AddPresetBase, Operator):
    """Add or remove a preset of the settings that the panel shows"""

    bl_label = "Add Body Moments Preset"
    preset_menu = PRESET_PANEL
    preset_subdir = PRESET_FOLDER
    preset_defines = ["settings = bpy.context.object.body_moments"]
    # without `density_volume`, which refers to an object of this file
    preset_values = [
        "settings." + name for name in properties.COPIED_PROPERTIES if name != "density_volume"
    ]

    def execute(self, context: Context) -> set[str]:
        objects = session.selected.objects_with_settings(chosen_objects(context))
        if not objects:
            return selection.refuse(self, "Select objects")
        active = context.object
        with context.temp_override(object=active if active in objects else objects[0]):
            return AddPresetBase.execute(self, context)


class OBJECT_OT_body_moments_preset_apply(Operator):
    """Give the settings of a preset to the objects that the panel is about"""

    bl_label = "Apply Preset"
    bl_options = {"INTERNAL", "UNDO"}

    filepath: StringProperty(
        name="Preset", description="File of the preset", subtype="FILE_PATH", options={"SKIP_SAVE"}
    )

    def execute(self, context: Context) -> set[str]:
        def apply(obj: Object) -> None:
            scene.changes.require_storable_data(obj)
            with context.temp_override(object=obj):
                bpy.ops.script.execute_preset(filepath=self.filepath, menu_idname=PRESET_PANEL)

        objects = session.selected.objects_with_settings(chosen_objects(context))
        return selection.change_all(
            self, objects, apply, ("Set {count} object", "Set {count} objects")
        )
