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
LABEL_SHARE, SHORT_LABEL_SHARE, INDEX_LABEL_SHARE = 0.36, 0.3, 0.12
REGION_MARGIN = 88  # what tabs, borders and an icon take of the region's width, in unscaled pixels
ROW_MARGIN = 80  # the same of a row without an icon, but with a button
DEFAULT_WIDTH = 300  # unscaled pixels of a region that is not known
BOX_MARGIN = 12  # what a box takes besides
MIN_LINE_WIDTH = 50  # no line is made narrower
MIN_PART, MIN_LAST_PART = 4, 3  # letters of a word that is broken
NARROW = 220  # regions below this width have buttons without icons, and headings above
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
    if _fits(1.0, localized(label)):
        row.label(text=label)
    else:
        sentence(row, bpy.context, localized(label))
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
    """Label, text to the right, copy button; the label above them where a row is too narrow for both, and the unit
    beside the label where one is too narrow for the text."""
    share = INDEX_LABEL_SHARE if len(label) < 2 else SHORT_LABEL_SHARE if len(label) < 4 else LABEL_SHARE
    if _fits(1.0 - share, text) and _fits(share, localized(label)):
        row = layout.row(align=True)
        cell = row.split(factor=share, align=True)
        cell.label(text=label)
        _right(cell, text)
        _copy(row, exact, unit)
    elif _fits(1.0, text):
        layout.label(text=label)
        row = layout.row(align=True)
        _right(row, text)
        _copy(row, exact, unit)
    else:
        number, _, name = text.rpartition(" ")
        row = layout.row(align=True)
        row.label(text="{:s} {:s}".format(localized(label), name), translate=False)
        _copy(row, exact, unit)
        _right(layout, number)


def _right(layout: UILayout, text: str) -> None:
    cell = layout.row(align=True)
    cell.alignment = "RIGHT"
    cell.label(text=text, translate=False)


def _copy(row: UILayout, exact: str, unit: str) -> None:
    button = row.operator(OBJECT_OT_body_moments_copy_value.bl_idname, text="", icon="COPYDOWN", emboss=False)
    button.value = exact
    button.unit = unit


def filled(layout: UILayout, template: str, *values: object, icon: str = "NONE") -> None:
    """A label that is filled after it was translated."""
    layout.label(text=localized(template).format(*values), icon=icon, translate=False)


def is_narrow(context: Context) -> bool:
    """Whether the region that is drawn has room for little more than words."""
    region = context.region
    return region is not None and 0 < region.width < NARROW * context.preferences.system.ui_scale


def button(layout: UILayout, context: Context, idname: str, icon: str, **options: str):
    """The button of an operator, without its icon where the words need the room."""
    return layout.operator(idname, icon="NONE" if is_narrow(context) else icon, **options)


def sentence(layout: UILayout, context: Context, text: str, icon: str = "NONE", boxed: bool = False) -> None:
    """A text, already translated, in as many lines as the region's width asks for. boxed: whether a box is around
    it."""
    column = layout.column(align=True)
    column.scale_y = 0.85
    width, size = _width(context)
    margin = int(BOX_MARGIN * context.preferences.system.ui_scale) if boxed else 0
    for i, line in enumerate(_wrapped(text, width - margin, size)):
        if icon == "NONE":
            column.label(text=line, translate=False)
        else:
            column.label(text=line, icon=icon if i == 0 else "BLANK1", translate=False)


def message(layout: UILayout, context: Context, shown: Finding, icon: str = "", boxed: bool = False) -> None:
    """The sentence of a finding. icon: by default that of its severity. boxed: as for `sentence`."""
    text = localized_sentence(shown, context.scene.unit_settings)
    sentence(layout, context, text, icon or ICONS[severity(shown)], boxed)


def stale_row(layout: UILayout, context: Context, code: str | None) -> None:
    """Why numbers no longer hold, where they do not."""
    if code is not None:
        row = layout.row()
        row.alert = True
        reason = localized_sentence(finding(code), context.scene.unit_settings)
        sentence(row, context, localized("Out of date: {:s}").format(reason), icon="FILE_REFRESH")


def _fits(share: float, *cells: str) -> bool:
    """Whether texts have place beside each other in that share of a row, beside its button, of the region that is being
    drawn."""
    if bpy.context.region is None:
        return True
    _, size = _width(bpy.context)
    blf.size(0, size)
    room = bpy.context.region.width - ROW_MARGIN * bpy.context.preferences.system.ui_scale
    return len(cells) * max(blf.dimensions(0, cell)[0] + 0.2 * size for cell in cells) <= share * room


def _width(context: Context) -> tuple[int, float]:
    """(pixels, font size in pixels) that a line has."""
    scale = context.preferences.system.ui_scale or 1.0  # 0 without a window
    region = context.region
    width = region.width if region is not None and region.width else DEFAULT_WIDTH * scale
    points = context.preferences.ui_styles[0].widget.points
    return max(int(width - REGION_MARGIN * scale), int(MIN_LINE_WIDTH * scale)), points * scale


@lru_cache(maxsize=256)
def _wrapped(text: str, width: int, size: float) -> tuple[str, ...]:
    blf.size(0, size)
    lines, line = [], ""
    for word in text.split(" "):  # not at the spaces inside numbers
        longer = "{:s} {:s}".format(line, word) if line else word
        if _is_within(longer, width):
            line = longer
            continue
        if line:
            lines.append(line)
        *parts, line = _parts(word, width)
        lines += parts
    return (*lines, line)


def _parts(word: str, width: int) -> list[str]:
    """A word that is longer than a line, in several; else itself."""
    parts, rest = [], word
    while len(rest) > MIN_PART and not _is_within(rest, width):
        end = len(rest) - 1
        while end > MIN_PART and not _is_within(rest[:end] + "-", width):
            end -= 1
        end = min(end, len(rest) - MIN_LAST_PART)
        parts.append(rest[:end] + "-")
        rest = rest[end:]
    return [*parts, rest]


def _is_within(text: str, width: int) -> bool:
    return blf.dimensions(0, text)[0] <= width
