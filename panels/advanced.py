# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of rarely needed numbers: error bounds, the display mesh, the Fourier transform.

It has sub-panels for the moments to a chosen order, sections and shapes.
"""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from ..blender import session, write
from ..blender.session.displayed import displayed
from ..blender.settings.preferences import shows_advanced
from ..core import inertia
from . import places, rows, texts


class AdvancedPanel:
    """Error bounds and analyses"""

    bl_label = "Advanced"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return shows_advanced() and session.selected.subject(context) is not None

    def draw(self, context: Context) -> None:
        layout = self.layout
        obj = session.selected.subject(context)
        scene = context.scene
        rows.button(layout, "object.body_moments_fourier", "MOD_WAVE", short="Fourier")
        # Live numbers have no error bounds.
        if (displayed_body := displayed(obj, scene)) is not None and displayed_body.live is None:
            numbers = displayed_body.in_frame(scene.body_moments.frame)
            _bounds(layout, obj, numbers)
            _display_mesh(layout, obj, numbers)


def _display_mesh(layout: UILayout, obj: Object, numbers: inertia.PlainBody) -> None:
    display = write.properties.optional(obj, "body_display_volume")
    if display is None:
        return
    if (body := rows.fold(layout, "body_moments_display_mesh", "Display Mesh")) is not None:
        column = body.column(align=True)
        rows.values(column, ("Volume", "Difference"), "volume", (display, display - numbers.volume))
        texts.filled(column, "{:+.3g}% of the volume", 100.0 * (display / numbers.volume - 1.0))


def _bounds(layout: UILayout, obj: Object, numbers: inertia.PlainBody) -> None:
    body = rows.fold(layout, "body_moments_bounds", "Error Bounds")
    if body is None:
        return
    rounding = (
        "Quadrature and Rounding, Estimated"
        if write.properties.is_estimated(obj)
        else "Rounding, at Most"
    )
    sources = (
        (rounding, numbers.error_bound),
        ("Float32 Coordinates, at Most", numbers.error_bound["input"]),
    )
    # label, quantity, name of the bound, and the value beside which the bound is shown
    entries = [
        (label, name, name, size)
        for label, name, size in (
            ("Volume", "volume", numbers.volume),
            ("Area", "area", numbers.area),
        )
        if size  # a wire has neither, a grid of densities no surface
    ]
    entries.append(("Center", "length", "center_of_mass", max(map(abs, numbers.center))))
    entries.append(("Inertia", "inertia", "inertia", max(numbers.moments)))
    rows.error_bounds(body, sources, entries)


class MomentsPanel:
    """Moments to a chosen order"""

    bl_label = "Moments"

    def draw(self, context: Context) -> None:
        layout = self.layout
        obj = session.selected.subject(context)
        settings = context.scene.body_moments
        column = layout.column()
        rows.settings(column, settings, "moments_order", "moments_of", "moments_about")
        rows.settings(column, settings, "frame", expand=True)
        row = layout.row(align=True)
        rows.button(row, "object.body_moments_compute_moments", "PHYSICS", short="Compute")
        row.operator("object.body_moments_copy", text="", icon="COPYDOWN").what = "MOMENTS"
        computed = session.memory.moments.get(obj)
        if computed is None:
            return
        table = session.stored.moments
        kind = session.tracking.stamps.Kind.MOMENTS
        reason = session.tracking.staleness.stale_reason(obj, context.scene, kind)
        texts.stale_state(layout, reason)
        degrees, missing = table.current_numbers(obj, context.scene)
        if missing is not None:
            texts.message(layout, missing)
        for degree in degrees:
            column = layout.column(align=True)
            texts.filled(
                column,
                "Order {:d} ({:s})" if degree.unit else "Order {:d}",
                degree.degree,
                degree.unit,
            )
            rows.table(column, [(*row, degree.unit) for row in degree.rows])
        if computed.order > table.MAX_SHOWN_ORDER:
            texts.remark(
                layout,
                "Orders {first} to {last} are only in the copy.",
                first=table.MAX_SHOWN_ORDER + 1,
                last=computed.order,
            )


CLASSES = (
    *places.in_both_places(AdvancedPanel, "advanced"),
    *places.in_both_places(MomentsPanel, "orders", parent="advanced"),
)
