# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of levels in vessels, and of cut and fill."""

from __future__ import annotations

from math import pi

from bpy.types import Context, UILayout

from ..blender.read.visibility import measurable
from ..blender.session import memory, selected, stored
from ..blender.session.tracking.staleness import stale_reason
from ..blender.session.tracking.stamps import Kind
from . import places, rows, texts

TABLE_STEP = 4  # every fourth row of the level table is listed; the first one is that of no liquid


class CutsPanel:
    """Levels of liquids in vessels, and volumes above and below a plane or another surface"""

    bl_label = "Above and Below"

    def draw(self, context: Context) -> None:
        layout = self.layout
        obj = selected.subject(context)
        column = rows.buttons(layout, ("object.body_moments_level", "MATFLUID"))
        rows.button(column, "object.body_moments_cut_fill", "MOD_BOOLEAN", short="Cut, Fill")
        for values, kind, draw in (
            (memory.levels, Kind.LEVEL, _level),
            (memory.cut_fills, Kind.CUT_FILL, _cut_fill),
        ):
            if obj in values and stale_reason(obj, context.scene, kind):
                texts.remark(
                    layout, "The object has changed. Press the button again.", icon="FILE_REFRESH"
                )
            elif obj in values:
                draw(layout, values[obj])


def _level(layout: UILayout, level: stored.cuts.Level) -> None:
    layout.label(text="Liquid", icon="MATFLUID")
    column = layout.column(align=True)
    rows.quantities(
        column,
        [
            ("Level", "length", level.height),
            ("Over Bottom", "length", level.height - level.hollow.bottom),
            ("Volume", "volume", level.volume),
            ("Mass", "mass", level.volume * level.density),
            ("Capacity", "volume", level.hollow.capacity),
        ],
    )
    if level.tilt is None:
        texts.remark(column, "Spills at Tilt: only up to 20,000 triangles")
    elif level.tilt < pi:
        rows.table(column, [rows.angle_cell("Spills at Tilt", level.tilt)])
    row = layout.row(align=True)
    row.operator("object.body_moments_show_level", text="Show Level").what = "SURFACE"
    row.operator("object.body_moments_show_level", text="", icon="CURVE_DATA").what = "TABLE"
    if (body := rows.fold(layout, "body_moments_level_surface", "Free Surface")) is not None:
        area, least, largest = level.surface_moments  # m², and the principal second moments, m⁴
        rows.quantities(
            body,
            [
                ("Area", "area", area),
                ("I1", "area_moment", least),
                ("I2", "area_moment", largest),
            ],
        )
        center = level.liquid.part.center[0].tolist()
        rows.group(
            body,
            "Center of the Liquid",
            rows.AXIS_LABELS,
            "length",
            center,
            level.volume ** (1 / 3),  # a length beside which rounding is shown as 0
        )
    if (body := rows.fold(layout, "body_moments_level_table", "Level Table")) is not None:
        units = texts.scene_units()
        cells = [
            (units.text("length", height), units.text("volume", volume), repr(volume), "m³")
            for height, volume in level.table[TABLE_STEP::TABLE_STEP].tolist()
        ]
        rows.table(body, cells)


def _cut_fill(layout: UILayout, known_cut_fill: stored.cuts.KnownCutFill) -> None:
    cut_fill = known_cut_fill.cut_fill
    layout.label(text="Cut and Fill", icon="MOD_BOOLEAN")
    rows.quantities(
        layout,
        [
            ("Cut", "volume", cut_fill.cut.total),
            ("Fill", "volume", cut_fill.fill.total),
            ("Net", "volume", cut_fill.net),
            ("Cut Area", "area", cut_fill.cut_area),
            ("Fill Area", "area", cut_fill.fill_area),
        ],
    )
    for finding in known_cut_fill.findings:
        texts.message(layout, finding)
    if (body := rows.fold(layout, "body_moments_cut_fill_centers", "Centers")) is not None:
        for label, part, area in (
            ("Cut", cut_fill.cut, cut_fill.cut_area),
            ("Fill", cut_fill.fill, cut_fill.fill_area),
        ):
            if part.total > 0.0:
                center = part.center.tolist()
                rows.group(body, label, rows.AXIS_LABELS, "length", center, area**0.5)


CLASSES = places.in_both_places(
    CutsPanel, "cuts", parent="section", options=frozenset(), shown_for=measurable
)
