# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on a measurement: headline, method, reason."""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from ...blender.session.displayed import Displayed, Trust, displayed, failure
from ...blender.session.live.following import Lag, current_numbers
from ...blender.session.tracking import posed
from ...blender.write import properties
from ...blender.write.translations import localized
from ...core.verdict.method import Source
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
    Lag.NONE: "Live ({milliseconds:.0f} ms). Press Measure to store",
    Lag.FIRST_ORDER: (
        "Live: mass, volume and center of this frame; inertia follows when it stops ({milliseconds:.0f} ms)"
    ),
    Lag.BEHIND: "Live lags: measuring takes {milliseconds:.0f} ms, and waits until the edit stops",
}


def verdict(layout: UILayout, context: Context, obj: Object, shown: Displayed | None) -> None:
    """Draw the object's name, and the state and method of its measurement."""
    column = layout.column(align=True)
    column.label(text=obj.name, icon="OBJECT_DATA", translate=False)
    refusal = failure(obj)
    if refusal is not None or shown is None:
        text = "Not Measured Again" if shown is not None else "Not Measured"
        column.label(text=text, icon="RADIOBUT_OFF" if refusal is None else "CANCEL")
    if refusal is not None:
        rows.message(column, context, refusal, icon="BLANK1")
        remedies.remedies(column, context, refusal)
    if shown is None:
        return
    if posed.stands_for_meshes(obj):
        _posed(column, context, obj)
        return
    _headline(column, context, obj, shown)
    if shown.live is not None and shown.reason is None:
        rows.remark(column, context, LIVE[shown.lag], icon="REC", milliseconds=1e3 * shown.live.seconds)
    now = current_numbers(obj)
    if now is not None and now.refusal is not None and now.refusal != refusal:
        rows.message(column, context, now.refusal)
    rows.stale_row(column, context, shown.reason)


def _posed(column: UILayout, context: Context, armature: Object) -> None:
    """Draw the meshes that an armature deforms, with warnings about missing and outdated numbers."""
    meshes = posed.deformed_meshes(armature)
    texts = "Sum of {count} mesh of the armature", "Sum of {count} meshes of the armature"
    rows.remark(column, context, *texts, icon="POSE_HLT", count=len(meshes))
    numbers = {mesh.name: displayed(mesh, context.scene) for mesh in meshes}
    lacking = [name for name, shown in numbers.items() if shown is None]
    stale = [name for name, shown in numbers.items() if shown is not None and shown.trust == Trust.OUT_OF_DATE]
    for text, names in (("Not measured: {objects}", lacking), ("Out of date: {objects}", stale)):
        if names:
            rows.remark(column, context, text, icon="ERROR", objects=names)


def _headline(column: UILayout, context: Context, obj: Object, shown: Displayed) -> None:
    """Draw the method in two lines. A method of another version of the add-on is shown by its own text."""
    key = method_key(shown.method, any(found.code == WALL_MEASURED for found in shown.findings))
    source = Source.POLYGONS if shown.method is None or key == str(shown.method) else shown.method.source
    headline, explanation = METHODS.get(key, (properties.method_text(obj).title(), ""))
    title = localized(SOURCES.get(source, "{:s}")).format(localized(headline))
    rows.sentence(column, context, title, icon=ICONS.get(key, "INFO"))
    if explanation:
        rows.sentence(column, context, localized(explanation), icon="BLANK1")
