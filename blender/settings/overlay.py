# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the overlay in the 3D Viewport: a group of the scene's settings."""

from bpy.props import BoolProperty, EnumProperty
from bpy.types import PropertyGroup


class BodyMomentsOverlaySettings(PropertyGroup):
    """Settings of the overlay of measured objects."""

    show: BoolProperty(
        name="Mass Properties",
        description="Draw the center of mass and the principal axes of measured objects in the 3D Viewport",
        default=True,
    )
    show_all: BoolProperty(
        name="All Measured Objects",
        description="Draw all visible measured objects instead of the selected ones",
        default=False,
    )
    show_axes: BoolProperty(
        name="Principal Axes",
        description="Draw the principal axes 1, 2 and 3, each as long as its radius of gyration in both directions",
        default=True,
    )
    show_drop_line: BoolProperty(
        name="Drop Line",
        description="Draw a line from the center of mass straight down or up to the floor, Z = 0",
        default=True,
    )
    equivalent: EnumProperty(
        name="Equal Inertia",
        description="Draw the body of uniform density that has the same mass and the same principal moments",
        items=(
            ("NONE", "None", "Draw no equivalent body"),
            ("BOX", "Box", "Draw the box with the same inertia"),
            ("ELLIPSOID", "Ellipsoid", "Draw the ellipsoid with the same inertia"),
        ),
        default="NONE",
    )
    show_sum: BoolProperty(
        name="Sum of Selection",
        description="Draw the center of mass and the principal axes of the selected objects as one body",
        default=False,
    )
    show_faults: BoolProperty(
        name="Faults",
        description="Draw boundary edges and flipped faces that were found when the object was measured",
        default=False,
    )
    show_support: BoolProperty(
        name="Support Polygon",
        description="Draw the support polygon and the direction of tipping of objects whose stability was computed",
        default=True,
    )
    show_path: BoolProperty(
        name="Path of Balance Groups",
        description="Draw the path of the center of mass that was computed over the frame range",
        default=True,
    )
