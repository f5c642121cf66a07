# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of rarely needed numbers: error bounds, the display mesh, the Fourier transform.

The moments to a chosen order, sections and shapes are sub-panels of it.
"""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from ...blender.session.displayed import displayed
from ...blender.write import properties
from ...blender.write.units import SI_UNITS, Units
from .. import rows
from ..places import in_both_places

BOUNDS = (("Rounding, at Most", None), ("Float32 Coordinates, at Most", "input"))
ESTIMATED = "Quadrature and Rounding, Estimated"
BOUND_LABELS = {
    "volume": ("Volume", "volume"),
    "area": ("Area", "area"),
    "center_of_mass": ("Center", "length"),
    "inertia": ("Inertia", "inertia"),
}


class AdvancedPanel:
    """Error bounds and analyses"""

    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, obj, scene = self.layout, context.object, context.scene
        layout.use_property_decorate = False
        units = Units.from_settings(scene.unit_settings)
        shown = displayed(obj, scene)
        if shown is not None and shown.live is None:
            numbers = shown.in_frame(scene.body_moments.frame)
            _bounds(layout, obj, units, numbers)
            _display_mesh(layout, obj, units, numbers)
        rows.button(
            layout,
            context,
            "object.body_moments_fourier",
            "MOD_WAVE",
            text="Fourier Transform...",
            short="Fourier...",
        )


def _display_mesh(layout: UILayout, obj: Object, units: Units, shown: properties.StoredProperties) -> None:
    display = properties.optional(obj, "body_display_volume")
    if display is None:
        return
    header, body = layout.panel("body_moments_display_mesh", default_closed=True)
    header.label(text="Display Mesh")
    if body is not None:
        column = body.column(align=True)
        rows.values(column, units, ("Volume", "Difference"), "volume", (display, display - shown.volume))
        rows.filled(column, "{:+.3g}% of the volume", 100.0 * (display / shown.volume - 1.0))


def _bounds(layout: UILayout, obj: Object, units: Units, shown: properties.StoredProperties) -> None:
    header, body = layout.panel("body_moments_bounds", default_closed=True)
    header.label(text="Error Bounds")
    if body is None:
        return
    sizes = {
        "volume": shown.volume,
        "area": shown.area,
        "center_of_mass": max(map(abs, shown.center)),
        "inertia": max(shown.moments),
    }
    for heading, bound in BOUNDS:
        column = body.column(align=True)
        column.label(text=ESTIMATED if bound is None and properties.is_estimated(obj) else heading)
        values = shown.error_bound if bound is None else shown.error_bound[bound]
        rows.table(
            column,
            [
                (label, units.bound(quantity, values[name], sizes[name]), repr(values[name]), SI_UNITS[quantity])
                for name, (label, quantity) in BOUND_LABELS.items()
                if name not in ("volume", "area") or sizes[name]  # a wire has neither, a grid of densities no surface
            ],
        )


CLASSES = VIEW3D_PT_body_moments_advanced, OBJECT_PT_body_moments_advanced = in_both_places(AdvancedPanel, "advanced")
