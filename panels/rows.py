# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of a narrow panel: values that can be copied, and sentences that wrap.

Blender translates what it draws: what is a label in the source, as it is; what is filled, before that (`filled`,
`message`). Names, numbers and filled texts are drawn as they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import blf
import bpy
import numpy as np
from bpy.types import Context, UILayout

from ..core.verdict.finding import Finding, Severity, finding
from ..operators.actions.measure.copy import OBJECT_OT_body_moments_copy_value
from ..operators.write.messages import severity
from ..operators.write.translations import localized, localized_sentence
from ..operators.write.units import SI_UNITS, Units

# share of a row that its label takes, one of few letters, and of one
LABEL_SHARE, SHORT_LABEL_SHARE, INDEX_LABEL_SHARE = 0.36, 0.2, 0.1
REGION_MARGIN = 96  # what tabs, borders and an icon take of the region's width, in unscaled pixels
MIN_LINE_WIDTH = 80  # no line is made narrower: longer words would stand alone, and be cut off
ICONS = {Severity.NOTE: "INFO", Severity.WARNING: "ERROR", Severity.ERROR: "CANCEL"}  # ERROR is Blender's warning sign


def value(layout: UILayout, units: Units, label: str, quantity: str, si: float) -> None:
    """One value with its unit, and a button that copies it to the last digit."""
    texts(layout, label, units.text(quantity, si), repr(float(si)), SI_UNITS[quantity])


def values(
    layout: UILayout,
    units: Units,
    labels: Sequence[str],
    quantity: str,
    si: Sequence[float],
    size: float = 0.0,
) -> None:
    """A row for each value, all in the same unit. size: as for `Units.texts`."""
    for label, text, number in zip(labels, units.texts(quantity, si, size), si):
        texts(layout, label, text, repr(float(number)), SI_UNITS[quantity])


def heading(layout: UILayout, label: str, quantity: str, si: Sequence[float]) -> None:
    """A heading whose button copies all values below it."""
    row = layout.row(align=True)
    row.label(text=label)
    _copy(row, repr(np.asarray(si, float).tolist()), SI_UNITS.get(quantity, ""))


def direction(layout: UILayout, label: str, vector: Sequence[float]) -> None:
    """A unit vector in one row, or in three where that is too narrow."""
    cosines = ["{:.4f}".format(component + 0.0).replace("-0.0000", "0.0000").replace("-", "−") for component in vector]
    if not _fits(1.0 - INDEX_LABEL_SHARE, *cosines):
        for name, text, component in zip("xyz", cosines, vector):
            texts(layout, "{:s} {:s}".format(label, name).strip(), text, repr(float(component)), "")
        return
    row = layout.row(align=True)
    split = row.split(factor=INDEX_LABEL_SHARE, align=True)
    split.label(text=label)
    cells = split.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
    for text in cosines:
        cell = cells.row(align=True)
        cell.alignment = "RIGHT"
        cell.label(text=text, translate=False)
    _copy(row, repr([float(component) for component in vector]), "")


def texts(layout: UILayout, label: str, text: str, exact: str, unit: str) -> None:
    """Label, text to the right, copy button; the label above them where a row is too narrow for both."""
    share = LABEL_SHARE if len(label) > 3 else SHORT_LABEL_SHARE
    if _fits(1.0 - share, text):
        row = layout.row(align=True)
        cell = row.split(factor=share, align=True)
        cell.label(text=label)
    else:
        layout.label(text=label)
        row = layout.row(align=True)
        cell = row
    cell = cell.row(align=True)
    cell.alignment = "RIGHT"
    cell.label(text=text, translate=False)
    _copy(row, exact, unit)


def _copy(row: UILayout, exact: str, unit: str) -> None:
    button = row.operator(OBJECT_OT_body_moments_copy_value.bl_idname, text="", icon="COPYDOWN", emboss=False)
    button.value = exact
    button.unit = unit


def filled(layout: UILayout, template: str, *values: object, icon: str = "NONE") -> None:
    """A label that is filled after it was translated."""
    layout.label(text=localized(template).format(*values), icon=icon, translate=False)


def sentence(layout: UILayout, context: Context, text: str, icon: str = "NONE") -> None:
    """A text, already translated, in as many lines as the region's width asks for."""
    column = layout.column(align=True)
    column.scale_y = 0.85
    for i, line in enumerate(_wrapped(text, *_width(context))):
        if icon == "NONE":
            column.label(text=line, translate=False)
        else:
            column.label(text=line, icon=icon if i == 0 else "BLANK1", translate=False)


def message(layout: UILayout, context: Context, shown: Finding, icon: str = "") -> None:
    """The sentence of a finding. icon: by default that of its severity."""
    text = localized_sentence(shown, context.scene.unit_settings)
    sentence(layout, context, text, icon or ICONS[severity(shown)])


def stale_row(layout: UILayout, context: Context, code: str | None) -> None:
    """Why numbers no longer hold, where they do not."""
    if code is not None:
        row = layout.row()
        row.alert = True
        reason = localized_sentence(finding(code), context.scene.unit_settings)
        sentence(row, context, localized("Out of date: {:s}").format(reason), icon="FILE_REFRESH")


def _fits(share: float, *cells: str) -> bool:
    """Whether texts have place beside each other in that share of a row of the region that is being drawn."""
    if bpy.context.region is None:
        return True
    width, size = _width(bpy.context)
    blf.size(0, size)
    return len(cells) * max(blf.dimensions(0, cell)[0] + 0.2 * size for cell in cells) <= share * (width + 2.0 * size)


def _width(context: Context) -> tuple[int, float]:
    """(pixels, font size in pixels) that a line has."""
    scale = context.preferences.system.ui_scale
    region = context.region
    width = region.width if region is not None else 0
    points = context.preferences.ui_styles[0].widget.points
    return max(int(width - REGION_MARGIN * scale), int(MIN_LINE_WIDTH * scale)), points * scale


@lru_cache(maxsize=256)
def _wrapped(text: str, width: int, size: float) -> tuple[str, ...]:
    blf.size(0, size)
    lines, line = [], ""
    for word in text.split():
        longer = "{:s} {:s}".format(line, word) if line else word
        if line and blf.dimensions(0, longer)[0] > width:
            lines.append(line)
            line = word
        else:
            line = longer
    return (*lines, line)
