# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of colliders: the button that makes them, and what they do to the object's
physics.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, dist
from typing import Any

from bpy.types import Context, OperatorProperties

from ..blender import read, scale, session, settings
from ..blender.session.stored.collider_tolerance import is_beyond_tolerance, tolerance_remedy
from ..operators.setup.colliders import SHAPES
from . import places, rows, texts

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
ANOTHER_BODY = "An engine would simulate another body."
# by the kind of correction that did not suffice: the remedy, and that for pieces
REMEDIES = {
    "none": ("Choose Masses or Vertices for Correct.",) * 2,
    "masses": ("Choose Convex Pieces, and more of them.", "Allow more pieces."),
    "vertices": (
        "Increase Outward and Inward, or choose Convex Pieces.",
        "Increase Outward and Inward, or allow more pieces.",
    ),
}
# No correction changes boxes, spheres, capsules and cylinders.
PRIMITIVE_REMEDY = "Choose Convex Pieces, or a shape of equal inertia."
SHAPE_NAMES = {key: name for key, name, _ in SHAPES}


class CollidersPanel:
    """Colliders, and how an engine that takes mass, center and inertia from them differs"""

    bl_label = "Colliders"

    def draw(self, context: Context) -> None:
        layout = self.layout
        subject = session.selected.subject(context)
        body = None if subject is None else settings.given.body_of(subject)
        layout.label(text="" if body is None else body.name, icon="OBJECT_DATA", translate=False)
        group = None if body is None else body.get(settings.given.COLLIDERS)
        stored = group if hasattr(group, "keys") and KEYS.issubset(group.keys()) else None
        make_colliders = "object.body_moments_make_colliders"
        kind = SHAPES[0][0] if stored is None else str(stored["shape"]).upper()
        correct = "NONE" if stored is None else str(stored["correct"]).upper()
        row = layout.row(align=True)
        renew = {} if stored is None else {"text": "Renew Colliders"}
        make = rows.button(row, make_colliders, "MESH_ICOSPHERE", **renew)
        make.shape = kind
        _repeat(make, stored, correct)
        remove = row.row(align=True)
        remove.enabled = stored is not None
        remove.operator("object.body_moments_remove_colliders", text="", icon="X")
        # These buttons show progress, and Esc cancels them; the redo panel cannot.
        text = SHAPE_NAMES.get(kind, "Shape")
        choice = layout.operator_menu_enum(make_colliders, "shape", text=text, icon="MESH_DATA")
        _repeat(choice, stored, correct)
        layout.label(text="Correct")
        row = layout.row(align=True)
        for name, label in (("NONE", "Off"), ("MASSES", "Masses"), ("VERTICES", "Vertices")):
            is_chosen = stored is not None and name == correct
            again = rows.button(row, make_colliders, "NONE", text=label, depress=is_chosen)
            again.shape = kind
            _repeat(again, stored, name)
        if getattr(context.space_data, "type", "") == "VIEW_3D":
            layout.prop(context.space_data.shading, "wireframe_color_type", text="Wire")
        reason = (
            None
            if stored is None
            else session.tracking.staleness.stale_reason(
                body, context.scene, session.tracking.stamps.Kind.COLLIDERS
            )
        )
        texts.stale_state(layout, reason)
        if stored is None:
            texts.remark(layout, "Engines take mass, center and inertia from colliders.")
            return
        column = layout.column(align=True)
        texts.filled(
            column, "1 Collider" if stored["count"] == 1 else "{:d} Colliders", stored["count"]
        )
        # largest extent, in m
        size = max(body.dimensions) * scale.meters_per_unit(context.scene)
        shift = dist(stored["center_shift"], (0.0, 0.0, 0.0))
        changes = (
            abs(stored.get("mass_ratio", 1.0) - 1.0),
            stored.get("inertia_change", 0.0),
            shift / (size or 1.0),  # an empty has no size
        )
        if max(changes) > SLIGHT:
            remedy, remedy_for_pieces = REMEDIES.get(stored["correct"], REMEDIES["none"])
            if stored["shape"] == "pieces":
                remedy = remedy_for_pieces
            kinds = {
                child[settings.given.COLLIDER]["kind"]
                for child in body.children
                if settings.given.COLLIDER in child
            }
            texts.remark(column, ANOTHER_BODY, icon="ERROR")
            texts.remark(column, remedy if "mesh" in kinds else PRIMITIVE_REMEDY)
        else:
            texts.remark(column, "An engine simulates the body within 1%.", icon="CHECKMARK")
        if is_beyond_tolerance(stored):
            texts.remark(column, "The tolerance is not kept.", icon="ERROR")
            texts.remark(column, tolerance_remedy(stored))
        texts.title(layout, "Of the Object's")
        labels = ("Volume", "Mass", "Moment 1", "Moment 2", "Moment 3")
        moments = stored.get("moment_ratios", (None,) * 3)
        ratios = zip(labels, (stored.get("volume_ratio"), stored.get("mass_ratio"), *moments))
        rows.table(
            layout,
            [
                (label, "{:.5g} %".format(100.0 * ratio), repr(ratio), "")
                for label, ratio in ratios
                if ratio is not None
            ],
        )
        texts.title(layout, "Off by")
        column = layout.column(align=True)
        labels = ("Center", "Outward", "Inward", "Uncertain by")
        lengths = shift, *(stored[name] for name in ("outward", "inward", "distance_bound"))
        rows.values(column, labels, "length", lengths, size)  # Rounding is shown as 0.
        turn = degrees(stored["axes_turn"])
        rows.table(column, [("Axes", "{:.3f}°".format(turn), repr(turn), "")])


def _repeat(make: OperatorProperties, stored: Mapping[str, Any] | None, correct: str) -> None:
    """Set an operator to make colliders with the stored limits, if any, and with a kind of
    correction.
    """
    make.correct = correct
    if stored is None:
        return
    make.engine = str(stored["engine"]).upper()
    if "tolerance" in stored and "limits" in stored:
        make.tolerance = "LENGTH"
        make.outward, make.inward = stored["tolerance"]
        make.pieces, make.vertices = stored["limits"]


CLASSES = places.in_both_places(
    CollidersPanel, "colliders", shown_for=read.visibility.measurable, for_any=True
)
