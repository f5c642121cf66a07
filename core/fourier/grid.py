# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Large regular grids of frequencies, to a stated tolerance: points on the faces, and a non-uniform
fast transform.

    ∫ exp(-i q·x) dV = i q·S / q²,    S = ∫ n exp(-i q·x) dA ≈ Σ N w exp(-i q·x)

Each triangle takes about n² points of a rule that is exact to degree 2n-1. Over a triangle q·x
spans g = |q| diameter at most; the best polynomial of degree 2n-1 in q·x is within 2 (g/4)^(2n) /
(2n)! of exp(-i q·x), and a rule with positive weights errs by no more than twice that. This bound
is met by one triangle in the worst direction; the errors of many cancel as the waves do. So fewer
points are taken if a test shows that they suffice: at frequencies of all sizes, the joint error of
the triangles is found by comparison with the closed form. If a wave is shorter than a triangle's
height over its shortest side, the bound is kept, because at some frequencies all triangles of a
regular mesh err alike. Triangles that would need too many points keep their closed form.

The width of the spreading kernel follows from a bound of its aliasing. The reported error is found
by comparison with the closed form at other frequencies.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from math import factorial

import numpy as np

from ..mesh import Surface
from ..moments import Measure
from ..numerics import (
    Array,
    Index,
    NDArray,
    check_type,
    compensated_normals,
    gauss_legendre,
    triangle_rule,
)
from .transform import Transform
from .triangle_kernel import PAIRS_PER_BLOCK, PhaseMeans, TriangleBlock
from .wave_vectors import APPROXIMATE, FrequencyGrid, ListWaves, Spectrum

POINTS_PER_CHUNK = 1 << 14  # points that are spread between two steps
MAX_POINTS_PER_SIDE = 24  # Gauss points along a side at most
DIRECT_COST = 6.0  # Cost of a frequency in closed form, in cells spread.
SAMPLE_FREQUENCIES = 24  # frequencies that are compared with the closed form
ERROR_SAFETY_FACTOR = 3.0  # ratio of the reported or allowed error to the largest difference found
# Rough shares of the time: of `_assign_triangles`, and of the comparison.
ASSIGNMENT_TIME = 0.3
CHECKING_TIME = 0.1
TRIAL_RADII = (1.0, 0.6, 0.35, 0.2, 0.1, 0.05)  # Relative to the largest frequency along an axis.
# Allowed factors of the errors of single triangles over the error of their sum.
ERROR_CREDITS = (1e6, 1e5, 1e4, 1e3, 1e2, 10.0)
OVERSAMPLING = 2.0
BETA = 2.30  # per unit of width, for that oversampling
CELLS_PER_BLOCK = 1 << 19  # cells that a block of points is spread over: it stays near the cache
WIDTHS = range(4, 16)
ALIASED_ORDERS = 4  # Aliases of the fine grid that are counted; further ones are far smaller.
ROUNDING = 1e-15


class GridTransform(Transform):
    """A transform on a regular grid, to a tolerance: `steps` does the work, `result` returns the
    spectrum.

    The result is "approximate", by the non-uniform fast transform of Barnett, Magland and af
    Klinteberg (2019), or exact if that costs less; see the module. `of` is volume or area,
    `tolerance` absolute, in the unit of the values. ValueError if double precision cannot reach it;
    otherwise errors are as for `solid_transform`.
    """

    # Set if any triangle takes points.
    spreading: Spreading
    exact: Transform  # closed form at a sample of the frequencies

    def __init__(
        self, surface: Surface, grid: FrequencyGrid, of: Measure, tolerance: float, threads: int = 1
    ):
        check_type("grid", grid, FrequencyGrid)
        super().__init__(surface, grid, of, threads)
        self.surface = surface
        self.grid = grid
        faces = self.faces
        # Allowed error of a mean over the area: half of the tolerance each for the points and for
        # the kernel. A volume is the sum divided by |q|, which is from `step` to `largest`.
        if of == Measure.VOLUME:
            allowed = tolerance / faces.scale**3 / (2.0 * faces.area)
            step = grid.step * faces.scale
            largest = np.sqrt(3.0) * grid.largest * faces.scale
        else:
            allowed = tolerance / faces.scale**2 / (2.0 * faces.area)
            step = 1.0
            largest = 1.0
        self.width = _kernel_width(grid.half, allowed * step, of == Measure.VOLUME)
        # Allowed errors of one D, and of all together.
        self.single_tolerance = allowed * largest / 2.0
        self.joint_tolerance = allowed * faces.area / ERROR_SAFETY_FACTOR
        # Triangles that take points: the number of points along a side, and their indices.
        self.point_groups: list[tuple[int, Index]] = []

    def _assign_triangles(self) -> Iterator[float]:
        """Set `point_groups`, and `direct`, the triangles that keep their closed form."""
        counts = yield from self._point_counts()
        most = min(MAX_POINTS_PER_SIDE, int(np.sqrt(DIRECT_COST * len(self.sums) / self.width**3)))
        self.direct = self.faces.select(np.flatnonzero(counts > most))
        self.point_groups = [
            (n, np.flatnonzero(counts == n)) for n in np.unique(counts[counts <= most]).tolist()
        ]

    def _point_counts(self) -> Generator[float, None, NDArray[np.int64]]:
        """Return the (m,) numbers of Gauss points along the sides of the triangles.

        They are the fewest that keep the joint error at the trial vectors, or those of the bound.
        """
        largest = np.sqrt(3.0) * self.grid.largest * self.faces.scale
        spans = largest * self.faces.diameters
        keeps_bound = largest * self.faces.heights >= 2.0 * np.pi  # see the module
        bound = _points_per_side(spans, self.single_tolerance)
        q = _trial_vectors(self.grid) * self.faces.scale
        size = np.sqrt((q**2).sum(axis=1)) if self.measure == Measure.VOLUME else 1.0
        exact_rows = np.zeros(0, np.intp)
        exact = np.zeros(len(q), np.complex128)
        counts = bound
        for credit in ERROR_CREDITS:
            before = counts
            counts = _points_per_side(spans, self.single_tolerance * credit)
            counts = np.where(keeps_bound, bound, counts)
            rows = np.flatnonzero((counts < bound) & (counts <= MAX_POINTS_PER_SIDE))
            if not len(rows) or np.array_equal(counts, before):
                continue
            if len(rows) != len(exact_rows):  # With less credit, rows only become fewer.
                exact_rows = rows
                exact = yield from self._sum_over(rows, q)
            sums = np.zeros(len(q), np.complex128)
            for n in np.unique(counts[rows]).tolist():
                sums += yield from self._points_over(rows[counts[rows] == n], n, q)
            if (np.abs(sums - exact) / size).max() <= self.joint_tolerance:
                return counts
        return bound

    def _sum_over(
        self, triangle_rows: Index, q: NDArray
    ) -> Generator[float, None, NDArray[np.complex128]]:
        """Return (k,) Σ (q·N) D / |q|, or Σ |N| D, over some triangles at wave vectors (k, 3), in
        closed form.
        """
        faces = self.faces.select(triangle_rows)
        waves = ListWaves(q)
        total = np.zeros(len(q), np.complex128)
        all_waves = slice(0, len(q))
        for run in faces.blocks(PAIRS_PER_BLOCK // len(q)):
            block = TriangleBlock(faces, run)
            real, imaginary = PhaseMeans(block, waves, all_waves)(all_waves)
            weights = self._weights(block.normals, waves.q)
            total += (weights * (real + 0.5)).sum(axis=1) + 1j * (weights * imaginary).sum(axis=1)
            yield 0.0
        result = np.empty_like(total)
        result[waves.order] = total
        return result

    def _points_over(
        self, triangle_rows: Index, n: int, q: NDArray
    ) -> Generator[float, None, NDArray[np.complex128]]:
        """Return the sums of `_sum_over` by quadrature, with n points along a side of each
        triangle.
        """
        total = np.zeros(len(q), np.complex128)
        size = max(1, PAIRS_PER_BLOCK // (len(q) * n * n))
        for start in range(0, len(triangle_rows), size):
            points, vectors, weights = self._nodes(
                self.faces.triangles[triangle_rows[start : start + size]], n
            )
            phases = sum(np.multiply.outer(q[:, axis], points[axis]) for axis in range(3))
            sources = self._weights(vectors, q.T)[..., None] * weights
            total += ((np.cos(phases) - 1j * np.sin(phases)) * sources).sum(axis=(1, 2))
            yield 0.0
        return total

    def _weights(self, vectors: NDArray, q: NDArray) -> Array:
        """Return (k, m) (q·N) / |q|, or (1, m) |N|, for normals (3, m) and wave vectors (3, k)."""
        if self.measure == Measure.AREA:
            return np.sqrt((vectors**2).sum(axis=0))[None]
        products = sum(np.multiply.outer(a, b) for a, b in zip(q, vectors))
        return products / np.sqrt((q**2).sum(axis=0))[:, None]

    def _nodes(self, triangles: NDArray, n: int) -> tuple[NDArray, NDArray, NDArray]:
        """Return (3, m, k) points in triangles, (3, m) the normals and (k,) weights."""
        corners = [self.faces.points[corner].T for corner in triangles.T]
        shares, weights = triangle_rule(n)
        return (
            sum(
                (corner[..., None] * share for corner, share in zip(corners, shares)), np.zeros(())
            ),
            compensated_normals(*corners),
            weights,
        )

    def steps(self) -> Iterator[float]:
        """Do the work in parts; yield the rough fraction done, from 0 to 1, after each."""
        expected = len(self.faces.triangles) * len(_trial_vectors(self.grid)) / PAIRS_PER_BLOCK
        for trials, _ in enumerate(self._assign_triangles()):
            yield ASSIGNMENT_TIME * trials / (trials + expected)
        checking_time = CHECKING_TIME if self.point_groups else 0.0
        # Costs are in cells spread.
        direct_cost = len(self.direct.triangles) * len(self.sums) * DIRECT_COST
        point_count = sum(len(rows) * len(triangle_rule(n)[1]) for n, rows in self.point_groups)
        spreading_cost = self.width**3 * point_count
        unit = (1.0 - ASSIGNMENT_TIME - checking_time) / (direct_cost + spreading_cost)
        for share in super().steps():
            yield ASSIGNMENT_TIME + share * direct_cost * unit
        if not self.point_groups:
            return
        for share in self._spread_points():
            yield ASSIGNMENT_TIME + (direct_cost + share * spreading_cost) * unit
        vectors = self.waves.vectors(slice(0, self.waves.rows))
        middle = (self.grid.half, self.grid.half, 0)
        for axis, waves in enumerate(self.spreading.sums()):
            # Less the 1/2 that `Transform` subtracts from each D.
            spread = waves.reshape(-1) - waves[middle].real
            self.sums += vectors[axis] * spread if self.measure == Measure.VOLUME else spread
            yield 1.0 - checking_time
        samples = self.grid.vectors()[_sample_indices(self.grid)]
        self.exact = Transform(self.surface, samples, self.measure, self.threads)
        yield from (1.0 - checking_time * (1.0 - share) for share in self.exact.steps())

    def _spread_points(self) -> Iterator[float]:
        """Spread the points of `point_groups`; yield the fraction done after each chunk."""
        strength_count = 3 if self.measure == Measure.VOLUME else 1
        self.spreading = Spreading(self.grid.half, self.width, strength_count)
        total = sum(len(rows) * len(triangle_rule(n)[1]) for n, rows in self.point_groups)
        done = 0
        for n, rows in self.point_groups:
            count = len(triangle_rule(n)[1])
            size = max(1, POINTS_PER_CHUNK // count)
            for start in range(0, len(rows), size):
                chunk = rows[start : start + size]
                points, strengths, weights = self._nodes(self.faces.triangles[chunk], n)
                if self.measure == Measure.AREA:
                    strengths = np.sqrt((strengths**2).sum(axis=0))[None]
                strengths = (strengths[..., None] * weights).reshape(strength_count, -1)
                angles = points.reshape(3, -1) * (self.grid.step * self.faces.scale)
                self.spreading.add(angles, strengths)
                done += len(chunk) * count
                yield done / total

    def result(self) -> Spectrum:
        """Return the spectrum, when all steps are done; its error includes the difference from
        closed-form samples.
        """
        spectrum = super().result()
        if not self.point_groups:
            return spectrum
        samples = spectrum.values[_sample_indices(self.grid)]
        error = ERROR_SAFETY_FACTOR * np.abs(samples - self.exact.result().values).max()
        return replace(spectrum, error=spectrum.error + error, method=APPROXIMATE)


def _kernel_width(half: int, tolerance: float, divided: bool) -> int:
    """Return the least width of the kernel for an error of tolerance Σ |c|, after division by |k|
    if `divided`.
    """
    # A vector k with its largest component at an index has at most the largest error up to this
    # index along each axis, and at least this length. At k = 0 nothing is divided.
    least_length = np.arange(1, half + 1) if divided else np.ones(half)
    for width in WIDTHS:
        axis_errors = np.maximum.accumulate(aliasing(half, width))[1:]
        if (3.0 * axis_errors / least_length).max() <= tolerance:
            return width
    raise ValueError("tolerance out of reach")


def _points_per_side(spans: NDArray, tolerance: float) -> NDArray[np.int64]:
    """Return the (m,) numbers of points along a side that keep each D within tolerance; spans: |q|
    times diameters.
    """
    span = np.append(0.0, np.geomspace(1e-6, 4.0 * MAX_POINTS_PER_SIDE, 4000))
    limits = []
    for n in range(1, MAX_POINTS_PER_SIDE + 1):
        # The bound of the module, with further terms of the series as a geometric one; spans for
        # which it hardly converges are left to more points.
        ratio = span / 4.0 / (2 * n + 1)
        bound = 2.0 * (span / 4.0) ** (2 * n) / factorial(2 * n) / np.maximum(1.0 - ratio, 0.1)
        limits.append(span[(bound <= tolerance) & (ratio < 0.9)].max())
    return np.searchsorted(np.maximum.accumulate(limits), spans) + 1


def _trial_vectors(grid: FrequencyGrid) -> Array:
    """Return (k, 3) wave vectors of all sizes in a grid, along its axes and diagonals and between
    them.
    """
    along = np.concatenate([np.eye(3), [[1.0, 1.0, 1.0], [0.9, -0.7, 0.4]]])
    shells = [grid.largest * share for share in TRIAL_RADII if share * grid.half >= 1.0]
    return np.concatenate([size * along for size in shells])


def _sample_indices(grid: FrequencyGrid) -> Index:
    """Return indices of sample places on a grid: on axes and diagonals, where faces show most, and
    random ones.
    """
    h = grid.half
    n = grid.count
    steps = np.concatenate([np.eye(3, dtype=int), np.ones((1, 3), int), 1 - np.eye(3, dtype=int)])
    positions = np.concatenate(
        [h + steps * s for s in (-h, -1, 1)]
        + [np.random.default_rng(0).integers(0, n, (SAMPLE_FREQUENCIES, 3))]
    )
    positions = np.unique(np.clip(positions, 0, n - 1), axis=0)
    return (positions[:, 0] * n + positions[:, 1]) * n + positions[:, 2]


def aliasing(half: int, width: int) -> Array:
    """Return (half + 1,) error bounds of the sums for |k| ≤ half along an axis, as shares of Σ |c|,
    by aliases of k.
    """
    side = _grid_side(half, width)
    k = np.arange(half + 1)
    aliased = sum(
        np.abs(_kernel_transform(k / side + m, width))
        for m in range(-ALIASED_ORDERS, ALIASED_ORDERS + 1)
        if m
    )
    return aliased / _kernel_transform(k / side, width) + ROUNDING


class Spreading:
    """Sums Σ c exp(-i k·θ) for k from -half to half along each axis, with several strengths c of
    each point.

    After Barnett, Magland and af Klinteberg (2019): each point is spread over width³ cells of a
    grid that is twice as fine by the kernel exp(β (sqrt(1 - z²) - 1)), the grid is transformed, and
    the kernel's transform is divided out. The error is about 10^(1 - width) of Σ |c|.

    half: largest k along an axis. width: of the kernel, in cells. count: the number of strengths of
    each point.
    """

    def __init__(self, half: int, width: int, count: int):
        self.half = half
        self.width = width
        self.side = _grid_side(half, width)
        # Along x some more cells, so that a block of neighbors covers one run of them.
        self.cells = [np.zeros((self.side + width) * self.side**2) for _ in range(count)]

    def add(self, angles: Array, strengths: Array) -> None:
        """Spread points at angles (3, p), in rad, with strengths (count, p)."""
        positions = angles * (self.side / (2.0 * np.pi)) % self.side
        positions[positions >= self.side] = 0.0  # Rounding makes tiny negative angles a full turn.
        order = np.argsort(positions[0])
        size = max(1, CELLS_PER_BLOCK // self.width**3)
        for start in range(0, len(order), size):
            block = order[start : start + size]
            self._add_block(positions[:, block], strengths[:, block])

    def _add_block(self, positions: NDArray, strengths: NDArray) -> None:
        """Spread points at (3, p) positions, in cells and with neighbors along x, with strengths
        (count, p).
        """
        n = self.side
        w = self.width
        p = positions.shape[1]
        steps = np.arange(w)
        first = np.floor(positions - w / 2.0) + 1.0
        kernel = _kernel(((first - positions)[..., None] + steps) * (2.0 / w), w)  # (3, p, w)
        x, y, z = first.astype(np.int64)[..., None] + (steps + w // 2)
        low = int(x.min())
        high = int(x.max()) + 1
        yz_cell = ((y % n)[:, :, None] * n + (z % n)[:, None, :]).reshape(p, 1, w * w)
        yz_kernel = (kernel[1][:, :, None] * kernel[2][:, None, :]).reshape(p, 1, w * w)
        cell = ((x - low)[:, :, None] * (n * n) + yz_cell).reshape(-1)
        weights = np.empty((p, w, w * w))
        run = slice(low * n * n, high * n * n)
        for cells, strength in zip(self.cells, strengths):
            np.multiply((kernel[0] * strength[:, None])[:, :, None], yz_kernel, out=weights)
            cells[run] += np.bincount(cell, weights.reshape(-1), minlength=run.stop - run.start)

    def sums(self) -> Iterator[NDArray[np.complex128]]:
        """Yield the (2 half + 1, 2 half + 1, half + 1) sums of each strength, for k_z ≥ 0, and drop
        its cells.
        """
        n = self.side
        k = np.arange(-self.half, self.half + 1)
        # Cells are numbered from half a kernel below the grid.
        shift = np.exp(2j * np.pi / n * (self.width // 2) * k)
        factor = shift / _kernel_transform(k / n, self.width)
        while self.cells:
            cells = self.cells.pop(0).reshape(-1, n, n)
            cells[: self.width] += cells[n:]  # The cells beyond the grid are those at its start.
            waves = np.fft.rfftn(cells[:n])
            sums = waves[np.ix_(k, k, k[self.half :])]
            sums *= factor[:, None, None]
            sums *= factor[None, :, None]
            sums *= factor[None, None, self.half :]
            yield sums


def _kernel(z: NDArray, width: int) -> Array:
    """Return the kernel at z, from -1 to 1 but for rounding."""
    inside = np.maximum(1.0 - z * z, 0.0)
    return np.exp(BETA * width * (np.sqrt(inside) - 1.0))


def _kernel_transform(frequencies: NDArray, width: int) -> Array:
    """Return ∫ kernel(2 t / width) exp(-2πi f t) dt over its support, by Gauss's rule."""
    nodes, weights = gauss_legendre(8 * width + 32)
    z = 2.0 * nodes - 1.0
    phases = np.pi * width * np.multiply.outer(frequencies, z)
    return (np.cos(phases) * (weights * _kernel(z, width))).sum(axis=-1) * width


def _grid_side(half: int, width: int) -> int:
    """Return the cells along a side of the fine grid: even, with small prime factors only, for a
    fast transform.
    """
    n = int(OVERSAMPLING * (2 * half + 1)) + width
    n += n % 2
    while pow(2 * 3 * 5 * 7, 64, n):  # A larger prime divides n.
        n += 2
    return n
