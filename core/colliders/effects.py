# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The effect of colliders on a body's physics, and masses of colliders that take it away.

An engine without an explicit inertial sums up its colliders, overlaps counted twice. The sum is linear in the masses m
of the colliders: ten rows of mass, first and second moments, each divided by the collider's mass. The corrected masses
lie nearest to uniform density, by Σ (m - u)² / u with the masses u of uniform density: the least change of the density
in the mean over the volume. If no masses ≥ 0 have all ten sums, the mass is kept, then the center comes as near as it
can, then the inertia.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import asin, sqrt

import numpy as np
from numpy.typing import NDArray

from ..inertia.findings import NO_CERTAIN_VOLUME
from ..inertia.mass_properties import MassProperties
from ..inertia.plain_body import EQUAL_MOMENTS_RTOL
from ..moments.exponents import monomial_count, monomials
from ..moments.moments import SECOND_MOMENT_INDEX
from ..robots.model import Shape
from ..robots.shapes import moments_of
from ..verdict.finding import MeasureError

SUMS = monomial_count(2)  # mass, first and second moments
DEGREE = monomials(2).sum(axis=1)
# Products count twice in the norm of a tensor.
IN_NORM = np.where(monomials(2).max(axis=1) * 2 == DEGREE, np.sqrt(2.0), 1.0) * (DEGREE > 0) + (DEGREE == 0)
HELD_WEIGHT, NEARNESS = 30.0, 1e-5  # Beside sums that are not held. Repetition takes the effect on held ones away.
REPETITIONS = 40
ROUNDING, REACHED = 1e-15, 1e-11  # of the body's mass and size


@dataclass(frozen=True)
class Effect:
    """Mass properties of the colliders beside those of the body, in the body's frame, SI.

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


def effect(body: MassProperties, shapes: Sequence[Shape], volume: float) -> Effect:
    """Compare the sum of colliders with masses, of uniform density each, with a body of a volume.

    MeasureError if the colliders have no mass.
    """
    shares, rows = _ten_sums(body, shapes)
    sums = rows @ [shape.mass for shape in shapes]
    if not sums[0] > 0.0:
        raise MeasureError(NO_CERTAIN_VOLUME)
    shift = sums[1:4] / sums[0]
    second = sums[SECOND_MOMENT_INDEX] - sums[0] * np.outer(shift, shift)
    spreads, axes = np.linalg.eigh(second)
    spreads, axes = np.maximum(spreads[::-1], 0.0), axes[:, ::-1]
    moments = spreads.sum() - spreads
    inertia = second.trace() * np.eye(3) - second
    own = body.principal.moments
    return Effect(
        _ratio(float(sum(shares)), volume),
        _ratio(float(sums[0]), body.mass),
        tuple(shift.tolist()),
        tuple(_ratio(a, b) for a, b in zip(moments.tolist(), own.tolist())),
        _axes_turn(own, body.principal.axes, moments, axes),
        _ratio(float(np.linalg.norm(inertia - body.inertia)), float(np.linalg.norm(body.inertia))),
    )


def uniform_masses(density: float, shapes: Sequence[Shape]) -> list[float]:
    """Return the masses of colliders of one density, kg/m³."""
    return [density * float(moments_of(shape).total) for shape in shapes]


def correct_masses(body: MassProperties, shapes: Sequence[Shape]) -> list[float]:
    """Return the masses ≥ 0 nearest to uniform density with the body's mass, center and inertia, or near to them.

    MeasureError if the colliders have no volume, or the body has no mass.
    """
    volumes, rows = _ten_sums(body, shapes)
    if not sum(volumes) > 0.0 or not body.mass > 0.0:
        raise MeasureError(NO_CERTAIN_VOLUME)
    weights = np.sqrt(volumes / sum(volumes))
    second = body.inertia.trace() / 2.0 * np.eye(3) - body.inertia
    target = np.zeros(SUMS)
    target[0] = 1.0
    target[SECOND_MOMENT_INDEX] = second / body.mass
    size = sqrt(max(float(rows[[4, 7, 9]].sum(axis=0).max()), float(second.trace()) / body.mass))
    units = IN_NORM / size**DEGREE
    rows, target = rows * weights * units[:, None], target * units
    roots, off = _nearest(rows, target, SUMS, weights)
    if off > REACHED:
        center, off = _nearest(rows[:4], target[:4], 4, weights)
        if off > REACHED:
            center, _ = _nearest(rows[:4], target[:4], 1, weights)
            target[1:4] = rows[1:4] @ center
        roots, _ = _nearest(rows, target, 4, weights)
    return (body.mass * weights * roots).tolist()


def _ten_sums(body: MassProperties, shapes: Sequence[Shape]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (n,) volumes of colliders, and (10, n) moments by their masses, about the body's center."""
    moments = [moments_of(shape).truncate(2) for shape in shapes]
    volumes = np.array([float(one.total) for one in moments])
    raw = np.array([one.about_point(body.center).raw for one in moments]).reshape(-1, SUMS).T
    return volumes, raw / np.where(volumes > 0.0, volumes, 1.0)


def _nearest(
    rows: NDArray[np.float64], target: NDArray[np.float64], held: int, wish: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float]:
    """Return (n,) x ≥ 0 nearest to a wish, and how far the `held` first rows of rows @ x = target are from holding.

    The other rows come as near as they can. The method of multipliers adds to the target what is missing.
    """
    weights = np.where(np.arange(len(rows)) < held, HELD_WEIGHT, 1.0)
    system = np.concatenate([rows * weights[:, None], NEARNESS * np.eye(len(wish))])
    wanted, x, off = target.copy(), wish, np.inf
    for _ in range(REPETITIONS):
        x = _nonnegative(system, np.concatenate([wanted * weights, NEARNESS * wish]), x)
        missing = (target - rows @ x)[:held]
        off = float(np.abs(missing).max())
        if off <= ROUNDING:
            break
        wanted[:held] += missing
    return x, off


def _nonnegative(system: NDArray[np.float64], target: NDArray[np.float64], x: NDArray) -> NDArray[np.float64]:
    """Return (n,) x ≥ 0 with the least |system @ x - target| (Lawson and Hanson 1974), from a start ≥ 0.

    The columns must be independent.
    """
    size, x = len(x), x.copy()
    free = x > 0.0
    noise = 64.0 * np.finfo(float).eps * float(np.abs(system).sum(axis=0).max()) * float(np.abs(target).max())
    for _ in range(10 * size + 10):
        while True:
            best = np.zeros(size)
            best[free] = np.linalg.lstsq(system[:, free], target, rcond=None)[0]
            if not (best[free] <= 0.0).any():
                break
            falls = free & (best <= 0.0)
            step = (x[falls] / np.maximum(x[falls] - best[falls], np.finfo(float).tiny)).min()
            x = x + step * (best - x)
            at_zero = falls & (x <= np.finfo(float).eps * np.abs(x).max())
            free &= ~at_zero
            x[~free] = 0.0
        x = best
        gain = np.where(free, -np.inf, system.T @ (target - system @ x))
        entering = int(gain.argmax())
        if gain[entering] <= noise:
            break
        free[entering] = True
    return x


def _ratio(value: float, of: float) -> float | None:
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
