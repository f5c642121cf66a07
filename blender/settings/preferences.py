# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: initial settings of a scene, copied into it when it is first used
(`copy_defaults`).

So a file gives the same numbers on every machine, and in batch, which never reads preferences.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty
from bpy.types import AddonPreferences, Context, Scene, UILayout

from ...core import density, numerics
from . import given, hooks

ADDON_ID = __name__.removesuffix(".blender.settings.preferences")
MATERIAL_ITEMS = [
    (
        material.name,
        material.name,
        "{:.7g} kg/m³. Source: {:s}".format(material.density, material.source),
    )
    for material in density.MATERIALS
]
# To the website that the manifest names, else to the manual that the build puts beside the code.
LINKS = {"Manual": ("index.html", "HELP"), "Report a Bug": ("faq.html#report-a-bug", "URL")}
COPIED = (
    "frame",
    "density_unit",
    "digits",
    "digit_grouping",
    "default_material",
    "default_density",
)


class SceneDefaults:
    """Properties common to the preferences and the settings of a scene."""

    frame: given.choice_property(
        "Frame",
        "Axes and origin in which the center of mass, the axes and the tensor are shown",
        ("WORLD", "World", "World axes and origin"),
        ("OBJECT", "Object", "Location and rotation of the object, with unit scale"),
    )
    density_unit: given.choice_property(
        "Density Unit",
        "Unit in which densities are shown and entered",
        ("AUTO", "By Unit System", "kg/m³, in scenes with imperial units lb/ft³"),
        ("KG_M3", "kg/m³", "Kilograms per cubic meter"),
        ("G_CM3", "g/cm³", "Grams per cubic centimeter"),
        ("LB_IN3", "lb/in³", "Pounds per cubic inch"),
    )
    digits: IntProperty(
        name="Precision",
        description="Significant digits of the largest number of a column. Copied values always "
        "have all digits",
        default=4,
        min=2,
        max=15,
    )
    digit_grouping: given.choice_property(
        "Digit Grouping",
        "What separates groups of three digits in numbers of five digits and more",
        ("SPACE", "Space", "20 000"),
        ("COMMA", "Comma", "20,000"),
        ("NONE", "None", "20000"),
    )
    default_material: given.choice_property(
        "Default Material",
        "Material of objects whose density has not been set",
        ("NONE", "None", "1000 kg/m³, with a note"),
        ("CUSTOM", "Custom", "The density below"),
        *MATERIAL_ITEMS,
        update=hooks.default_density_changed,
    )
    default_density: given.density_property(
        "Density in kg/m³ of objects whose density has not been set",
        hooks.default_density_changed,
        name="Default Density",
        min=0.01,
    )


class BodyMomentsPreferences(SceneDefaults, AddonPreferences):
    """Initial settings of new scenes."""

    bl_idname = ADDON_ID

    show_overlay: BoolProperty(
        name="Overlay",
        description="Draw the center of mass and the principal axes of measured objects in the 3D "
        "Viewport",
        default=True,
    )
    live_budget: FloatProperty(
        name="Live Budget",
        description="Milliseconds per redraw that live numbers may take before they lag behind",
        default=10.0,
        min=1.0,
        soft_max=100.0,
        precision=1,
    )
    show_advanced: BoolProperty(
        name="Advanced",
        description="Show the menu and the panel Advanced: moments of any order, Fourier "
        "transforms, sections, "
        "signatures, density polynomials",
    )

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        draw_links(layout.row())
        layout.label(text="Defaults, copied into a scene when it is first used")
        column = layout.column()
        column.prop(self, "default_material")
        if self.default_material == "CUSTOM":
            column.prop(self, "default_density", text="Density (kg/m³)")
        column.prop(self, "frame")
        column = layout.column()
        column.prop(self, "density_unit")
        column.prop(self, "digits")
        column.prop(self, "digit_grouping")
        column = layout.column()
        column.prop(self, "show_overlay")
        layout.separator()
        layout.label(text="For all scenes")
        column = layout.column()
        column.prop(self, "live_budget")
        column.prop(self, "show_advanced")


def preferences() -> BodyMomentsPreferences | None:
    """Return the preferences, None if the package is used without being an enabled add-on."""
    addon = bpy.context.preferences.addons.get(ADDON_ID)
    return None if addon is None else addon.preferences


def shows_advanced() -> bool:
    """Return whether analyses that few need are shown; without an enabled add-on nothing could
    switch them on.
    """
    chosen = preferences()
    return chosen is None or chosen.show_advanced


def copy_defaults(scene: Scene) -> None:
    """Copy the preferences into a scene that has none yet; meant for operators that a user
    starts.
    """
    settings = scene.body_moments
    source = preferences()
    if source is None or settings.has_defaults or not scene.is_editable:
        return
    settings.has_defaults = True
    for name in COPIED:
        if not settings.is_property_set(name):
            setattr(settings, name, getattr(source, name))
    if not settings.overlay.is_property_set("show"):
        settings.overlay.show = source.show_overlay


def default_density(scene: Scene) -> float | None:
    """Return the density in kg/m³ of the scene's objects without their own, None if the scene has
    none.
    """
    settings = scene.body_moments
    if settings.default_material == "CUSTOM":
        return numerics.shortest_decimal(settings.default_density)
    return (
        None
        if settings.default_material == "NONE"
        else density.BY_NAME[settings.default_material].density
    )


def default_material(scene: Scene) -> str:
    """Return the name of the material of the scene's objects that have no density of their own, ""
    if there is none.
    """
    name = scene.body_moments.default_material
    return name if name in density.BY_NAME else ""


def manual_folder() -> Path:
    """Return the folder of the manual, which need not exist."""
    return Path(sys.modules[ADDON_ID].__path__[0]) / "manual"


def address(page: str) -> str:
    """Return the address of a page of the manual, or the website; "" if there is neither."""
    website = getattr(sys.modules[ADDON_ID], "bl_info", {}).get("doc_url", "")  # from the manifest
    return website or (manual_folder().as_uri() + "/" + page if manual_folder().is_dir() else "")


def draw_links(layout: UILayout, icons_only: bool = False) -> None:
    """Draw the buttons that open the links, if there is anything to open."""
    for name, (page, icon) in LINKS.items():
        if url := address(page):
            emboss = {"text": "", "emboss": False} if icons_only else {"text": name}
            layout.operator("wm.url_open", icon=icon, **emboss).url = url
