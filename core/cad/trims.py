# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A test that closed curves in the parameters of a surface are just the boundary of its domain and trim nothing.

Sides of the domain that are one point of the surface (poles) may be left out. Sides that are the same curve (a seam),
and a seam at any other place of a closed surface, are run once in each direction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

TRIM_RTOL = 1e-7  # float32 rounding: distance of the curve from the sides, relative to the domain


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of a curve with (n, 2) control points. straight: True if they are the corners of a polygonal line."""

    points: NDArray[np.float64]
    straight: bool


def trims_nothing(
    pieces: Sequence[Piece],
    domain: tuple[tuple[float, float], tuple[float, float]],
    closed: Sequence[bool] = (False, False),
    poles: Sequence[Sequence[bool]] = ((False, False), (False, False)),
) -> bool:
    """Return whether the pieces run along the whole boundary once, always in the same sense of rotation.

    closed: whether the surface closes along each direction. poles: whether its side at the least and the largest value
    of each parameter is a point.
    """
    low, high = np.array(domain).T
    if not pieces or not (high > low).all():
        return False
    runs = _runs([((piece.points - low) / (high - low), piece.straight) for piece in pieces], closed)
    if runs is None:
        return False
    senses: set[float] = set()
    for axis in (0, 1):
        along = sorted((at, begin, end) for run, at, begin, end in runs if run == axis)
        sides_left = set() if closed[1 - axis] else {end for end in (0, 1) if not poles[1 - axis][end]}
        starts = [k for k, run in enumerate(along) if not k or run[0] - along[k - 1][0] > 2.0 * TRIM_RTOL]
        for first, last in zip(starts, [*starts[1:], len(along)]):
            net, total = _traversals([run[1:] for run in along[first:last]], closed[axis])
            side = next((end for end in (0, 1) if abs(along[first][0] - end) <= TRIM_RTOL), None)
            if side is None or closed[1 - axis]:
                is_right = not net.any() and (total <= 2).all()
            elif poles[1 - axis][side]:
                is_right = bool((total <= 1).all())
            else:
                is_right = bool((total == 1).all() and (net == net[0]).all())
                senses.add(float(net[0]) * (1.0 if (axis == 0) == (side == 0) else -1.0))
                sides_left.discard(side)
            if not is_right:
                return False
        if sides_left:
            return False
    return len(senses) <= 1


def _runs(
    pieces: Sequence[tuple[NDArray, bool]], closed: Sequence[bool]
) -> list[tuple[int, float, float, float]] | None:
    """Return runs along the directions of the unit square: the changing parameter, the other one, begin and end.

    pieces: control points, and True if they are corners. None if a piece runs across.
    """
    runs = []
    for points, straight in pieces:
        for row in np.stack([points[:-1], points[1:]], axis=1) if straight else points[None]:
            is_still = np.ptp(row, axis=0) <= TRIM_RTOL
            if is_still.all():
                continue
            axis = int(is_still.argmin())
            at, ends = float(row[:, 1 - axis].mean()), row[[0, -1], axis].tolist()
            is_beyond = min(ends) < -TRIM_RTOL or max(ends) > 1.0 + TRIM_RTOL
            if not is_still.any() or is_beyond and not closed[axis]:
                return None
            if closed[1 - axis]:  # A seam at the end of the domain is the one at its beginning.
                at = (at + TRIM_RTOL) % 1.0 - TRIM_RTOL
            runs.append((axis, at, *ends))
    return runs


def _traversals(runs: Sequence[tuple[float, float]], closed: bool) -> tuple[NDArray, NDArray]:
    """Return how often runs along a line pass each of its pieces: the difference of both directions, and the sum."""
    marks, changes = [0.0, 1.0], []
    for begin, end in runs:
        low, high, way = min(begin, end), max(begin, end), 1 if end > begin else -1
        turns = range(int(np.floor(low + TRIM_RTOL)), int(np.ceil(high - TRIM_RTOL))) if closed else [0]
        for turn in turns:
            ends = max(low - turn, 0.0), min(high - turn, 1.0)
            changes.append((*ends, way))
            marks += ends
    edges = np.unique(marks)
    middles = ((edges[:-1] + edges[1:]) / 2.0)[np.diff(edges) > 2.0 * TRIM_RTOL]
    passes = np.array([way * ((low < middles) & (middles < high)) for low, high, way in changes])
    return passes.sum(axis=0), np.abs(passes).sum(axis=0)
