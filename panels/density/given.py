# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of known mass: the sub-panel of their center and inertia, and of point masses."""

from __future__ import annotations

from bpy.types import Context, PropertyGroup, UILayout

from ...blender.settings.given import shows_collection
from ..places import in_both_places
from ..settings import setting


class GivenPanel:
    """A mass that is known, with or without its center and inertia"""

    bl_label = "Given Mass"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = context.object
        return obj is not None and (_may_be_point(obj) or obj.body_moments.mass_from == "MASS")

    def draw(self, context: Context) -> None:
        layout, obj = self.layout, context.object
        layout.use_property_decorate = False
        settings = obj.body_moments
        if _may_be_point(obj):
            row = layout.row(align=True)
            row.prop_enum(settings, "mass_from", "DENSITY", text="No Mass")
            row.prop_enum(settings, "mass_from", "MASS", text="Point Mass")
            if settings.mass_from != "MASS":
                return
        column = layout.column()
        setting(column, settings, "mass", text="Mass (kg)")
        given_rows(layout, settings)


def _may_be_point(obj) -> bool:
    return obj.type == "EMPTY" and not shows_collection(obj)


def given_rows(layout: UILayout, settings: PropertyGroup) -> None:
    """Draw the optional properties of a given mass."""
    column = layout.column()
    setting(column, settings, "use_center")
    if settings.use_center:
        setting(column, settings, "given_center", text="Center")
    setting(column, settings, "use_inertia")
    if settings.use_inertia:
        setting(column, settings, "given_inertia_diagonal", text="Ixx, Iyy, Izz")
        setting(column, settings, "given_inertia_products", text="Ixy, Ixz, Iyz")


CLASSES = VIEW3D_PT_body_moments_given, OBJECT_PT_body_moments_given = in_both_places(GivenPanel, "given")
