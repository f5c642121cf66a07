# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts of a narrow panel: sentences that wrap, and whether texts fit.

Blender translates labels as it draws them: constant labels are passed as in the source, filled ones
are translated before that (`filled`, `message`). Names, numbers and filled texts are drawn without
translation.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache, partial

import blf
import bpy
from bpy.types import UILayout

from ..blender import write
from ..blender.write.translations import localized
from ..core import verdict

REGION_MARGIN = 88  # width of tabs, borders and an icon in the region, in unscaled pixels
ROW_MARGIN = 80  # width for a row without an icon, but with a button
TEXT_MARGIN = 0.2  # space around a text in a row, relative to the font size
DEFAULT_WIDTH = 300  # unscaled pixels, for a region of unknown width
BOX_MARGIN = 12  # additional width of a box
MIN_LINE_WIDTH = 50  # no line is made narrower
# letters of a word that is broken
MIN_PART = 4
MIN_LAST_PART = 3
NARROW = 220  # regions below this width have buttons without icons, and headings above
# ERROR is Blender's warning sign
ICONS = {
    verdict.Severity.NOTE: "INFO",
    verdict.Severity.WARNING: "ERROR",
    verdict.Severity.ERROR: "CANCEL",
}


def title(layout: UILayout, label: str) -> None:
    """Draw a label above rows, in several lines if the panel is too narrow for one."""
    headline(layout, localized(label))


def headline(layout: UILayout, text: str) -> None:
    """Draw a translated text above rows, as `title` does."""
    room = find_room()
    if room is None or length(text) <= room:
        layout.label(text=text, translate=False)
    else:
        sentence(layout, text)


def filled(layout: UILayout, template: str, *values: object, icon: str = "NONE") -> None:
    """Draw a label that is filled after its translation."""
    layout.label(text=localized(template).format(*values), icon=icon, translate=False)


def scene_units() -> write.units.Units:
    """Return the units of the scene that is shown."""
    return write.units.Units.from_settings(bpy.context.scene.unit_settings)


def is_narrow() -> bool:
    """Return whether the region has room for little more than words."""
    region = bpy.context.region
    return (
        region is not None and 0 < region.width < NARROW * bpy.context.preferences.system.ui_scale
    )


def sentence(layout: UILayout, text: str, icon: str = "NONE", boxed: bool = False) -> None:
    """Draw a translated text, wrapped to the region's width. boxed: a box is around it."""
    column = layout.column(align=True)
    column.scale_y = 0.85
    width, size = _width()
    margin = int(BOX_MARGIN * bpy.context.preferences.system.ui_scale) if boxed else 0
    for i, line in enumerate(_wrapped(text, width - margin, size)):
        if icon == "NONE":
            column.label(text=line, translate=False)
        else:
            column.label(text=line, icon=icon if i == 0 else "BLANK1", translate=False)


def message(
    layout: UILayout, finding: verdict.Finding, icon: str = "", boxed: bool = False
) -> None:
    """Draw the sentence of a finding, with the number of its elements instead of their indices.

    icon: by default that of its severity. boxed: as for `sentence`.
    """
    text = write.translations.localized_sentence(
        replace(finding, elements=()), bpy.context.scene.unit_settings
    )
    sentence(layout, text, icon or ICONS[verdict.severity(finding)], boxed)


def remark(
    layout: UILayout, text: str, /, icon: str = "INFO", boxed: bool = False, **values: object
) -> None:
    """Draw an interface text, translated, filled and wrapped."""
    sentence(
        layout,
        verdict.fill(text, None, values, localized, partial(scene_units().text, "length")),
        icon,
        boxed,
    )


def state(layout: UILayout, text: str, icon: str = "") -> None:
    """Draw one row about the state of numbers.

    It is there without a text too, so that nothing below it moves.
    """
    row = layout.row()
    row.alert = icon == "FILE_REFRESH"
    row.label(text=text, icon=icon or "BLANK1", translate=False)


def stale_state(layout: UILayout, reason: str | None) -> None:
    """Draw one row, always, with the reason why numbers are out of date, if any."""
    state(layout, outdated(reason) if reason else "", "FILE_REFRESH" if reason else "")


def outdated(reason: str) -> str:
    """Return the translated sentence on why numbers are out of date."""
    return localized("Out of date: {:s}").format(localized(reason))


def fits(share: float, *cells: str) -> bool:
    """Return whether texts fit side by side, in cells of equal width, in this share of a row of the
    region being drawn, without the row's button.
    """
    room = find_room()
    return room is None or len(cells) * max(map(length, cells)) <= share * room


def find_room() -> float | None:
    """Return the width in pixels of a row without its button, or None if no region is being
    drawn.
    """
    if bpy.context.region is None:
        return None
    return bpy.context.region.width - ROW_MARGIN * bpy.context.preferences.system.ui_scale


def length(text: str) -> float:
    """Return the width in pixels of a text, with the space around it."""
    _, size = _width()
    blf.size(0, size)
    return blf.dimensions(0, text)[0] + TEXT_MARGIN * size


def _width() -> tuple[int, float]:
    """Return the width of a line and the font size, in pixels."""
    region = bpy.context.region
    preferences = bpy.context.preferences
    scale = preferences.system.ui_scale or 1.0  # 0 without a window
    width = region.width if region is not None and region.width else DEFAULT_WIDTH * scale
    points = preferences.ui_styles[0].widget.points
    return max(int(width - REGION_MARGIN * scale), int(MIN_LINE_WIDTH * scale)), points * scale


@lru_cache(maxsize=256)
def _wrapped(text: str, width: int, size: float) -> tuple[str, ...]:
    # width and font size are in pixels
    blf.size(0, size)
    lines = []
    line = ""
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
    """Split a word that is longer than a line, of this width in pixels; return a shorter one
    unchanged.
    """
    parts = []
    rest = word
    while len(rest) > MIN_PART and not _is_within(rest, width):
        end = len(rest) - MIN_LAST_PART
        while end > MIN_PART and not _is_within(rest[:end] + "-", width):
            end -= 1
        parts.append(rest[:end] + "-")
        rest = rest[end:]
    return [*parts, rest]


def _is_within(text: str, width: int) -> bool:
    return blf.dimensions(0, text)[0] <= width
