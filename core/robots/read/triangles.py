# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of a mesh's parts, gathered in one frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[NDArray[np.floating], NDArray[np.integer]]


class Gathered:
    """Points and triangles of parts, each placed by a (4, 4) matrix."""

    def __init__(self) -> None:
        self._points: list[NDArray] = []
        self._triangles: list[NDArray] = []

    def add(self, points: NDArray, triangles: NDArray, matrix: NDArray) -> None:
        """Add (n, 3) points and (m, 3) triangles, whose order is reversed if the matrix mirrors."""
        turned = triangles[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0.0 else triangles
        self._triangles.append(turned + sum(map(len, self._points)))
        self._points.append(points @ matrix[:3, :3].T + matrix[:3, 3])

    def arrays(self) -> Arrays:
        """Return all points and triangles."""
        none = np.zeros((0, 3))
        return np.concatenate([none, *self._points]), np.concatenate([none.astype(np.int64), *self._triangles])


def fan(sizes: NDArray[np.int64], corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return (m, 3) triangles: faces of given sizes, cut into fans about their first corners."""
    starts = np.cumsum(sizes) - sizes
    cut = np.maximum(sizes - 2, 0)
    face = np.repeat(np.arange(len(sizes)), cut)
    step = np.arange(cut.sum()) - np.repeat(np.cumsum(cut) - cut, cut)
    first = starts[face]
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)
