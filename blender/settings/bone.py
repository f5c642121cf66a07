# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a pose bone: the material of its part of a character."""

import bpy
from bpy.props import EnumProperty, FloatProperty
from bpy.types import PropertyGroup

from .hooks import part_changed


class BodyMomentsBoneSettings(PropertyGroup):
    """Settings of the material of a bone's part."""

    mass_from: EnumProperty(
        name="Specify",
        description="Where the mass of the bone's part comes from",
        items=(
            ("MESH", "Mesh", "The density of each mesh that the part is of"),
            ("DENSITY", "Density", "A density for what is skinned to the bone; objects parented to it keep theirs"),
            ("MASS", "Mass", "The mass of the bone's whole part"),
        ),
        default="MESH",
        update=part_changed,
    )
    density: FloatProperty(
        name="Density",
        description="Density in kg/m³ of what is skinned to the bone, independent of the scene units",
        default=1000.0,
        min=0.0,
        soft_max=25000.0,
        step=1000,
        precision=3,
        update=part_changed,
    )
    mass: FloatProperty(
        name="Mass",
        description="Mass of the bone's part in kilograms, independent of the scene units",
        default=1.0,
        min=0.0,
        step=10,
        precision=6,
        update=part_changed,
    )


def register() -> None:
    bpy.utils.register_class(BodyMomentsBoneSettings)
    bpy.types.PoseBone.body_moments = bpy.props.PointerProperty(name="Body Moments", type=BodyMomentsBoneSettings)


def unregister() -> None:
    del bpy.types.PoseBone.body_moments
    bpy.utils.unregister_class(BodyMomentsBoneSettings)
