# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of text files: decimal numbers as arrays; refusals, with line and text, of fields that
would be misread.

Most lines match a regular expression that allows only short numbers; all others are checked word by
word.
"""

import mmap
import re
from pathlib import Path
from typing import NoReturn

import numpy as np

from ..numerics import Array, Index
from ..verdict import FileError
from .findings import LINE_MISREAD
from .number_text import parse_number, parse_whole

MAX_FLOAT32 = 3.4028235677973366e38  # larger numbers are infinite in float32
MAX_TEXT = 60  # letters of a line that are shown
BLOCK = 1 << 18  # bytes
MARK = b"\xef\xbb\xbf"  # byte order mark
# Decimal numbers that are so short that they are below 1e38 without being computed; the same, or
# NaN. A repeated group is held by (?>...): Python before 3.11.5 lets a group with *+, ++ or ?+
# match more than the group itself does (python/cpython#106052).
SHORT = (
    rb"[+-]?(?:[0-9]{1,8}+(?>(?:\.[0-9]*+)?)|\.[0-9]++)"
    rb"(?>(?:[eE](?:-[0-9]++|\+?0?[0-2]?[0-9]))?)"
)
SHORT_OR_NAN = rb"(?:" + SHORT + rb"|[+-]?[nN][aA][nN])"
SHORT_WHOLE = rb"[+-]?[0-9]{1,18}+"
# forms that C prints
_NOT_FINITE = re.compile(rb"[+-]?(?:nan|inf|infinity|nan\([\w]*\)|1\.#\w+)", re.IGNORECASE)
MAX_POWER = 22  # up to this float64 holds a power of ten
MAX_WHOLE = 1e18  # int64 holds smaller numbers, and replaces larger ones by its largest
_POWERS = 10.0 ** np.arange(MAX_POWER + 1)
_SPACE, _NINE, _DOT = b" 9."
_BLANKS = bytes(letter if _SPACE < letter <= _NINE else _SPACE for letter in range(256))

# Words for the field that a line should have.
NUMBER = "a finite decimal number"
WHOLE = "a whole number"
VERTEX = "the number of an existing vertex"
COUNT = "a line with more or fewer numbers"
Data = mmap.mmap | bytes
Fault = tuple[str, str]  # the text of a line, and the word for the text that should stand there


def map_file(path: str | Path) -> mmap.mmap:
    """Return the mapped bytes of a file, which must not be empty."""
    with open(path, "rb") as file:
        return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)


def find_number_fault(word: bytes, places_point: bool) -> Fault | None:
    """Return the fault of a word that is no number, or None. places_point: it must be finite in
    float32, too.
    """
    try:
        value = parse_number(word.decode("utf-8", "replace"))
    except ValueError:
        is_number = not places_point and _NOT_FINITE.fullmatch(word) is not None
    else:
        is_number = not places_point or abs(value) < MAX_FLOAT32
    return None if is_number else (shorten(word), NUMBER)


def find_whole_fault(word: bytes) -> Fault | None:
    """Return the fault of a word that is no whole number, or None."""
    try:
        parse_whole(word.decode("utf-8", "replace"))
    except ValueError:
        return shorten(word), WHOLE
    return None


def count_fault(words: list[bytes]) -> Fault:
    """Return the fault of a line with too few or too many fields."""
    return shorten(b" ".join(words)), COUNT


def shorten(text: bytes) -> str:
    """Return the beginning of a text for a message."""
    return text[: 4 * MAX_TEXT].decode("utf-8", "replace")[:MAX_TEXT]


def refuse_line(data: Data, at: int, fault: Fault) -> NoReturn:
    """Raise the FileError about the line that contains the offset `at`."""
    line = 1 + sum(
        data[start : min(start + BLOCK, at)].count(b"\n") for start in range(0, at, BLOCK)
    )
    raise FileError(LINE_MISREAD, line=line, text=fault[0], expected=fault[1])


def parse_decimals(text: bytes) -> tuple[Array, Index, int]:
    """Return the (n,) decimal numbers of a text, the offsets of their first letters, and the count
    of exponents.

    Numbers of up to 15 digits that need no higher power of ten than 22 are correctly rounded,
    others to two units in the last place. Words of letters separate numbers. ValueError if another
    word is no number, or touches a letter.
    """
    letters = np.frombuffer(text, np.uint8)
    is_part = (letters > _SPACE) & (letters <= _NINE)
    edges = np.flatnonzero(np.diff(is_part, prepend=False, append=False))
    starts = edges[::2]
    ends = edges[1::2]
    # The letter before an exponent is an e that follows a number.
    is_exponent = (letters[starts - 1] | 32 == ord("e")) & (starts > 0)
    is_exponent[1:] &= ends[:-1] == starts[1:] - 1
    is_exponent[:1] = False
    is_sign = (letters == ord("+")) | (letters == ord("-"))
    has_sign = is_sign[starts]
    before = np.where(starts > 0, letters[starts - 1], _SPACE)
    after = np.append(letters, np.uint8(_SPACE))[ends]
    touches = (before[~is_exponent] > _SPACE).any() or np.count_nonzero(
        after > _SPACE
    ) != np.count_nonzero(is_exponent)
    if (
        touches
        or (is_exponent[1:] & is_exponent[:-1]).any()
        or np.count_nonzero(is_sign) != np.count_nonzero(has_sign)
    ):
        raise ValueError("no decimal numbers")
    whole = np.fromstring(text.translate(_BLANKS, b"."), np.int64, sep=" ")
    powers = np.zeros(len(starts), np.int64)
    dots = np.flatnonzero(letters == _DOT)
    first = owners = np.flatnonzero(~is_exponent)
    if len(dots) != len(first) or (dots < starts[first]).any() or (dots >= ends[first]).any():
        owners = np.searchsorted(starts, dots, "right") - 1  # Not every number has a dot.
    powers[owners] = dots - ends[owners] + 1
    digits = ends - starts - has_sign
    digits[owners] -= 1
    if (np.diff(owners) < 1).any() or is_exponent[owners].any() or digits.min(initial=1) < 1:
        raise ValueError("no decimal numbers")
    last = np.flatnonzero(is_exponent)
    powers[last - 1] += whole[last]
    values = whole.astype(np.float64)
    left = np.abs(powers)
    is_hard = (np.abs(values) >= MAX_WHOLE) | (left > 2 * MAX_POWER)
    left = np.minimum(left, 2 * MAX_POWER)
    while left.any():
        scales = _POWERS[np.minimum(left, MAX_POWER)]
        values = np.where(powers < 0, values / scales, values * scales)
        left = np.maximum(left - MAX_POWER, 0)
    is_hard[last] = is_hard[last - 1]
    if is_hard.any():
        is_part[is_part] = np.repeat(is_hard, ends - starts)
        is_part[starts[last] - 1] = is_hard[last]
        hard = np.where(is_part, letters, np.uint8(_SPACE)).tobytes()
        values[is_hard & ~is_exponent] = np.fromstring(hard, np.float64, sep=" ")
    return values[first], starts[first], len(last)
