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

BLOCK = 1 << 18  # bytes at a time
MALFORMED = (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError, struct.error, zlib.error)


def refuse(count: int, place: Finding) -> None:
    if count:
        raise FileError(NON_FINITE_COORDINATES, count=count, place=place.as_record())


def bad_in_table(rows: NDArray) -> tuple[int, int]:
    """Return the count of numbers in (n, k) that are not finite in float32, and the first row with such a number."""
    with np.errstate(over="ignore", invalid="ignore"):
        # The smallest and the largest are NaN if one of the numbers is.
        if rows.dtype.kind != "f" or not rows.size or rows.max() < MAX_FLOAT32 and rows.min() > -MAX_FLOAT32:
            return 0, 0
        bad = ~(np.abs(rows) < MAX_FLOAT32)
    return int(np.count_nonzero(bad)), int(np.argmax(bad.any(axis=1)))
