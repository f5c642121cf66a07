# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and area moments of triangles and quads, to third order, with rigorous bounds of their
errors.

The divergence theorem turns a body into cones from a reference point over its faces. Over the cone
on a triangle a, b, c with determinant w = a·((b-a) x (c-a)) a monomial f of degree n integrates to
w / (2n + 6) · E[f], where E[f] is its mean over the triangle; over the triangle itself to half its
doubled area times E[f] (Sheynin and Tuzikov 2001, put so that triangles which share an edge share
work). Third moments follow from lower ones about the middle of an edge, except for the third
moments about that middle: for a triangle with edge e, and f from the middle to the third corner,
they are

    E[x x' x''] = f f' f'' / 10 + (f e' e'' + e f' e'' + e e' f'') / 120,

of the order of an edge cubed: unless `exact`, large meshes leave them out and add their bound to
`rounding_error`.

Edges are taken before the reference point is subtracted, so that a determinant's error is relative
to the product of its edges. With u = 2^-53, edges e and e' and vertices within `reach` of the
reference point, a determinant is off by at most 9 u reach·τ, where τ_x = |e_y e'_z| + |e_z e'_y|
bounds |normal_x|. Bodies of few triangles are for `third_order_small`.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from ..mesh.planarity import PlanarityAccumulator
from ..mesh.surface import NO_QUADS, Surface
from ..moments.exponents import monomial_count
from ..moments.moments import PAIRWISE_SUM_ROUNDINGS, Measure, Moments, U
from ..numerics.arrays import indices_in_range
from ..verdict.tolerances import check_size
from .third_order_kernel import (
    NO_VERTEX,
    TRIPLES,
    BlockAccumulator,
    BlockResult,
    BlockSums,
    combine_blocks,
    scratch_size,
)
from .third_order_small import (
    AREA_FACTORS,
    AXIS_PAIRS,
    CONE_DIVISORS,
    DEGREE,
    error_bounds,
    small_moments,
)

MAX_TRIANGLES_PER_BLOCK = (
    65536  # triangles at most: by then calls cost little, and more would leave the cache
)
SCRATCH_BYTES = (
    16,
    6_000_000,
)  # limit of all threads' scratch together: bytes for each triangle, and a constant
# Up to this number of triangles the third order is always exact, which takes half as long again.
MAX_TRIANGLES_EXACT_THIRD = 100_000
MAX_SMALL_TRIANGLES = 1024  # triangles up to which `small_moments` is faster
MIN_TRIANGLES_TO_PAIR = 1000  # triangles below which looking for pairs costs more than it saves
# Triangles that are worth a thread: with fewer, calls are short, and wait for the interpreter.
MIN_TRIANGLES_PER_THREAD = 250_000
# Reaches beyond this, or below its inverse, are scaled, so that a product of six does not overflow
# or vanish.
MAX_UNSCALED_REACH = 2.0**100
DIVISORS = np.array([6.0, 48.0, 120.0, 2880.0])[DEGREE]  # divide the sums of `BlockSums`

# Faces measured together: (k, 4) quads, (k, 3) triangles, or two such arrays of triangles with rows
# that may be halves of one quad, with the surface's first row of each array; or, without rows, (4,
# k) corners of turned quads.
_Block = tuple[list[int], list[NDArray]]


def integrate(
    surface: Surface,
    threads: int,
    *,
    area: bool,
    area_moments: bool,
    exact: bool,
    about: NDArray | None = None,
    planarity: PlanarityAccumulator | None = None,
) -> tuple[Moments, Moments]:
    """Return the moments of the volume to third order; and the area if `area`, its moments if
    `area_moments`.
    """
    count = surface.triangle_count
    if not count:
        return nothing(3, about)
    points = np.ascontiguousarray(surface.points)
    if points.dtype != np.float32:
        points = points.astype(np.float64, copy=False)
    low, high = finite_box(surface)
    center = box_center(low, high, points.dtype) if about is None else np.asarray(about, np.float64)
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * U)
    largest = max(reach.tolist())
    check_size(4.0 * largest)  # the diagonal of the box is shorter
    if largest and not 1.0 / MAX_UNSCALED_REACH < largest < MAX_UNSCALED_REACH:
        return _measure_rescaled(
            surface, int(np.log2(largest)), threads, about, area, area_moments, exact
        )
    exact = exact or count <= MAX_TRIANGLES_EXACT_THIRD
    if count <= MAX_SMALL_TRIANGLES:
        for faces in (surface.triangles, surface.quads):
            if not indices_in_range(faces, len(points)):
                raise ValueError(NO_VERTEX)
        volume, areas, cones = small_moments(
            points,
            surface.all_triangles()[0],
            np.array([count]),
            center[None],
            reach[None],
            surface.coordinate_error[None],
            area=area,
            area_moments=area_moments,
        )
        if planarity is not None:
            planarity.cones = float(cones[0, 0]), float(cones[0, 1])
        return volume.at(0), areas.at(0)
    # Two threads have a block each: the sums are the same with one, and with more where there is
    # room for more.
    room = SCRATCH_BYTES[0] * count + SCRATCH_BYTES[1]
    each = 8 * scratch_size(3, area, exact)
    size = max(2, min(MAX_TRIANGLES_PER_BLOCK, room // (2 * each), count) // 2 * 2)
    threads = max(1, min(threads, count // MIN_TRIANGLES_PER_THREAD, room // (each * size)))
    job = _Integration(
        points,
        center,
        reach,
        surface.coordinate_error,
        count,
        area,
        area_moments,
        exact,
        planarity,
        size,
        threads,
    )
    return job.moments(combine_blocks(job.block_sums(job.blocks(surface))))


def nothing(order: int, about: NDArray | None) -> tuple[Moments, Moments]:
    """Return zero moments of the volume and the area, for a surface without faces."""
    zeros = np.zeros(monomial_count(order))
    about = np.zeros(3) if about is None else about
    return Moments(zeros, about, Measure.VOLUME), Moments(zeros, about, Measure.AREA)


def finite_box(surface: Surface) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the least and the largest coordinates. ValueError if they are not finite."""
    low, high = surface.box
    if not all(map(isfinite, low.tolist() + high.tolist())):
        raise ValueError("coordinates must be finite")
    return low, high


def box_center(low: NDArray, high: NDArray, dtype: np.dtype) -> NDArray[np.float64]:
    """Return the center of a box of points, rounded for float32 ones so that subtracting it is
    exact.
    """
    center = low / 2.0 + high / 2.0
    return center.astype(np.float32).astype(np.float64) if dtype == np.float32 else center


def _measure_rescaled(
    surface: Surface,
    exponent: int,
    threads: int,
    about: NDArray | None,
    area: bool,
    area_moments: bool,
    exact: bool,
) -> tuple[Moments, Moments]:
    """Return the moments by measuring a copy of about unit size, 2^exponent times smaller: scaling
    rounds nothing.
    """
    points = np.ldexp(surface.points.astype(np.float64), -exponent)
    small = Surface(
        points,
        surface.all_triangles()[0],
        displacement=np.ldexp(surface.coordinate_error, -exponent),
    )
    results = []
    about = None if about is None else np.ldexp(about, -exponent)
    for moments in integrate(
        small, threads, about=about, area=area, area_moments=area_moments, exact=exact
    ):
        powers = exponent * (
            DEGREE[: len(moments.raw)] + (3 if moments.measure == Measure.VOLUME else 2)
        )
        with np.errstate(over="ignore"):  # the caller refuses what becomes infinite
            results.append(
                replace(
                    moments,
                    raw=np.ldexp(moments.raw, powers),
                    about=np.ldexp(moments.about, exponent),
                    rounding_error=np.ldexp(moments.rounding_error, powers) + np.finfo(float).tiny,
                    input_error=np.ldexp(moments.input_error, powers),
                )
            )
    return results[0], results[1]


@dataclass(frozen=True, eq=False)
class _Integration:
    """The integration over a surface in blocks of faces, by several threads.

    points: (n, 3). reach: (3,) bounds |points - center|. half_ulp: (3,). count: triangles; size:
    triangles in a block.
    """

    points: NDArray
    center: NDArray[np.float64]
    reach: NDArray[np.float64]
    half_ulp: NDArray[np.float64]
    count: int
    area: bool
    area_moments: bool
    exact: bool
    planarity: PlanarityAccumulator | None
    size: int
    threads: int

    def blocks(self, surface: Surface) -> list[_Block]:
        """Return the faces in as few blocks as the memory allows, for any number of threads."""
        triangles = surface.triangles
        half = len(surface.triangles) // 2
        size = self.size
        if _quad_corners_of(triangles[:1], triangles[half : half + 1]) is None:
            half = 0
        whole = (
            ((0, half), (triangles[:half], triangles[half : 2 * half]), size // 2),
            ((2 * half,), (triangles[2 * half :],), size),
            ((0,), (surface.quads,), size // 2),
        )
        return [
            ([start + i for start in starts], [array[i : i + step] for array in arrays])
            for starts, arrays, step in whole
            for i in range(0, len(arrays[0]), step)
        ]

    def block_sums(self, blocks: list[_Block]) -> list[BlockResult]:
        """Return the sums of the blocks, computed by several threads, in the order of the blocks,
        turned quads last.
        """
        queue = iter(enumerate(blocks))
        threads = min(self.threads, len(blocks))
        if threads == 1:
            parts = self._run_queue(queue)
        else:
            with ThreadPoolExecutor(threads) as pool:
                parts = [
                    part
                    for of_thread in pool.map(self._run_queue, [queue] * threads)
                    for part in of_thread
                ]
        parts.sort(key=itemgetter(0))
        results = [block for _, of_thread, _ in parts for block in of_thread]
        flipped = np.concatenate(
            [NO_QUADS.T, *(block for *_, of_thread in parts for block in of_thread)], axis=1
        )
        step = self.size // 2
        if flipped.size:
            results += self.block_sums(
                [([], [flipped[:, i : i + step]]) for i in range(0, flipped.shape[1], step)]
            )
        return results

    def _run_queue(
        self, queue: Iterator[tuple[int, _Block]]
    ) -> list[tuple[int, list[BlockResult], list[NDArray]]]:
        """Return for each block taken from the queue: its number, its sums, and quads that were
        left out.
        """
        faces = BlockAccumulator(
            self.points,
            self.center,
            area=self.area,
            area_moments=self.area_moments,
            exact=self.exact,
        )
        parts = []
        for number, block in queue:
            faces.results, faces.flipped = [], []
            self._add(faces, *block)
            parts.append((number, faces.results, faces.flipped))
        return parts

    def _add(self, faces: BlockAccumulator, starts: list[int], arrays: list[NDArray]) -> None:
        first = arrays[0]
        halves = None
        planarity = self.planarity
        if not starts:
            faces.add_faces(first)
            return
        if first.shape[1] == 4:
            faces.add_faces(
                first.T, quads=True, observe=planarity and partial(planarity.add_quads, *starts)
            )
            return
        if len(first) >= MIN_TRIANGLES_TO_PAIR:
            halves = quad_corners(first) if len(arrays) == 1 else _quad_corners_of(*arrays)
        if halves:
            planarity_rows = (starts, 1) if len(arrays) == 2 else ([starts[0], starts[0] + 1], 2)
            faces.add_faces(
                halves, observe=planarity and partial(planarity.add_triangles, *planarity_rows)
            )
            return
        for start, part in zip(starts, arrays):
            faces.add_faces(
                part.T, observe=planarity and partial(planarity.add_triangles, [start], 1)
            )

    def moments(self, sums: BlockSums) -> tuple[Moments, Moments]:
        """Return volume and area, with their bounds."""
        sizes, rounding, inputs = _error_bounds(self, sums)
        raw = sums.sums / DIVISORS
        if self.planarity is not None:
            self.planarity.cones = sizes[0], float(sums.sums[0])
        error = rounding[0] / CONE_DIVISORS + 8.0 * U * np.abs(raw)
        volume = Moments(raw, self.center, Measure.VOLUME, error, inputs[0])
        if not self.area:
            return volume, Moments(np.zeros(1), self.center, Measure.AREA)
        raw = (
            sums.areas / (DIVISORS / AREA_FACTORS)
            if self.area_moments
            else np.array([sizes[1] / 2.0])
        )
        count = len(raw)
        error = rounding[1, :count] / 2.0 + 8.0 * U * np.abs(raw)
        return volume, Moments(raw, self.center, Measure.AREA, error, inputs[1, :count])


def _error_bounds(
    job: _Integration, sums: BlockSums
) -> tuple[list[float], NDArray[np.float64], NDArray[np.float64]]:
    """Return the sums of |determinants| and doubled areas; (2, 20) errors of Σ w E[f]; (2, 20)
    `input_error`.
    """
    sizes = np.add.reduce(sums.sizes, axis=1)
    count = np.array([[np.add.reduce(sums.counts)]])
    # einsum instead of a matrix product, after which the threads of some BLAS keep a core busy for
    # a while.
    products = np.einsum("in,jn,n->ij", sums.side, sums.base, sums.counts)
    tau = np.array([[products[i, j] + products[j, i] for i, j in AXIS_PAIRS]])
    lengths = np.sqrt(np.add.reduce(sums.side**2)) + np.sqrt(np.add.reduce(sums.base**2))
    edges = np.array(
        [[np.add.reduce(lengths * sums.counts)]]
    )  # bounds their sum, at the triangles' first corners
    roundings = PAIRWISE_SUM_ROUNDINGS + sums.blocks
    bounds = error_bounds(
        job.reach[None],
        job.half_ulp[None],
        tau,
        edges,
        sizes[None],
        count,
        float(roundings),
        job.area,
    )
    rounding, inputs = bounds[0][:, 0], bounds[1][:, 0]
    if not job.exact:  # then add the bound of the omitted third order
        e = sums.base
        f = sums.side + sums.base / 2.0
        rest = [
            f[i] * f[j] * f[k] / 10.0
            + (f[i] * e[j] * e[k] + e[i] * f[j] * e[k] + e[i] * e[j] * f[k]) / 120.0
            for i, j, k in TRIPLES
        ]
        for which in range(2):
            rounding[which, 10:] += (1.0 + 1e-9) * np.add.reduce(rest * sums.sizes[which], axis=1)
    return sizes.tolist(), rounding, inputs


def quad_corners(triangles: NDArray) -> list[NDArray] | None:
    """Return (k/2,) corners of quads, if triangles 2i and 2i+1 are always halves of a quad; else
    None.
    """
    return _quad_corners_of(triangles[0::2], triangles[1::2])


def _quad_corners_of(first: NDArray, second: NDArray) -> list[NDArray] | None:
    """Return the four corners of k quads, (k,) each, if the i-th triangles are always halves of a
    quad; else None.
    """
    if not len(second) or len(first) != len(second):
        return None
    for i in range(3):
        for j in range(3):
            ends = ((i, j), (i - 1, (j + 1) % 3))
            if all(
                first[0, a] == second[0, b] and np.array_equal(first[:, a], second[:, b])
                for a, b in ends
            ):
                return [first[:, i], first[:, (i + 1) % 3], first[:, i - 1], second[:, (j + 2) % 3]]
    return None
