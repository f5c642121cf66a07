# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body beside another one that stands for it: its colliders, or a link's geometry, filled
evenly.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from math import asin, degrees, hypot, sqrt

import numpy as np

from ..inertia import EQUAL_MOMENTS_RTOL
from ..numerics import Array, NDArray, second_of_inertia
from ..verdict import Finding, finding
from .findings import AUDIT_NOT_UNIFORM
from .model import Inertial
from .stated import StatedInertial

# Relative differences: below the first equal; above the second not by rounded digits.
AGREES = 5e-3
DIFFERS = 1e-2
# kg/m³, possible range of a robot: from foam to above the heaviest metal.
LEAST_DENSITY = 10.0
LARGEST_DENSITY = 30_000.0


@dataclass(frozen=True)
class Effect:
    """Mass properties of colliders beside those of the body, in the body's frame, SI.

    The ratios are those of colliders to body, None if the body's number is zero. center_shift: (3,)
    m, from the body's center. moment_ratios: (3,) of the ascending principal moments. axes_turn:
    the angle between the principal axes that both have, rad. inertia_change: the norm of the change
    of the tensor, in parts of the norm of the body's.
    """

    volume_ratio: float | None
    mass_ratio: float | None
    center_shift: tuple[float, ...]
    moment_ratios: tuple[float | None, ...]
    axes_turn: float
    inertia_change: float | None

    def as_record(self) -> dict[str, float | list[float | None] | None]:
        """Return the plain numbers by their keys in a record."""
        return {
            key: list(value) if isinstance(value, tuple) else value
            for key, value in asdict(self).items()
        }


def compare(
    body: Inertial, mass: float, shift: NDArray, second: NDArray, volume_ratio: float | None
) -> Effect:
    """Return the effect of colliders of a mass, kg, whose center is shifted, (3,) m, beside a body.

    second: (3, 3) ∫ x xᵀ dm of the colliders about their center, kg·m².
    """
    ascending, axes = np.linalg.eigh(second)
    # The moment about an axis is the sum of the other spreads: the largest spread comes first.
    spreads = np.maximum(ascending[::-1], 0.0)
    axes = axes[:, ::-1]
    moments = spreads.sum() - spreads
    change = second.trace() * np.eye(3) - second - body.inertia
    return Effect(
        volume_ratio,
        ratio(mass, body.mass),
        tuple(shift.tolist()),
        tuple(ratio(*pair) for pair in zip(moments.tolist(), body.moments.tolist())),
        _axes_turn(body.moments, body.axes, moments, axes),
        ratio(float(np.linalg.norm(change)), float(np.linalg.norm(body.inertia))),
    )


def ratio(value: float, of: float) -> float | None:
    """Return value / of, None if that is not positive."""
    return value / of if of > 0.0 else None


def _axes_turn(
    moments: NDArray, axes: NDArray, other_moments: NDArray, other_axes: NDArray
) -> float:
    """Return the least angle, rad, that turns principal axes to others; moments ascend, (3, 3)
    columns are axes, whose signs do not matter.

    Equal moments leave their axes free: then the angle between the axes of the remaining moment
    counts, or none if all are equal.
    """
    is_equal = np.zeros(2, bool)  # first and second moment; second and third
    for several in (moments, other_moments):
        is_equal |= np.diff(several) <= EQUAL_MOMENTS_RTOL * several[2]
    if is_equal.all():
        return 0.0
    if is_equal.any():
        single = 2 if is_equal[0] else 0
        first, second = axes[:, single], other_axes[:, single]
        # Two unit vectors at an angle are 2 sin(angle/2) apart.
        chord = min(np.linalg.norm(first - second), np.linalg.norm(first + second))
        return 2.0 * asin(min(1.0, float(chord) / 2.0))
    along = np.diagonal(axes.T @ other_axes)
    signs = np.where(along < 0.0, -1.0, 1.0)
    if np.linalg.det(other_axes * signs) < 0.0:
        # No rotation mirrors: the axis with the least to lose goes the other way.
        signs[np.abs(along).argmin()] *= -1.0
    # The norm of R - 1 is √8 times the sine of half the angle of a rotation R.
    distance = float(np.linalg.norm(other_axes * signs - axes))
    return 2.0 * asin(min(1.0, distance / sqrt(8.0)))


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
        return max(self.compare_centers(stated), float(change / self._norm))

    @cached_property
    def _norm(self) -> float:
        return float(np.linalg.norm(self.inertia))

    @cached_property
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
