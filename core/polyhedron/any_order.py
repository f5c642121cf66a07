# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and surface moments of any order of triangles and quads, in memory or as a stream, with
rigorous bounds.

Sheynin and Tuzikov (*Explicit formulae for polyhedra moments*, Pattern Recognition Letters 22,
2001): with the coefficients S_pqr of 1 / ((1-a·ξ)(1-b·ξ)(1-c·ξ)), the integrals over the cone from
the origin on a triangle a, b, c with determinant w, and over the triangle itself, with doubled area
A, are

    ∫ x^p y^q z^r dV = w p! q! r! / (p+q+r+3)! S_pqr,
    ∫ x^p y^q z^r dA = A p! q! r! / (p+q+r+2)! S_pqr.

The recursion of `any_order_kernel` replaces their explicit sum for S. Coordinates are taken about a
point of the body, and scaled by a power of two to at most about 1 if they are far from it, so that
high powers stay in range.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import InitVar, dataclass
from functools import lru_cache
from itertools import chain, islice
from math import frexp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inertia import MOMENTS_OVERFLOW
from ..mesh import Surface, turned_quads
from ..moments import Measure, Moments, U, unchecked_moments
from ..moments.exponents import (
    count_of_degree,
    factorial_ratios,
    monomial_count,
    monomial_values,
    monomials,
    quotient_indices,
)
from ..numerics import Array, batches, cross, dot, indices_in_range
from ..verdict import MeasureError, check_size
from .any_order_kernel import UNDERFLOW_BOUND, AnyOrderKernel, Sums, absolute_sums, row_count
from .third_order import NO_VERTEX, box_center, finite_box, nothing, paired_corners

SCRATCH_NUMBERS = (
    1_400_000  # limit of a block's scratch; with smaller blocks, two threads wait for each other
)
# Least faces in a block: numpy copies reused rows that are shorter than half its buffer of 8192.
MIN_FACES_PER_BLOCK = 4608
BLOCKS_PER_TASK = 8  # blocks that are handed to a thread at once
MAX_UNSCALED_EXPONENT = 8  # powers of two up to which coordinates are left as they are
MAX_EXPONENT = 1000.0  # powers of two beyond which a moment overflows
TRIANGLES_PER_BLOCK = 512  # triangles whose levels stay in the cache


@lru_cache
def area_factors(order: int) -> Array:
    """Return the (K,) factors p! q! r! / (p+q+r+2)! of the monomials."""
    return factorial_ratios(monomials(order), 2)


def _exponent(reach: float) -> int:
    """Return the exponent of the power of two that scales a body with this reach: 0 if its size is
    usual.
    """
    exponent = frexp(reach)[1]
    return exponent if abs(exponent) > MAX_UNSCALED_EXPONENT else 0


@dataclass(frozen=True, eq=False)
class _FaceBatch:
    """Faces, (m, 3) or (m, 4), of a piece of the body. size: faces in a block. half_ulp: (3,) of
    the points.
    """

    points: NDArray
    faces: NDArray
    size: int
    half_ulp: Array


class _CompensatedSum:
    """A running sum of arrays, with the rounding errors of the additions (Neumaier), and the sums
    for its bounds.
    """

    def __init__(self, order: int, weights: int):
        self.order, self.weights = order, weights
        self.high = self.low = self.sizes = np.zeros(())
        self.faces = 0
        self.pending: list[Sums] = []

    def add(self, part: Sums) -> None:
        """Add a block's sums."""
        total = self.high + part.sums
        grown = total - self.high
        self.low = self.low + ((self.high - (total - grown)) + (part.sums - grown))
        self.high = total
        last = self.pending[-1] if self.pending else part
        columns = sum(waiting.chunks.shape[1] for waiting in self.pending)
        if (
            len(last.chunks) != len(part.chunks)
            or not np.array_equal(last.half_ulp, part.half_ulp)
            or columns * count_of_degree(self.order) * 3 * self.weights > SCRATCH_NUMBERS
        ):
            self.flush()
        self.pending.append(part)

    def flush(self) -> None:
        """Add up the bounds of the pending blocks: many at once, which is faster."""
        if self.pending:
            self.sizes = self.sizes + absolute_sums(self.order, self.weights, self.pending)
            self.pending = []


@dataclass(eq=False)
class StreamIntegrator:
    """One body being measured, piece by piece.

    Without `center` and `reach`, its first piece sets point and scale.
    """

    order: int
    area: bool
    threads: int
    progress: Callable[[int], None] | None
    center: Array | Any
    reach: InitVar[float | None]

    def __post_init__(self, reach: float | None) -> None:
        self.exponent: int | Any = None if reach is None else _exponent(reach)
        self.idle: list[AnyOrderKernel] = []
        self.half_ulp = np.zeros(3)

    def integrate(self, stream: Iterable[Surface]) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume and, if wanted, of the area."""
        total = _CompensatedSum(self.order, 2 if self.area else 1)
        for faces, parts in self._ordered_results(self._tasks(stream)):
            for part in parts:
                total.add(part)
            total.faces += faces
            if self.progress is not None:
                self.progress(total.faces)
        total.flush()
        if not total.faces:
            return nothing(self.order, self.center)
        return self._moments(total, Measure.VOLUME), self._moments(
            total, Measure.AREA
        ) if self.area else None

    def _ordered_results(self, tasks: Iterator[_FaceBatch]) -> Iterator[tuple[int, list[Sums]]]:
        """Yield the results of `_run` in the order of the tasks, whichever finishes first; a few
        run at a time.
        """
        first = list(islice(tasks, min(self.threads, 2)))
        alone = len(first) < 2
        tasks = chain(first, tasks)
        del first  # the list holds pieces of a stream
        if alone:  # one thread, or one task: starting threads would take longer than the work
            yield from map(self._run, tasks)
            return
        with ThreadPoolExecutor(self.threads) as pool:
            waiting: deque = deque()
            for task in tasks:
                waiting.append(pool.submit(self._run, task))
                if len(waiting) > 2 * self.threads:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()

    def _tasks(self, stream: Iterable[Surface]) -> Iterator[_FaceBatch]:
        for surface in stream:
            if not len(surface.triangles) + len(surface.quads):
                continue
            points = np.ascontiguousarray(surface.points)
            if points.dtype != np.float32:
                points = points.astype(np.float64, copy=False)
            self._choose_frame(surface)
            half_ulp = surface.coordinate_error
            self.half_ulp = np.maximum(self.half_ulp, half_ulp)
            for faces in (surface.triangles, surface.quads):
                size = self._size(faces)
                blocks = -(-len(faces) // size)
                step = size * (
                    BLOCKS_PER_TASK
                    if self.threads == 1
                    else max(1, min(BLOCKS_PER_TASK, blocks // (4 * self.threads)))
                )
                for start in range(0, len(faces), step):
                    yield _FaceBatch(points, faces[start : start + step], size, half_ulp)

    def _size(self, faces: NDArray) -> int:
        """Return the number of faces in a block, even, so that 2 or 4 threads get equally many
        blocks.
        """
        corners = faces.shape[1]
        # The kernel takes two triangles that share an edge as one face.
        ours = 2 if corners == 3 and paired_corners(faces[:2]) is not None else 1
        most = ours * max(
            SCRATCH_NUMBERS // row_count(corners + ours - 1, self.order, 1), MIN_FACES_PER_BLOCK
        )
        blocks = -(-len(faces) // (4 * most)) * 4
        blocks = max(1, min(blocks, len(faces) // (ours * MIN_FACES_PER_BLOCK)))
        return max(2, -(-len(faces) // (2 * blocks)) * 2)

    def _choose_frame(self, surface: Surface) -> None:
        """Set the reference point and the scale by the first piece, unless they are given."""
        low, high = finite_box(surface)
        if self.center is None:
            self.center = box_center(low, high, surface.points.dtype)
        largest = float(np.maximum(high - self.center, self.center - low).max())
        check_size(4.0 * largest)
        if self.exponent is None:
            self.exponent = _exponent(largest)
        beyond = frexp(largest)[1] - self.exponent
        if (beyond + 2) * (self.order + 3) > MAX_EXPONENT:
            raise ValueError("about and reach needed")
        if (max(beyond, 0) + self.exponent) * (self.order + 3) > MAX_EXPONENT:
            raise MeasureError(MOMENTS_OVERFLOW, order=int(self.order))

    def _run(self, task: _FaceBatch) -> tuple[int, list[Sums]]:
        """Run one task, in any thread.

        Return its number of faces and the sums of each of its blocks.
        """
        if not indices_in_range(task.faces, len(task.points)):
            raise ValueError(NO_VERTEX)
        levels = self.idle.pop() if self.idle else AnyOrderKernel(self.order, self.area)
        block_sums = [
            levels.block_sums(
                task.points, self.center, 2.0**-self.exponent, task.half_ulp, corners, size
            )
            for corners, size in self._blocks(task)
        ]
        self.idle.append(levels)
        return len(task.faces), block_sums

    @staticmethod
    def _blocks(task: _FaceBatch) -> Iterator[tuple[Sequence[NDArray] | NDArray, int]]:
        """Yield the corners of each block's faces (cut quads, paired or single triangles), and a
        full block's size.
        """
        for start in range(0, len(task.faces), task.size):
            faces = task.faces[start : start + task.size]
            if faces.shape[1] == 4:
                faces = turned_quads(task.points, faces)
            halves = paired_corners(faces) if faces.shape[1] == 3 else None
            yield (faces.T, task.size) if halves is None else (halves, task.size // 2)

    def _moments(self, total: _CompensatedSum, of: Measure) -> Moments:
        """Return the moments in the body's own unit, with their bounds, from the sums."""
        degree = monomials(self.order).sum(axis=1)
        row, dimension = (0, 3) if of == Measure.VOLUME else (1, 2)
        factors = area_factors(self.order) / ((degree + 3.0) if of == Measure.VOLUME else 1.0)
        sizes = total.sizes[3 * row : 3 * row + 3]
        raw = (total.high[row] + total.low[row]) * factors
        # ∫ |x^α| is at most weight reach^α / this
        mean = 2.0 * ((degree + 3.0) if of == Measure.VOLUME else 1.0)
        rounding = U * (8.0 * degree + 228.0)
        error = (
            (rounding * sizes[0] + sizes[1]) * (1.0 + 1e-9) / mean
            + 8.0 * U * np.abs(raw)
            + UNDERFLOW_BOUND * total.faces
        )
        moved = self._input_error(total, of) if self.half_ulp.any() else np.zeros(len(raw))
        powers = self.exponent * (degree + dimension)
        return Moments(
            np.ldexp(raw, powers),
            self.center,
            of,
            np.ldexp(error, powers) + np.finfo(float).tiny,
            np.ldexp(moved, powers),
        )

    def _input_error(self, total: _CompensatedSum, of: Measure) -> Array:
        """Return bounds of the change if vertices move by half ulps, from the swept volume or the
        added area.
        """
        swept = total.sizes[2] * (1.0 + 1e-9)
        if of == Measure.VOLUME:
            return swept
        moved = total.sizes[5] * (1.0 + 1e-9)
        half_ulp = np.ldexp(self.half_ulp, -self.exponent)
        table = monomials(self.order)
        for degree in range(1, self.order + 1):
            known = monomial_count(degree - 1)
            below = monomial_count(degree - 2)
            lower = np.append(swept[below:known], 0.0) / np.linalg.norm(half_ulp)
            for axis, quotients in enumerate(quotient_indices(degree, count_of_degree(degree - 1))):
                moved[known : monomial_count(degree)] += (
                    table[known : monomial_count(degree), axis] * half_ulp[axis] * lower[quotients]
                )
        return moved


def extend_small_moments(
    volume: Moments,
    order: int,
    points: NDArray,
    triangles: NDArray[np.integer],
    counts: NDArray[np.integer],
    reach: NDArray,
) -> Moments:
    """Return moments of n bodies, `volume` (n, 20), to a higher order; reach: (n, 3) from their
    reference points.
    """
    known = volume.raw.shape[1]
    ends = np.cumsum(counts)
    powers = monomials(order)[known:]
    degree = powers.sum(axis=1)
    factors = area_factors(order)[known:] / (degree + 3.0)
    coordinates = np.ascontiguousarray(points.T)
    sums = []
    sizes = []
    for part in batches(counts, TRIANGLES_PER_BLOCK):
        rows = triangles[ends[part.start] - counts[part.start] : ends[part.stop - 1]]
        own = counts[part]
        corners = coordinates.take(rows.T, axis=1).astype(np.float64, copy=False)
        a, b, c = (corners - np.repeat(volume.about[part].T, own, axis=1)[:, None]).transpose(
            1, 0, 2
        )
        det = dot(a, cross(b - a, c - a))
        starts = np.cumsum(own) - own
        sums.append(np.add.reduceat(_coefficients(a, b, c, order)[known:] * det, starts, axis=1).T)
        sizes.append(np.add.reduceat(np.abs(det), starts))
    raw = np.concatenate(sums) * factors
    largest = monomial_values(reach, order)[:, known:]
    # A coefficient has an error of (6 n + 8) u, a determinant that of the known total, and sums
    # that of their lengths.
    relative = U * (14.0 * degree + 16.0 + 3.0 * counts[:, None])
    size = np.concatenate(sizes)[:, None] / (2.0 * degree + 6.0)
    error = (relative * size + 2.0 * volume.rounding_error[:, :1]) * largest + 8.0 * U * np.abs(raw)
    return unchecked_moments(
        np.concatenate([volume.raw, raw], axis=1),
        volume.about,
        Measure.VOLUME,
        np.concatenate([volume.rounding_error, error], axis=1),
        np.concatenate([volume.input_error, volume.input_error[:, :1] * largest], axis=1),
    )


def _coefficients(a: NDArray, b: NDArray, c: NDArray, order: int) -> Array:
    """Return the (K, t) S_α of triangles with corners (3, t)."""
    vectors = np.stack([a, c, b], axis=1)
    out = np.empty((monomial_count(order), a.shape[1]))
    levels = np.empty((2, count_of_degree(order), 3, a.shape[1]))
    terms = np.empty((count_of_degree(order - 1), *a.shape))
    levels[0, 0] = out[0] = 1.0  # C, D and S of degree 0
    for degree in range(1, order + 1):
        below = count_of_degree(degree - 1)
        count = count_of_degree(degree)
        known = levels[1 - degree % 2, :below]
        grown = levels[degree % 2, :count]
        np.multiply(known, vectors[0], out=grown[:below])
        grown[below:] = 0.0
        for z, vector in enumerate(vectors[1:]):
            np.multiply(known, vector, out=terms[:below])
            # In each run of equal q + r, rows times y or z are the next run's.
            for rows in range(1, degree + 1):
                source = rows * (rows - 1) // 2
                target = rows * (rows + 1) // 2 + z
                grown[target : target + rows] += terms[source : source + rows]
        grown[:, 1] += grown[:, 0]
        grown[:, 2] += grown[:, 1]
        out[monomial_count(degree - 1) : monomial_count(degree)] = grown[:, 2]
    return out
