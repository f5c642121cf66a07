# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bounding box of finite coordinates that come in blocks."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface
from ..verdict.finding import FileError, finding
from .findings import AT_ROW, NON_FINITE_COORDINATES

Box = tuple[NDArray[np.float64], NDArray[np.float64]]


def box_of_blocks(blocks: Iterable[NDArray[np.floating]], element: str) -> Box:
    """Return the least and the largest coordinates of (n, 3) or (n, 3, 3) blocks, zeros if there are none."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    rows = bad = first = 0
    for block in blocks:
        least, largest = Surface(block.reshape(-1, 3)).box if len(block) else (low, high)
        if np.isfinite([least, largest]).all() or not len(block):
            low, high = np.minimum(low, least), np.maximum(high, largest)
        else:
            wrong = ~np.isfinite(block.reshape(len(block), -1))
            first = first if bad else rows + int(np.argmax(wrong.any(axis=1)))
            bad += int(np.count_nonzero(wrong))
        rows += len(block)
    if bad:
        place = finding(AT_ROW, element=element, row=first).as_record()
        raise FileError(NON_FINITE_COORDINATES, count=bad, place=place)
    return (low, high) if rows else (np.zeros(3), np.zeros(3))
