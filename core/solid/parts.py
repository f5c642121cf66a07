# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The closed parts of a body, and one density for each of them from the densities of its faces.

A part is filled with the material of its faces. Where they differ it takes their mean, weighted by area. A cavity has
no material: what it encloses is taken away from the part that it is cut from, whatever its own faces are painted with.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..density.piecewise_mass import weighted_solid
from ..mesh.surface import normals
from ..moments.moments import Moments


@dataclass(frozen=True, eq=False)
class Components:
    """The triangles whose signed sum is the body, and the closed part that each bounds.

    points: (n, 3); triangles: (t, 3), as measured: turned where that was needed, caps included. face: (t,) the mesh
    face of each, -1 for a cap. part: (t,), 0 to number - 1. within: (number,) whose material a part counts with: its
    own, or of a cavity that of the part it is cut from.
    """

    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    face: NDArray[np.integer]
    part: NDArray[np.integer]
    number: int
    within: NDArray[np.integer]

    def areas(self, linear: NDArray | None = None) -> NDArray[np.float64]:
        """(t,) of the triangles under a (3, 3) map, by default as they are."""
        points = self.points.astype(np.float64)
        if linear is not None:
            points = points @ np.asarray(linear).T
        return np.linalg.norm(normals(points, self.triangles), axis=1) / 2.0

    def moments(self, like: Moments) -> list[Moments]:
        """The volume moments of each part, negative for cavities. like: the whole body's."""
        order = np.argsort(self.part, kind="stable")
        ends = np.searchsorted(self.part[order], np.arange(self.number + 1))
        rows = [order[start:end] for start, end in zip(ends, ends[1:])]
        return [weighted_solid(self.points, self.triangles[own], np.ones(len(own)), like) for own in rows]
