# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfer tables from values of a grid to densities.

Text of pairs "value density", separated by commas, semicolons or new lines; between its values the density runs
straight, beyond them it is constant.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import MeasureError
from .findings import TRANSFER_TABLE_NUMBERS, TRANSFER_TABLE_SYNTAX

# CT numbers in Hounsfield units to kg/m³: air, fat, water and soft tissue, bone, after Schneider, Bortfeld and Schlegel
# (Phys. Med. Biol. 45, 2000), as the table of densities that comes with GATE has them.
CT_DENSITIES = "-1000 1.21, -98 930, -97 930.486, 14 1030, 23 1031, 100 1119.9, 101 1076.2, 1600 1964.2, 3000 2800"


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
