# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfer tables from values of a grid to densities.

Text of pairs "value density", separated by commas, semicolons or new lines; between its values the density is
interpolated linearly, beyond them it is constant.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import MeasureError
from .findings import TRANSFER_TABLE_NUMBERS, TRANSFER_TABLE_SYNTAX


def parse_table(text: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (n,) values, ascending, and (n,) densities in kg/m³; MeasureError if the text is no such table."""
    entries = []
    for pair in re.split(r"[,;\n]", text):
        words = pair.split()
        if not words:
            continue
        try:
            value, density = map(float, words)
        except ValueError:
            raise MeasureError(TRANSFER_TABLE_SYNTAX, part=pair.strip()) from None
        entries.append((value, density))
    table = np.array(entries, np.float64).reshape(-1, 2)
    rises = (np.diff(table[:, 0]) > 0.0).all()
    if len(table) < 2 or not (np.isfinite(table).all() and rises and (table[:, 1] >= 0.0).all()):
        raise MeasureError(TRANSFER_TABLE_NUMBERS)
    return table[:, 0], table[:, 1]
