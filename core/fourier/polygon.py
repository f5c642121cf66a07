# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of plane polygons with holes, in closed form at any frequency.

The formulas of `transform` for a body hold one dimension lower: with the edges e, their outward
normals n of the same length, the phases m in their middles and half the phase t along them

    ∫ exp(-i q·x) dA = i/q² Σ (q·n) (exp(-i m) sinc(t) - 1).
"""

from collections.abc import Iterator, Sequence
from math import factorial

import numpy as np

from ..moments import U
from ..numerics import Array, ArrayLike, Complex, NDArray, check_filled, float_array, phase_factors
from .transform import ROUNDING_FACTOR, ZERO_WAVE_NUMBER
from .triangle_kernel import PAIRS_PER_BLOCK
from .wave_vectors import FrequencyGrid, Spectrum, wave_vectors

SERIES_TERMS = 10  # Terms of sinc(t) - 1 for t up to 1.


def polygon_transform(loops: Sequence[ArrayLike], q: ArrayLike) -> Spectrum:
    """Return the closed-form transform F(q) = ∫ exp(-i q·x) dA of polygons in the plane.

    Parameters
    ----------
    loops : sequence of (n, 2) array_like
        Outlines counter-clockwise, holes clockwise. If they overlap, each counts, with its sign.
    q : (M, 2) array_like
        Wave vectors, rad per unit of length.

    Returns
    -------
    Spectrum
        Values in unit².

    Raises
    ------
    ValueError
        If a loop is not three or more rows of two finite numbers.
    MeasureError
        If the wave vectors are not finite (M, 2).

    Examples
    --------
    >>> from body_moments.core.fourier import polygon_transform
    >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    >>> np.round(polygon_transform([square], [[0.0, 0.0], [np.pi, 0.0]]).values, 6).tolist()
    [(1+0j), -0.63662j]
    """
    corners = [float_array("loops", loop, "n", 2, finite=True) for loop in loops]
    check_filled("loops", corners)
    if min(map(len, corners)) < 3:
        raise ValueError("loops below three points")
    points = np.concatenate(corners)
    starts = np.cumsum([0, *map(len, corners)])
    following = np.arange(1, len(points) + 1)
    following[starts[1:] - 1] = starts[:-1]
    transform = RegionTransform(points, np.stack([np.arange(len(points)), following], axis=1), q)
    for _ in transform.steps():
        pass
    return transform.result()


class RegionTransform:
    """The transform of a plane region under way: `steps` does the work, `result` returns the
    spectrum.

    The (m, 2) edges are closed; the inside lies to the left of each. `q` are (M, 2) wave vectors,
    rad per unit of length, or a grid of two dimensions. `rounded` and `stored` bound the shift of
    each coordinate by rounding and by storing as float32. MeasureError if the wave vectors are not
    finite (M, 2), ValueError if coordinates are not.
    """

    def __init__(
        self,
        points: NDArray,
        edges: NDArray,
        q: ArrayLike | FrequencyGrid,
        rounded: float = 0.0,
        stored: float = 0.0,
    ):
        self.grid = q if isinstance(q, FrequencyGrid) else None
        self.vectors = half_of_grid(q) if isinstance(q, FrequencyGrid) else wave_vectors(q, 2)
        ends = points[edges.ravel()] if len(edges) else np.zeros((1, 2))
        if not np.isfinite(ends).all():
            raise ValueError("coordinates must be finite")
        self.center = ends.min(axis=0) / 2.0 + ends.max(axis=0) / 2.0
        reach = np.sqrt(((ends - self.center) ** 2).sum(axis=1)).max()
        exponent = int(np.ceil(np.log2(reach))) if reach > 0.0 else 0
        self.scale = float(np.ldexp(1.0, exponent))
        self.start, self.end = ((points[edges[:, i]] - self.center) / self.scale for i in (0, 1))
        self.perimeter = float(np.hypot(*(self.end - self.start).T).sum()) * self.scale
        # An edge that moves sweeps over its length times the way, and a little at its ends.
        self.rounding_error, self.input_error = (
            np.sqrt(2.0) * step * (self.perimeter + 3.0 * step * len(edges))
            for step in (rounded, stored)
        )
        self.values = np.empty(len(self.vectors), np.complex128)

    def steps(self) -> Iterator[float]:
        """Do the work in parts; yield the fraction done, from 0 to 1, after each."""
        edge = self.end - self.start
        middle = (self.start + self.end).T / 2.0
        half = edge.T / 2.0
        normal = np.stack([edge[:, 1], -edge[:, 0]])
        size = max(1, PAIRS_PER_BLOCK // max(1, len(edge)))
        for begin in range(0, len(self.vectors), size):
            part = slice(begin, begin + size)
            self.values[part] = _edge_sum(middle, half, normal, self.vectors[part] * self.scale)
            yield min(1.0, (begin + size) / len(self.vectors))

    def result(self) -> Spectrum:
        """Return the spectrum, when all steps are done."""
        scale = self.scale
        values = self.values
        q = self.vectors
        is_zero = np.sqrt((q**2).sum(axis=1)) * scale <= ZERO_WAVE_NUMBER
        if is_zero.any():  # A - i q·∫x dA
            edge = self.end - self.start
            cross = self.start[:, 0] * edge[:, 1] - self.start[:, 1] * edge[:, 0]
            first_moment = (cross[:, None] * (self.start + self.end)).sum(axis=0) / 6.0
            values[is_zero] = cross.sum() / 2.0 - 1j * (q[is_zero] @ first_moment * scale)
        values = values * scale**2 * phase_factors(q, self.center)
        if self.grid is not None:
            q = self.grid.vectors()
            values = self.grid.expand(values)
        error = U * ROUNDING_FACTOR * self.perimeter * scale + self.rounding_error
        return Spectrum(q, values, error + 8.0 * U * np.abs(values), float(self.input_error))


def half_of_grid(grid: FrequencyGrid) -> Array:
    """Return ((2h+1)(h+1), 2) wave vectors of a grid with y ≥ 0; the values at the others are
    conjugates.
    """
    steps: Array = np.arange(-grid.half, grid.half + 1, dtype=np.float64) * grid.step
    return np.stack(np.meshgrid(steps, steps[grid.half :], indexing="ij"), axis=-1).reshape(-1, 2)


def _edge_sum(middle: NDArray, half: NDArray, normal: NDArray, q: NDArray) -> Complex:
    """Return the module's sum over k edges at (M, 2) wave vectors, (M,); middles, half edges and
    normals are (2, k).
    """
    half_phase, t, across = (
        sum((np.multiply.outer(a, b) for a, b in zip(q.T, vectors)), np.zeros(()))
        for vectors in (middle / 2.0, half, normal)
    )
    # exp(-i m) - 1, without cancellation
    turn = -2.0 * np.sin(half_phase) * (np.sin(half_phase) + 1j * np.cos(half_phase))
    square = np.maximum((q.T**2).sum(axis=0), ZERO_WAVE_NUMBER**2)
    return 1j * (across * (turn + (1.0 + turn) * _sinc_minus_one(t))).sum(axis=1) / square


def _sinc_minus_one(t: NDArray) -> Array:
    """Return sin(t) / t - 1, accurate to its last digits."""
    square = np.minimum(t * t, 1.0)
    series = np.zeros_like(t)
    for k in range(SERIES_TERMS, 0, -1):
        series = square * (series + (-1.0) ** k / factorial(2 * k + 1))
    is_large = np.abs(t) > 1.0
    return np.where(is_large, np.sin(t) / np.where(is_large, t, 1.0) - 1.0, series)
