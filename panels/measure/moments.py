# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the moments to a chosen order: results of a button, as a table whose cells can be copied."""

from __future__ import annotations

from bpy.types import Context

from ...blender.session import stored
from ...blender.session.tracking.staleness import stale_reason
from ...core.lazy import loaded_module
from .. import rows
from ..places import in_both_places
from ..settings import setting


class MomentsPanel:
    """Moments to a chosen order"""

    bl_label = "Moments"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout, obj, settings = self.layout, context.object, context.scene.body_moments
        layout.use_property_decorate = False
        column = layout.column()
        setting(column, settings, "moments_order")
        setting(column, settings, "moments_of")
        setting(column, settings, "moments_about")
        setting(column, settings, "frame", expand=True)
        rows.button(layout, context, "object.body_moments_compute_moments", "PHYSICS", short="Compute")
        table = loaded_module(stored, "moments")
        computed = None if table is None else table.computed_moments(obj)
        if computed is None:
            return
        rows.stale_row(layout, context, stale_reason(obj, context.scene, table.stamp_of))
        degrees, missing = table.current_numbers(obj, context.scene)
        if missing is not None:
            rows.message(layout, context, missing)
        for degree in degrees:
            column = layout.column(align=True)
            rows.filled(column, "Order {:d} ({:s})" if degree.unit else "Order {:d}", degree.degree, degree.unit)
            rows.table(column, [(*row, degree.unit) for row in degree.rows])
        if computed.order > table.MAX_SHOWN_ORDER:
            text, first = "Orders {first} to {last} are only in the copy.", table.MAX_SHOWN_ORDER + 1
            rows.remark(layout, context, text, first=first, last=computed.order)
        rows.button(layout, context, "object.body_moments_copy_moments", "COPYDOWN", short="Copy as CSV")


CLASSES = VIEW3D_PT_body_moments_orders, OBJECT_PT_body_moments_orders = in_both_places(
    MomentsPanel, "orders", parent="advanced"
)
