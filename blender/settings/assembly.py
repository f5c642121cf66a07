# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the masses of assemblies and of pose bones, and of the weight of characters.

An assembly is a collection, or an empty with its children; the rows of its tree are kept beside its
settings.
"""

from bpy.props import BoolProperty, CollectionProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Collection, Context, Object, PoseBone, PropertyGroup

from .chosen import chosen_objects
from .given import (
    GivenPartProperties,
    choice_property,
    density_property,
    mass_property,
    shows_collection,
)
from .hooks import part_changed

Root = Object | Collection


class BodyMomentsAssemblyRow(PropertyGroup):
    """One member in the tree of an assembly, as it was measured.

    `name`: of the object or collection.
    """

    depth: IntProperty(name="Depth", description="How many assemblies the member is in")
    member: choice_property(
        "Member",
        "What the member is",
        ("COLLECTION", "Collection", "All members of a collection"),
        (
            "INSTANCE",
            "Instance",
            "An instance of a collection whose members have densities of their own",
        ),
        ("EMPTY", "Empty", "All children of an empty"),
        ("OBJECT", "Object", "An object"),
        ("POINT", "Point Mass", "An empty with a given mass"),
    )
    is_counted: BoolProperty(name="Counted", description="Whether the member is part of the total")
    is_open: BoolProperty(name="Open", description="Show the members of this one", default=True)
    mass: FloatProperty(name="Mass", description="Mass in kg", precision=6)
    share: FloatProperty(name="Share", description="Mass by the mass of the assembly")
    findings: StringProperty(
        name="Findings", description="Why it is not counted, and what was noticed, as JSON"
    )


class BodyMomentsAssemblySettings(GivenPartProperties, PropertyGroup):
    """Settings of an assembly's mass, and its last measurement."""

    mass_from: choice_property(
        "Specify",
        "Whether the mass is the sum of the members or given, as of a bought part",
        ("MEMBERS", "Members", "Add up the members"),
        (
            "MASS",
            "Mass",
            "Enter the mass of the whole; the members give its center and inertia unless entered",
        ),
        update=part_changed,
    )
    mass: mass_property(
        "Mass of the whole in kilograms, independent of the scene units", part_changed
    )
    rows: CollectionProperty(name="Members", type=BodyMomentsAssemblyRow)
    active_row: IntProperty(
        name="Active Member", description="Member that is highlighted in the tree"
    )


def is_assembly(data: Root) -> bool:
    """Return whether `data` is a collection, or an empty that is measured with its children."""
    return (
        isinstance(data, Collection)
        or data.type == "EMPTY"
        and not shows_collection(data)
        and bool(data.children)
    )


def active_assembly(context: Context) -> Root:
    """Return the active empty if it has children, else a collection of the active object, else the
    active one. An unselected active object gives way to a selected one.
    """
    chosen = chosen_objects(context)
    active = context.collection
    obj = context.object if context.object in chosen or not chosen else chosen[0]
    if obj is None or is_assembly(obj):
        return active if obj is None else obj
    collections = obj.users_collection
    return active if active in collections or not collections else collections[0]


def settings_of(data: Root) -> PropertyGroup:
    """Return the settings of an assembly."""
    return data.body_moments if isinstance(data, Collection) else data.body_moments_assembly


class BodyMomentsBoneSettings(PropertyGroup):
    """Settings of the material of a bone's part."""

    mass_from: choice_property(
        "Specify",
        "Where the mass of the bone's part comes from",
        ("MESH", "Mesh", "The density of each mesh that the part is of"),
        (
            "DENSITY",
            "Density",
            "A density for what is skinned to the bone; objects parented to it keep theirs",
        ),
        ("MASS", "Mass", "The mass of the bone's whole part"),
        update=part_changed,
    )
    density: density_property(
        "Density in kg/m³ of what is skinned to the bone, independent of the scene units",
        part_changed,
    )
    mass: mass_property(
        "Mass of the bone's part in kilograms, independent of the scene units", part_changed
    )
    is_contact: BoolProperty(
        name="Contact",
        description="Only such bones touch the ground. If no bone of the armature is one, every "
        "bone may",
        override={"LIBRARY_OVERRIDABLE"},
        update=part_changed,
    )


class BodyMomentsWeightSettings(PropertyGroup):
    """Settings of an armature's weight: what the viewport shows, its total mass and its ground."""

    show: BoolProperty(
        name="Weight",
        description="Draw center of mass, plumb line and support polygon of the character as it is "
        "posed",
        override={"LIBRARY_OVERRIDABLE"},
        update=part_changed,
    )
    mass: FloatProperty(
        name="Total Mass",
        description="Mass of all bones in kilograms; those with a mass of their own keep it. At 0, "
        "the measured mass",
        min=0.0,
        step=10,
        precision=3,
        override={"LIBRARY_OVERRIDABLE"},
        update=part_changed,
    )
    shown_mass: FloatProperty(
        name="Total Mass",
        description=(
            "Mass of all bones in kilograms; those with a mass of their own keep it. At 0, the "
            "measured mass, which is shown in gray"
        ),
        min=0.0,
        step=10,
        precision=3,
        get=lambda settings: settings.mass or settings.id_data.get("body_mass", 0.0),
        set=lambda settings, mass: setattr(settings, "mass", mass),
    )
    show_axes: BoolProperty(
        name="Principal Axes",
        description="Draw the principal axes of the character, too",
        override={"LIBRARY_OVERRIDABLE"},
        update=part_changed,
    )
    ground: FloatProperty(
        name="Ground",
        description="Height of the ground, against gravity from the world origin. Show Weight "
        "finds it",
        unit="LENGTH",
        override={"LIBRARY_OVERRIDABLE"},
        update=part_changed,
    )


POINTERS = {
    (Collection, "body_moments"): BodyMomentsAssemblySettings,
    (Object, "body_moments_assembly"): BodyMomentsAssemblySettings,
    (Object, "body_moments_weight"): BodyMomentsWeightSettings,
    (PoseBone, "body_moments"): BodyMomentsBoneSettings,
}
