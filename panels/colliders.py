# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of colliders: the button that makes them, and what they do to the object's
physics.
"""

from __future__ import annotations

from math import degrees, dist

from bpy.types import Context, Object

from ..blender.read.visibility import measurable
from ..blender.scale import meters_per_unit
from ..blender.session.tracking.staleness import stale_reason
from ..blender.session.tracking.stamps import of_colliders
from ..blender.settings.given import COLLIDER, COLLIDERS
from . import rows
from .places import in_both_places

# Ratios to numbers that are zero are not stored.
KEYS = {
    "shape",
    "engine",
    "correct",
    "count",
    "center_shift",
    "axes_turn",
    "outward",
    "inward",
    "distance_bound",
}
SLIGHT = 0.01  # parts by which an engine may be off without a warning
REMEDIES = {  # by the kind of correction that did not suffice
    "none": "An engine would simulate another body. Choose Masses or Vertices for Correct.",
    "masses": "An engine would simulate another body. Choose Convex Pieces, and more of them.",
    "vertices": "An engine would simulate another body. Increase Outward and Inward, or choose "
    "Convex Pieces.",
}


class CollidersPanel:
    """Colliders, and how an engine that takes mass, center and inertia from them differs"""

    bl_label = "Colliders"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.object is not None and measurable(context.object)

    def draw(self, context: Context) -> None:
        layout = self.layout
        body = _body(context.object)
        layout.use_property_decorate = False
        group = body.get(COLLIDERS)
        stored = group if hasattr(group, "keys") and KEYS.issubset(group.keys()) else None
        row = layout.row(align=True)
        text = {} if stored is None else {"text": "Renew Colliders"}
        make = rows.button(row, "object.body_moments_make_colliders", "MESH_ICOSPHERE", **text)
        if stored is None:
            rows.remark(layout, "Engines take mass, center and inertia from colliders.")
            return
        row.operator("object.body_moments_remove_colliders", text="", icon="X")
        make.shape, make.engine, make.correct = (
            str(stored[name]).upper() for name in ("shape", "engine", "correct")
        )
        rows.stale_row(layout, stale_reason(body, context.scene, of_colliders))
        column = layout.column(align=True)
        rows.filled(
            column, "1 Collider" if stored["count"] == 1 else "{:d} Colliders", stored["count"]
        )
        size = max(body.dimensions) * meters_per_unit(context.scene)
        shift = dist(stored["center_shift"], (0.0, 0.0, 0.0))
        changes = (
            abs(stored.get("mass_ratio", 1.0) - 1.0),
            stored.get("inertia_change", 0.0),
            shift / (size or 1.0),
        )
        if max(changes) > SLIGHT:
            rows.remark(column, REMEDIES.get(stored["correct"], REMEDIES["none"]), icon="ERROR")
        else:
            rows.remark(column, "An engine simulates the body within 1%.", icon="CHECKMARK")
        rows.title(layout, "Of the Object's")
        labels = ("Volume", "Mass", "Moment 1", "Moment 2", "Moment 3")
        moments = stored.get("moment_ratios", (None,) * 3)
        ratios = zip(labels, (stored.get("volume_ratio"), stored.get("mass_ratio"), *moments))
        rows.table(
            layout.column(align=True),
            [
                (label, "{:.5g} %".format(100.0 * one), repr(one), "")
                for label, one in ratios
                if one is not None
            ],
        )
        rows.title(layout, "Off by")
        column = layout.column(align=True)
        labels = ("Center", "Outward", "Inward", "Uncertain by")
        lengths = shift, *(stored[name] for name in ("outward", "inward", "distance_bound"))
        rows.values(column, labels, "length", lengths, size)  # Rounding is shown as 0.
        turn = degrees(stored["axes_turn"])
        rows.table(column, [("Axes", "{:.3f}°".format(turn), repr(turn), "")])


def _body(obj: Object) -> Object:
    """Return the body of a collider, and any other object itself."""
    return obj.parent if COLLIDER in obj and obj.parent is not None else obj


CLASSES = in_both_places(CollidersPanel, "colliders")
