# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of option values on the command line, with the messages for invalid ones. Standard library only."""

from __future__ import annotations

import argparse
import math

from ...core.verdict.finding import finding
from ...core.verdict.number_text import parse_number, parse_whole
from ..findings import (
    USAGE_COMMAND,
    USAGE_DENSITY_SOURCE,
    USAGE_FORMAT_UNKNOWN,
    USAGE_FREQUENCY_COUNT,
    USAGE_NOT_NUMBER,
    USAGE_NOT_POSITIVE,
    USAGE_NOT_POSITIVE_TRIPLE,
    USAGE_NOT_TRIPLE,
    USAGE_ORDER,
    USAGE_ORDER_TOO_HIGH,
    USAGE_POSITIONS,
    USAGE_RANGE,
    USAGE_SPLINE_ORDER,
)
from .formats import FORMATS

# Equal to the values in the core, which needs numpy: the process that supervises others may have none.
MAX_ORDER = 30
MAX_SPLINE_ORDER = 16
MAX_GRID = 256  # frequencies along an axis: its arrays take a few gigabytes


def _refuse(code: str, **values: object) -> argparse.ArgumentTypeError:
    return argparse.ArgumentTypeError(str(finding(code, **values)))


def command(text: str) -> str:
    """Return the one command that these options belong to."""
    if text != "measure":
        raise _refuse(USAGE_COMMAND, name=text)
    return text


def _float(text: str) -> float:
    """Return the number, or NaN for other text."""
    try:
        return parse_number(text.strip())
    except ValueError:
        return math.nan


def _int(text: str) -> int:
    """Return the whole number, or -1 for other text."""
    try:
        return parse_whole(text.strip())
    except ValueError:
        return -1


def positive(text: str) -> float:
    """Return a positive number."""
    value = _float(text)
    if not (0.0 < value < math.inf):
        raise _refuse(USAGE_NOT_POSITIVE, text=text)
    return value


def number(text: str) -> float:
    """Return a finite number."""
    value = _float(text)
    if not math.isfinite(value):
        raise _refuse(USAGE_NOT_NUMBER, text=text)
    return value


def count(text: str) -> int:
    """Return a positive whole number."""
    if not (text.isdecimal() and text.isascii() and int(text[:9]) > 0 and len(text) <= 9):
        raise _refuse(USAGE_NOT_POSITIVE, text=text)
    return int(text)


def triple(text: str) -> tuple[float, ...]:
    """Three finite numbers."""
    values = tuple(map(_float, text.split(",")))
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise _refuse(USAGE_NOT_TRIPLE, text=text)
    return values


def spacing(text: str) -> tuple[float, ...]:
    """Three positive numbers."""
    values = triple(text)
    if min(values) <= 0.0:
        raise _refuse(USAGE_NOT_POSITIVE_TRIPLE, text=text)
    return values


def positions(text: str) -> tuple[str, str]:
    """AXIS=FILE, the positions of samples along x, y or z."""
    axis, equals, path = text.partition("=")
    if axis not in ("x", "y", "z") or not equals or not path:
        raise _refuse(USAGE_POSITIONS, text=text)
    return axis, path


def spline_order(text: str) -> int:
    """Return the order of a spline of samples."""
    if text not in {str(order) for order in range(1, MAX_SPLINE_ORDER + 1)}:
        raise _refuse(USAGE_SPLINE_ORDER, text=text, limit=MAX_SPLINE_ORDER)
    return int(text)


def order(text: str) -> int:
    """Return the order of moments."""
    value = _int(text)
    if value < 0:
        raise _refuse(USAGE_ORDER, text=text, limit=MAX_ORDER)
    if value > MAX_ORDER:
        raise _refuse(USAGE_ORDER_TOO_HIGH, text=text, limit=MAX_ORDER)
    return value


def frequencies(text: str) -> int:
    """Return the number of frequencies of a grid along an axis."""
    value = _int(text)
    if not 2 <= value <= MAX_GRID:
        raise _refuse(USAGE_FREQUENCY_COUNT, text=text, limit=MAX_GRID)
    return value


def format_name(text: str) -> str:
    """Return the name of a format of results."""
    if text not in FORMATS:
        raise _refuse(USAGE_FORMAT_UNKNOWN, text=text, formats=", ".join(FORMATS))
    return text


ABOUT = ("center", "origin", "world")
SOURCES = ("value", "materials", "attribute", "volume")  # sources of density, as in the panel
_NAMED_SOURCES = ("attribute", "volume")


def about(text: str) -> str | tuple[float, ...]:
    """Return a point by its name or its coordinates."""
    return text if text in ABOUT else triple(text)


def split_source(text: str) -> tuple[str, str]:
    """Return a source of density, and the name behind it."""
    source, _, name = text.partition(":")
    return source, name


def source(text: str) -> str:
    """Return the source of a density: a word, followed by a name if it needs one."""
    word, name = split_source(text)
    if word not in SOURCES or bool(name) != (word in _NAMED_SOURCES):
        raise _refuse(USAGE_DENSITY_SOURCE, text=text)
    return text


def file_range(text: str) -> tuple[int, int | None]:
    """A:B, the files from number A on and before number B, counted from 0; either may be left out."""
    begin, colon, end = text.partition(":")
    if not colon or not all(part.isascii() and (part.isdecimal() or not part) for part in (begin, end)):
        raise _refuse(USAGE_RANGE, text=text)
    first, last = int(begin or 0), int(end) if end else None
    if last is not None and last < first:
        raise _refuse(USAGE_RANGE, text=text)
    return first, last
