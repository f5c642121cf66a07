# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a printed body: walls, layers, infill, a pocket of ballast, and the filament."""

from collections.abc import Mapping
from typing import Any

from bpy.props import FloatProperty, FloatVectorProperty, IntProperty
from bpy.types import PropertyGroup

from ...core.measurement import Pocket, PrintSettings
from ...core.numerics import shortest_decimal
from .given import choice_property
from .hooks import changed

# Fields of `PrintSettings`: their properties, and one of these in SI units.
PRINT_OPTIONS = {
    "walls": ("print_walls", 1),
    "line_width": ("print_line_width", 1e-3),
    "top": ("print_top_layers", 1),
    "bottom": ("print_bottom_layers", 1),
    "layer_height": ("print_layer_height", 1e-3),
    "infill": ("print_infill", 1),
    "price": ("spool_price", 1),
    "spool": ("spool_mass", 1),
}
PRINT_FIELDS = "print_walls", "print_top_layers", "print_bottom_layers", "print_infill"
# By key: name, description and values of PRINT_FIELDS.
PRESETS = {
    "WALLS_2": ("2 Walls", "2 walls of 0.42 mm, 4 layers of 0.2 mm, 15 % infill", (2, 4, 4, 15)),
    "WALLS_3": ("3 Walls", "3 walls of 0.42 mm, 5 layers of 0.2 mm, 20 % infill", (3, 5, 5, 20)),
    "WALLS_4": ("4 Walls", "4 walls of 0.42 mm, 6 layers of 0.2 mm, 40 % infill", (4, 6, 6, 40)),
    "VASE": ("Vase", "1 wall of 0.42 mm, 4 bottom layers of 0.2 mm, nothing else", (1, 0, 4, 0)),
}


def _set_preset(settings: PropertyGroup) -> None:
    values = dict(zip(PRINT_FIELDS, PRESETS[settings.print_preset][2]))
    for name, value in (values | {"print_line_width": 0.42, "print_layer_height": 0.2}).items():
        setattr(settings, name, value)


def _count(name: str, description: str, default: int) -> Any:
    return IntProperty(
        name=name, description=description, default=default, min=0, soft_max=20, update=changed
    )


def _millimeters(name: str, description: str, default: float) -> Any:
    return FloatProperty(
        name=name,
        description=description,
        default=default,
        min=0.001,
        soft_max=2.0,
        step=1,
        precision=3,
        update=changed,
    )


class PrintProperties:
    """Settings of a printed body."""

    print_preset: choice_property(
        "Preset",
        "Settings of a common print with a nozzle of 0.4 mm, which replace those below",
        *((key, name, text) for key, (name, text, _) in PRESETS.items()),
        update=lambda settings, _context: _set_preset(settings),
        options={"SKIP_SAVE"},
    )
    print_walls: _count("Walls", "Number of walls (perimeters)", 2)
    print_line_width: _millimeters("Line Width", "Width of one wall in mm", 0.42)
    print_top_layers: _count("Top Layers", "Number of full layers below faces that face up", 4)
    print_bottom_layers: _count(
        "Bottom Layers", "Number of full layers above faces that face down", 4
    )
    print_layer_height: _millimeters("Layer Height", "Height of one layer in mm", 0.2)
    print_infill: FloatProperty(
        name="Infill",
        description="Share of the core that is filled",
        default=15.0,
        min=0.0,
        max=100.0,
        subtype="PERCENTAGE",
        update=changed,
    )
    pocket_center: FloatVectorProperty(
        name="Center",
        description="Center of the pocket of ballast, in the object's coordinates",
        subtype="XYZ",
        precision=4,
        update=changed,
    )
    pocket_radius: FloatProperty(
        name="Pocket",
        description="Radius of the pocket of ballast in mm; 0 for none",
        min=0.0,
        precision=3,
        update=changed,
    )
    pocket_density: FloatProperty(
        name="Ballast",
        description="Density of what fills the pocket, in kg/m³",
        default=7820.0,
        min=0.0,
        soft_max=25000.0,
        update=changed,
    )
    spool_price: FloatProperty(
        name="Price of a Spool",
        description="Price of a spool of filament, in any currency. At 0, no price is shown",
        min=0.0,
        precision=2,
        update=changed,
    )
    spool_mass: FloatProperty(
        name="Spool",
        description="Filament on a spool, in kg",
        default=1.0,
        min=0.001,
        precision=3,
        update=changed,
    )


def print_settings(properties: PropertyGroup) -> PrintSettings:
    """Return the print settings in the settings of an object."""
    radius, density = properties.pocket_radius, properties.pocket_density
    center = tuple(map(shortest_decimal, properties.pocket_center))
    pocket = Pocket(center, shortest_decimal(radius) * 1e-3, shortest_decimal(density))
    values = {}
    for field, (name, scale) in PRINT_OPTIONS.items():
        value = getattr(properties, name)
        values[field] = shortest_decimal(value) * scale if isinstance(value, float) else value
    return PrintSettings(**values, pocket=pocket if radius else None)


def set_print(properties: PropertyGroup, values: Mapping[str, float]) -> None:
    """Set fields of `PrintSettings` in the settings of an object."""
    for field, value in values.items():
        name, scale = PRINT_OPTIONS[field]
        is_count = isinstance(getattr(properties, name), int)
        setattr(properties, name, round(value) if is_count else value / scale)
