# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A link's geometry as an evenly filled body, beside the inertial that its file states."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, hypot

import numpy as np

from ..numerics import Array, second_of_inertia
from ..verdict import Finding, finding
from .comparison import Effect, compare
from .findings import AUDIT_NOT_UNIFORM
from .stated import StatedInertial

# Relative differences: below the first equal; above the second not by rounded digits.
AGREES = 5e-3
DIFFERS = 1e-2
# kg/m³, possible range of a robot: from foam to above the heaviest metal.
LEAST_DENSITY = 10.0
LARGEST_DENSITY = 30_000.0


def is_possible(density: float) -> bool:
    """Return whether a robot may have a density, kg/m³."""
    return LEAST_DENSITY <= density <= LARGEST_DENSITY


@dataclass(frozen=True, eq=False)
class Reference:
    """A link's geometry, filled evenly: volume, m³; (3,) center in the link's frame, m; inertia
    about it of 1 kg, m².

    origins: (3,) the origins of its shapes.
    """

    volume: float
    center: Array
    inertia: Array
    origins: tuple[Array, ...] = ()

    @classmethod
    def of_inertial(cls, inertial: StatedInertial) -> Reference:
        """Return a geometry, of volume 1, whose even filling has the center and, per kilogram, the
        inertia of an inertial.
        """
        return cls(1.0, inertial.center, inertial.inertia / inertial.mass)

    def density(self, stated: StatedInertial) -> float:
        """Return the density, kg/m³, of this geometry with the stated mass."""
        return stated.mass / self.volume

    def compare(self, stated: StatedInertial) -> float:
        """Return the larger relative difference: of the centers, per radius of gyration, or of the
        inertia.
        """
        change = np.linalg.norm(stated.inertia / stated.mass - self.inertia)
        apart = float(change / np.linalg.norm(self.inertia))
        return max(self.compare_centers(stated), apart)

    @property
    def radius(self) -> float:
        """The radius of gyration about the center, m."""
        return float(np.sqrt(np.trace(self.inertia) / 2.0))

    def compare_centers(self, stated: StatedInertial) -> float:
        """Return the center's difference per radius of gyration."""
        return float(np.linalg.norm(stated.center - self.center) / self.radius)

    def effect(self, stated: StatedInertial, drawn_volume: float | None) -> Effect:
        """Return the mass properties of this geometry, filled evenly with the stated mass, beside
        the stated ones.
        """
        second = stated.mass * second_of_inertia(self.inertia)
        volume_ratio = None if drawn_volume is None else self.volume / drawn_volume
        return compare(
            stated.principal(), stated.mass, self.center - stated.center, second, volume_ratio
        )

    def describe_effect(self, stated: StatedInertial, effect: Effect, part: str) -> Finding:
        """Return the note about an effect of this geometry. part: its name."""
        first, second, third = effect.moment_ratios
        return finding(
            AUDIT_NOT_UNIFORM,
            part=part,
            factor=float(np.trace(stated.inertia) / stated.mass / np.trace(self.inertia)),
            volume=effect.volume_ratio,
            first=first,
            second=second,
            third=third,
            distance=hypot(*effect.center_shift),
            turn=degrees(effect.axes_turn),
        )

    def uniform(self, mass: float) -> StatedInertial:
        """Return the inertial of this geometry, filled evenly with a mass in kg."""
        return StatedInertial(mass, self.center, mass * self.inertia)
