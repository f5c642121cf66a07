# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that Blender stores as float32 and a person typed as decimals.

Read while panels draw: without numpy.
"""

from functools import lru_cache
from struct import pack

FLOAT32_MAX = 3e38  # larger numbers, rounded to fewer digits, may leave the range of float32


@lru_cache(maxsize=1024)  # settings, read at every redraw
def shortest_decimal(value: float) -> float:
    """Return the shortest decimal that is stored as this float32: 0.001 for
    0.0010000000474974513.
    """
    if abs(value) < FLOAT32_MAX:
        stored = pack("f", value)
        for digits in range(1, 9):
            decimal = float("{:.{}g}".format(value, digits))
            if pack("f", decimal) == stored:
                return decimal
    return float("{:.9g}".format(value))
