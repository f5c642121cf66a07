# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of option values on the command line, with the messages for invalid ones.

Standard library only.
"""

import math
from argparse import ArgumentTypeError
from collections.abc import Callable

from ...core import density, files, robots
from ...core.measurement import PrintSettings, documents
from ..parser import COMMANDS

# Equal to the values in the core, which needs numpy: the process that supervises others may have
# none.
MAX_ORDER = 30
MAX_SPLINE_ORDER = 16
MAX_FRAME = 1_048_574  # Blender's limit
MIN_HEEL_STEP = 0.1  # degrees
MAX_GRID = 256  # frequencies along an axis: its arrays take a few gigabytes
ABOUT = ("center", "origin", "world")
# by source: True if a name follows
_NAMED = {
    "value": False,
    "materials": False,
    "attribute": True,
    "volume": True,
}


# Functions from documents, which may be iterated twice, to pieces of text. Robots are written by
# the processes that measure the files.
FORMATS = documents.FORMATS | dict.fromkeys(
    robots.FORMATS, lambda of_files: (one.get("robot", "") for one in of_files)
)


def command(text: str) -> str:
    """Return the text if it is “measure”, the command of these options."""
    if text != "measure":
        raise ArgumentTypeError("“{}” is no command: {} are".format(text, ", ".join(COMMANDS)))
    return text


def _float(text: str) -> float:
    """Return the number, or NaN for other text."""
    try:
        return files.parse_number(text.strip())
    except ValueError:
        return math.nan


def _bounded(name: str, least: int, most: int) -> Callable[[str], int]:
    """Return a function that parses a whole number within limits. name: the number, as messages
    name it.
    """

    def parse(text: str) -> int:
        try:
            value = files.parse_whole(text.strip())
        except ValueError:
            value = least - 1
        if not least <= value <= most:
            raise ArgumentTypeError("{!r} is not {} from {} to {}".format(text, name, least, most))
        return value

    return parse


order = _bounded("an order", 0, MAX_ORDER)
spline_order = _bounded("an order", 1, MAX_SPLINE_ORDER)
frequencies = _bounded("a number of frequencies", 2, MAX_GRID)
count = _bounded("a whole number", 1, 10**9 - 1)


def positive(text: str) -> float:
    """Return a positive number."""
    value = _float(text)
    if not (0.0 < value < math.inf):
        raise ArgumentTypeError("{!r} is not a positive number".format(text))
    return value


def number(text: str) -> float:
    """Return a finite number."""
    value = _float(text)
    if not math.isfinite(value):
        raise ArgumentTypeError("{!r} is not a finite number".format(text))
    return value


def scene_frame(text: str) -> float:
    """Return a frame of a scene, which need not be whole."""
    value = _float(text)
    if not abs(value) <= MAX_FRAME:
        raise ArgumentTypeError(
            "{!r} is not a frame from {} to {}".format(text, -MAX_FRAME, MAX_FRAME)
        )
    return value


def triple(text: str) -> tuple[float, ...]:
    """Return three finite numbers."""
    values = tuple(map(_float, text.split(",")))
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise ArgumentTypeError("{!r} is not three numbers X,Y,Z".format(text))
    return values


_PRINT_DEFAULTS = PrintSettings()._asdict()
del _PRINT_DEFAULTS["pocket"]


def print_settings(text: str) -> tuple[tuple[str, float], ...]:
    """Return the pairs of NAME=VALUE,…, settings of a print."""
    pairs = []
    for part in text.split(","):
        name, _, value = part.partition("=")
        is_count = isinstance(_PRINT_DEFAULTS.get(name), int)
        if name not in _PRINT_DEFAULTS or (is_count and not value.isdecimal()):
            names = ", ".join(_PRINT_DEFAULTS)
            message = "{!r} is not NAME=VALUE with one of {}; walls and layers are whole numbers"
            raise ArgumentTypeError(message.format(part, names))
        pairs.append((name, int(value) if is_count else number(value)))
    return tuple(pairs)


def label(text: str) -> int | str:
    """Return the number of a label, or “all”."""
    try:
        return text if text == "all" else files.parse_whole(text.strip())
    except ValueError:
        raise ArgumentTypeError("{!r} is not a whole number or all".format(text)) from None


def spacing(text: str) -> tuple[float, ...]:
    """Return three positive numbers."""
    values = triple(text)
    if min(values) <= 0.0:
        raise ArgumentTypeError("{!r} is not three positive numbers X,Y,Z".format(text))
    return values


def positions(text: str) -> tuple[str, str]:
    """Return AXIS=FILE, the positions of samples along x, y or z, as a pair."""
    axis, _, path = text.partition("=")
    if axis not in ("x", "y", "z") or not path:
        raise ArgumentTypeError("{!r} is not x=FILE.npy, y=FILE.npy or z=FILE.npy".format(text))
    return axis, path


def format_name(text: str) -> str:
    """Return the name of a format of results."""
    if text not in FORMATS:
        raise ArgumentTypeError("{!r} is not one of {}".format(text, ", ".join(FORMATS)))
    return text


def about(text: str) -> str | tuple[float, ...]:
    """Return a point: one of the names in `ABOUT`, or three coordinates."""
    return text if text in ABOUT else triple(text)


def against(text: str) -> float | str:
    """Return a height, or the name of an object, or `rim`."""
    try:
        return number(text)
    except ArgumentTypeError:
        return text


def split_source(text: str) -> tuple[str, str]:
    """Return a source of density, and the name after its colon, or an empty text."""
    source, _, name = text.partition(":")
    return source, name


def source(text: str) -> str:
    """Return `value`, `materials`, `attribute:NAME` or `volume:NAME`; raise ArgumentTypeError for
    other texts.
    """
    word, name = split_source(text)
    if _NAMED.get(word) is not bool(name):
        raise ArgumentTypeError(
            "{!r} is not value, materials, attribute:NAME or volume:NAME".format(text)
        )
    return text


def liquid(text: str) -> float:
    """Return the density of a liquid, kg/m³, from its name or as a number."""
    liquids = {name: one for name, one in density.BY_NAME.items() if one.category == "Liquids"}
    for name, material in liquids.items():
        if text.casefold() in (name.casefold(), name.partition(",")[0].casefold()):
            return material.density
    value = _float(text)
    if not (1e-3 <= value <= 1e6):
        names = "; ".join(liquids)
        raise ArgumentTypeError(
            f"{text!r} is neither a density from 1e-3 to 1e6 nor one of {names}"
        )
    return value


def heel_angles(text: str) -> tuple[float, ...]:
    """Return the angles of A:B:STEP, in degrees."""
    parts = [*map(_float, text.split(":"))]
    if len(parts) == 3 and all(map(math.isfinite, parts)):
        first, last, step = parts
        if -180.0 <= first <= last <= 180.0 and step >= MIN_HEEL_STEP:
            count = math.floor((last - first) / step + 1e-9) + 1
            return tuple(first + i * step for i in range(count))
    raise ArgumentTypeError(
        "{!r} is not A:B:STEP, angles from -180 to 180 in steps of at least {}".format(
            text, MIN_HEEL_STEP
        )
    )


def file_range(text: str) -> tuple[int, int | None]:
    """Return A and B of A:B, the files from number A up to B - 1, counted from 0; 0 and None if
    left out.
    """
    begin, colon, end = text.partition(":")
    if not colon or not all(
        part.isascii() and (part.isdecimal() or not part) for part in (begin, end)
    ):
        raise ArgumentTypeError("{!r} is not A:B, two whole numbers".format(text))
    first = int(begin or 0)
    last = int(end) if end else None
    if last is not None and last < first:
        raise ArgumentTypeError("{!r} ends before it begins".format(text))
    return first, last
