# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pockets of ballast in prints: balls inside of the core."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .. import mesh, moments
from ..numerics import Array

ROUNDINGS = 8.0  # relative bound of a ball's moments, in units of float64


def ball_moments(center: Array, radius: float, order: int) -> moments.Moments:
    """Return the moments of the volume of a ball about its center."""
    exponents = moments.monomials(order)
    degree = exponents.sum(axis=1) + 3
    gammas = np.array([math.gamma((n + 1) / 2.0) for n in range(order + 4)])
    raw = 2.0 * gammas[exponents].prod(axis=1) / gammas[degree - 1] * radius**degree / degree
    raw[(exponents % 2).any(axis=1)] = 0.0
    return moments.Moments(
        raw, center, moments.Measure.VOLUME, ROUNDINGS * np.finfo(float).eps * raw
    )


class PocketRoom:
    """The room for pockets in prints: inside of one core, and a line's width from the outside.

    low, high: (3,) the box of the cores.
    """

    def __init__(
        self, cores: Sequence[mesh.Surface], outsides: Sequence[mesh.Surface], line: float
    ) -> None:
        self.line = line
        joined = mesh.join_surfaces(cores), mesh.join_surfaces(outsides)
        self._trees = [mesh.tree_of_all(one.points, one.all_triangles()[0]) for one in joined]
        self.low, self.high = joined[0].points.min(axis=0), joined[0].points.max(axis=0)

    def radii(self, places: Array) -> Array:
        """Return the (k,) largest radii of pockets around places (k, 3); 0 outside of the core."""
        whole = np.zeros(len(places), np.intp)
        core, outside = self._trees
        winding, is_sure = core.winding_numbers(places - core.origin, whole, 0.0)
        inside = np.flatnonzero(is_sure & (winding == 1))
        found = np.zeros(len(places))
        places, whole = places[inside], whole[inside]
        away = outside.distances(places - outside.origin, whole) - self.line
        radii = np.minimum(core.distances(places - core.origin, whole), away)
        found[inside] = np.maximum(radii, 0.0)
        return found
