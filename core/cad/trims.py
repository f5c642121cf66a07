# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A test that a closed curve in the parameters of a surface is just the boundary of its domain and trims nothing."""

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


def trims_nothing(pieces: Sequence[Piece], domain: tuple[tuple[float, float], tuple[float, float]]) -> bool:
    """Return whether the pieces run once around the domain, in either sense, end to end and always on its sides."""
    low, high = np.array(domain).T
    if not (high > low).all():
        return False
    steps: list[float] = []
    last = None
    for piece in pieces:
        points = (piece.points - low) / (high - low)
        if last is not None and np.abs(points[0] - last).max() > TRIM_RTOL:
            return False
        last = points[-1]
        sides = _sides(points)
        if not piece.straight and not sides.all(axis=0).any():
            return False  # A smooth curve around a corner of the domain cuts it off.
        for start, end, here, there in zip(points[:-1], points[1:], sides[:-1], sides[1:]):
            shared = here & there
            if not shared.any():
                return False
            x, y = end - start
            steps.append(float((x, y, -x, -y)[int(shared.argmax())]))  # counterclockwise
    if last is None or np.abs((pieces[0].points[0] - low) / (high - low) - last).max() > TRIM_RTOL:
        return False
    traveled = sum(steps)
    one_way = all(step * np.sign(traveled) >= -TRIM_RTOL for step in steps)
    return one_way and round(abs(traveled) / 4.0) == 1  # a closed curve runs around a whole number of times


def _sides(points: NDArray) -> NDArray[np.bool_]:
    """Return an (n, 4) mask of the sides of the unit square that each point is on: bottom, right, top, left."""
    x, y = points.T
    return np.abs(np.stack([y, x - 1.0, y - 1.0, x], axis=1)) <= TRIM_RTOL
