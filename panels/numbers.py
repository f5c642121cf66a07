# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers: mass, volume, center, inertia, axes, bounds."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object, UILayout

from ..core.verdict.finding import finding
from ..operators.session import live
from ..operators.write import properties
from ..operators.write.units import SI_UNITS, Units
from . import rows

AXIS_LABELS = ("X", "Y", "Z")


PRINCIPAL_LABELS = ("1", "2", "3")


EQUAL_MOMENTS_RTOL = 1e-6  # moments closer than this, relatively, are shown as equal


EQUAL_MOMENTS = {  # by whether 1 and 2, and 2 and 3, are equal
    (True, True): "panel_equal_moments_all",
    (True, False): "panel_equal_moments_12",
    (False, True): "panel_equal_moments_23",
}


BOUNDS = (("Rounding, at Most", None), ("Float32 Coordinates, at Most", "input"))


ESTIMATED = "Quadrature and Rounding, Estimated"


BOUND_LABELS = {
    "volume": ("Volume", "volume"),
    "area": ("Area", "area"),
    "center_of_mass": ("Center", "length"),
    "inertia": ("Inertia", "inertia"),
}


def numbers(layout: UILayout, context: Context, units: Units, shown: properties.StoredProperties) -> None:
    scene = context.scene
    column = layout.column(align=True)
    rows.value(column, units, "Mass", "mass", shown.body.mass)
    length = properties.optional(context.object, "body_length")
    if length is None:
        rows.value(column, units, "Density", "density", shown.density)
        source = properties.density_from(context.object)
        if source:
            rows.message(column, context, finding("panel_density_mean", cause=source), icon="BLANK1")
        rows.value(column, units, "Volume", "volume", shown.volume)
        if shown.area:  # a grid of densities has no surface
            rows.value(column, units, "Area", "area", shown.area)
    else:
        rows.value(column, units, "Length", "length", length)
    layout.row().prop(scene.body_moments, "frame", expand=True)
    column = layout.column(align=True)
    rows.heading(column, "Center of Mass", "length", shown.body.center)
    rows.values(column, units, AXIS_LABELS, "length", shown.body.center, shown.body.radii_of_gyration.max())
    column = layout.column(align=True)
    moments = shown.body.principal.moments
    rows.heading(column, "Principal Moments", "inertia", moments)
    rows.values(column, units, PRINCIPAL_LABELS, "inertia", moments)
    column = layout.column(align=True)
    rows.heading(column, "Principal Axes", "", shown.body.principal.axes.T)
    for label, axis in zip(PRINCIPAL_LABELS, shown.body.principal.axes.T):
        rows.direction(column, label, axis)
    code = EQUAL_MOMENTS.get(tuple((np.diff(moments) <= EQUAL_MOMENTS_RTOL * moments[2]).tolist()))
    if code:
        rows.message(column, context, finding(code))


def more(layout: UILayout, obj: Object, units: Units, shown: properties.StoredProperties) -> None:
    header, body = layout.panel("body_moments_gyration", default_closed=True)
    header.label(text="Radii of Gyration")
    if body is not None:
        rows.values(body.column(align=True), units, PRINCIPAL_LABELS, "length", shown.body.radii_of_gyration)
    header, body = layout.panel("body_moments_tensor", default_closed=True)
    header.label(text="Inertia Tensor")
    if body is not None:
        column = body.column(align=True)
        column.label(text="About the center of mass, Ixy = −∫xy dm")
        entries = properties.tensor_entries(shown.body.inertia)
        rows.values(column, units, ["I" + name for name in properties.ENTRIES], "inertia", entries)
    if live.current_numbers(obj) is not None:
        return
    display = properties.optional(obj, "body_display_volume")
    if display is not None:
        header, body = layout.panel("body_moments_display_mesh", default_closed=True)
        header.label(text="Display Mesh")
        if body is not None:
            column = body.column(align=True)
            rows.value(column, units, "Volume", "volume", display)
            rows.value(column, units, "Difference", "volume", display - shown.volume)
            rows.filled(column, "{:+.3g}% of the volume", 100.0 * (display / shown.volume - 1.0))
    header, body = layout.panel("body_moments_bounds", default_closed=True)
    header.label(text="Error Bounds")
    if body is not None:
        _bounds(body, obj, units, shown)


def _bounds(layout: UILayout, obj: Object, units: Units, shown: properties.StoredProperties) -> None:
    sizes = {
        "volume": shown.volume,
        "area": shown.area,
        "center_of_mass": np.abs(shown.body.center).max(),
        "inertia": shown.body.principal.moments.max(),
    }
    for heading, bound in BOUNDS:
        column = layout.column(align=True)
        column.label(text=ESTIMATED if bound is None and properties.is_estimated(obj) else heading)
        values = shown.error_bound if bound is None else shown.error_bound[bound]
        for name, (label, quantity) in BOUND_LABELS.items():
            if name in ("volume", "area") and not sizes[name]:
                continue  # a wire has neither, a grid of densities no surface
            rows.texts(
                column, label, units.bound(quantity, values[name], sizes[name]), repr(values[name]), SI_UNITS[quantity]
            )
