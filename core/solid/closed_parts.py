# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The closed parts of a body: which triangles bound each, and which part a cavity is cut from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import normals


@dataclass(frozen=True, eq=False)
class ClosedParts:
    """Triangles, (t, 3), with the body as signed sum, turned and with caps; and the closed part that each bounds.

    face: (t,) the mesh face of each, -1 for a cap. part: (t,), 0 to number - 1. host_part: (number,) the part that a
    part's volume counts with: itself, or for a cavity the part it is cut from.
    """

    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    face: NDArray[np.integer]
    part: NDArray[np.integer]
    number: int
    host_part: NDArray[np.integer]

    def areas(self, linear: NDArray | None = None) -> NDArray[np.float64]:
        """Return (t,) areas of the triangles under a (3, 3) map, by default as they are."""
        points = self.points.astype(np.float64)
        if linear is not None:
            points = points @ np.asarray(linear).T
        return np.linalg.norm(normals(points, self.triangles), axis=1) / 2.0
