# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Righting arms of a heeled body.

From the position of rest, with axes f forward, s to the side and k up, heel by p about f and trim
by q put gravity against

    u = (-sin q, cos q sin p, cos q cos p).

At each heel the level keeps the displacement, and a free trim is where the energy e(u) of
`flotation` is least along q. The righting arm is the derivative of e by p over cos q, the
horizontal distance between the verticals through gravity and buoyancy, and positive if it rights.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ..numerics import Array, ArrayLike, Index, check_filled, float_array, unit_vector
from .flotation import Flotation

MAX_STEPS = 30
MAX_TRIM_STEP = 0.2  # rad
LEVEL_TRIM = 1e-12  # relative to the size: smaller trimming arms count as none
ROUNDS = 40  # rounds of the search for an angle
ANGLE_ATOL = 1e-9  # rad: closer angles are one
SEARCH_STEP = np.radians(2.5)
FIRST_HEEL = 1e-3  # rad; the arm at rest is zero, so that its sign is that beside it
_Position: TypeAlias = tuple[float, Flotation]  # a trim, rad, and the state there


@dataclass(frozen=True, eq=False)
class RightingCurve:
    """Righting arms over angles of heel, rad, ascending.

    `arms`: (k,) GZ, m. `trims`: (k,) rad. `energies`: (k,) work against the arms per weight from
    rest, m. `is_free`: whether the trim is free. `capsize`, `flooding`: the angles beyond which it
    turns over, or liquid runs in through an opening, below and above zero; nan if not between zero
    and the angles.
    """

    angles: Array
    arms: Array
    trims: Array
    energies: Array
    is_free: bool
    capsize: tuple[float, float]
    flooding: tuple[float, float]

    @property
    def stable_range(self) -> tuple[float, float]:
        """The angles between which it comes back, as far as they are known."""
        low = np.fmax(np.fmax(self.capsize[0], self.flooding[0]), min(self.angles[0], 0.0))
        high = np.fmin(np.fmin(self.capsize[1], self.flooding[1]), max(self.angles[-1], 0.0))
        return float(low), float(high)


def righting_curve(
    rest: Flotation,
    angles: ArrayLike,
    forward: ArrayLike | None = None,
    free_trim: bool = True,
) -> RightingCurve:
    """Compute the righting arms of a body that heels from its position of rest.

    Parameters
    ----------
    rest : Flotation
    angles : (k,) array_like
        Of heel, rad; positive toward the right of `forward`.
    forward : (3,) array_like, optional
        The axis of heel, projected onto the water; that of least stiffness without it.
    free_trim : bool

    Returns
    -------
    RightingCurve

    Examples
    --------
    >>> from body_moments.core.floating import FloatingBody, righting_curve
    >>> log = FloatingBody(
    ...     np.array([[x, y, z] for x in (-3.0, 3.0) for y in (-1.0, 1.0) for z in (-0.5, 0.5)]),
    ...     [
    ...         [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    ...         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ...     ],
    ...     mass=6000.0,
    ...     center=[0.0, 0.0, 0.0],
    ...     density=1000.0,
    ... )
    >>> curve = righting_curve(log.settle([0.0, 0.0, 1.0]), np.radians([0.0, 45.0, 100.0]))
    >>> float(np.degrees(curve.capsize[1]).round(6))
    90.0
    """
    wanted = np.unique(float_array("angles", angles, "k", finite=True))
    check_filled("angles", wanted)
    # The search has a grid of its own: between the angles asked for it may turn over and back.
    low, high = min(wanted[0], 0.0), max(wanted[-1], 0.0)
    grid = np.arange(np.ceil(low / SEARCH_STEP), np.floor(high / SEARCH_STEP) + 1.0) * SEARCH_STEP
    grid = np.append(
        grid, [sign * FIRST_HEEL for sign in (-1, 1) if low < sign * FIRST_HEEL < high]
    )
    is_new = np.abs(grid[:, None] - wanted).min(axis=1) > ANGLE_ATOL
    angles = np.union1d(wanted, grid[is_new])
    is_wanted = np.isin(angles, wanted)
    axis = rest.heel_axis if forward is None else unit_vector("forward", forward)
    axis = unit_vector("forward across the water", axis - rest.up * float(rest.up @ axis))
    frame = np.stack([axis, np.cross(rest.up, axis), rest.up])
    heeling = _Heeling(frame, free_trim)
    heeled: dict[float, _Position] = {}
    for side in (angles[angles >= 0.0], angles[angles < 0.0][::-1]):
        near = (0.0, rest)
        for angle in side.tolist():
            near = heeled[angle] = heeling.position(angle, near)
    positions = [heeled[angle] for angle in angles.tolist()]
    arms = np.array([heeling.arm(angle, heeled[angle]) for angle in angles.tolist()])
    arms = np.where(np.abs(arms) <= LEVEL_TRIM * rest.body.size, 0.0, arms)
    dry_heights = np.array([-state.depth_of_openings for _, state in positions])

    # The height of the lowest opening over the waterline.
    def dry_height_at(angle: float, near: _Position) -> float:
        return -heeling.position(angle, near)[1].depth_of_openings

    capsize, flooding = [], []
    for sign in (-1.0, 1.0):
        # The indices of the angles on one side, outward.
        side = np.flatnonzero(sign * angles >= 0.0)[:: int(sign)]
        heeled_side = side[np.abs(angles[side]) > ANGLE_ATOL]
        righting = sign * arms
        # The arm at rest is 0: the first angle beside it tells whether the body comes back at all.
        if len(heeled_side) and righting[heeled_side[0]] <= 0.0:
            capsize.append(0.0)
        else:
            capsize.append(
                _first_change(
                    angles,
                    righting,
                    heeled_side,
                    positions,
                    lambda at, near, s=sign: s * heeling.arm(at, heeling.position(at, near)),
                )
            )
        flooding.append(_first_change(angles, dry_heights, side, positions, dry_height_at))
    return RightingCurve(
        angles=wanted,
        arms=arms[is_wanted],
        trims=np.array([trim for trim, _ in positions])[is_wanted],
        energies=np.array([state.energy for _, state in positions])[is_wanted] - rest.energy,
        is_free=free_trim,
        capsize=tuple(capsize),
        flooding=tuple(flooding),
    )


class _Heeling:
    """Positions of a body that heels. frame: (3, 3) rows forward, to the side and up at rest."""

    def __init__(self, frame: Array, free_trim: bool) -> None:
        self._frame = frame
        self._free_trim = free_trim

    def position(self, angle: float, near: _Position) -> _Position:
        """Return the trim and the state at an angle of heel, from those at another angle near it:
        by Newton's method, kept within the trims that are known to be too small and too large.
        """
        trim, state = near
        side = np.array([0.0, np.sin(angle), np.cos(angle)])  # u of the module at trim 0
        low, high = -np.inf, np.inf
        for _ in range(MAX_STEPS):
            up = (np.array([-np.sin(trim), 0.0, 0.0]) + np.cos(trim) * side) @ self._frame
            state = state.body.at(up, state)
            if not self._free_trim:
                break
            # the derivative of u by the trim
            along = (np.array([-np.cos(trim), 0.0, 0.0]) - np.sin(trim) * side) @ self._frame
            slope = float(state.arm @ along)
            if abs(slope) <= LEVEL_TRIM * state.body.size:
                break
            low, high = (low, trim) if slope > 0.0 else (trim, high)
            curvature = float(along @ state.stiffness @ along) - state.energy
            step = -slope / curvature if curvature > 0.0 else -np.sign(slope) * MAX_TRIM_STEP
            step = float(np.clip(step, -MAX_TRIM_STEP, MAX_TRIM_STEP))
            if abs(step) <= ANGLE_ATOL * 1e-3:
                break
            trim = trim + step if low < trim + step < high else (low + high) / 2.0
        return trim, state

    def arm(self, angle: float, position: _Position) -> float:
        """Return the righting arm: how far buoyancy pushes up at the side that is lower."""
        lower_side = np.array([0.0, np.cos(angle), -np.sin(angle)]) @ self._frame
        return float(position[1].arm @ lower_side)


def _first_change(
    angles: Array,
    values: Array,
    side: Index,
    positions: list[_Position],
    value_at: Callable[[float, _Position], float],
) -> float:
    """Return the angle nearest to zero at which values turn from positive to negative; nan if none
    does.

    side: indices of angles on one side, outward. value_at: the value at an angle near a position.
    """
    for i, j in zip(side, side[1:]):
        if not (values[i] > 0.0 >= values[j]):
            continue
        low, high, first, last = angles[i], angles[j], values[i], values[j]
        middle = high
        for _ in range(ROUNDS):
            # The Illinois method: regula falsi that halves the value at an end that is kept. If the
            # value at one end is infinite, that end is taken.
            middle = low + (high - low) * first / (first - last) if np.isfinite(last) else high
            value = value_at(float(middle), positions[i])
            if value > 0.0:
                low, first, last = middle, value, last / 2.0
            else:
                high, last, first = middle, value, first / 2.0
            if abs(high - low) <= ANGLE_ATOL or abs(value) <= ANGLE_ATOL * 1e-3:
                break
        return float(middle)
    return float("nan")
