# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that Blender stores as float32 and a person typed as decimals."""

from __future__ import annotations

from array import array
from functools import lru_cache


@lru_cache(maxsize=1024)  # settings, read at every redraw
def shortest_decimal(value: float) -> float:
    """Return the shortest decimal that is stored as this float32.

    Parameters
    ----------
    value : float
        A number that was stored as float32, such as a Blender property.

    Returns
    -------
    float
        0.001 if float32 has 0.0010000000474974513.

    Examples
    --------
    >>> from body_moments.core.numerics import shortest_decimal
    >>> shortest_decimal(0.0010000000474974513)
    0.001
    """
    stored = _as_float32(value)
    for digits in range(1, 9):
        decimal = float("{:.{:d}g}".format(stored, digits))
        if _as_float32(decimal) == stored:
            return decimal
    return float("{:.9g}".format(stored))


def _as_float32(value: float) -> float:
    return array("f", (value,))[0]
