# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the selection: its total."""

from __future__ import annotations

from bpy.types import Context, UILayout

from ..core.verdict.finding import finding
from ..operators.session import results
from ..operators.write.messages import truncate_list
from ..operators.write.translations import localized
from ..operators.write.units import Units
from . import rows
from .numbers import AXIS_LABELS, PRINCIPAL_LABELS
from .places import in_both_places


class SelectionPanel:
    """The selected objects as one body"""

    bl_label = "Selection"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout = self.layout
        if len(context.selected_objects) > 1:
            layout.operator("object.body_moments_copy_settings", icon="PASTEDOWN")
        _total(layout, context, Units.of(context.scene.unit_settings))


def _total(layout: UILayout, context: Context, units: Units) -> None:
    layout.label(text="Total of Selection")
    total = results.total(context)
    column = layout.column(align=True)
    if not total.count:
        rows.message(column, context, finding("panel_nothing_measured"))
        return
    rows.filled(column, "1 Object" if total.count == 1 else "{:d} Objects", total.count, icon="GROUP")
    for names, text in ((total.missing, "Not measured: {:s}"), (total.stale, "Out of date: {:s}")):
        if names:
            row = column.row()
            row.alert = True
            rows.sentence(row, context, localized(text).format(truncate_list(names, translate=localized)), icon="ERROR")
    for caveat in total.findings:
        rows.message(column, context, caveat)
    column = layout.column(align=True)
    if total.body is not None:
        rows.value(column, units, "Mass", "mass", total.body.mass)
    if total.volume:
        rows.value(column, units, "Volume", "volume", total.volume)
    if total.area:
        rows.value(column, units, "Area", "area", total.area)
    if total.body is None:
        return
    column = layout.column(align=True)
    rows.heading(column, "Center of Mass (World)", "length", total.body.center)
    rows.values(column, units, AXIS_LABELS, "length", total.body.center, total.body.radii_of_gyration.max())
    column = layout.column(align=True)
    moments = total.body.principal.moments
    rows.heading(column, "Principal Moments", "inertia", moments)
    rows.values(column, units, PRINCIPAL_LABELS, "inertia", moments)


CLASSES = VIEW3D_PT_body_moments_selection, OBJECT_PT_body_moments_selection = in_both_places(
    SelectionPanel, "selection"
)
