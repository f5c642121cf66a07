# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave vectors, as a list or as a regular grid, with q·v and exp(-i q·x) for sums over faces.

On a list every phase costs a sine and a cosine. On a grid exp(-i q·x) is a product of three numbers
from tables, one for each axis. The tables hold sines and cosines, computed without a recurrence, so
that no error grows along an axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..moments import U
from ..numerics import Array, ArrayLike, Complex, NDArray
from ..verdict import MeasureError
from .findings import FREQUENCIES_INVALID, WAVE_VECTORS_RANGE, WAVE_VECTORS_SHAPE

MAX_FREQUENCY = 1e100  # its square is still a number, for any size of the body

# Both return arrays of shape (wave vectors of some rows, k).
Dot = Callable[[slice], Array]  # q·v
Phases = Callable[[slice], tuple[Array, Array]]  # cos(q·x) and sin(q·x)
EXACT, APPROXIMATE = "exact", "approximate"


@dataclass(frozen=True)
class FrequencyGrid:
    """A regular grid of wave vectors around 0, in the order of `numpy.fft.fftshift`.

    Parameters
    ----------
    count : int
        Frequencies along each axis, at least 2.
    largest : float
        The largest ``|q|`` along each axis, rad per unit of length. With h = count // 2 the j-th
        frequency of an axis is (j - h) / h · largest: 0 is always one of them, and an even count
        leaves out +largest.
    dimension : int
        3, or 2 for flat shapes.

    Raises
    ------
    MeasureError
        If `count` is below 2, or `largest` is not positive or above 1e100.

    Examples
    --------
    >>> from body_moments.core.fourier import FrequencyGrid
    >>> grid = FrequencyGrid(4, 10.0)
    >>> grid.axis().tolist(), grid.vectors().shape
    ([-10.0, -5.0, 0.0, 5.0], (64, 3))
    """

    count: int
    largest: float
    dimension: int = 3

    def __post_init__(self) -> None:
        if self.count < 2:
            raise MeasureError(FREQUENCIES_INVALID, need="at least two along each axis")
        if not 0.0 < self.largest <= MAX_FREQUENCY:
            raise MeasureError(
                FREQUENCIES_INVALID, need="a largest one that is positive and at most 1e100 rad/m"
            )

    @property
    def half(self) -> int:
        """Steps from 0 to the largest frequency."""
        return self.count // 2

    @property
    def step(self) -> float:
        """The distance between neighbors along an axis, rad per unit of length."""
        return self.largest / self.half

    def axis(self) -> Array:
        """Return the (count,) frequencies along each axis."""
        return (np.arange(self.count, dtype=np.float64) - self.half) * self.step

    def vectors(self) -> Array:
        """Return every wave vector, (count³, 3) or (count², 2), the last axis fastest."""
        axes = np.meshgrid(*[self.axis()] * self.dimension, indexing="ij")
        return np.stack(axes, axis=-1).reshape(-1, self.dimension)

    def expand(self, values: Complex) -> Complex:
        """Return all (count³,) or (count²,) values from those with last coordinate ≥ 0, both ends
        included.
        """
        n = self.count
        h = self.half
        values = np.asarray(values).reshape(*[2 * h + 1] * (self.dimension - 1), h + 1)
        opposite = np.flip(values).conj()  # F(-q) = conj F(q)
        # With an even count, the last frequency of each axis is no place of the grid.
        in_grid = (slice(n),) * (self.dimension - 1)
        full = np.empty((n,) * self.dimension, np.complex128)
        full[..., h:] = values[in_grid][..., : n - h]
        full[..., :h] = opposite[in_grid][..., :h]
        return full.reshape(-1)


def wave_vectors(q: ArrayLike, dimension: int) -> Array:
    """Return a user's (M, dimension) wave vectors as float64; MeasureError if shape, type or range
    is wrong.
    """
    q = np.asarray(q)
    if q.dtype.kind not in "fiu" or q.ndim != 2 or q.shape[1] != dimension:
        raise MeasureError(
            WAVE_VECTORS_SHAPE, dimension=dimension, shape=list(q.shape), type=str(q.dtype)
        )
    q = q.astype(np.float64)
    if not (np.abs(q) <= MAX_FREQUENCY).all():
        raise MeasureError(WAVE_VECTORS_RANGE)
    return q


class ListWaves:
    """A list of wave vectors (M, 3), sorted by size so that a block has similar ones; a row is one
    wave vector. Methods take the same arguments as those of `GridWaves`, and ignore `part`.
    """

    columns = 1

    def __init__(self, q: Array):
        self.order = np.argsort(np.sqrt((q * q).sum(axis=1)), kind="stable")
        self.q = np.ascontiguousarray(q[self.order].T)
        self.rows = len(q)

    def vectors(self, wave_rows: slice) -> Array:
        """Return the (3, m) wave vectors of some rows."""
        return self.q[:, wave_rows]

    def dot(self, part: slice, vectors: NDArray) -> Dot:
        """Return a function that returns q·v for the rows of a part and vectors (3, k)."""

        def products(wave_rows: slice) -> Array:
            x, y, z = self.q[:, wave_rows, None]
            return x * vectors[0] + y * vectors[1] + z * vectors[2]

        return products

    def phase_factors(self, part: slice, points: NDArray) -> Phases:
        """Return a function that returns cos(q·x) and sin(q·x) for the rows of a part and points
        (3, k).
        """
        dot = self.dot(part, points)

        def phases(wave_rows: slice) -> tuple[Array, Array]:
            phase = dot(wave_rows)
            return np.cos(phase), np.sin(phase)

        return phases


class GridWaves:
    """The half of a grid with z ≥ 0, times `scale`; the rest follows from F(-q) = conj F(q).

    Along x and y both ends are included, so that the half has every vector of the grid, or its
    opposite. A row has all z at one x and y.
    """

    def __init__(self, grid: FrequencyGrid, scale: float):
        steps = np.arange(-grid.half, grid.half + 1, dtype=np.float64)
        self.side: Array = np.asarray(steps * grid.step * scale, np.float64)
        self.depth = self.side[grid.half :]
        self.rows = len(self.side) ** 2
        self.columns = len(self.depth)

    def vectors(self, wave_rows: slice) -> Array:
        """Return the (3, m) wave vectors of some rows."""
        i, j = np.divmod(np.arange(wave_rows.start, wave_rows.stop), len(self.side))
        x = self.side[i]
        y = self.side[j]
        n = self.columns
        return np.stack([np.repeat(x, n), np.repeat(y, n), np.tile(self.depth, len(x))])

    def dot(self, part: slice, vectors: NDArray) -> Dot:
        """Return a function that returns q·v for the rows of a part and vectors (3, k)."""
        first, x, y = self._tables(part, vectors)
        z = self.depth[:, None] * vectors[2]

        def products(wave_rows: slice) -> Array:
            i, j = np.divmod(np.arange(wave_rows.start, wave_rows.stop), len(self.side))
            return ((x[i - first] + y[j])[:, None] + z).reshape(-1, z.shape[1])

        return products

    def phase_factors(self, part: slice, points: NDArray) -> Phases:
        """Return a function that returns cos(q·x) and sin(q·x) for the rows of a part and points
        (3, k).
        """
        first, x, y = self._tables(part, points)
        z = self.depth[:, None] * points[2]
        cos_x, sin_x = np.cos(x), np.sin(x)
        cos_y, sin_y = np.cos(y), np.sin(y)
        cos_z, sin_z = np.cos(z), np.sin(z)

        def phases(wave_rows: slice) -> tuple[Array, Array]:
            i, j = np.divmod(np.arange(wave_rows.start, wave_rows.stop), len(self.side))
            a, b = cos_x[i - first], sin_x[i - first]
            c, d = cos_y[j], sin_y[j]
            cos_xy = (a * c - b * d)[:, None]
            sin_xy = (a * d + b * c)[:, None]
            cosine = cos_xy * cos_z - sin_xy * sin_z
            sine = cos_xy * sin_z + sin_xy * cos_z
            return cosine.reshape(-1, points.shape[1]), sine.reshape(-1, points.shape[1])

        return phases

    def _tables(self, part: slice, vectors: NDArray) -> tuple[int, NDArray, NDArray]:
        """Return the first index along x that a part needs, the products with x from there on, and
        those with y.
        """
        n = len(self.side)
        first = part.start // n
        return (
            first,
            self.side[first : (part.stop - 1) // n + 1, None] * vectors[0],
            self.side[:, None] * vectors[1],
        )


@dataclass(frozen=True, eq=False)
class Spectrum:
    """∫ exp(-i q·x) at wave vectors q, (M, 3) or (M, 2) of a polygon, in rad per unit of length;
    spectra of bodies add.

    `values`: (M,), unit³ of a body, unit² of a surface or a polygon. `error`: (M,) of the values:
    for an "exact" spectrum a bound of the rounding, for an "approximate" one an estimate.
    `input_error`: a bound of the change that storing coordinates as float32 may have made, for any
    q. `method`: "exact" or "approximate".
    """

    q: Array
    values: Complex
    error: Array
    input_error: float = 0.0
    method: str = EXACT

    def __add__(self, other: Spectrum) -> Spectrum:
        """Add the spectrum of another body, at the same wave vectors."""
        method = EXACT if self.method == other.method == EXACT else APPROXIMATE
        return Spectrum(
            self.q,
            self.values + other.values,
            self.error + other.error,
            self.input_error + other.input_error,
            method,
        )

    def scale(self, factor: float) -> Spectrum:
        """Multiply by a positive factor, such as the thickness of a sheet."""
        return replace(
            self,
            values=self.values * factor,
            error=self.error * factor,
            input_error=self.input_error * factor,
        )

    def multiply_by_phases(self, waves: Complex, count: int) -> Spectrum:
        """Return the spectrum of `count` copies together, from the (M,) sums of exp(-i q·t) over
        their places.
        """
        # Of each phase, with a margin, and of the sum of the copies.
        rounding = (8.0 + count) * count * U * np.abs(self.values)
        return replace(
            self,
            values=self.values * waves,
            error=count * self.error + rounding,
            input_error=count * self.input_error,
        )
