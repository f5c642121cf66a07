# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of an object's body and of its materials, in property groups; results live in ID
properties.

The given mass has no unit type: Blender would scale it by scale_length³, while a part weighs the
same in all units.
"""

from functools import partial
from typing import Any

import bpy
from bpy.props import (
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, Material, Object, PropertyGroup, Scene

from ...core.density import BY_NAME, CT_DENSITIES, DENSITY_UNITS, density_unit
from ...core.numerics import shortest_decimal
from ..scale import meters_per_unit
from .density import object_density
from .given import (
    GIVEN_PROPERTIES,
    GivenPartProperties,
    choice_property,
    density_property,
    is_point_mass,
    mass_property,
)
from .hooks import changed, density_changed, threshold_changed, wall_changed
from .prints import PRINT_OPTIONS, PrintProperties, set_print

TRANSLATION_CONTEXT = (
    "Body Moments"  # for words that mean something else in Blender's own translations
)

COPIED_PROPERTIES = (
    *(
        "kind",
        "wall",
        "thickness",
        "mass_from",
        "density",
        "linear_density",
        "material",
        "mass",
        "overlap",
    ),
    *("density_from", "density_polynomial", "density_frame", "density_attribute", "density_volume"),
    *(
        "grid",
        "grid_as",
        "threshold",
        "threshold_fill",
        "label",
        "values_from",
        "value_density",
        "transfer_table",
    ),
    *(name for name, _ in PRINT_OPTIONS.values()),
    *("pocket_center", "pocket_radius", "pocket_density"),
    *("spline_order", *GIVEN_PROPERTIES),
)


_choice = partial(choice_property, update=changed)


def _density_changed(settings: PropertyGroup, context: Context) -> None:
    _forget_material(settings)
    density_changed(settings, context)


def _forget_material(settings: PropertyGroup, _context: Context | None = None) -> None:
    material = BY_NAME.get(settings.material)
    if settings.material and (
        material is None or shortest_decimal(material.density) != shortest_decimal(settings.density)
    ):
        settings.material = ""


def _density_in(unit: str, description: str):
    """Return a property that gets and sets the setting `density` in another unit."""
    factor, name = DENSITY_UNITS[unit]
    return FloatProperty(
        name="Density ({:s})".format(name),
        description=description.format(name),
        get=lambda settings: _shown_density(settings) / factor,
        set=lambda settings, value: setattr(settings, "density", value * factor),
        min=0.0,
        soft_max=25000.0 / factor,
        precision=3 if factor < 100.0 else 4,
        options=set(),
    )


def _text(name: str, description: str, **special: Any) -> Any:
    return StringProperty(name=name, description=description, update=changed, **special)


def _shown_density(settings: PropertyGroup) -> float:
    if isinstance(settings.id_data, Object):
        return object_density(settings, bpy.context.scene)
    return settings.density


class BodyMomentsObjectSettings(GivenPartProperties, PrintProperties, PropertyGroup):
    """Settings of one object's body."""

    kind: _choice(
        "Kind",
        "What the geometry of the object represents",
        ("SOLID", "Solid", "The surface bounds a volume filled with material"),
        ("SHELL", "Shell", "The surface is a sheet or wall of the given thickness"),
        (
            "PRINTED",
            "Printed",
            "The surface bounds a 3D print: walls, top and bottom layers around a core of infill, "
            "printed upward along the world's z. Seams, supports, brims and the pattern's "
            "directions are not modeled",
        ),
        ("WIRE", "Wire", "The curve is a wire of the given mass per length"),
        translation_context=TRANSLATION_CONTEXT,
    )
    mass_from: _choice(
        "Specify",
        "Whether density or mass is entered; the other is computed",
        ("DENSITY", "Density", "Enter the density and compute the mass"),
        ("MASS", "Mass", "Enter the measured mass and compute the mean density"),
        update=density_changed,
    )
    density_from: _choice(
        "Density From",
        "Source of the density",
        ("VALUE", "One Value", "The same density everywhere"),
        (
            "MATERIALS",
            "Materials",
            "Density of each material, per face of a shell and per closed component of a solid. "
            "Faces whose "
            "material has no density use the object's",
        ),
        (
            "POLYNOMIAL",
            "Polynomial",
            "Polynomial in x, y and z, in kg/m³ for coordinates in meters",
        ),
        (
            "ATTRIBUTE",
            "Vertex Attribute",
            "Float attribute on the vertices of a shell, in kg/m³, interpolated linearly",
        ),
        (
            "VOLUME",
            "Volume Object",
            "Grid of a Volume object around a solid, constant in each voxel",
        ),
        update=density_changed,
    )
    density_polynomial: _text(
        "Polynomial",
        "Density in kg/m³ for x, y and z in meters, such as 1000 + 20*z. Alternatively the "
        "coefficients of 1, x, "
        "y, z, x², xy, xz, y², yz, z², … separated by commas",
        default="1000",
    )
    density_frame: _choice(
        "Coordinates",
        "Coordinate system of x, y and z in the polynomial",
        (
            "OBJECT",
            "Object",
            "Meters along the object's axes from its origin, mirrored by a negative scale. Each "
            "instance has its own",
        ),
        ("WORLD", "World", "Meters along the world axes from the world origin"),
    )
    density_attribute: _text(
        "Attribute",
        "Float attribute on the vertices with the density in kg/m³, after modifiers",
        default="density",
    )
    density: density_property(
        "Density in kg/m³, independent of the scene units", _density_changed, soft_min=0.01
    )
    linear_density: mass_property(
        "Mass per length of the wire in kg/m, independent of the scene units",
        density_changed,
        "Linear Density",
    )
    mass: mass_property(
        "Mass in kilograms, independent of the scene units. Type pounds as 5*0.45359237",
        density_changed,
    )
    wall: _choice(
        "Wall",
        "Position of the material relative to the surface",
        ("THIN", "Thin", "Area times thickness, for thin sheets"),
        ("INWARD", "Inward", "Real thickness behind the faces, with mitered corners"),
        ("OUTWARD", "Outward", "Real thickness in front of the faces, with mitered corners"),
        (
            "CENTERED",
            "Centered",
            "Real thickness, half behind and half in front of the faces, with mitered corners",
        ),
        update=wall_changed,
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of the sheet or wall",
        default=0.001,
        min=0.0,
        precision=6,
        unit="LENGTH",
        update=wall_changed,
    )
    overlap: _choice(
        "Overlaps",
        "How overlapping or nested components of the object count",
        (
            "SIGNED",
            "Count Each Shell",
            "Every component counts fully; shared space counts twice, with a warning",
        ),
        ("UNION", "Count as Union", "Components are united first by Blender's Boolean"),
    )
    material: _text("Material", "Material that the density was taken from")
    grid: _text("Grid", "Grid to measure. If empty, “density” or else the first suitable grid")
    grid_as: _choice(
        "Measure As",
        "What the values of the grid represent",
        ("DENSITY", "Density", "The values determine the density of each voxel"),
        ("SOLID", "Solid", "The grid is a level set that bounds a solid filled with material"),
        (
            "THRESHOLD",
            "Threshold",
            "The body where the values, linear between voxels, are at least a threshold",
        ),
        ("LABEL", "Label", "The values are numbers of regions: the voxels of one, or of all"),
    )
    label: IntProperty(
        name="Label",
        description="Number of the region to measure. 0: all regions, the voxels that are not 0",
        default=0,
        update=changed,
    )
    threshold: FloatProperty(
        name="Threshold",
        description="Grid value from which on a point belongs to the body",
        default=0.5,
        step=1,
        precision=4,
        update=threshold_changed,
    )
    threshold_fill: _choice(
        "Filled With",
        "What the body within the threshold is made of",
        ("MATERIAL", "Material", "One density, as for any solid"),
        ("GRID", "Grid", "The density that the values of the grid represent"),
    )
    values_from: _choice(
        "Values",
        "How grid values are converted to densities",
        ("FACTOR", "Factor", "Multiply the values by a density"),
        ("TABLE", "Table", "Use a transfer table, for example for CT numbers"),
    )
    value_density: density_property(
        "Density in kg/m³ where the grid value is 1",
        changed,
        name="Density of Value 1",
        default=1.0,
        step=100,
        precision=4,
    )
    transfer_table: _text(
        "Transfer Table",
        "Pairs of a grid value and a density in kg/m³, separated by commas. Linear in between, "
        "constant beyond. "
        "The default converts CT numbers to tissue densities",
        default=CT_DENSITIES,
    )
    spline_order: IntProperty(
        name="Spline Order",
        description="Order of the spline whose coefficients the values are: 1 for voxels, 2 for "
        "trilinear, 4 for cubic",
        default=1,
        min=1,
        max=6,
        update=changed,
    )
    sample_positions: _text(
        "Sample Positions",
        "Where the samples of an imported scan stand along x, y and z, in voxels, if not evenly",
        options={"HIDDEN"},
    )
    accepted: _text(
        "Accepted Findings",
        "Codes of the warnings that were accepted for this object and are notes",
        options={"HIDDEN"},
    )
    density_volume: PointerProperty(
        name="Volume",
        description="Volume object whose grid is the density inside the solid",
        type=Object,
        poll=lambda _settings, obj: obj.type == "VOLUME",
        update=changed,
    )


class BodyMomentsMaterialSettings(PropertyGroup):
    """Settings of a material's density."""

    density: density_property(
        "Density in kg/m³, independent of the scene units. At 0, the density of the object is used",
        _forget_material,
        default=0.0,
    )
    material: StringProperty(
        name="Material",
        description="Entry of the material table that the density was taken from",
    )


for unit in DENSITY_UNITS:
    BodyMomentsObjectSettings.__annotations__["density_" + unit.lower()] = _density_in(
        unit, "Density in {:s}"
    )
    BodyMomentsMaterialSettings.__annotations__["density_" + unit.lower()] = _density_in(
        unit, "Density in {:s}. At 0, the density of the object is used"
    )


def density_field_name(scene: Scene) -> str:
    """Return the name of the property that shows an object's or a material's density in the scene's
    unit.
    """
    unit = density_unit(scene.body_moments.density_unit, scene.unit_settings.system)
    return "density_" + unit.lower()


def copy_settings(source: PropertyGroup, target: PropertyGroup) -> bool:
    """Copy COPIED_PROPERTIES, set ones even if equal; return whether any value was different."""
    changed = False
    for name in COPIED_PROPERTIES:
        value = getattr(source, name)
        is_different = comparable(getattr(target, name)) != comparable(value)
        if is_different or source.is_property_set(name) and not target.is_property_set(name):
            setattr(target, name, value)
        changed = changed or is_different
    return changed


def comparable(value):
    """Return the value in a form that can be compared: an array as a tuple of its numbers."""
    return value[:] if hasattr(value, "foreach_get") else value


def apply_options(settings: PropertyGroup, options, scene: Scene) -> None:
    """Write kind, overlap, wall, density, mass and thickness from `MeasureOptions` into the
    settings, if not None.
    """
    for name in ("kind", "overlap", "wall"):
        if getattr(options, name) is not None:
            setattr(settings, name, getattr(options, name).upper())
    if options.density is not None and not is_point_mass(settings.id_data):
        settings.mass_from = "DENSITY"
        settings.density_from = "VALUE"
        name = "linear_density" if settings.kind == "WIRE" else "density"
        setattr(settings, name, options.density)
        if settings.id_data.type == "VOLUME":
            settings.values_from = "FACTOR"
            settings.value_density = options.density
    if options.mass is not None:
        settings.mass_from = "MASS"
        settings.mass = options.mass
    set_print(settings, dict(options.printed))
    if options.thickness is not None:
        settings.thickness = options.thickness / meters_per_unit(scene)


POINTERS = {
    (Object, "body_moments"): BodyMomentsObjectSettings,
    (Material, "body_moments"): BodyMomentsMaterialSettings,
}
