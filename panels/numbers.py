# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers: mass, volume, center, inertia, axes, bounds."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object, UILayout

from ..operators.session import live
from ..operators.write import properties
from ..operators.write.units import SI_UNITS, Units
from . import rows

AXES = ("X", "Y", "Z")


NUMBERS = ("1", "2", "3")


EQUAL = 1e-6  # moments closer than this, relatively, are shown as equal


BOUNDS = (("Rounding, at Most", None), ("Coordinates Stored as Float32, at Most", "input"))


ESTIMATED = "Quadrature and Rounding, Estimated"


BOUNDED = {
    "volume": ("Volume", "volume"),
    "area": ("Area", "area"),
    "center_of_mass": ("Center", "length"),
    "inertia": ("Inertia", "inertia"),
}


def _numbers(layout: UILayout, context: Context, units: Units, found: properties.Stored) -> None:
    scene, source = context.scene, properties.density_from(context.object)
    column = layout.column(align=True)
    rows.value(column, units, "Mass", "mass", found.body.mass)
    length = properties.optional(context.object, "body_length")
    if length is None:
        rows.value(column, units, "Density", "density", found.density)
        if source:
            rows.sentence(column, context, "The mean, from {:s}".format(source), icon="BLANK1")
        rows.value(column, units, "Volume", "volume", found.volume)
        if found.area:  # a grid of densities has no surface
            rows.value(column, units, "Area", "area", found.area)
    else:
        rows.value(column, units, "Length", "length", length)
    layout.row().prop(scene.body_moments, "frame", expand=True)
    column = layout.column(align=True)
    rows.heading(column, "Center of Mass", "length", found.body.center)
    rows.values(column, units, AXES, "length", found.body.center, found.body.radii_of_gyration.max())
    column = layout.column(align=True)
    rows.heading(column, "Principal Moments", "inertia", found.body.principal.moments)
    rows.values(column, units, NUMBERS, "inertia", found.body.principal.moments)
    column = layout.column(align=True)
    rows.heading(column, "Principal Axes", "", found.body.principal.axes.T)
    for label, axis in zip(NUMBERS, found.body.principal.axes.T):
        rows.direction(column, label, axis)
    free = _free_axes(found.body.principal.moments)
    if free:
        column.label(text=free, icon="INFO")


def _free_axes(moments: np.ndarray) -> str:
    """What equal moments leave to choose."""
    first, second = (np.diff(moments) <= EQUAL * moments[2]).tolist()
    if first and second:
        return "All axes have equal moments"
    return "Axes 1 and 2 have equal moments" if first else "Axes 2 and 3 have equal moments" if second else ""


def _more(layout: UILayout, obj: Object, units: Units, found: properties.Stored) -> None:
    header, body = layout.panel("body_moments_gyration", default_closed=True)
    header.label(text="Radii of Gyration")
    if body is not None:
        rows.values(body.column(align=True), units, NUMBERS, "length", found.body.radii_of_gyration)
    header, body = layout.panel("body_moments_tensor", default_closed=True)
    header.label(text="Inertia Tensor")
    if body is not None:
        column = body.column(align=True)
        column.label(text="At the center of mass, Ixy = −∫xy dm")
        entries = properties.tensor_entries(found.body.inertia)
        rows.values(column, units, ["I" + name for name in properties.ENTRIES], "inertia", entries)
    if live.shown(obj) is not None:
        return
    display = properties.optional(obj, "body_display_volume")
    if display is not None:
        header, body = layout.panel("body_moments_display_mesh", default_closed=True)
        header.label(text="Display Mesh Instead")
        if body is not None:
            column = body.column(align=True)
            rows.value(column, units, "Volume", "volume", display)
            rows.value(column, units, "Difference", "volume", display - found.volume)
            column.label(text="{:+.3g} % of the volume".format(100.0 * (display / found.volume - 1.0)))
    header, body = layout.panel("body_moments_bounds", default_closed=True)
    header.label(text="Error Bounds")
    if body is not None:
        _bounds(body, obj, units, found)


def _bounds(layout: UILayout, obj: Object, units: Units, found: properties.Stored) -> None:
    sizes = {
        "volume": found.volume,
        "area": found.area,
        "center_of_mass": np.abs(found.body.center).max(),
        "inertia": found.body.principal.moments.max(),
    }
    for heading, bound in BOUNDS:
        column = layout.column(align=True)
        column.label(text=ESTIMATED if bound is None and properties.is_estimated(obj) else heading)
        values = found.error_bound if bound is None else found.error_bound[bound]
        for name, (label, quantity) in BOUNDED.items():
            if name in ("volume", "area") and not sizes[name]:
                continue  # a wire has neither, a grid of densities no surface
            rows.texts(
                column, label, units.bound(quantity, values[name], sizes[name]), repr(values[name]), SI_UNITS[quantity]
            )
