# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The total of the selection."""

from __future__ import annotations

from bpy.types import Context, UILayout

from ..core.verdict.finding import finding
from ..operators.session import results
from ..operators.write.messages import truncate_list
from ..operators.write.translations import localized
from ..operators.write.units import Units
from . import rows
from .numbers import AXIS_LABELS, PRINCIPAL_LABELS


def totals(layout: UILayout, context: Context, units: Units) -> None:
    header, body = layout.panel("body_moments_totals", default_closed=True)
    header.label(text="Total of Selection")
    if body is None:
        return
    total = results.total(context)
    column = body.column(align=True)
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
    column = body.column(align=True)
    if total.body is not None:
        rows.value(column, units, "Mass", "mass", total.body.mass)
    if total.volume:
        rows.value(column, units, "Volume", "volume", total.volume)
    if total.area:
        rows.value(column, units, "Area", "area", total.area)
    if total.body is None:
        return
    column = body.column(align=True)
    rows.heading(column, "Center of Mass (World)", "length", total.body.center)
    rows.values(column, units, AXIS_LABELS, "length", total.body.center, total.body.radii_of_gyration.max())
    column = body.column(align=True)
    moments = total.body.principal.moments
    rows.heading(column, "Principal Moments", "inertia", moments)
    rows.values(column, units, PRINCIPAL_LABELS, "inertia", moments)
