# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of a body and of a surface, in closed form at any frequency.

Zhang and Chen (2001) add up tetrahedra by a formula that divides by q·a, by q·(a-b) and so on: it
fails near every plane across an edge. The divergence theorem leaves one division, by q². With N =
(b-a) x (c-a) and `triangle_kernel`'s D

    ∫ exp(-i q·x) dV = i/q² Σ (q·N) (D - 1/2),    ∫ exp(-i q·x) dA = Σ |N| D.

The N of a closed surface add up to zero; therefore 1/2 may be taken off each D, which leaves terms
of the order of q·x, and nothing cancels as q goes to 0.

Error. u = 2^-53, A the area, R the reach from the center. A phase is off by a few u |q| R, a D by
that or by a few u, and |D - 1/2| is below 1 and below |q| R; q·N/q² is at most |N|/|q|. Altogether
the error is at most ROUNDING_FACTOR u A R for any q. N is found in twice the precision, because
slivers would lose more digits; so is the phase of the center, which may be far away.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import cast

import numpy as np

from ..mesh import Surface
from ..moments import Measure, U
from ..numerics import ArrayLike, Complex, phase_factors, two_sum
from ..polyhedron import polyhedron_moments
from ..verdict import MeasureError
from .findings import FOURIER_OF_OPEN_SURFACE
from .triangle_kernel import (
    PAIRS_PER_BLOCK,
    TRIANGLES_PER_BLOCK,
    PhaseMeans,
    SortedTriangles,
    TriangleBlock,
)
from .wave_vectors import FrequencyGrid, GridWaves, ListWaves, Spectrum, wave_vectors

# pairs of triangles and frequencies that are handed out at a time: about a tenth of a second
PAIRS_PER_TASK = 1 << 20
ZERO_WAVE_NUMBER = 1e-20  # |q| R below which F is V - i q·∫x dV, to all digits
OPEN_AREA_RTOL = 1e-6  # Relative to the area: above it a surface counts as open.
# a wave vector that is special to no body, of length 1.5
GENERIC_WAVE_VECTOR = np.array([[0.72, 0.9, 0.96]])
ROUNDING_FACTOR = 64.0


def solid_transform(surface: Surface, q: ArrayLike | FrequencyGrid, threads: int = 1) -> Spectrum:
    """Return the closed-form transform F(q) = ∫ exp(-i q·x) dV of the body in a closed surface.

    Parameters
    ----------
    surface : Surface
        Closed. The transform is signed as a volume is: positive for outward faces.
    q : (M, 3) array_like, or FrequencyGrid
        Wave vectors, rad per unit of length.
    threads : int

    Returns
    -------
    Spectrum
        Values in unit³.

    Raises
    ------
    MeasureError
        If the surface is open or has no faces, wave vectors are not finite, or sizes are beyond the
        range of numbers.
    ValueError
        If coordinates are not finite, or an index has no point.

    Notes
    -----
    Zhang and Chen (2001) sum over tetrahedra; here the divergence theorem is used, see the module.

    Examples
    --------
    >>> from body_moments.core import Surface, solid_transform
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> spectrum = solid_transform(surface, [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])
    >>> np.round(spectrum.values * 6, 6).tolist()
    [(1+0j), (0.062359-0.879355j)]
    """
    return run_to_completion(Transform(surface, q, Measure.VOLUME, threads))


def surface_transform(surface: Surface, q: ArrayLike | FrequencyGrid, threads: int = 1) -> Spectrum:
    """Return ∫ exp(-i q·x) dA over a surface, closed or not.

    Parameters
    ----------
    surface : Surface
    q : (M, 3) array_like, or FrequencyGrid
        Wave vectors, rad per unit of length.
    threads : int

    Returns
    -------
    Spectrum
        Values in unit².

    Raises
    ------
    MeasureError, ValueError
        As for `solid_transform`, except that surfaces may be open.

    Examples
    --------
    >>> from body_moments.core.fourier import surface_transform
    >>> from body_moments.core.mesh import Surface
    >>> triangle = Surface.from_triangles(np.eye(4, 3, -1), [[0, 1, 2]])
    >>> np.round(surface_transform(triangle, [[0.0, 0.0, 5.0]]).values, 9).tolist()
    [(0.5+0j)]
    """
    return run_to_completion(Transform(surface, q, Measure.AREA, threads))


def run_to_completion(transform: Transform) -> Spectrum:
    """Run all steps of a transform, and return its spectrum."""
    for _ in transform.steps():
        pass
    return transform.result()


class Transform:
    """A transform under way: `steps` does the work, `result` returns the spectrum.

    `q` are (M, 3) wave vectors or a grid; `of` is volume or area. MeasureError and ValueError as
    `solid_transform`.
    """

    def __init__(
        self, surface: Surface, q: ArrayLike | FrequencyGrid, of: Measure, threads: int = 1
    ):
        self.q = q if isinstance(q, FrequencyGrid) else wave_vectors(q, 3)
        self.measure = of
        self.threads = threads
        self.faces = SortedTriangles(surface)
        self.direct = self.faces  # the triangles that are summed in closed form
        self.volume, self.area = polyhedron_moments(
            surface, area_order=0, threads=threads, allow_open=True
        )
        self.gap = 0.0  # the part of the vector sum that only an open surface has
        if of == Measure.VOLUME:
            across = np.cross(GENERIC_WAVE_VECTOR[0], self._vector_sum())
            self.gap = float(np.linalg.norm(across)) / 1.5  # by the length of the wave vector
            if self.gap > OPEN_AREA_RTOL * self.faces.area:
                raise MeasureError(FOURIER_OF_OPEN_SURFACE)
        scale = self.faces.scale
        if isinstance(self.q, FrequencyGrid):
            self.waves = GridWaves(self.q, scale)
        else:
            self.waves = ListWaves(self.q * scale)
        # Sums in the order of `waves`, and what was rounded off them.
        self.sums, self.rest = np.zeros((2, self.waves.rows * self.waves.columns), np.complex128)

    def _vector_sum(self) -> Complex:
        """Return (3,) ∫ n exp(-i q·x) dA at GENERIC_WAVE_VECTOR, parallel to it for a closed
        surface.
        """
        waves = ListWaves(GENERIC_WAVE_VECTOR)
        total = np.zeros(3, np.complex128)
        for run in self.faces.blocks(PAIRS_PER_BLOCK):
            block = TriangleBlock(self.faces, run)
            real, imaginary = PhaseMeans(block, waves, slice(0, 1))(slice(0, 1))
            total += (block.normals * real).sum(axis=1) + 1j * (block.normals * imaginary).sum(
                axis=1
            )
        return total

    def steps(self) -> Iterator[float]:
        """Do the work in parts; yield the fraction done, from 0 to 1, after each."""
        block_size = min(TRIANGLES_PER_BLOCK, max(len(self.direct.triangles), 1))
        rows_per_task = max(1, PAIRS_PER_TASK // (block_size * self.waves.columns))
        rows = self.waves.rows
        parts = [slice(i, min(i + rows_per_task, rows)) for i in range(0, rows, rows_per_task)]
        tasks = [(run, part) for run in self.direct.blocks() for part in parts]
        if self.threads == 1:
            for done, task in enumerate(tasks, 1):
                self._add(*self._run_task(task))
                yield done / len(tasks)
            return
        with ThreadPoolExecutor(self.threads) as pool:
            waiting: list[Future] = []
            try:
                for submitted, task in enumerate(tasks, 1):
                    waiting.append(pool.submit(self._run_task, task))
                    if len(waiting) > 2 * self.threads:
                        self._add(*waiting.pop(0).result())
                        yield (submitted - len(waiting)) / len(tasks)
                for future in waiting:
                    self._add(*future.result())
                yield 1.0
            finally:
                for future in waiting:
                    future.cancel()

    def _add(self, part: slice, values: Complex) -> None:
        """Add a task's results by compensated summation: the rounding of thousands of sums would
        pile up.
        """
        self.sums[part], rest = two_sum(self.sums[part], values)
        self.rest[part] += rest

    def _run_task(self, task: tuple[slice, slice]) -> tuple[slice, Complex]:
        """Return the slice of a task's results, and Σ (q·N) (D - 1/2) or Σ |N| (D - 1/2) there.

        task: a run of triangles, and a part of the rows of the wave vectors.
        """
        run, part = task
        block = TriangleBlock(self.direct, run)
        columns = self.waves.columns
        means = PhaseMeans(block, self.waves, part)
        across = self.waves.dot(part, block.normals)
        size = max(1, PAIRS_PER_BLOCK // (len(block.lengths) * columns))
        sums = np.empty((part.stop - part.start) * columns, np.complex128)
        for i in range(part.start, part.stop, size):
            stop = min(i + size, part.stop)
            wave_rows = slice(i, stop)
            real, imaginary = means(wave_rows)
            weight = across(wave_rows) if self.measure == Measure.VOLUME else block.lengths
            place = slice((i - part.start) * columns, (stop - part.start) * columns)
            sums.real[place] = np.add.reduce(np.multiply(real, weight, out=real), axis=1)
            sums.imag[place] = np.add.reduce(np.multiply(imaginary, weight, out=imaginary), axis=1)
        return slice(part.start * columns, part.stop * columns), sums

    def result(self) -> Spectrum:
        """Return the spectrum, when all steps are done."""
        faces = self.faces
        sums = self.sums + self.rest
        if self.measure == Measure.AREA:
            ordered = sums + faces.area  # each D less 1/2, and Σ |N| is twice the area
            unit = faces.scale**2
            moments = self.area
        else:
            ordered = self._to_transform(sums)
            unit = faces.scale**3
            moments = self.volume
        if isinstance(self.q, FrequencyGrid):
            q = self.q.vectors()
            values = self.q.expand(ordered)
        else:
            q = self.q
            values = np.empty_like(ordered)
            values[cast("ListWaves", self.waves).order] = ordered
        values *= unit
        error = unit * (U * ROUNDING_FACTOR * faces.area + self.gap) + 8.0 * U * np.abs(values)
        return Spectrum(
            q, values * phase_factors(q, faces.center), error, float(moments.input_error[0])
        )

    def _to_transform(self, sums: Complex) -> Complex:
        """Return F in units of the scale: i/q² times the sums, or by the moments if q is zero."""
        q = self.waves.vectors(slice(0, self.waves.rows))
        square = (q * q).sum(axis=0)
        is_zero = square <= ZERO_WAVE_NUMBER**2
        values = 1j * sums / np.where(is_zero, 1.0, square)
        raw = self.volume.raw[:4] / self.faces.scale ** np.array([3, 4, 4, 4])
        about = (self.volume.about - self.faces.center) / self.faces.scale
        values[is_zero] = raw[0] - 1j * (q[:, is_zero].T @ (raw[1:] + raw[0] * about))
        return values
