# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on a measurement: headline, method, reason."""

from __future__ import annotations

from collections.abc import Sequence

from bpy.types import Context, Object, UILayout

from ...blender.session.findings import STALE_SETTINGS
from ...blender.session.live import live
from ...blender.session.stored import results, trust
from ...blender.session.tracking import posed, staleness
from ...blender.write import properties
from ...blender.write.translations import localized
from ...core.verdict.finding import Finding, finding
from ...core.verdict.method import Method, Source
from ...core.verdict.sentences import METHODS, method_key
from ...core.wall.findings import WALL_MEASURED
from .. import rows
from ..findings import (
    PANEL_LIVE,
    PANEL_LIVE_BEHIND,
    PANEL_LIVE_FIRST_ORDER,
    PANEL_POSED,
    PANEL_POSED_MISSING,
    PANEL_POSED_STALE,
)
from . import remedies

ICONS = {
    "exact": "CHECKMARK",
    "grid exact": "VOLUME_DATA",
    "shell": "MOD_SOLIDIFY",
    "wall": "MOD_SOLIDIFY",
    "wire": "CURVE_DATA",
    "capped": "ERROR",
    "open": "CANCEL",
    "given": "EMPTY_AXIS",
    "assembly": "OUTLINER_COLLECTION",
}
SOURCES = {Source.NURBS: "NURBS: {:s}", Source.GRID: "Grid: {:s}"}  # prefix for the measured data, before a verdict

LIVE = {
    live.Lag.NONE: PANEL_LIVE,
    live.Lag.FIRST_ORDER: PANEL_LIVE_FIRST_ORDER,
    live.Lag.BEHIND: PANEL_LIVE_BEHIND,
}


def method_and_findings(obj: Object) -> tuple[Method | None, Sequence[Finding]]:
    """Return the method and findings of the displayed numbers: live or stored."""
    now = live.current_numbers(obj)
    if now is not None and now.measurement is not None:
        return now.measurement.method, now.measurement.findings
    return properties.method(obj), properties.findings(obj)


def verdict(layout: UILayout, context: Context, obj: Object, measured: bool) -> None:
    """Draw the object's name, and the state and method of its measurement."""
    column = layout.column(align=True)
    column.label(text=obj.name, icon="OBJECT_DATA", translate=False)
    refusal = results.failure(obj)
    if refusal is not None or not measured:
        text = "Not Measured Again" if measured else "Not Measured"
        column.label(text=text, icon="RADIOBUT_OFF" if refusal is None else "CANCEL")
    if refusal is not None:
        rows.message(column, context, refusal, icon="BLANK1")
        remedies.remedies(column, context, refusal)
    if not measured:
        return
    if posed.stands_for_meshes(obj):
        _posed(column, context, obj)
        return
    _headline(column, context, obj)
    now = live.current_numbers(obj)
    if now is not None and now.measurement is not None:
        if live.is_stale(obj, context.scene):
            rows.stale_row(column, context, STALE_SETTINGS)
            return
        code = LIVE[live.lag(obj)]
        rows.message(column, context, finding(code, milliseconds=1e3 * now.seconds), icon="REC")
        return
    if now is not None and now.refusal is not None and now.refusal != results.failure(obj):
        rows.message(column, context, now.refusal)
    rows.stale_row(column, context, staleness.stale_reason(obj, context.scene))


def _posed(column: UILayout, context: Context, armature: Object) -> None:
    """Draw the meshes that an armature deforms, with warnings about missing and outdated numbers."""
    meshes = posed.deformed_meshes(armature)
    rows.message(column, context, finding(PANEL_POSED, count=len(meshes)), icon="POSE_HLT")
    lacking = [mesh.name for mesh in meshes if results.in_world(mesh, context.scene) is None]
    stale = [
        mesh.name
        for mesh in meshes
        if mesh.name not in lacking and trust.trust(mesh, context.scene) == trust.Trust.OUT_OF_DATE
    ]
    for code, names in ((PANEL_POSED_MISSING, lacking), (PANEL_POSED_STALE, stale)):
        if names:
            rows.message(column, context, finding(code, objects=names))


def _headline(column: UILayout, context: Context, obj: Object) -> None:
    """Draw the method in two lines. A method of another version of the add-on is shown by its own text."""
    method, findings = method_and_findings(obj)
    key = method_key(method, any(found.code == WALL_MEASURED for found in findings))
    source = Source.POLYGONS if method is None or key == str(method) else method.source
    headline, explanation = METHODS.get(key, (properties.method_text(obj).title(), ""))
    title = localized(SOURCES.get(source, "{:s}")).format(localized(headline))
    rows.sentence(column, context, title, icon=ICONS.get(key, "INFO"))
    if explanation:
        rows.sentence(column, context, localized(explanation), icon="BLANK1")
