# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a scene, declared as property groups: display, initial settings, overlay, and
reference.

Inertia and moments are shown about the reference.
"""

from bpy.props import BoolProperty, FloatVectorProperty, IntProperty, PointerProperty
from bpy.types import Object, PropertyGroup, Scene

from ...core.measurement import MAX_ORDER
from . import given, preferences, properties


class BodyMomentsOverlaySettings(PropertyGroup):
    """Settings of the overlay of measured objects."""

    show: BoolProperty(
        name="Mass Properties",
        description="Draw the center of mass and the principal axes of measured objects in the 3D "
        "Viewport",
        default=True,
    )
    show_all: BoolProperty(
        name="All Measured Objects",
        description="Draw all visible measured objects instead of the selected ones. From 20 "
        "objects on, only the "
        "sum, doubtful ones and the active one are drawn",
    )
    show_axes: BoolProperty(
        name="Principal Axes",
        description="Draw the principal axes 1, 2 and 3 in the colors of X, Y and Z",
        default=True,
    )
    show_drop_line: BoolProperty(
        name="Drop Line",
        description="Draw a line from the center of mass straight down or up to the floor, Z = 0",
        default=True,
    )
    equivalent: given.choice_property(
        "Equal Inertia",
        "Draw the body of uniform density that has the same mass and the same principal moments",
        ("NONE", "None", "Draw no equivalent body"),
        ("BOX", "Box", "Draw the box with the same inertia"),
        ("ELLIPSOID", "Ellipsoid", "Draw the ellipsoid with the same inertia"),
    )
    show_sum: BoolProperty(
        name="Sum of Selection",
        description="Draw the center of mass and the principal axes of the selected objects as one "
        "body",
    )
    show_faults: BoolProperty(
        name="Faults",
        description="Draw boundary edges and flipped faces that were found when the object was "
        "measured",
    )
    show_support: BoolProperty(
        name="Support Polygon",
        description="Draw the support polygon and the direction of tipping of objects whose "
        "stability was computed",
        default=True,
    )
    show_level: BoolProperty(
        name="Levels",
        description="Draw the surfaces of liquids in vessels whose level was computed",
        default=True,
    )
    show_waterline: BoolProperty(
        name="Waterline",
        description="Draw the waterline of floating objects, and their centers of buoyancy (B) and "
        "gravity (G) and metacenter (M)",
        default=True,
    )
    show_path: BoolProperty(
        name="Path of Centers",
        description="Draw the path of the center of mass that was computed over the frame range",
        default=True,
    )


class BodyMomentsReferenceSettings(PropertyGroup):
    """Settings of the reference of inertia and moments."""

    about: given.choice_property(
        "About",
        "Point and axes that inertia and moments are referred to",
        ("CENTER", "Center of Mass", "The center of mass, along the world axes"),
        ("ORIGIN", "Object Origin", "Origin and axes of the measured object"),
        ("WORLD", "World Origin", "World origin and axes"),
        ("CURSOR", "3D Cursor", "Location and axes of the 3D cursor"),
        ("OBJECT", "Other Object", "Origin and axes of another object"),
        ("AXIS", "Axis", "The axis from one point to another"),
        translation_context=properties.TRANSLATION_CONTEXT,
        default="WORLD",
    )
    object: PointerProperty(
        name="Object", description="Object whose origin and axes are the reference", type=Object
    )
    first: FloatVectorProperty(
        name="From",
        description="First point of the axis, in the world",
        subtype="XYZ",
        unit="LENGTH",
        precision=6,
    )
    second: FloatVectorProperty(
        name="To",
        description="Second point of the axis, in the world",
        subtype="XYZ",
        unit="LENGTH",
        precision=6,
        default=(0.0, 0.0, 1.0),
    )


class BodyMomentsSceneSettings(preferences.SceneDefaults, PropertyGroup):
    """The scene's settings: the display of numbers, and the initial settings of objects."""

    overlay: PointerProperty(name="Overlay", type=BodyMomentsOverlaySettings)
    has_defaults: BoolProperty(
        name="Has Defaults",
        description="The add-on's preferences were copied into this scene",
        options={"HIDDEN"},
    )
    units_answered: BoolProperty(
        name="Keep Units",
        description="Keep the units of the scene, and do not ask again",
        options={"HIDDEN"},
    )
    moments_order: IntProperty(
        name="Order",
        translation_context=properties.TRANSLATION_CONTEXT,
        description="Highest p + q + r of the computed moments ∫ x^p y^q z^r",
        default=4,
        min=1,
        max=MAX_ORDER,
        soft_max=20,
    )
    moments_of: given.choice_property(
        "Domain",
        "What the moments integrate over",
        ("VOLUME", "Volume", "Volume. For shells, area times thickness"),
        ("SURFACE", "Surface", "Area of the faces"),
        (
            "MASS",
            "Mass",
            "Volume, or for shells the area, times the density wherever it comes from",
        ),
        ("FLAT", "Area", "Area of a flat shape in its own plane, ∫ x^p y^q dA"),
    )
    moments_about: given.choice_property(
        "About",
        "Point that the coordinates are relative to",
        ("ORIGIN", "Frame Origin", "Origin of the chosen frame"),
        ("CENTER", "Center", "Center of the volume or surface: central moments"),
        (
            "NORMALIZED",
            "Center, Normalized",
            "Central moments of the shape scaled to a volume or area of 1, independent of size",
        ),
        (
            "INVARIANT",
            "Invariants",
            "Numbers of a flat shape that do not depend on its place, rotation and size: Hu's, "
            "then Flusser's",
        ),
        ("REFERENCE", "Reference", "Point and axes that Inertia about Reference refers to"),
        translation_context=properties.TRANSLATION_CONTEXT,
    )


CLASSES = (preferences.BodyMomentsPreferences,)
POINTERS = {
    (Scene, "body_moments"): BodyMomentsSceneSettings,
    (Scene, "body_moments_reference"): BodyMomentsReferenceSettings,
}
