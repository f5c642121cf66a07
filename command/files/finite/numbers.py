# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of numbers, as binary files have them."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from ....core.streams.findings import NON_FINITE_COORDINATES
from ....core.streams.misread import MAX_FLOAT32
from ....core.verdict.finding import FileError, Finding

BLOCK = 1 << 18  # Numbers at a time, so that arrays computed from them stay in the cache.
MALFORMED = (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError, struct.error, zlib.error)


def refuse(count: int, place: Finding) -> None:
    if count:
        raise FileError(NON_FINITE_COORDINATES, count=count, place=place.as_record())


def bad_in_table(rows: NDArray) -> tuple[int, int]:
    """Return the count of numbers in (n, k) that are not finite in float32, and the first row with such a number."""
    if rows.dtype.kind != "f":
        return 0, 0
    count, first = 0, 0
    step = max(1, BLOCK // (8 * rows.shape[1]))
    with np.errstate(over="ignore", invalid="ignore"):
        for start in range(0, len(rows), step):
            block = np.ascontiguousarray(rows[start : start + step])
            # A block's smallest and largest are NaN where one of its numbers is.
            if block.max() < MAX_FLOAT32 and block.min() > -MAX_FLOAT32:
                continue
            bad = ~(np.abs(block) < MAX_FLOAT32)
            if not count:
                first = start + int(np.argmax(bad.any(axis=1)))
            count += int(np.count_nonzero(bad))
    return count, first
