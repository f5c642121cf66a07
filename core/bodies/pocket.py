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
    """Return the moments of the volume of a ball about its center: 0 if an exponent is odd, else
    2 Γ((p+1)/2) Γ((q+1)/2) Γ((r+1)/2) / Γ((n+3)/2) · R^(n+3) / (n+3) with n = p+q+r.
    """
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
        core = mesh.join_surfaces(cores)
        outside = mesh.join_surfaces(outsides)
        self._trees = [
            mesh.tree_of_all(surface.points, surface.all_triangles()[0])
            for surface in (core, outside)
        ]
        self.low = core.points.min(axis=0)
        self.high = core.points.max(axis=0)

    def radii(self, places: Array) -> Array:
        """Return the (k,) largest radii of pockets around places (k, 3); 0 outside of the core."""
        part = np.zeros(len(places), np.intp)  # A tree may hold several meshes; these hold one.
        core, outside = self._trees
        winding, is_sure = core.winding_numbers(places - core.origin, part, 0.0)
        inside = np.flatnonzero(is_sure & (winding == 1))
        inner = places[inside]
        from_outside = outside.distances(inner - outside.origin, part[inside]) - self.line
        from_core = core.distances(inner - core.origin, part[inside])
        radii = np.zeros(len(places))
        radii[inside] = np.maximum(np.minimum(from_core, from_outside), 0.0)
        return radii
