# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The constant set of a smooth trivariate: a B-spline of higher order, to a stated tolerance.

The spline is evaluated on finer grids; their trilinear interpolants converge to it with the square
of the spacing. So a third of the difference between two interpolants is added to the finer one
(Richardson). The change of the result from one grid to the next is the estimate of its error.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..moments import Moments
from ..numerics import Array, ArrayLike, NDArray
from .threshold import ThresholdBody, threshold_body

MAX_SAMPLES = 1 << 24  # Limit for the finest grid.
TOLERANCE = 1e-4  # Allowed difference of two grids, relative to the volume.


def smooth_threshold_body(
    samples: ArrayLike,
    threshold: float,
    spline_order: int,
    order: int = 3,
    matrix: ArrayLike | None = None,
    background: float | None = None,
    with_density: bool = False,
) -> ThresholdBody:
    """Return the moments of the set on which a uniform spline of (nx, ny, nz) coefficients is at
    least a threshold.

    The spline order is 3 or more; 4 is cubic. The other parameters are as for `threshold_body`.
    Without a background below the threshold, the outermost coefficients are repeated beyond the
    grid, but the body is cut off at its edge. The bounds include the difference of the last two
    extrapolations.
    """
    samples = np.asarray(samples, np.float64)
    matrix = np.eye(4) if matrix is None else np.asarray(matrix, np.float64)
    place = np.eye(4)
    if background is not None and background < threshold:
        margin = (spline_order + 1) // 2
        samples = np.pad(samples, margin, constant_values=background)
        place[:3, 3] = -margin
    coarse = extrapolated = None
    parts = 1
    while True:
        values = spline_values(samples, spline_order, parts)
        finer = matrix @ place @ np.diag([1.0 / parts] * 3 + [1.0])
        body = threshold_body(values, threshold, order, finer, with_density=with_density)
        if coarse is not None:
            last = extrapolated or coarse
            extrapolated = _combine(body, coarse, 1.0 / 3.0)
            estimated = _combine(extrapolated, last, None)
            error = estimated.volume.rounding_error[0]
            if error <= TOLERANCE * estimated.volume.total or 8 * values.size > MAX_SAMPLES:
                return estimated
        coarse = body
        parts = 2 * parts


def spline_values(coefficients: NDArray, order: int, parts: int) -> Array:
    """Return a uniform spline's values (parts (nx - 1) + 1, …) at its (nx, ny, nz) coefficients and
    between them.
    """
    values = np.asarray(coefficients, np.float64)
    reach = (order + 1) // 2
    for axis in range(3):
        lines = np.moveaxis(values, axis, 0)
        count = len(lines)
        padded = np.pad(lines, ((reach, reach), (0, 0), (0, 0)), mode="edge")
        finer = np.zeros((parts * (count - 1) + 1, *lines.shape[1:]))
        for phase in range(parts):
            between = finer[phase::parts]
            for shift in range(-reach, reach + 1):
                weight = _cardinal(order, phase / parts - shift)
                if weight:
                    between += weight * padded[reach + shift :][: len(between)]
        values = np.moveaxis(finer, 0, axis)
    return values


def _cardinal(order: int, x: float) -> float:
    """Return the value at x of the centered B-spline of this order, with knots at unit distance."""
    return sum(
        (-1.0) ** j * math.comb(order, j) * max(x + order / 2.0 - j, 0.0) ** (order - 1)
        for j in range(order + 1)
    ) / math.factorial(order - 1)


def _combine(body: ThresholdBody, other: ThresholdBody, share: float | None) -> ThresholdBody:
    """Add to the moments a share of their difference from another body's; if None, add it to their
    bounds.
    """

    def combined(fine: Moments, coarse: Moments) -> Moments:
        difference = fine.raw - coarse.about_point(fine.about).raw
        if share is None:
            return replace(fine, rounding_error=fine.rounding_error + np.abs(difference))
        return replace(fine, raw=fine.raw + share * difference)

    names = [name for name in ("volume", "area", "mass") if getattr(body, name) is not None]
    return replace(
        body, **{name: combined(getattr(body, name), getattr(other, name)) for name in names}
    )
