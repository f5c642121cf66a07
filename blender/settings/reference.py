# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the reference that inertia and moments are shown about: a group of the scene's."""

import bpy
from bpy.props import EnumProperty, FloatVectorProperty, PointerProperty
from bpy.types import Object, PropertyGroup


class BodyMomentsReferenceSettings(PropertyGroup):
    """Settings of the reference of inertia and moments."""

    about: EnumProperty(
        name="About",
        description="Point and axes that inertia and moments are referred to",
        translation_context="Body Moments",
        items=(
            ("CENTER", "Center of Mass", "The center of mass, along the world axes"),
            ("ORIGIN", "Object Origin", "Origin and axes of the measured object"),
            ("WORLD", "World Origin", "World origin and axes"),
            ("CURSOR", "3D Cursor", "Location and axes of the 3D cursor"),
            ("OBJECT", "Other Object", "Origin and axes of another object"),
            ("AXIS", "Axis", "The axis from one point to another"),
        ),
        default="WORLD",
    )
    object: PointerProperty(name="Object", description="Object whose origin and axes are the reference", type=Object)
    first: FloatVectorProperty(
        name="From", description="First point of the axis, in the world", subtype="XYZ", unit="LENGTH", precision=6
    )
    second: FloatVectorProperty(
        name="To",
        description="Second point of the axis, in the world",
        subtype="XYZ",
        unit="LENGTH",
        precision=6,
        default=(0.0, 0.0, 1.0),
    )


def register() -> None:
    bpy.utils.register_class(BodyMomentsReferenceSettings)
    bpy.types.Scene.body_moments_reference = PointerProperty(
        name="Body Moments Reference", type=BodyMomentsReferenceSettings
    )


def unregister() -> None:
    del bpy.types.Scene.body_moments_reference
    bpy.utils.unregister_class(BodyMomentsReferenceSettings)
