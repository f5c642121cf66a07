# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognition of label maps, whose numbers name regions and measure nothing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MOST_LABELS = 256  # different numbers; scans of 8 bits may have as many, but change everywhere
MAX_CHANGING = 0.5  # share of neighbors that differ, of those that are not both background


def count_labels(values: NDArray) -> int:
    """Return the count of different numbers in a (nx, ny, nz) grid that looks like labels, else 0.

    Labels are three or more whole numbers in regions; the background is the first sample's.
    """
    found = np.zeros(0)
    inside = changing = 0
    for slab in values:
        numbers = np.unique(slab)
        found = np.union1d(found, numbers)
        if len(found) > MOST_LABELS or not (numbers == np.rint(numbers)).all():
            return 0
        before, after = slab[:, :-1], slab[:, 1:]
        background = values[0, 0, 0]
        inside += np.count_nonzero((before != background) | (after != background))
        changing += np.count_nonzero(before != after)
    return len(found) if len(found) > 2 and changing <= MAX_CHANGING * inside else 0
