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
from ...core.verdict.finding import Finding
from ...core.verdict.method import Method, Source
from ...core.verdict.sentences import METHODS, method_key
from ...core.wall.findings import WALL_MEASURED
from .. import rows
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
    live.Lag.NONE: "Live ({milliseconds:.0f} ms). Press Measure to store",
    live.Lag.FIRST_ORDER: (
        "Live: mass, volume and center of this frame; inertia follows when it stops ({milliseconds:.0f} ms)"
    ),
    live.Lag.BEHIND: "Live lags: measuring takes {milliseconds:.0f} ms, and waits until the edit stops",
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
        rows.remark(column, context, LIVE[live.lag(obj)], icon="REC", milliseconds=1e3 * now.seconds)
        return
    if now is not None and now.refusal is not None and now.refusal != results.failure(obj):
        rows.message(column, context, now.refusal)
    rows.stale_row(column, context, staleness.stale_reason(obj, context.scene))


def _posed(column: UILayout, context: Context, armature: Object) -> None:
    """Draw the meshes that an armature deforms, with warnings about missing and outdated numbers."""
    meshes = posed.deformed_meshes(armature)
    texts = "Sum of {count} mesh of the armature", "Sum of {count} meshes of the armature"
    rows.remark(column, context, *texts, icon="POSE_HLT", count=len(meshes))
    lacking = [mesh.name for mesh in meshes if results.in_world(mesh, context.scene) is None]
    stale = [
        mesh.name
        for mesh in meshes
        if mesh.name not in lacking and trust.trust(mesh, context.scene) == trust.Trust.OUT_OF_DATE
    ]
    for text, names in (("Not measured: {objects}", lacking), ("Out of date: {objects}", stale)):
        if names:
            rows.remark(column, context, text, icon="ERROR", objects=names)


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
