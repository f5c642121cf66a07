# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points from triangles, however thin, by a tree in double precision."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .bvh import Bvh, sort_components


class SurfaceTree:
    """A tree over (m, 3) triangles of (n, 3) points."""

    def __init__(self, points: NDArray, triangles: NDArray):
        component = np.zeros(len(triangles), np.intp)
        self._tree = Bvh(points, sort_components(points, triangles, component, 1), np.ones(1, bool))

    def nearest(self, points: NDArray, within: float = np.inf) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
        """Return (k,) distances of (k, 3) points and their triangles, for `corners`; inf and -1 beyond `within`."""
        return self._tree.nearest(points - self._tree.origin, np.zeros(len(points), np.intp), within)

    def distance(self, points: NDArray, within: float = np.inf) -> NDArray[np.float64]:
        """Return (k,) distances of (k, 3) points; infinity beyond `within`."""
        return self.nearest(points, within)[0]

    def corners(self, face: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the (k, 3, 3) corners of triangles."""
        return self._tree.corners(face).transpose(2, 1, 0) + self._tree.origin
