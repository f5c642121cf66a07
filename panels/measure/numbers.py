# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers that answer first: mass, volume, center."""

from __future__ import annotations

from bpy.types import Context, UILayout

from ...blender.session.displayed import Displayed
from ...blender.write import properties
from ...blender.write.units import Units
from .. import rows

AXIS_LABELS = ("X", "Y", "Z")
PRINCIPAL_LABELS = ("1", "2", "3")
CENTER_HEADINGS = {"WORLD": "Center of Mass (World)", "OBJECT": "Center of Mass (Object)"}  # by the frame
RESTING_HEADINGS = {"WORLD": "Center of Mass at Rest (World)", "OBJECT": "Center of Mass at Rest (Object)"}  # for rigs


def numbers(layout: UILayout, context: Context, units: Units, displayed: Displayed) -> None:
    """Draw mass, volume, area, density and center of the measurement."""
    column = layout.column(align=True)
    frame = context.scene.body_moments.frame
    shown = displayed.in_frame(frame)
    entries = [("Mass", "mass", shown.mass)]
    length = properties.optional(context.object, "body_length")
    if length is None:
        entries.append(("Volume", "volume", shown.volume))
        if shown.area:  # a grid of densities has no surface
            entries.append(("Area", "area", shown.area))
        entries.append(("Density", "density", shown.density))
    else:
        entries.append(("Length", "length", length))
    rows.quantities(column, units, entries)
    source = properties.density_from(context.object)
    if source:
        rows.remark(column, context, "Mean density, from {cause}", icon="BLANK1", cause=source)
    column = layout.column(align=True)
    is_rig = context.object.type == "ARMATURE" and not displayed.is_posed
    headings = RESTING_HEADINGS if is_rig else CENTER_HEADINGS
    rows.heading(column, headings[frame], "length", shown.center)
    rows.values(column, units, AXIS_LABELS, "length", shown.center, max(shown.gyration))
