# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panels of the density and of a given mass, and the density's row in the main panel.

The density is a given mass, one value, materials, a polynomial, an attribute or a Volume object; a
grid of voxels has settings of its own. An empty may stand for a point mass.
"""

from __future__ import annotations

from bpy.types import Context, Object, PropertyGroup, UILayout

from ..blender.read.visibility import GEOMETRY_TYPES
from ..blender.session import stored
from ..blender.settings.given import shows_collection
from ..blender.settings.preferences import default_material, shows_advanced
from ..blender.settings.properties import density_field_name
from ..blender.write.translations import CONTEXT
from ..core.lazy import loaded_module
from . import material_menus as materials
from . import rows
from .places import in_both_places


class DensityPanel:
    """What the object is made of"""

    bl_label = "Density"

    def draw(self, context: Context) -> None:
        _settings(self.layout, context, context.object)


def _has_density(obj: Object) -> bool:
    return obj.type in GEOMETRY_TYPES or shows_collection(obj)


def material_row(layout: UILayout, context: Context, obj: Object) -> None:
    """Draw the density's most used setting in one row: the material, or the setting in its
    place.
    """
    if not _has_density(obj):
        return
    settings = obj.body_moments
    column = layout.column()
    column.use_property_split = True
    if obj.type == "VOLUME" and settings.grid_as == "DENSITY":
        rows.setting(column, settings, "grid")
    elif settings.mass_from == "MASS":
        rows.setting(column, settings, "mass", text="Mass (kg)")
    elif settings.kind == "WIRE":
        rows.setting(column, settings, "linear_density", text="Density (kg/m)")
    elif settings.density_from == "VALUE" or obj.type == "VOLUME":
        _material(column, context, settings, "Material")
    else:
        rows.setting(column, settings, "density_from")


def _density_source(column: UILayout, settings: PropertyGroup) -> None:
    """Draw the source of the density, without polynomials unless one is in use or the preferences
    show them.
    """
    if shows_advanced() or settings.density_from == "POLYNOMIAL":
        rows.setting(column, settings, "density_from")
        return
    grid = column.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    grid.use_property_split = False  # each choice has its name on it
    for source in ("VALUE", "MATERIALS", "ATTRIBUTE", "VOLUME"):
        grid.prop_enum(settings, "density_from", source)


def _settings(layout: UILayout, context: Context, obj: Object) -> None:
    settings = obj.body_moments
    if obj.override_library is not None:
        rows.remark(
            layout,
            "Library override: settings and results are lost on saving. Make it local.",
            icon="ERROR",
        )
    if obj.type == "VOLUME" and _grid_settings(layout, obj):
        return
    column = layout.column()
    column.use_property_split = True
    if obj.type == "VOLUME":
        rows.setting(column, settings, "mass_from", expand=True)
        if settings.mass_from == "MASS":
            rows.setting(column, settings, "mass", text="Mass (kg)")
        else:
            _uniform_density(column, context, settings, "Material")
        return
    row = _labeled_row(column, "Kind")
    row.use_property_split = False
    for kind in (
        ("SOLID", "SHELL", "WIRE")
        if obj.type == "CURVE" or settings.kind == "WIRE"
        else ("SOLID", "SHELL")
    ):
        row.prop_enum(settings, "kind", kind)
    if settings.kind == "SHELL":
        rows.setting(column, settings, "wall")
        rows.setting(column, settings, "thickness")
        _max_thickness(column, obj)
    elif settings.kind == "SOLID":
        rows.setting(column, settings, "overlap")
    rows.setting(column, settings, "mass_from", expand=True)
    if settings.mass_from == "DENSITY" and settings.kind == "WIRE":
        rows.setting(column, settings, "linear_density", text="Density (kg/m)")
        return
    if settings.mass_from == "MASS":
        rows.setting(column, settings, "mass", text="Mass (kg)")
        return
    _density_source(column, settings)
    if settings.density_from == "POLYNOMIAL":
        rows.setting(column, settings, "density_polynomial")
        rows.setting(column, settings, "density_frame", expand=True)
    elif settings.density_from == "ATTRIBUTE":
        if obj.type == "MESH":
            column.prop_search(
                settings, "density_attribute", obj.data, "attributes", results_are_suggestions=True
            )
        else:
            rows.setting(column, settings, "density_attribute")
    elif settings.density_from == "VOLUME":
        rows.setting(column, settings, "density_volume")
    elif settings.density_from == "MATERIALS":
        _materials(layout, context, obj)
    else:
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
        rows.remark(row, "Folds over from {length:length}", icon="ERROR", length=limit)
    else:
        rows.remark(row, "Largest wall: {length:length}", length=limit)


def _materials(layout: UILayout, context: Context, obj: Object) -> None:
    settings = obj.body_moments
    column = layout.column(align=True)
    rows.filled(column, "Densities ({:s})", rows.scene_units().unit("density", 0.0)[1])
    shown = {slot.material: None for slot in obj.material_slots if slot.material}
    for material in shown:
        materials.density_row(column, context.scene, material, material.name)
    if not shown:
        rows.remark(column, "No material slots")
    column = layout.column()
    column.use_property_split = True
    _uniform_density(column, context, settings, "Others")


def _labeled_row(column: UILayout, label: str) -> UILayout:
    """Return a row beside a label, as Blender aligns properties, or below it in a narrow panel."""
    if rows.is_narrow():
        rows.title(column, label)
        return column.row(align=True)
    split = column.row(align=True).split(factor=0.4, align=True)
    heading = split.row()
    heading.alignment = "RIGHT"
    heading.label(text=label, text_ctxt=CONTEXT)
    return split.row(align=True)


def _uniform_density(column: UILayout, context: Context, settings, heading: str) -> None:
    """Draw the object's own density, with the table and the user's presets."""
    _material(column, context, settings, heading)
    rows.setting(column, settings, density_field_name(context.scene))


def _material(column: UILayout, context: Context, settings, heading: str) -> None:
    row = _labeled_row(column, heading)
    default = "" if settings.is_property_set("density") else default_material(context.scene)
    row.menu("OBJECT_MT_body_moments_materials", text=settings.material or default or "Custom")
    row.popover("OBJECT_PT_body_moments_presets", text="", icon="PRESET")


def _grid_settings(layout: UILayout, obj: Object) -> bool:
    """Draw the settings of an object's grid, and return whether the mass comes from the grid, not
    from a material.
    """
    settings = obj.body_moments
    column = layout.column()
    rows.setting(column, settings, "grid")
    rows.setting(column, settings, "grid_as", expand=True)
    if settings.grid_as == "SOLID":
        return False
    if settings.grid_as == "THRESHOLD":
        rows.setting(column, settings, "threshold")
        rows.setting(column, settings, "threshold_fill", expand=True)
    rows.setting(column, settings, "spline_order")
    if settings.sample_positions:
        column.label(text="Samples at their own positions", icon="SNAP_INCREMENT")
    if settings.grid_as == "THRESHOLD" and settings.threshold_fill == "MATERIAL":
        return False
    rows.setting(column, settings, "mass_from", expand=True)
    rows.setting(column, settings, "values_from", expand=True)
    if settings.values_from == "FACTOR":
        rows.setting(column, settings, "value_density", text="Value 1 (kg/m³)")
    else:
        rows.setting(column, settings, "transfer_table", text="Table")
        rows.sentence(layout.column(), settings.transfer_table.replace(", ", " · "))
    if settings.mass_from == "MASS":
        rows.setting(column, settings, "mass", text="Mass (kg)")
    return True


class GivenPanel:
    """A mass that is known, with or without its center and inertia"""

    bl_label = "Given Mass"

    def draw(self, context: Context) -> None:
        layout, obj = self.layout, context.object
        settings = obj.body_moments
        if _may_be_point(obj):
            row = layout.row(align=True)
            row.prop_enum(settings, "mass_from", "DENSITY", text="No Mass")
            row.prop_enum(settings, "mass_from", "MASS", text="Point Mass")
            if settings.mass_from != "MASS":
                return
        column = layout.column()
        rows.setting(column, settings, "mass", text="Mass (kg)")
        given_rows(layout, settings)


def _may_be_point(obj) -> bool:
    return obj.type == "EMPTY" and not shows_collection(obj)


def given_rows(layout: UILayout, settings: PropertyGroup) -> None:
    """Draw the optional properties of a given mass."""
    column = layout.column()
    rows.setting(column, settings, "use_center")
    if settings.use_center:
        rows.setting(column, settings, "given_center", text="Center")
    rows.setting(column, settings, "use_inertia")
    if settings.use_inertia:
        rows.setting(column, settings, "given_inertia_diagonal", text="Ixx, Iyy, Izz")
        rows.setting(column, settings, "given_inertia_products", text="Ixy, Ixz, Iyz")


CLASSES = (
    *in_both_places(DensityPanel, "density", shown_for=_has_density),
    *in_both_places(
        GivenPanel,
        "given",
        shown_for=lambda obj: _may_be_point(obj) or obj.body_moments.mass_from == "MASS",
    ),
)
