# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings: what an object is made of, and in which frame numbers are shown.

They live in property groups (`Object.body_moments`, `Material.body_moments`, `Scene.body_moments`); results live in ID
properties, never here. The given mass has no unit type: Blender would scale a `unit='MASS'`
property by scale_length³, while a weighed part weighs the same whatever a scene's unit is.
"""

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty
from bpy.types import Context, Material, Object, PropertyGroup, Scene

from ...core.density.materials import BY_NAME
from ...core.density.transfer_function import CT
from ...core.numerics.float32 import decimal
from ...core.polyhedron import MAX_ORDER
from .hooks import wall_changed

COPIED = (
    *("kind", "wall", "thickness", "mass_from", "density", "linear_density", "material", "mass", "overlap"),
    *("density_from", "density_polynomial", "density_frame", "density_attribute"),
    *("density_volume", "grid", "grid_as", "values_from", "value_density", "transfer_table", "spline_order"),
)


def _forget_material(settings: PropertyGroup, _context: Context) -> None:
    material = BY_NAME.get(settings.material)
    if settings.material and (material is None or np.float32(material.density) != np.float32(settings.density)):
        settings.material = ""


class BodyMomentsObjectSettings(PropertyGroup):
    """What one object is made of."""

    kind: EnumProperty(
        name="Kind",
        description="What the surface stands for",
        items=(
            ("SOLID", "Solid", "The surface bounds a body that is filled with the material"),
            ("SHELL", "Shell", "The surface itself is a sheet of the given thickness"),
            ("WIRE", "Wire", "A curve itself is a wire of the given mass per length"),
        ),
        default="SOLID",
    )
    mass_from: EnumProperty(
        name="Mass From",
        description="Which of mass and density is given; the other follows from the geometry",
        items=(
            ("DENSITY", "Density", "The density is given, the mass follows"),
            ("MASS", "Mass", "The mass is given, as weighed, and the density follows"),
        ),
        default="DENSITY",
    )
    density_from: EnumProperty(
        name="Density From",
        description="Where the density comes from",
        items=(
            ("VALUE", "One Value", "The same density everywhere"),
            (
                "MATERIALS",
                "Materials",
                "Each material's own: of a shell by face, of a solid by closed part. Faces without a material that "
                "has a density take the object's",
            ),
            (
                "POLYNOMIAL",
                "Polynomial",
                "A polynomial in x, y and z, in kg/m³ where coordinates are in meters",
            ),
            (
                "ATTRIBUTE",
                "Vertex Attribute",
                "Of a shell: a float attribute on its vertices, in kg/m³, linear in between",
            ),
            ("VOLUME", "Volume Object", "Of a solid: the grid of a Volume object, constant in each voxel"),
        ),
        default="VALUE",
    )
    density_polynomial: StringProperty(
        name="Polynomial",
        description=(
            "kg/m³, of x, y, z in meters, such as 1000 + 20*z; or its coefficients for 1, x, y, z, x², xy, xz, "
            "y², yz, z², … separated by commas"
        ),
        default="1000",
    )
    density_frame: EnumProperty(
        name="Coordinates",
        description="What x, y and z of the polynomial are",
        items=(
            (
                "OBJECT",
                "Own",
                "Meters along the object's own axes from its origin; a negative scale mirrors them, and instances "
                "carry the density along, each in its own place",
            ),
            ("WORLD", "World", "Meters along the world's axes from its origin"),
        ),
        default="OBJECT",
    )
    density_attribute: StringProperty(
        name="Attribute",
        description="Name of a float attribute on the vertices, kg/m³, as the modifiers leave it",
        default="density",
    )
    density: FloatProperty(
        name="Density",
        description="Density in kg/m³, whatever the scene's units are. Type lb/ft³ as 170*16.0185",
        default=1000.0,
        min=0.0,
        soft_min=0.01,
        soft_max=25000.0,
        step=1000,
        precision=3,
        update=_forget_material,
    )
    linear_density: FloatProperty(
        name="Linear Density",
        description="Mass per length of a wire, in kg/m, whatever the scene's units are",
        default=1.0,
        min=0.0,
        step=10,
        precision=6,
    )
    mass: FloatProperty(
        name="Mass",
        description="Mass in kilograms, whatever the scene's units are. Type pounds as 5*0.45359237",
        default=1.0,
        min=0.0,
        step=10,
        precision=6,
    )
    wall: EnumProperty(
        name="Wall",
        description="Where the material of the shell is",
        items=(
            ("THIN", "Thin", "In the surface itself: area times thickness, good for thin sheets"),
            ("INWARD", "Inward", "Behind the faces, as real material with mitred corners"),
            ("OUTWARD", "Outward", "In front of the faces, as real material with mitred corners"),
            (
                "CENTERED",
                "Centered",
                "Half behind the faces, half in front, as real material with mitred corners",
            ),
        ),
        default="THIN",
        update=wall_changed,
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of the sheet",
        default=0.001,
        min=0.0,
        precision=6,
        unit="LENGTH",
        update=wall_changed,
    )
    overlap: EnumProperty(
        name="Overlaps",
        description=("What is measured where shells of this object overlap or lie inside one another"),
        items=(
            (
                "SIGNED",
                "Counted Each",
                "Every shell counts; what two of them share counts twice, with a warning",
            ),
            ("UNION", "United", "Shells are united first, by Blender's exact boolean"),
        ),
        default="SIGNED",
    )
    material: StringProperty(
        name="Material",
        description="Name of the material that the density was taken from",
    )
    grid: StringProperty(
        name="Grid",
        description="Name of the grid that is measured; empty for “density”, or else the first that can be one",
    )
    grid_as: EnumProperty(
        name="Measure As",
        description="What the values of the grid are",
        items=(
            ("DENSITY", "Density", "The values tell how much mass there is at each place"),
            ("SOLID", "Solid", "The grid is a level set: the solid that it bounds is filled with the material"),
        ),
        default="DENSITY",
    )
    values_from: EnumProperty(
        name="Values",
        description="How the values of the grid become densities",
        items=(
            ("FACTOR", "Factor", "Each value times the same density"),
            ("TABLE", "Table", "By a transfer table, as for CT numbers"),
        ),
        default="FACTOR",
    )
    value_density: FloatProperty(
        name="Density of Value 1",
        description="Density in kg/m³ where the grid's value is 1",
        default=1.0,
        min=0.0,
        soft_max=25000.0,
        step=100,
        precision=4,
    )
    transfer_table: StringProperty(
        name="Transfer Table",
        description=(
            "Pairs of a value and a density in kg/m³, separated by commas; straight between them, constant beyond. "
            "The default turns CT numbers into tissue densities"
        ),
        default=CT,
    )
    spline_order: IntProperty(
        name="Spline Order",
        description="The values are the coefficients of a spline of this order: 1 voxels, 2 trilinear, 4 cubic",
        default=1,
        min=1,
        max=6,
    )
    density_volume: PointerProperty(
        name="Volume",
        description="The Volume object whose grid is the density inside of this solid",
        type=Object,
        poll=lambda _settings, obj: obj.type == "VOLUME",
    )


class BodyMomentsMaterialSettings(PropertyGroup):
    """What a material weighs."""

    density: FloatProperty(
        name="Density",
        description="Density in kg/m³, whatever the scene's units are; 0 for none, then the object's is taken",
        default=0.0,
        min=0.0,
        soft_max=25000.0,
        step=1000,
        precision=3,
        update=_forget_material,
    )
    material: StringProperty(
        name="Material",
        description="Name of the entry that the density was taken from",
    )


class BodyMomentsSceneSettings(PropertyGroup):
    """How the scene's numbers are shown."""

    frame: EnumProperty(
        name="Frame",
        description=("The axes and origin that the center of mass, the axes and the tensor are shown in"),
        items=(
            ("WORLD", "World", "The scene's axes and origin"),
            ("OBJECT", "Object", "The object's own location and rotation, with unit scale"),
        ),
        default="WORLD",
    )
    moments_order: IntProperty(
        name="Order",
        description="The highest p + q + r of the moments ∫ x^p y^q z^r that are computed",
        default=4,
        min=1,
        max=MAX_ORDER,
        soft_max=20,
    )
    moments_of: EnumProperty(
        name="Over",
        description="What the moments are integrals over; no density is in them",
        items=(
            ("VOLUME", "Volume", "The volume; of a shell, its area times its thickness"),
            ("SURFACE", "Surface", "The area of the faces"),
        ),
        default="VOLUME",
    )
    moments_about: EnumProperty(
        name="About",
        description="The point that coordinates are measured from",
        items=(
            ("ORIGIN", "Frame's Origin", "The origin of the frame that is chosen"),
            ("CENTER", "Center", "The center of the volume, or of the surface: central moments"),
            (
                "NORMALIZED",
                "Center, Normalized",
                "Central moments of the body scaled to a volume, or an area, of 1: the same for every size",
            ),
        ),
        default="ORIGIN",
    )


def copy_settings(source: PropertyGroup, target: PropertyGroup) -> bool:
    """Copy every setting; whether anything was different."""
    changed = False
    for name in COPIED:
        value = getattr(source, name)
        if getattr(target, name) != value:
            setattr(target, name, value)
            changed = True
    return changed


def keep(settings: PropertyGroup, options, scene: Scene) -> None:
    """Make the options (`measure.MeasureOptions`, SI) that are not None the object's settings."""
    for name in ("kind", "overlap"):
        if getattr(options, name) is not None:
            setattr(settings, name, getattr(options, name).upper())
    if options.density is not None:
        settings.mass_from, settings.density_from = "DENSITY", "VALUE"
        setattr(settings, "linear_density" if settings.kind == "WIRE" else "density", options.density)
        if settings.id_data.type == "VOLUME":
            settings.values_from, settings.value_density = "FACTOR", options.density
    if options.mass is not None:
        settings.mass_from, settings.mass = "MASS", options.mass
    if options.thickness is not None:
        settings.thickness = options.thickness / decimal(scene.unit_settings.scale_length)


CLASSES = (BodyMomentsObjectSettings, BodyMomentsMaterialSettings, BodyMomentsSceneSettings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Object.body_moments = PointerProperty(name="Body Moments", type=BodyMomentsObjectSettings)
    Material.body_moments = PointerProperty(name="Body Moments", type=BodyMomentsMaterialSettings)
    Scene.body_moments = PointerProperty(name="Body Moments", type=BodyMomentsSceneSettings)


def unregister() -> None:
    del Scene.body_moments
    del Material.body_moments
    del Object.body_moments
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
