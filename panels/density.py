# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panels of the density and of a given mass, and the density's row in the main panel.

The density is a given mass, one value, materials, a polynomial, an attribute or a Volume object; a
grid of voxels has settings of its own. An empty may stand for a point mass.
"""

from __future__ import annotations

from itertools import chain

import bpy
from bpy.types import Context, Mesh, Object, Panel, PropertyGroup, UILayout

from ..blender.session import stored
from ..blender.session.selected import chosen_settings, common, is_mixed, owners
from ..blender.settings import given, preferences, properties
from ..blender.write.translations import CONTEXT
from ..core.lazy import loaded_module
from . import material_menus as materials
from . import places, rows, texts

PRINT_SETTINGS = (
    "print_preset",
    "print_walls",
    "print_line_width",
    "print_top_layers",
    "print_bottom_layers",
    "print_layer_height",
    "print_infill",
    "spool_price",
)


class DensityPanel:
    """What the object is made of"""

    bl_label = "Density"

    def draw(self, context: Context) -> None:
        _settings(self.layout, context)


def material_row(layout: UILayout, context: Context) -> None:
    """Draw the density's most used setting in one row: the material, or the setting in its
    place.
    """
    settings = chosen_settings(context)
    objects = owners(context)
    if settings is None or not given.has_density(objects[0]):
        return
    are_volumes = all(obj.type == "VOLUME" for obj in objects)
    column = layout.column()
    column.use_property_split = True
    if are_volumes and common(settings, "grid_as") == "DENSITY":
        rows.settings(column, settings, "grid")
    elif is_mixed(settings, "mass_from"):
        rows.settings(column, settings, "mass_from")
    elif settings.mass_from == "MASS":
        rows.settings(column, settings, "mass")
    elif common(settings, "kind") == "WIRE":
        rows.settings(column, settings, "linear_density")
    elif common(settings, "density_from") == "VALUE" or are_volumes:
        _material(column, context, settings, "Material")
    else:
        rows.settings(column, settings, "density_from")


def _density_source(column: UILayout, settings: PropertyGroup) -> None:
    """Draw the source of the density, without polynomials unless one is in use or the preferences
    show them.
    """
    source = common(settings, "density_from")  # None: the objects differ
    if preferences.shows_advanced() or source in (None, "POLYNOMIAL"):
        rows.settings(column, settings, "density_from")
        return
    grid = column.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    grid.use_property_split = False  # each choice has its name on it
    for choice in ("VALUE", "MATERIALS", "ATTRIBUTE", "VOLUME"):
        grid.prop_enum(settings, "density_from", choice)


def _settings(layout: UILayout, context: Context) -> None:
    settings = chosen_settings(context)
    objects = owners(context)
    if any(obj.override_library is not None for obj in objects):
        texts.remark(
            layout,
            "Library override: settings and results are lost on saving. Make it local.",
            icon="ERROR",
        )
    are_volumes = all(obj.type == "VOLUME" for obj in objects)
    if are_volumes and _grid_settings(layout, settings):
        return
    column = layout.column()
    column.use_property_split = True
    kind = "SOLID" if are_volumes else common(settings, "kind")
    if not are_volumes:
        _shape_settings(column, settings, objects, kind)
    rows.settings(column, settings, "mass_from", expand=True)
    mass_from = common(settings, "mass_from")
    if mass_from == "MASS":
        rows.settings(column, settings, "mass")
    elif mass_from is not None and kind == "WIRE":
        rows.settings(column, settings, "linear_density")
    elif mass_from is not None:
        _density_settings(layout, column, context, settings, are_volumes)


def _shape_settings(
    column: UILayout, settings: PropertyGroup, objects: list[Object], kind: str | None
) -> None:
    """Draw the kind of the bodies, and their walls or overlaps."""
    if kind is None:
        rows.settings(column, settings, "kind")
    else:
        row = rows.labeled_row(column, "Kind", CONTEXT)
        row.use_property_split = False
        may_be_wire = kind == "WIRE" or all(obj.type == "CURVE" for obj in objects)
        for item in ("SOLID", "SHELL", "PRINTED", *(["WIRE"] if may_be_wire else [])):
            row.prop_enum(settings, "kind", item)
    if kind == "SHELL":
        rows.settings(column, settings, "wall", "thickness")
        if len(objects) == 1:
            _max_thickness(column, objects[0])
    elif kind == "PRINTED":
        _print_settings(column, settings)
    if kind in ("SOLID", "PRINTED"):
        rows.settings(column, settings, "overlap")


def _print_settings(column: UILayout, settings: PropertyGroup) -> None:
    """Draw how the bodies are printed, and the price of the filament."""
    rows.settings(column, settings, *PRINT_SETTINGS)
    if common(settings, "pocket_radius"):
        rows.settings(column, settings, "pocket_radius", "pocket_density", "pocket_center")
    if common(settings, "spool_price"):
        rows.settings(column, settings, "spool_mass")
    objects = owners(bpy.context)
    if len(objects) == 1 and "body_material_volume" in objects[0]:
        texts.filled(column, "Material: {:.5g} cm³", 1e6 * objects[0]["body_material_volume"])
        if "body_price" in objects[0]:
            texts.filled(column, "Price: {:.2f}", objects[0]["body_price"])


def _density_settings(
    layout: UILayout, column: UILayout, context: Context, settings: PropertyGroup, are_volumes: bool
) -> None:
    """Draw the source of the density and its settings."""
    if are_volumes:
        _uniform_density(column, context, settings, "Material")
        return
    _density_source(column, settings)
    source = common(settings, "density_from")
    if source == "POLYNOMIAL":
        rows.settings(column, settings, "density_polynomial")
        rows.settings(column, settings, "density_frame", expand=True)
    elif source == "ATTRIBUTE":
        mesh = owners(context)[0].data
        if isinstance(mesh, Mesh) and not is_mixed(settings, "density_attribute"):
            column.prop_search(
                settings, "density_attribute", mesh, "attributes", results_are_suggestions=True
            )
        else:
            rows.settings(column, settings, "density_attribute")
    elif source == "VOLUME":
        rows.settings(column, settings, "density_volume")
    elif source == "MATERIALS":
        _materials(layout, context, settings)
    elif source is not None:
        _uniform_density(column, context, settings, "Material")


def _max_thickness(layout: UILayout, obj: Object) -> None:
    """Draw the largest thickness of the wall, once it is known."""
    sliders = loaded_module(stored, "sliders")
    limit = None if sliders is None else sliders.max_thickness(obj)
    if limit is None:
        return
    folds = sliders.is_too_thick(obj)
    row = layout.row()
    row.alert = folds
    if folds:
        texts.remark(row, "Folds over from {length:length}", icon="ERROR", length=limit)
    else:
        texts.remark(row, "Largest wall: {length:length}", length=limit)


def _materials(layout: UILayout, context: Context, settings: PropertyGroup) -> None:
    column = layout.column(align=True)
    texts.filled(column, "Densities ({:s})", texts.scene_units().unit("density", 0.0)[1])
    slots = chain.from_iterable(obj.material_slots for obj in owners(context))
    slot_materials = dict.fromkeys(slot.material for slot in slots if slot.material)
    for material in slot_materials:
        materials.density_row(column, context.scene, material, material.name)
    if not slot_materials:
        texts.remark(column, "No material slots")
    column = layout.column()
    column.use_property_split = True
    _uniform_density(column, context, settings, "Others")


def _uniform_density(column: UILayout, context: Context, settings, heading: str) -> None:
    """Draw the object's own density, with the table and the user's presets."""
    _material(column, context, settings, heading)
    rows.settings(column, settings, properties.density_field_name(context.scene))


def _material(column: UILayout, context: Context, settings: PropertyGroup, heading: str) -> None:
    """Draw the menu of materials, with the name of the chosen one, and the user's presets.

    The name of a density that nobody has set is that of the default material, and "Custom" that of
    a density without a material.
    """
    row = rows.labeled_row(column, heading)
    name = "Mixed"
    if not is_mixed(settings, "material") and (
        settings.material or not is_mixed(settings, "density_kg_m3")
    ):
        is_set = owners(context)[0].body_moments.is_property_set("density")
        name = (
            settings.material
            or (not is_set and preferences.default_material(context.scene))
            or "Custom"
        )
    row.menu("OBJECT_MT_body_moments_materials", text=name)
    row.popover("OBJECT_PT_body_moments_presets", text="", icon="PRESET")


class OBJECT_PT_body_moments_mixed(Panel):
    """A setting that differs among the selected objects: a new value is that of all"""

    bl_label = "Mixed"
    bl_space_type = "PROPERTIES"
    bl_region_type = "HEADER"

    def draw(self, context: Context) -> None:
        if name := getattr(context, "body_moments_setting", ""):
            column = self.layout.column()
            column.label(text="For all selected objects")
            column.prop(context.scene.body_moments_selection, name)


def _grid_settings(layout: UILayout, settings: PropertyGroup) -> bool:
    """Draw the settings of an object's grid, and return whether the mass comes from the grid, not
    from a material.
    """
    column = layout.column()
    rows.settings(column, settings, "grid")
    rows.settings(column, settings, "grid_as", expand=True)
    grid_as = common(settings, "grid_as")
    if grid_as in (None, "SOLID"):
        return False
    if grid_as == "LABEL":
        rows.settings(column, settings, "label")
        return False
    if grid_as == "THRESHOLD":
        rows.settings(column, settings, "threshold")
        rows.settings(column, settings, "threshold_fill", expand=True)
    rows.settings(column, settings, "spline_order")
    if getattr(settings, "sample_positions", ""):
        column.label(text="Samples at their own positions", icon="SNAP_INCREMENT")
    if grid_as == "THRESHOLD" and common(settings, "threshold_fill") in (None, "MATERIAL"):
        return False
    rows.settings(column, settings, "mass_from", "values_from", expand=True)
    if common(settings, "values_from") in (None, "FACTOR"):
        rows.settings(column, settings, "value_density")
    else:
        rows.settings(column, settings, "transfer_table")
        texts.sentence(layout.column(), settings.transfer_table.replace(", ", " · "))
    if common(settings, "mass_from") == "MASS":
        rows.settings(column, settings, "mass")
    return True


class GivenPanel:
    """A mass that is known, with or without its center and inertia"""

    bl_label = "Given Mass"

    def draw(self, context: Context) -> None:
        layout = self.layout
        settings = chosen_settings(context)
        if settings is None:
            return
        if _may_be_point(owners(context)[0]):
            row = layout.row(align=True)
            row.prop_enum(settings, "mass_from", "DENSITY", text="No Mass")
            row.prop_enum(settings, "mass_from", "MASS", text="Point Mass")
        elif is_mixed(settings, "mass_from"):
            rows.settings(layout, settings, "mass_from")
        if common(settings, "mass_from") == "MASS":
            rows.settings(layout.column(), settings, "mass")
            given_rows(layout, settings)


def _may_be_point(obj: Object) -> bool:
    return obj.type == "EMPTY" and not given.shows_collection(obj)


def given_rows(layout: UILayout, settings: PropertyGroup) -> None:
    """Draw the optional properties of a given mass."""
    column = layout.column()
    rows.settings(column, settings, "use_center")
    if common(settings, "use_center"):
        rows.settings(column, settings, "given_center")
    rows.settings(column, settings, "use_inertia")
    if common(settings, "use_inertia"):
        rows.settings(column, settings, "given_inertia_diagonal", "given_inertia_products")


CLASSES = (
    *places.in_both_places(DensityPanel, "density", shown_for=given.has_density, for_any=True),
    *places.in_both_places(
        GivenPanel,
        "given",
        shown_for=lambda obj: _may_be_point(obj) or obj.body_moments.mass_from == "MASS",
        for_any=True,
    ),
)
