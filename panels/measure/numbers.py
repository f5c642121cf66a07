# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers that answer first: mass, volume, center."""

from __future__ import annotations

from bpy.types import Context, UILayout

from ...blender.session.stored import results
from ...blender.session.tracking import posed
from ...blender.write import properties
from ...blender.write.units import Units
from .. import rows

AXIS_LABELS = ("X", "Y", "Z")
PRINCIPAL_LABELS = ("1", "2", "3")
CENTER_HEADINGS = {"WORLD": "Center of Mass (World)", "OBJECT": "Center of Mass (Object)"}  # by the frame
RESTING_HEADINGS = {"WORLD": "Center of Mass at Rest (World)", "OBJECT": "Center of Mass at Rest (Object)"}  # for rigs


def numbers(layout: UILayout, context: Context, units: Units, shown: properties.StoredProperties) -> None:
    """Draw mass, volume, area, density and center of the measurement."""
    column = layout.column(align=True)
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
    obj = context.object
    is_posed = posed.stands_for_meshes(obj) and results.are_meshes_measured(obj, context.scene)
    is_rig = obj.type == "ARMATURE" and not is_posed
    headings = RESTING_HEADINGS if is_rig else CENTER_HEADINGS
    rows.heading(column, headings[context.scene.body_moments.frame], "length", shown.center)
    rows.values(column, units, AXIS_LABELS, "length", shown.center, max(shown.gyration))
