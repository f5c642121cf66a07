# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings: what an object is made of, and in which frame numbers are shown.

They live in property groups (`Object.body_moments`, `Scene.body_moments`); results live in ID
properties, never here. The given mass has no unit type: Blender would scale a `unit='MASS'`
property by scale_length³, while a weighed part weighs the same whatever a scene's unit is.
"""

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, PointerProperty, StringProperty
from bpy.types import Context, Object, PropertyGroup, Scene

from ..core.decimal import decimal
from ..core.materials import BY_NAME

COPIED = ("kind", "thickness", "mass_from", "density", "linear_density", "material", "mass", "overlap")


def _forget_material(settings: PropertyGroup, _context: Context) -> None:
    material = BY_NAME.get(settings.material)
    if settings.material and (
        material is None or np.float32(material.density) != np.float32(settings.density)
    ):
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
    density: FloatProperty(
        name="Density",
        description="Density in kg/m³",
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
        description="Mass per length of a wire, in kg/m",
        default=1.0,
        min=0.0,
        step=10,
        precision=6,
    )
    mass: FloatProperty(
        name="Mass",
        description="Mass in kilograms, whatever the scene's units are",
        default=1.0,
        min=0.0,
        step=10,
        precision=6,
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of the sheet",
        default=0.001,
        min=0.0,
        precision=6,
        unit="LENGTH",
    )
    overlap: EnumProperty(
        name="Overlaps",
        description=(
            "What is measured where shells of this object overlap or lie inside one another"
        ),
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


class BodyMomentsSceneSettings(PropertyGroup):
    """How the scene's numbers are shown."""

    frame: EnumProperty(
        name="Frame",
        description=(
            "The axes and origin that the center of mass, the axes and the tensor are shown in"
        ),
        items=(
            ("WORLD", "World", "The scene's axes and origin"),
            ("OBJECT", "Object", "The object's own location and rotation, with unit scale"),
        ),
        default="WORLD",
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
    """Make those options (`measure.MeasureOptions`, SI) the object's settings that are not None."""
    for name in ("kind", "overlap"):
        if getattr(options, name) is not None:
            setattr(settings, name, getattr(options, name).upper())
    if options.density is not None:
        settings.mass_from = "DENSITY"
        setattr(settings, "linear_density" if settings.kind == "WIRE" else "density", options.density)
    if options.mass is not None:
        settings.mass_from, settings.mass = "MASS", options.mass
    if options.thickness is not None:
        settings.thickness = options.thickness / decimal(scene.unit_settings.scale_length)


CLASSES = (BodyMomentsObjectSettings, BodyMomentsSceneSettings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Object.body_moments = PointerProperty(name="Body Moments", type=BodyMomentsObjectSettings)
    Scene.body_moments = PointerProperty(name="Body Moments", type=BodyMomentsSceneSettings)


def unregister() -> None:
    del Scene.body_moments
    del Object.body_moments
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
