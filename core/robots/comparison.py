# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison of a body with another one that stands for it: its colliders, or a link's collision geometry."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import asin, sqrt

import numpy as np
from numpy.typing import NDArray

from ..inertia.plain_body import EQUAL_MOMENTS_RTOL
from .model import Inertial


@dataclass(frozen=True)
class Effect:
    """Mass properties of colliders beside those of the body, in the body's frame, SI.

    The ratios are those of colliders to body, None if the body's number is zero. center_shift: (3,) m, from the body's
    center. moment_ratios: (3,) of the ascending principal moments. axes_turn: the angle between the principal axes that
    both have, rad. inertia_change: the norm of the change of the tensor, in parts of the norm of the body's.
    """

    volume_ratio: float | None
    mass_ratio: float | None
    center_shift: tuple[float, ...]
    moment_ratios: tuple[float | None, ...]
    axes_turn: float
    inertia_change: float | None

    def as_record(self) -> dict[str, float | list[float | None] | None]:
        """Return the plain numbers by their keys in a record."""
        return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(self).items()}


def compare(own: Inertial, mass: float, shift: NDArray, second: NDArray, volume_ratio: float | None) -> Effect:
    """Compare a body with another one of a mass, kg, whose center is shifted, (3,) m.

    second: (3, 3) ∫ x xᵀ dm of the other body about its center, kg·m².
    """
    spreads, axes = np.linalg.eigh(second)
    spreads, axes = np.maximum(spreads[::-1], 0.0), axes[:, ::-1]
    moments = spreads.sum() - spreads
    inertia = second.trace() * np.eye(3) - second
    return Effect(
        volume_ratio,
        ratio(mass, own.mass),
        tuple(shift.tolist()),
        tuple(ratio(a, b) for a, b in zip(moments.tolist(), own.moments.tolist())),
        _axes_turn(own.moments, own.axes, moments, axes),
        ratio(float(np.linalg.norm(inertia - own.inertia)), float(np.linalg.norm(own.inertia))),
    )


def ratio(value: float, of: float) -> float | None:
    """Return value / of, None if that is not positive."""
    return value / of if of > 0.0 else None


def _axes_turn(own: NDArray, own_axes: NDArray, moments: NDArray, axes: NDArray) -> float:
    """Return the least angle that turns a body's principal axes to others; moments ascend, (3, 3) columns are axes.

    Equal moments leave their axes free: then the angle between the third axes counts, or none if all are equal.
    """
    equal = [(np.diff(one) <= EQUAL_MOMENTS_RTOL * one[2]).tolist() for one in (own, moments)]
    low, high = equal[0][0] or equal[1][0], equal[0][1] or equal[1][1]
    if low and high:
        return 0.0
    if low or high:
        axis = 2 if low else 0
        a, b = own_axes[:, axis], axes[:, axis]
        return 2.0 * asin(min(1.0, float(min(np.linalg.norm(a - b), np.linalg.norm(a + b))) / 2.0))
    along = np.diagonal(own_axes.T @ axes)
    signs = np.where(along < 0.0, -1.0, 1.0)
    if np.linalg.det(axes * signs) < 0.0:
        signs[np.abs(along).argmin()] *= -1.0
    return 2.0 * asin(min(1.0, float(np.linalg.norm(axes * signs - own_axes)) / sqrt(8.0)))
