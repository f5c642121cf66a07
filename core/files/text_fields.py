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

# Numbers from this one on are infinite in float32: it is halfway between the largest of these,
# 2^128 - 2^104, and 2^128, and rounds to the latter.
MAX_FLOAT32 = 3.4028235677973366e38
MAX_TEXT = 60  # letters of a line that are shown
BLOCK = 1 << 18  # bytes
MARK = b"\xef\xbb\xbf"  # byte order mark
# Decimal numbers that are so short that they are below 1e38 without being computed: less than 1e8,
# times 1e29 at most; the same, or NaN; whole numbers that fit into int64. A repeated group is held
# by (?>...): Python before 3.11.5 lets a group with *+, ++ or ?+
# match more than the group itself does (python/cpython#106052).
SHORT = (
    rb"[+-]?(?:[0-9]{1,8}+(?>(?:\.[0-9]*+)?)|\.[0-9]++)"
    rb"(?>(?:[eE](?:-[0-9]++|\+?0?[0-2]?[0-9]))?)"
)
SHORT_OR_NAN = rb"(?:" + SHORT + rb"|[+-]?[nN][aA][nN])"
SHORT_WHOLE = rb"[+-]?[0-9]{1,18}+"
# forms that C prints
_NOT_FINITE = re.compile(rb"[+-]?(?:nan|inf|infinity|nan\([\w]*\)|1\.#\w+)", re.IGNORECASE)
_SPACE, _NINE = b" 9"

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
    float32, too; if it is False, C's forms of NaN and infinity are numbers.
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
    """Return the beginning of a text for a message. A letter has four bytes at most."""
    return text[: 4 * MAX_TEXT].decode("utf-8", "replace")[:MAX_TEXT]


def refuse_line(data: Data, at: int, fault: Fault) -> NoReturn:
    """Raise the FileError about the line that contains the offset `at`."""
    line = 1 + sum(
        data[start : min(start + BLOCK, at)].count(b"\n") for start in range(0, at, BLOCK)
    )
    raise FileError(LINE_MISREAD, line=line, text=fault[0], expected=fault[1])


def parse_decimals(text: bytes) -> tuple[Array, Index]:
    """Return the (n,) decimal numbers of a text, and the offsets of their first letters.

    Words of letters separate numbers. ValueError if another word is no number, or touches a letter.
    """
    letters = np.frombuffer(text, np.uint8)
    before = np.append(np.uint8(_SPACE), letters[:-1])
    # Digits, signs and points are between the space and the nine. The other characters there are
    # refused by NumPy.
    is_part = (letters > _SPACE) & (letters <= _NINE)
    follows = (before > _SPACE) & (before <= _NINE)
    is_exponent = follows & ((letters | 32) == ord("e"))  # 32: lower case
    starts = np.flatnonzero(is_part & (before <= _SPACE))
    words = np.where(is_part | is_exponent, letters, np.uint8(_SPACE)).tobytes().split()
    # A number behind a letter is a word without a start; the rest finds a letter behind a number.
    if len(words) != len(starts) or (follows & (letters > _NINE) & ~is_exponent).any():
        raise ValueError("no decimal numbers")
    return np.array(words, np.float64), starts
