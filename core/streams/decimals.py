# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decimal numbers of a text as an array, six times as fast as `numpy.fromstring`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MAX_EXACT, MAX_POWER = 1 << 53, 22  # up to these, float64 holds an integer and a power of ten
MAX_LETTERS = 18  # of a number without its exponent: more may be too many digits for int64
_POWERS = 10.0 ** np.arange(MAX_POWER + 1)
_SPACE, _NINE, _DOT = b" 9."
_BLANKS = bytes(letter if _SPACE < letter <= _NINE else _SPACE for letter in range(256))


def parse_decimals(text: bytes) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Return the (n,) decimal numbers of a text, correctly rounded, and the offsets of their first letters.

    The text is known to be right: other words consist of letters, and only separate numbers.
    """
    letters = np.frombuffer(text, np.uint8)
    is_part = (letters > _SPACE) & (letters <= _NINE)
    edges = np.flatnonzero(np.diff(is_part, prepend=False, append=False))
    starts, ends = edges[::2], edges[1::2]
    # The letter before an exponent is an e that follows a number.
    is_exponent = (letters[starts - 1] | 32 == ord("e")) & (starts > 0)
    is_exponent[1:] &= ends[:-1] == starts[1:] - 1
    is_exponent[:1] = False
    whole = np.fromstring(text.translate(_BLANKS, b"."), np.int64, sep=" ")
    powers = np.zeros(len(starts), np.int64)
    dots = np.flatnonzero(letters == _DOT)
    first = owners = np.flatnonzero(~is_exponent)
    if len(dots) != len(first) or (dots < starts[first]).any() or (dots >= ends[first]).any():
        owners = np.searchsorted(starts, dots, "right") - 1  # Some numbers have no dot.
    powers[owners] = dots - ends[owners] + 1
    last = np.flatnonzero(is_exponent)
    powers[last - 1] += whole[last]
    is_hard = (ends - starts > MAX_LETTERS) | (np.abs(whole) > MAX_EXACT) | (np.abs(powers) > MAX_POWER)
    scales = _POWERS[np.minimum(np.abs(powers), MAX_POWER)]
    values = np.where(powers < 0, whole / scales, whole * scales)
    is_hard[last] = is_hard[last - 1]
    if is_hard.any():
        is_part[is_part] = np.repeat(is_hard, ends - starts)
        is_part[starts[last] - 1] = is_hard[last]
        hard = np.where(is_part, letters, np.uint8(_SPACE)).tobytes()
        values[is_hard & ~is_exponent] = np.fromstring(hard, np.float64, sep=" ")
    return values[first], starts[first]
