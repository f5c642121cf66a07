# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The constant set of a smooth trivariate: a B-spline of higher order, to a stated tolerance.

The spline is evaluated on finer grids; their trilinear interpolants converge to it with the square
of the spacing. So a third of the difference between two interpolants is added to the finer one
(Richardson). The change of the result from one grid to the next is the estimate of its error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import cast

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

    def body_of(values: NDArray, parts: int) -> ThresholdBody:
        """Return the body of the interpolant of values at `parts` points for each sample."""
        finer = matrix @ place @ np.diag([1.0 / parts] * 3 + [1.0])
        return threshold_body(values, threshold, order, finer, with_density=with_density)

    coarse = best = body_of(spline_values(samples, spline_order, 1), 1)
    parts = 2
    while True:
        values = spline_values(samples, spline_order, parts)
        fine = body_of(values, parts)
        extrapolated = _change_moments(fine, coarse, _extrapolate)
        bounded = _change_moments(extrapolated, best, _add_to_bounds)
        volume_error = bounded.volume.rounding_error[0]
        # The next grid would have eight times as many samples.
        if volume_error <= TOLERANCE * bounded.volume.total or 8 * values.size > MAX_SAMPLES:
            return bounded
        coarse = fine
        best = extrapolated
        parts = 2 * parts


def spline_values(coefficients: NDArray, order: int, parts: int) -> Array:
    """Return a uniform spline's values at its (nx, ny, nz) coefficients and between them.

    The values, (parts (nx - 1) + 1, …), are at multiples of 1 / parts. Beyond the edge of the grid,
    its outermost coefficients are repeated.
    """
    values = np.asarray(coefficients, np.float64)
    reach = (order + 1) // 2
    for axis in range(3):
        lines = np.moveaxis(values, axis, 0)
        count = len(lines)
        padded = np.pad(lines, ((reach, reach), (0, 0), (0, 0)), mode="edge")
        finer = np.zeros((parts * (count - 1) + 1, *lines.shape[1:]))
        # Points at the same fraction of a step have the same weights for their neighbors.
        for phase in range(parts):
            at_phase = finer[phase::parts]
            for shift in range(-reach, reach + 1):
                weight = _cardinal(order, phase / parts - shift)
                if weight:
                    at_phase += weight * padded[reach + shift :][: len(at_phase)]
        values = np.moveaxis(finer, 0, axis)
    return values


def _cardinal(order: int, x: float) -> float:
    """Return the value at x of the centered B-spline of this order, with knots at unit distance."""
    return sum(
        (-1.0) ** j * math.comb(order, j) * max(x + order / 2.0 - j, 0.0) ** (order - 1)
        for j in range(order + 1)
    ) / math.factorial(order - 1)


def _extrapolate(moments: Moments, difference: Array) -> Moments:
    """Return the limit of moments, as half the spacing leaves a quarter of their error."""
    return replace(moments, raw=moments.raw + 1.0 / 3.0 * difference)


def _add_to_bounds(moments: Moments, difference: Array) -> Moments:
    """Return moments whose bounds include a difference."""
    return replace(moments, rounding_error=moments.rounding_error + np.abs(difference))


def _change_moments(
    body: ThresholdBody, other: ThresholdBody, change: Callable[[Moments, Array], Moments]
) -> ThresholdBody:
    """Return the body with all its moments changed by a function of these moments and (K,) their
    differences from another body's.
    """

    def changed(moments: Moments, other_moments: Moments) -> Moments:
        return change(moments, moments.raw - other_moments.about_point(moments.about).raw)

    mass = None if body.mass is None else changed(body.mass, cast("Moments", other.mass))
    return replace(
        body,
        volume=changed(body.volume, other.volume),
        area=changed(body.area, other.area),
        mass=mass,
    )
