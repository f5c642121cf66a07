# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on what was measured: headline, method, reason."""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from ..operators.session import live, results, staleness
from ..operators.write import properties
from . import rows

# method: (headline, icon, explanation)
VERDICTS = {
    "exact": ("Exact, Closed Surface", "CHECKMARK", ""),
    "grid exact": ("Exact, from a Grid", "VOLUME_DATA", ""),
    "union": ("United Shells", "INFO", "By Blender's exact boolean, to 7 digits"),
    "shell": ("Shell", "MOD_SOLIDIFY", "The mass is in the surface"),
    "wire": ("Wire", "CURVE_DATA", "The mass is along the curve"),
    "reoriented": ("Reoriented", "INFO", "Closed after flipped faces were turned"),
    "capped": ("Capped", "ERROR", "The surface is open; its holes were capped"),
    "open": ("Open", "CANCEL", "Not closed: the numbers depend on the reference point"),
}


def _method_and_warnings(obj: Object) -> tuple[str, list[str]]:
    """Of the numbers that are shown: live or stored."""
    now = live.shown(obj)
    if now is not None and now.measurement is not None:
        return now.measurement.method, list(now.measurement.warnings)
    return properties.method_and_warnings(obj)


def _verdict(layout: UILayout, context: Context, obj: Object, measured: bool) -> None:
    column = layout.column(align=True)
    refusal = results.refusal(obj)
    if refusal or not measured:
        text = "Not Measured Again" if measured else "Not Measured"
        column.label(text=text, icon="CANCEL" if refusal else "RADIOBUT_OFF")
    if refusal:
        rows.sentence(column, context, refusal, icon="BLANK1")
    if not measured:
        return
    method, _ = _method_and_warnings(obj)
    *before, last = method.split() or [""]
    headline, icon, explanation = VERDICTS.get(method) or VERDICTS.get(last, (method.title(), "INFO", ""))
    before = [] if method in VERDICTS else [word[:1].upper() + word[1:] for word in before]
    column.label(text=" ".join([*before, headline]), icon=icon)
    if last == "shell" and obj.body_moments.wall != "THIN":
        explanation = "The mass is in walls of real thickness"
    if explanation:
        rows.sentence(column, context, explanation, icon="BLANK1")
    now = live.shown(obj)
    if now is not None and now.measurement is not None:
        if live.is_outdated(obj, context.scene):
            row = column.row()
            row.alert = True
            row.label(text="Out of Date: Settings Changed", icon="FILE_REFRESH")
            return
        column.label(text="Live, in {:.0f} ms: Measure Stores It".format(1e3 * now.seconds), icon="REC")
        return
    if now is not None:
        rows.sentence(column, context, now.reason, icon="ERROR")
    rows.outdated(column, staleness.reason(obj, context.scene))
