# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One density for each closed part of a body, from the densities of its faces.

A part is filled with the material of its faces. If they differ it takes their mean, weighted by area. A cavity has no
material: its volume is taken away from the part that it is cut from, whatever material its own faces have.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..solid.orientation import ClosedParts


@dataclass(frozen=True, eq=False)
class PartDensities:
    """Densities of parts, found from the densities of their faces, as arrays with an entry for each part.

    has_several_materials: the part's faces differ in density. has_foreign_cavity_material: the part is a cavity with a
    face of another density than the part that it is cut from. first_face: a part's first mesh face, -1 if it has none.
    range_by_area, most_by_area: the range of its faces' densities, and the largest density, times the part's area.
    """

    density: NDArray[np.float64]
    has_several_materials: NDArray[np.bool_]
    has_foreign_cavity_material: NDArray[np.bool_]
    first_face: NDArray[np.integer]
    range_by_area: NDArray[np.float64]
    most_by_area: NDArray[np.float64]


def part_densities(parts: ClosedParts, faces: NDArray[np.float64], linear: NDArray | None = None) -> PartDensities:
    """Return one density for each part: the mean of the (f,) face densities by area under the linear map."""
    of_mesh = parts.face >= 0
    part, face, area = parts.part[of_mesh], parts.face[of_mesh], parts.areas(linear)[of_mesh]
    first = np.full(parts.number, np.iinfo(np.int64).max)
    least, most = np.full(parts.number, np.inf), np.full(parts.number, -np.inf)
    np.minimum.at(first, part, face)
    np.minimum.at(least, part, faces[face])
    np.maximum.at(most, part, faces[face])
    there = first < np.iinfo(np.int64).max
    least, most = np.where(there, least, 0.0), np.where(there, most, 0.0)
    total = np.asarray(np.bincount(part, area, minlength=parts.number), np.float64)
    sums = np.bincount(part, area * faces[face], minlength=parts.number)
    mean = np.divide(sums, total, out=(least + most) / 2.0, where=total > 0.0)
    differs = most > least
    of_mesh = np.where(differs, np.clip(mean, least, most), least)
    cavity = parts.host_part != np.arange(parts.number)
    density = of_mesh[parts.host_part]
    return PartDensities(
        density,
        differs & ~cavity,
        cavity & there & (differs | (of_mesh != density)),
        np.where(there, first, -1),
        (most - least) * total,
        most * total,
    )
