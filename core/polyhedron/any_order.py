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

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import InitVar, dataclass
from functools import lru_cache
from itertools import chain, islice
from math import frexp
from typing import Any

import numpy as np

from ..inertia import MOMENTS_OVERFLOW
from ..mesh import Surface
from ..moments import (
    Measure,
    Moments,
    U,
    count_of_degree,
    factorial_ratios,
    monomial_count,
    monomial_values,
    monomials,
    quotient_indices,
    unchecked_moments,
)
from ..numerics import Array, NDArray, batches, cross, dot, indices_in_range, segment_starts
from ..verdict import MeasureError, check_size
from .any_order_kernel import SLICES, UNDERFLOW_BOUND, absolute_sums, coefficient_sums
from .faces import NO_VERTEX, Faces, box_center, face_blocks, finite_box
from .third_order import nothing

NUMBERS_PER_BLOCK = 1 << 17  # numbers of one level: longer arrays would leave the cache
MAX_FACES_PER_BLOCK = 4096
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
class _Block:
    """A block of faces, (m, 3) or (m, 4). coordinates: (3, n) of the points; half_ulp: (3,) bounds
    of their errors.
    """

    coordinates: NDArray
    faces: NDArray
    half_ulp: Array


class _CompensatedSum:
    """A running sum of arrays, with the rounding errors of the additions (Neumaier)."""

    def __init__(self) -> None:
        self.high = self.low = self.sizes = np.zeros(())
        self.faces = 0

    def add(self, faces: int, sums: Array, sizes: Array) -> None:
        """Add a block's number of faces, sums, and sums for their bounds."""
        total = self.high + sums
        grown = total - self.high
        self.low = self.low + ((self.high - (total - grown)) + (sums - grown))
        self.high = total
        self.sizes = self.sizes + sizes
        self.faces += faces


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
        self.half_ulp = np.zeros(3)

    def integrate(self, stream: Iterable[Surface]) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume and, if wanted, of the area."""
        total = _CompensatedSum()
        for faces, sums, sizes in self._ordered_results(self._blocks(stream)):
            total.add(faces, sums, sizes)
            if self.progress is not None:
                self.progress(total.faces)
        if not total.faces:
            return nothing(self.order, self.center)
        return self._moments(total, Measure.VOLUME), self._moments(
            total, Measure.AREA
        ) if self.area else None

    def _ordered_results(self, blocks: Iterator[_Block]) -> Iterator[tuple[int, Array, Array]]:
        """Yield the results of `_run` in the order of the blocks, whichever finishes first; a few
        run at a time.
        """
        first = list(islice(blocks, min(self.threads, 2)))
        alone = len(first) < 2
        blocks = chain(first, blocks)
        del first  # the list holds pieces of a stream
        if alone:  # one thread, or one block: starting threads would take longer than the work
            yield from map(self._run, blocks)
            return
        with ThreadPoolExecutor(self.threads) as pool:
            waiting: deque = deque()
            for block in blocks:
                waiting.append(pool.submit(self._run, block))
                if len(waiting) > 2 * self.threads:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()

    def _blocks(self, stream: Iterable[Surface]) -> Iterator[_Block]:
        for surface in stream:
            if not len(surface.triangles) + len(surface.quads):
                continue
            coordinates = np.ascontiguousarray(surface.points.T)
            if coordinates.dtype != np.float32:
                coordinates = coordinates.astype(np.float64, copy=False)
            self._choose_frame(surface)
            half_ulp = surface.coordinate_error
            self.half_ulp = np.maximum(self.half_ulp, half_ulp)
            size = min(NUMBERS_PER_BLOCK // count_of_degree(self.order), MAX_FACES_PER_BLOCK)
            size = max(size // SLICES, 1) * SLICES
            for _, rows in face_blocks(surface, size):
                yield _Block(coordinates, rows, half_ulp)

    def _choose_frame(self, surface: Surface) -> None:
        """Set the reference point and the scale by the first piece, unless they are given."""
        low, high = finite_box(surface)
        if self.center is None:
            self.center = box_center(low, high, surface.points.dtype)
        largest = float(np.maximum(high - self.center, self.center - low).max())
        check_size(4.0 * largest)
        if self.exponent is None:
            self.exponent = _exponent(largest)
        # The piece reaches to 2^beyond scaled units. A moment multiplies order + 3 such lengths;
        # four times as long ones allow for the sums.
        beyond = frexp(largest)[1] - self.exponent
        if (beyond + 2) * (self.order + 3) > MAX_EXPONENT:
            raise ValueError("about and reach needed")
        if (max(beyond, 0) + self.exponent) * (self.order + 3) > MAX_EXPONENT:
            raise MeasureError(MOMENTS_OVERFLOW, order=int(self.order))

    def _run(self, block: _Block) -> tuple[int, Array, Array]:
        """Return the number of faces of a block, its sums and the sums for their bounds."""
        if not indices_in_range(block.faces, block.coordinates.shape[1]):
            raise ValueError(NO_VERTEX)
        faces = Faces.gather(block.coordinates, block.faces)
        scale = 2.0**-self.exponent
        if scale != 1.0:
            faces = Faces(faces.corners * scale)
        corners = faces.corners - (self.center * scale)[:, None, None]
        weights = [np.einsum("ift,it->ft", faces.normals, corners[:, 0])]
        if self.area:
            weights.append(faces.lengths())
        weights = np.array(weights)
        return (
            len(block.faces),
            coefficient_sums(corners, weights, np.zeros(1, np.intp), self.order)[:, :, 0],
            absolute_sums(corners, faces.edges, weights, block.half_ulp * scale, self.order),
        )

    def _moments(self, total: _CompensatedSum, of: Measure) -> Moments:
        """Return the moments in the body's own unit, with their bounds, from the sums."""
        degree = monomials(self.order).sum(axis=1)
        row, dimension = (0, 3) if of == Measure.VOLUME else (1, 2)
        factors = area_factors(self.order) / ((degree + 3.0) if of == Measure.VOLUME else 1.0)
        # The sums of weights, of their rounding and of the input's effect, by `absolute_sums`.
        sizes = total.sizes[3 * row : 3 * row + 3]
        raw = (total.high[row] + total.low[row]) * factors
        # ∫ |x^α| is at most weight reach^α / this.
        divisor = 2.0 * ((degree + 3.0) if of == Measure.VOLUME else 1.0)
        # 6 n + 8 for a coefficient, 2 n for its factors; 220 is more than the sums of a block
        # round.
        rounding = U * (8.0 * degree + 228.0)
        error = (
            (rounding * sizes[0] + sizes[1]) * (1.0 + 1e-9) / divisor
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
            # ∫ |x^β| over the surface is at most the volume that it sweeps, by the step; 0 is for
            # monomials without the axis.
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
    """Return moments of n bodies, `volume` (n, 20), to a higher order.

    triangles: of all bodies, sorted by body, `counts`, (n,), each. reach: (n, 3) of the points from
    the reference points of `volume`.
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
        number = counts[part]
        corners = coordinates.take(rows.T, axis=1).astype(np.float64, copy=False)
        corners = corners - np.repeat(volume.about[part].T, number, axis=1)[:, None]
        a, b, c = corners.swapaxes(0, 1)
        det = dot(a, cross(b - a, c - a))
        starts = segment_starts(number)
        sums.append(coefficient_sums(corners, det[None, None], starts, order)[0, known:].T)
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
