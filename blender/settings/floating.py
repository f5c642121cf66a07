# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of floating: the scene's liquid, and the part of an object in a floating body."""

from bpy.props import FloatProperty
from bpy.types import Object, PropertyGroup, Scene

from ...core.density import BY_NAME
from . import given, hooks

LIQUIDS = {
    "SEA_WATER": "Sea Water",
    "WATER": "Water",
    "OIL": "Oil, Hydraulic",
}


class BodyMomentsLiquidSettings(PropertyGroup):
    """The liquid of a scene."""

    liquid: given.choice_property(
        "Liquid",
        "Liquid in which objects float",
        ("SEA_WATER", "Sea Water", "Sea water, 1023.343 kg/m³"),
        ("WATER", "Water", "Fresh water, 998.207 kg/m³"),
        ("OIL", "Oil", "Hydraulic oil, 871 kg/m³"),
        ("OTHER", "Other", "Liquid of a given density"),
    )
    density: FloatProperty(
        name="Density",
        description="Density of the liquid, in kg/m³",
        default=1000.0,
        min=0.0,
        soft_max=15000.0,
        precision=3,
    )
    level: FloatProperty(
        name="Level",
        description="Height of the liquid's surface, against gravity from the world origin",
        unit="LENGTH",
    )


class BodyMomentsTankSettings(PropertyGroup):
    """The part of an object in a floating body."""

    role: given.choice_property(
        "Part",
        "Part of the object when it floats",
        ("BODY", "Body", "Its mass counts, and it displaces the liquid"),
        (
            "TANK",
            "Tank",
            "It is a tank with liquid of the object's density, which moves as the body heels. The "
            "tank itself has no mass",
        ),
        ("FLOODED", "Flooded", "It is a space that the liquid around the body fills, too"),
        update=hooks.part_changed,
    )
    fill: FloatProperty(
        name="Fill Level",
        description="Filled share of the tank's volume",
        default=50.0,
        min=0.0,
        max=100.0,
        subtype="PERCENTAGE",
        update=hooks.part_changed,
    )


def liquid_density(scene: Scene) -> float:
    """Return the density of a scene's liquid, kg/m³."""
    settings = scene.body_moments_liquid
    if settings.liquid == "OTHER":
        return settings.density
    return BY_NAME[LIQUIDS[settings.liquid]].density


POINTERS = {
    (Scene, "body_moments_liquid"): BodyMomentsLiquidSettings,
    (Object, "body_moments_tank"): BodyMomentsTankSettings,
}
