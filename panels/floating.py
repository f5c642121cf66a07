# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of floating: the liquid, the position, hydrostatics, and righting arms."""

from __future__ import annotations

from math import isfinite, pi

from bpy.types import Context, UILayout

from ..blender.read.visibility import measurable
from ..blender.session import displayed, memory, selected, stored
from ..core import floating, verdict
from . import places, rows, texts

MAX_POSITIONS = 6


class FloatingPanel:
    """Where the object floats, and how stable it is"""

    bl_label = "Floating"

    def draw(self, context: Context) -> None:
        layout = self.layout
        objects = displayed.shown_objects(context)
        obj = objects[0] if len(objects) == 1 else selected.subject(context)
        settings = context.scene.body_moments_liquid
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_float", "MOD_OCEAN").position = 0
        row = column.row(align=True)
        rows.button(row, "object.body_moments_float_positions", "VIEWZOOM", short="Positions")
        rows.button(row, "object.body_moments_righting_arms", "FCURVE", short="GZ")
        column = layout.column(align=True)
        column.use_property_split = True
        column.prop(settings, "liquid")
        if settings.liquid == "OTHER":
            column.prop(settings, "density")
        column.prop(settings, "level")
        if obj is not None:
            tank = obj.body_moments_tank
            column.prop(tank, "role")
            if tank.role == "TANK":
                column.prop(tank, "fill")
        if obj is None or obj not in memory.afloat:
            texts.remark(layout, "Press Float to see where it rests.")
            return
        held_body = stored.floating.held_body(obj, context.scene)
        if isinstance(held_body, verdict.Finding):
            texts.message(layout, held_body)
        elif held_body is None:
            texts.remark(layout, "The object has changed. Press Float again.", icon="FILE_REFRESH")
        else:
            _numbers(layout, held_body)
            _positions(layout, held_body.afloat)
            if held_body.afloat.curve is not None:
                _stability(layout, held_body.afloat.curve)


def _numbers(layout: UILayout, held_body: stored.floating.Held) -> None:
    state = held_body.state
    smaller, larger = state.metacentric_heights  # GM in m, athwart and lengthwise
    if not held_body.is_at_rest:
        layout.label(text="Not at Rest: Held as Placed", icon="INFO")
    else:
        layout.label(text="Afloat", icon="CHECKMARK" if smaller > 0.0 else "ERROR")
    for finding in held_body.afloat.rest.findings:
        texts.message(layout, finding)
    column = layout.column(align=True)
    rows.quantities(
        column,
        [
            ("Draught", "length", state.draught),
            ("Displacement", "volume", state.displacement),
            ("Mass", "mass", state.body.total_mass),
        ],
    )
    rows.table(
        column,
        [
            rows.angle_cell("Heel, about X", held_body.heel),
            rows.angle_cell("Trim, about Y", held_body.trim),
        ],
    )
    rows.quantities(column, [("GM", "length", smaller), ("GM, Lengthwise", "length", larger)])
    if (body := rows.fold(layout, "body_moments_floating_more", "Hydrostatics")) is not None:
        keel = state.keel  # height of the lowest point, m
        rows.quantities(
            body,
            [
                ("KB", "length", float(state.up @ state.center_of_buoyancy) - keel),
                ("KG", "length", float(state.up @ state.center_of_gravity) - keel),
                ("BM", "length", state.metacentric_radii[0]),
                ("BM, Lengthwise", "length", state.metacentric_radii[1]),
                ("Waterplane", "area", state.plane.area),
                ("Second Moment", "area_moment", state.waterplane_moments[0]),
                ("Lengthwise", "area_moment", state.waterplane_moments[1]),
            ],
        )
        size = state.body.size
        for label, point in (
            ("Center of Buoyancy", state.center_of_buoyancy),
            ("Center of Flotation", state.center_of_flotation),
        ):
            rows.group(body, label, rows.AXIS_LABELS, "length", held_body.to_world(point), size)


def _positions(layout: UILayout, afloat: stored.floating.Afloat) -> None:
    if not afloat.rests:
        return
    layout.label(text="Positions of Rest")
    column = layout.column(align=True)
    for place, rest in enumerate(afloat.rests[:MAX_POSITIONS], 1):
        row = column.row(align=True)
        gm = texts.scene_units().text("length", rest.metacentric_heights[0])
        row.label(text="{:d}: GM {:s}".format(place, gm), translate=False)
        row.operator("object.body_moments_float", text="", icon="MOD_OCEAN").position = place
    further_count = len(afloat.rests) - MAX_POSITIONS
    if further_count > 0:
        texts.filled(column, "{:d} more", further_count)


def _stability(layout: UILayout, curve: floating.RightingCurve) -> None:
    layout.label(text="Righting Arms")
    column = layout.column(align=True)
    largest = int(curve.arms.argmax())
    low, high = curve.stable_range
    rows.table(
        column,
        [
            rows.quantity_cell("Largest GZ", "length", float(curve.arms[largest])),
            rows.angle_cell("At Heel", float(curve.angles[largest])),
            rows.angle_cell("Stable From", low),
            rows.angle_cell("Stable To", high),
        ],
    )
    for label, angles in (("Capsizes Beyond", curve.capsize), ("Floods Beyond", curve.flooding)):
        reached = [abs(angle) for angle in angles if isfinite(angle)]
        if reached:
            rows.table(column, [rows.angle_cell(label, min(reached))])
    if high >= pi - 1e-6 and low <= 1e-6 - pi:  # 1e-6: half a turn is stored as a float32
        texts.remark(column, "It comes back from any heel.")


CLASSES = places.in_both_places(FloatingPanel, "floating", shown_for=measurable, for_any=True)
