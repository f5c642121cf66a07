# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bounding box of coordinates that come in blocks, all of which must be finite."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface
from ..verdict.finding import FileError, finding
from .findings import AT_ROW, NON_FINITE_COORDINATES


class BoxOfBlocks:
    """Bounding box of blocks, which grows block by block. element: "triangle" or "vertex", the meaning of a row."""

    def __init__(self, element: str) -> None:
        self._element = element
        self._low, self._high = np.full(3, np.inf), np.full(3, -np.inf)
        self._rows = self._bad = self._first = 0

    def add(self, rows: NDArray[np.floating]) -> None:
        """Add (n, 3) or (n, 3, 3) coordinates."""
        if not len(rows):
            return
        low, high = Surface(rows.reshape(-1, 3)).box
        if np.isfinite(low).all() and np.isfinite(high).all():
            self._low, self._high = np.minimum(self._low, low), np.maximum(self._high, high)
        else:
            bad = ~np.isfinite(rows.reshape(len(rows), -1))
            if not self._bad:
                self._first = self._rows + int(np.argmax(bad.any(axis=1)))
            self._bad += int(np.count_nonzero(bad))
        self._rows += len(rows)

    @property
    def is_finite(self) -> bool:
        """True if all coordinates so far are finite."""
        return not self._bad

    def box(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the least and the largest coordinates, zero if there are none; FileError if some are not finite."""
        if self._bad:
            place = finding(AT_ROW, element=self._element, row=self._first)
            raise FileError(NON_FINITE_COORDINATES, count=self._bad, place=place.as_record())
        return (self._low, self._high) if self._rows else (np.zeros(3), np.zeros(3))
