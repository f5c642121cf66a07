# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on what was measured: headline, method, reason."""

from __future__ import annotations

from collections.abc import Sequence

from bpy.types import Context, Object, UILayout

from ..core.verdict.finding import Finding, finding
from ..operators.session import live, results, staleness
from ..operators.write import properties
from ..operators.write.messages import METHODS
from ..operators.write.translations import localized
from . import rows

ICONS = {
    "exact": "CHECKMARK",
    "grid exact": "VOLUME_DATA",
    "shell": "MOD_SOLIDIFY",
    "wall": "MOD_SOLIDIFY",
    "wire": "CURVE_DATA",
    "capped": "ERROR",
    "open": "CANCEL",
}
SOURCES = {"NURBS": "NURBS: {:s}", "grid": "Grid: {:s}"}  # of what was measured, before a method


def method_and_findings(obj: Object) -> tuple[str, Sequence[Finding]]:
    """Of the numbers that are shown: live or stored."""
    now = live.current_numbers(obj)
    if now is not None and now.measurement is not None:
        return str(now.measurement.method), now.measurement.findings
    return properties.method(obj), properties.findings(obj)


def verdict(layout: UILayout, context: Context, obj: Object, measured: bool) -> None:
    column = layout.column(align=True)
    refusal = results.failure(obj)
    if refusal is not None or not measured:
        text = "Not Measured Again" if measured else "Not Measured"
        column.label(text=text, icon="RADIOBUT_OFF" if refusal is None else "CANCEL")
    if refusal is not None:
        rows.message(column, context, refusal, icon="BLANK1")
    if not measured:
        return
    _headline(column, context, *method_and_findings(obj))
    now = live.current_numbers(obj)
    if now is not None and now.measurement is not None:
        if live.is_stale(obj, context.scene):
            rows.stale_row(column, context, "stale_settings")
            return
        rows.message(column, context, finding("panel_live", milliseconds=1e3 * now.seconds), icon="REC")
        return
    if now is not None:
        rows.message(column, context, now.refusal)
    rows.stale_row(column, context, staleness.stale_reason(obj, context.scene))


def _headline(column: UILayout, context: Context, method: str, findings: Sequence[Finding]) -> None:
    """What the method was, in two lines. A method of another version of the add-on speaks for itself."""
    source, last = ("", method) if method in METHODS else method.rpartition(" ")[::2]
    if last == "shell" and any(one.code == "wall_measured" for one in findings):
        last = "wall"
    headline, explanation = METHODS.get(last, (last.title(), ""))
    rows.filled(column, SOURCES.get(source, "{:s}"), localized(headline), icon=ICONS.get(last, "INFO"))
    if explanation:
        rows.sentence(column, context, localized(explanation), icon="BLANK1")
