# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One density for each closed part of a body, from the densities of its faces.

A part is filled with the material of its faces. Where they differ it takes their mean, weighted by area. A cavity has
no material: what it encloses is taken away from the part that it is cut from, whatever its own faces are painted with.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..solid.parts import Components


@dataclass(frozen=True, eq=False)
class PartDensities:
    """density: (number,) of each part. mixed: (number,) whether its own faces differ; painted: (number,) cavities with
    faces of other densities than what they are cut from. first: (number,) a part's first mesh face, -1 for none."""

    density: NDArray[np.float64]
    mixed: NDArray[np.bool_]
    painted: NDArray[np.bool_]
    first: NDArray[np.integer]


def part_densities(parts: Components, faces: NDArray[np.float64], linear: NDArray | None = None) -> PartDensities:
    """One density for each part. faces: (f,) that of every mesh face. linear: (3, 3) the map under which areas
    count."""
    own = parts.face >= 0
    part, face, area = parts.part[own], parts.face[own], parts.areas(linear)[own]
    first = np.full(parts.number, np.iinfo(np.int64).max)
    least, most = np.full(parts.number, np.inf), np.full(parts.number, -np.inf)
    np.minimum.at(first, part, face)
    np.minimum.at(least, part, faces[face])
    np.maximum.at(most, part, faces[face])
    total = np.bincount(part, area, minlength=parts.number)
    sums = np.bincount(part, area * faces[face], minlength=parts.number)
    with np.errstate(invalid="ignore"):
        mean = np.divide(sums, total, out=(least + most) / 2.0, where=total > 0.0)
    there = first < np.iinfo(np.int64).max
    mixed = there & (most > least)
    own = np.where(there, np.where(mixed, np.clip(mean, least, most), least), 0.0)
    cavity = parts.within != np.arange(parts.number)
    density = own[parts.within]
    return PartDensities(
        density, mixed & ~cavity, cavity & there & (mixed | (own != density)), np.where(there, first, -1)
    )
