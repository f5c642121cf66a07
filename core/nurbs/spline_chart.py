# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The coordinates of a B-spline patch: points, derivatives and nearest points anywhere on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numerics import Array, NDArray, dot
from ..verdict import WELDING_RTOL
from .bezier import DERIVATIVES, quotient_derivatives
from .quadric import Quadric
from .splines import Patch, homogeneous, patches_size

SAMPLES_PER_SPAN = 6  # density of the grid of first guesses
POINTS_PER_BLOCK = 1 << 20  # pairs of points and grid points compared at a time
STEPS = 30  # Limit of steps towards the nearest point.


@dataclass(frozen=True, eq=False)
class SplineChart:
    """A patch with its parameters as coordinates; one that closes goes on beyond its seam."""

    patch: Patch

    @cached_property
    def periods(self) -> tuple[float, float]:
        """Lengths of the directions that close, 0 for others."""
        tolerance = WELDING_RTOL * patches_size([self.patch])
        periods = []
        for axis, space in enumerate(self.patch.spaces):
            first, last = (self.patch.side(axis, end).points for end in (0, 1))
            closes = np.abs(first - last).max() <= tolerance
            periods.append((space.domain[1] - space.domain[0]) * bool(closes))
        return periods[0], periods[1]

    @cached_property
    def is_closed(self) -> bool:
        """Whether the patch has no boundary: it closes along its first parameter, and along the
        second or at points.
        """
        sides = [self.patch.side(1, end).points for end in (0, 1)]
        tolerance = WELDING_RTOL * patches_size([self.patch])
        ends_at_points = all(np.ptp(side, axis=0).max() <= tolerance for side in sides)
        return bool(self.periods[0] and (self.periods[1] or ends_at_points))

    @property
    def limits(self) -> tuple[float, float]:
        """Ends of the second parameter."""
        return self.patch.spaces[1].domain

    def knots(self, axis: int, low: float, high: float) -> Array:
        """Return the knots of a coordinate between two values."""
        inner = np.append(
            self.patch.spaces[axis].intervals[:, 0], self.patch.spaces[axis].domain[1]
        )
        period = self.periods[axis]
        if period:
            turns = np.arange(
                np.floor((low - inner[0]) / period), np.ceil((high - inner[0]) / period) + 1
            )
            inner = np.unique(inner[:-1] + period * turns[:, None])
        return inner[(inner > low) & (inner < high)]

    def step(self, each: int) -> tuple[float, float]:
        """Return the widths of tiles, `each` to a mean span."""
        low, high = np.array([space.domain for space in self.patch.spaces]).T
        width = (high - low) / [each * len(space.spans) for space in self.patch.spaces]
        return float(width[0]), float(width[1])

    def transform(self, matrix: NDArray) -> SplineChart:
        """Return the image of the patch under a (4, 4) affine map."""
        return SplineChart(self.patch.transform(matrix))

    def evaluate(self, u: NDArray, v: NDArray, most: int = 1) -> list[Array]:
        """Return (3, ...) points at coordinates, derivatives by u and v, and if most = 2 by uu, uv
        and vv.
        """
        tables, controls = [], []
        for space, at, period in zip(self.patch.spaces, (u, v), self.periods):
            low, high = space.domain
            if period:
                at = np.where((at < low) | (at > high), low + (at - low) % period, at)
            at = np.clip(at, low, high)
            spans = space.find_spans(at)
            tables.append(space.derivatives(spans, at, most))
            controls.append(space.controls_of_spans(spans))
        net = self._net[:, controls[0][..., :, None], controls[1][..., None, :]]
        halves = [np.einsum("d...ab,...b->d...a", net, table) for table in tables[1]]
        derivatives = [
            np.einsum("d...a,...a->d...", halves[j], tables[0][i]) for i, j in DERIVATIVES[most]
        ]
        if len(self._net) == 4:
            derivatives = quotient_derivatives(derivatives)
        derivatives[0] += self.patch.points[0, 0].reshape(3, *[1] * np.ndim(u))
        return derivatives

    def project(self, points: NDArray, guess: NDArray | None = None) -> Array:
        """Return (n, 2) coordinates of the points of the patch nearest to points, from a guess
        (n, 2).
        """
        best = at = self._nearest_samples(points) if guess is None else guess
        low, high = np.array([space.domain for space in self.patch.spaces]).T
        open_ends = ~np.array(self.periods, bool)
        flat = np.zeros((3, len(points)))
        step = np.zeros_like(at)
        nearest = np.full(len(points), np.inf)
        for _ in range(STEPS):
            place, *slopes = self.evaluate(*at.T)
            arms = points.T - place
            away = dot(arms, arms)
            # The margins are rounding, of squared distances and of squared coordinates.
            is_nearer = away <= (1.0 + 1e-10) * nearest + 1e-28 * np.square(self._net).max()
            best = np.where(is_nearer[:, None], at, best)
            nearest = np.where(is_nearer, away, nearest)
            ahead = _solve(*slopes, arms, flat)
            # A point at the end of a coordinate moves along the other one.
            is_held = open_ends & (((at <= low) & (ahead < 0.0)) | ((at >= high) & (ahead > 0.0)))
            if is_held.any():
                ahead = _solve(*(np.where(is_held.T[:, None], 0.0, slopes)), arms, flat)
            # A step that led away is tried again, a quarter as long; none is longer than a quarter
            # of the domain, both chosen.
            step = np.where(is_nearer[:, None], ahead, 0.25 * step)
            step = np.clip(step, -0.25 * (high - low), 0.25 * (high - low))
            at = best + step
            at[:, open_ends] = np.clip(at, low, high)[:, open_ends]
            if np.abs(at - best).max(initial=0.0) <= 1e-15 * np.abs(high - low).max():
                break
        return best

    def _nearest_samples(self, points: NDArray) -> Array:
        ends = [space.uniform_parameters(SAMPLES_PER_SPAN) for space in self.patch.spaces]
        # Not at the ends: from a pole no step leads to another meridian.
        rows = [(row[1:] + row[:-1]) / 2.0 for row in ends]
        grid = self.patch.evaluate_grid(*rows).reshape(-1, 3)
        step = max(1, POINTS_PER_BLOCK // len(grid))
        nearest = np.concatenate(
            [
                ((points[start : start + step, None] - grid) ** 2).sum(axis=2).argmin(axis=1)
                for start in range(0, len(points), step)
            ]
        )
        first, second = np.divmod(nearest, len(rows[1]))
        return np.stack([rows[0][first], rows[1][second]], axis=1)

    @cached_property
    def _net(self) -> Array:
        """(3 or 4, count_s, count_t) control points about the first."""
        net = homogeneous(self.patch.points - self.patch.points[0, 0], self.patch.weights)
        return np.ascontiguousarray(np.moveaxis(net, -1, 0))


def follow(chart: Quadric | SplineChart, points: NDArray, velocity: NDArray, at: NDArray) -> Array:
    """Return (n, 2) velocities of the nearest points of a surface, at coordinates (n, 2), as points
    move.
    """
    place, along, across, *second = chart.evaluate(*at.T, most=2)
    away = points.T - place
    # At nearest points, `away` is normal to both slopes. The derivative of this by time gives the
    # normal equations of the velocity, less the products of `away` and the second derivatives.
    return _solve(along, across, velocity.T, np.stack([dot(away, bend) for bend in second]))


def _solve(along: NDArray, across: NDArray, target: NDArray, bend: NDArray) -> Array:
    """Return the (n, 2) factors of two (3, n) slopes whose sum is nearest to (3, n) targets.

    bend: (3, n), subtracted from the products of the slopes: along², along · across and across².
    """
    # Normal equations: a u + b v = p, b u + c v = q.
    a = dot(along, along) - bend[0]
    b = dot(along, across) - bend[1]
    c = dot(across, across) - bend[2]
    p, q = dot(along, target), dot(across, target)
    determinant = a * c - b * b
    # At a pole one slope is zero, by 1e-12 of the other, and only the other coordinate can move.
    is_pole = ~(determinant > 1e-24 * (a + c) ** 2)
    determinant = np.where(is_pole, 1.0, determinant)
    first_at_pole = np.where(a > c, p / np.maximum(a, 1e-300), 0.0)
    second_at_pole = np.where(a > c, 0.0, q / np.maximum(c, 1e-300))
    first = np.where(is_pole, first_at_pole, (c * p - b * q) / determinant)
    second = np.where(is_pole, second_at_pole, (a * q - b * p) / determinant)
    return np.stack([first, second], axis=1)
