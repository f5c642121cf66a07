# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a character: rigid bodies that follow the matrices of their bones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..numerics import Array, NDArray, inertia_of_second


@dataclass(frozen=True, eq=False)
class Parts:
    """The p parts of one or several characters.

    names: of bones and held objects. masses: (p,) kg, 0 if they cannot be measured. centers:
    (p, 3). spreads: (p, 3, 3) integrals of r rᵀ dm about each part's center. matrices: (p, 4, 4) of
    bones and objects in the world.
    """

    names: tuple[str, ...]
    masses: Array
    centers: Array
    spreads: Array
    matrices: Array

    @property
    def mass(self) -> float:
        """The total mass, kg."""
        return float(self.masses.sum())

    @property
    def center(self) -> Array:
        """(3,) center of the total."""
        return self.centers[0] + (self.masses / self.mass) @ (self.centers - self.centers[0])

    @property
    def inertia(self) -> Array:
        """(3, 3) inertia tensor of the total about its center, in kg and Blender's units."""
        arms = self.centers - self.center
        spread = self.spreads.sum(axis=0) + np.einsum("p,pi,pj->ij", self.masses, arms, arms)
        return inertia_of_second(spread)

    @classmethod
    def join(cls, several: Sequence[Parts]) -> Parts:
        """Return the parts of several characters together."""
        arrays = ("masses", "centers", "spreads", "matrices")
        names = tuple(name for parts in several for name in parts.names)
        return cls(
            names, *(np.concatenate([getattr(parts, name) for parts in several]) for name in arrays)
        )

    def placed(self, matrices: NDArray, factors: NDArray) -> Parts:
        """Return parts that are in the spaces of their bones at (p, 4, 4) matrices, their masses
        times (p,) factors.
        """
        linear = matrices[:, :3, :3]
        centers = np.einsum("pij,pj->pi", linear, self.centers) + matrices[:, :3, 3]
        spreads = factors[:, None, None] * (linear @ self.spreads @ linear.swapaxes(1, 2))
        return Parts(self.names, factors * self.masses, centers, spreads, matrices)

    def factors_to(self, total: float, shares: NDArray) -> Array:
        """Return (p,) factors of the masses to a total, 1 for a total of 0.

        shares: (p,) mask of the parts that share the rest of it, if the others leave any; else all
        parts share the total.
        """
        rest = total - self.masses[~shares].sum()
        if total and rest > 0.0 and shares.any():
            return np.where(shares, rest / self.masses[shares].sum(), 1.0)
        return np.full(len(shares), total / self.mass if total else 1.0)
