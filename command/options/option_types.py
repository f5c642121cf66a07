# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of option values on the command line, with the messages for invalid ones.

Standard library only.
"""

import math
from argparse import ArgumentTypeError
from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

from ...core import density, files, robots
from ...core.measurement import PrintSettings, documents
from ..parser import COMMANDS

# Equal to the values in the core, which needs numpy: the process that supervises others may have
# none.
MAX_ORDER = 30
MAX_SPLINE_ORDER = 16
MAX_FRAME = 1_048_574  # Blender's limit
MIN_HEEL_STEP = 0.1  # degrees: 3601 angles at most
MAX_GRID = 256  # frequencies along an axis: its arrays take a few gigabytes
T = TypeVar("T")
ABOUT = ("center", "origin", "world")
# Sources of density: True if a colon and a name follow.
_NAMED = {
    "value": False,
    "materials": False,
    "attribute": True,
    "volume": True,
}


# Functions from documents, which may be iterated twice, to pieces of text. Robots are written by
# the processes that measure the files.
FORMATS = documents.FORMATS | dict.fromkeys(
    robots.FORMATS, lambda files: (document.get("robot", "") for document in files)
)


def command(text: str) -> str:
    """Return the text if it is “measure”, the command of these options."""
    if text != "measure":
        raise ArgumentTypeError("“{}” is no command: {} are".format(text, ", ".join(COMMANDS)))
    return text


def _checked(
    read: Callable[[str], T], description: str, holds: Callable[[T], bool] = lambda _: True
) -> Callable[[str], T]:
    """Return a parser of a text. It raises ArgumentTypeError, which names the description, if
    `read` raises ValueError or the value does not hold.
    """

    def parse(text: str) -> T:
        with suppress(ValueError):
            value = read(text)
            if holds(value):
                return value
        raise ArgumentTypeError("{!r} is not {}".format(text, description))

    return parse


def _float(text: str) -> float:
    return files.parse_number(text.strip())


def _floats(text: str) -> tuple[float, ...]:
    return tuple(map(_float, text.split(",")))


def _whole(text: str) -> int:
    return files.parse_whole(text.strip())


def _bounded(name: str, least: int, most: int) -> Callable[[str], int]:
    """Return a function that parses a whole number within limits, called `name` in messages."""
    description = "{} from {} to {}".format(name, least, most)
    return _checked(_whole, description, lambda value: least <= value <= most)


order = _bounded("an order", 0, MAX_ORDER)
spline_order = _bounded("an order", 1, MAX_SPLINE_ORDER)
frequencies = _bounded("a number of frequencies", 2, MAX_GRID)
count = _bounded("a whole number", 1, 10**9 - 1)
positive = _checked(_float, "a positive number", lambda value: 0.0 < value < math.inf)
number = _checked(_float, "a finite number", math.isfinite)
scene_frame = _checked(  # need not be whole
    _float,
    "a frame from {} to {}".format(-MAX_FRAME, MAX_FRAME),
    lambda value: abs(value) <= MAX_FRAME,
)
triple = _checked(
    _floats,
    "three numbers X,Y,Z",
    lambda values: len(values) == 3 and all(map(math.isfinite, values)),
)
spacing = _checked(
    _floats,
    "three positive numbers X,Y,Z",
    lambda values: len(values) == 3 and all(0.0 < value < math.inf for value in values),
)
label = _checked(lambda text: text if text == "all" else _whole(text), "a whole number or all")
# A sample's axis, and the file of positions along it.
positions = _checked(
    lambda text: text.partition("=")[::2],
    "x=FILE.npy, y=FILE.npy or z=FILE.npy",
    lambda pair: pair[0] in ("x", "y", "z") and pair[1] != "",
)
format_name = _checked(str, "one of " + ", ".join(FORMATS), FORMATS.__contains__)
source = _checked(
    str,
    "value, materials, attribute:NAME or volume:NAME",
    lambda text: _NAMED.get(split_source(text)[0]) is bool(split_source(text)[1]),
)


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


def liquid(text: str) -> float:
    """Return the density of a liquid, kg/m³, from its name or as a number."""
    liquids = {
        name: preset for name, preset in density.BY_NAME.items() if preset.category == "Liquids"
    }
    densities = {
        alias.casefold(): material.density
        for name, material in liquids.items()
        for alias in (name, name.partition(",")[0])
    }
    return _checked(
        lambda text: densities.get(text.casefold()) or _float(text),
        "a density from 1e-3 to 1e6, nor one of " + "; ".join(liquids),
        lambda value: 1e-3 <= value <= 1e6,
    )(text)


def heel_angles(text: str) -> tuple[float, ...]:
    """Return the angles of A:B:STEP, in degrees."""
    description = "A:B:STEP, angles from -180 to 180 in steps of at least {}".format(MIN_HEEL_STEP)
    first, last, step = _checked(
        lambda text: tuple(map(_float, text.split(":"))),
        description,
        lambda parts: (
            len(parts) == 3
            and -180.0 <= parts[0] <= parts[1] <= 180.0
            and MIN_HEEL_STEP <= parts[2] < math.inf
        ),
    )(text)
    # Chosen: the last angle is B if the rounding of the quotient, of the order of 1e-13 for 3600
    # steps, alone prevents it.
    count = math.floor((last - first) / step + 1e-9) + 1
    return tuple(first + i * step for i in range(count))


def _ends(text: str) -> tuple[int, int | None]:
    begin, end = text.split(":")
    return _whole(begin or "0"), _whole(end) if end else None


# The files from number A up to B - 1, counted from 0.
file_range = _checked(
    _ends,
    "A:B, two whole numbers, of which B is no smaller",
    lambda ends: 0 <= ends[0] <= (ends[0] if ends[1] is None else ends[1]),
)
