# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Integrals of exp(-i q·x) over triangles, for any triangle and any frequency, a block at a time.

With s = q·x at the corners, D = ∫ exp(-i s) over the triangle (0,0), (1,0), (0,1) is a divided
difference of exp(-i s). With the mean s0 of the three phases, their deviations d from it (so that Σ
d = 0) and e2, e3 the symmetric polynomials of d it has two forms:

    D = exp(-i s0) Σ_n (-i)^n h_n / (n+2)!,    h_n = -e2 h_(n-2) + e3 h_(n-3),  h_0 = 1, h_1 = 0
    D = -i (E_ab d_c + E_bc d_a + E_ca d_b) / Σ d²,    E_ab = exp(-i (s_a+s_b)/2) sinc((s_a-s_b)/2).

The first converges for small d. The second is the least-squares mean of the three ways to write D
as a quotient of a difference of E by a gap between two phases. It divides by no gap that may
vanish, and from Σ d² = 1 on no digit is lost. Coincident phases (q along a normal, across an edge,
corners in line) are no special case for either. E is computed once for each edge of a block.
"""

from __future__ import annotations

from copy import copy
from math import factorial, hypot

import numpy as np

from ..mesh import Surface
from ..numerics import (
    Array,
    Index,
    NDArray,
    check_type,
    compensated_normals,
    indices_in_range,
    spread_bits,
)
from ..verdict import MAX_COORDINATE, NO_FACES, OBJECT_SIZE, TOO_LARGE, MeasureError, check_size
from .wave_vectors import GridWaves, ListWaves

TRIANGLES_PER_BLOCK = 128
PAIRS_PER_BLOCK = 16384  # pairs of a triangle and a frequency: their arrays stay in the cache
TRIANGLES_PER_BATCH = 1 << 16  # triangles that are prepared at a time
MAX_SERIES_DIAMETER = 3.0  # largest |q| times diameter up to which a whole block takes the series
MAX_SERIES_SQUARE = 1.0  # Σ d² below which a single pair takes the series
MORTON_CELLS = 1023  # along an axis, to sort triangles in space
TINY = 1e-300


class SortedTriangles:
    """The triangles of a surface about its center and at unit size, sorted so that blocks of them
    are alike.

    scale: a power of two; points: (n, 3), (x - center) / scale, of length 1 at most. area: of all
    triangles (m, 3); diameters: (m,) their longest sides; heights: (m,) over the shortest sides.
    Lengths are in units of the scale.
    """

    def __init__(self, surface: Surface):
        check_type("surface", surface, Surface)
        points = surface.points
        if not all(
            indices_in_range(faces, len(points)) for faces in (surface.triangles, surface.quads)
        ):
            raise ValueError("no such vertex")
        triangles = surface.all_triangles()[0]
        if not len(triangles):
            raise MeasureError(NO_FACES)
        used = np.zeros(len(points), bool)
        used[triangles] = True
        corners = points[used].astype(np.float64)
        low = corners.min(axis=0)
        high = corners.max(axis=0)
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            raise ValueError("coordinates must be finite")
        center = low / 2.0 + high / 2.0
        if points.dtype == np.float32:
            center = center.astype(np.float32).astype(np.float64)  # then subtracting it is exact
        self.center = center
        reach = hypot(*np.maximum(high - center, center - low).tolist())
        if not reach < MAX_COORDINATE:
            raise MeasureError(OBJECT_SIZE, fault=TOO_LARGE)
        check_size(reach)
        exponent = int(np.ceil(np.log2(reach))) if reach > 0.0 else 0
        self.scale = float(np.ldexp(1.0, exponent))
        self.points = np.ascontiguousarray(np.ldexp(points.astype(np.float64) - center, -exponent))
        self._sort(triangles)

    def _sort(self, triangles: NDArray) -> None:
        """Sort by diameter to a factor of two, then along a space-filling curve: a block's
        triangles share edges.
        """
        keys = []
        diameters = []
        heights = []
        self.area = 0.0
        for start in range(0, len(triangles), TRIANGLES_PER_BATCH):
            a, b, c = (
                self.points[corner].T for corner in triangles[start : start + TRIANGLES_PER_BATCH].T
            )
            sides = np.sqrt(
                [((a - b) ** 2).sum(axis=0), ((b - c) ** 2).sum(axis=0), ((c - a) ** 2).sum(axis=0)]
            )
            diameter = sides.max(axis=0)
            shortest = sides.min(axis=0)
            doubled_area = np.sqrt((compensated_normals(a, b, c) ** 2).sum(axis=0))
            self.area += float(doubled_area.sum()) / 2.0
            heights.append(doubled_area / np.maximum(shortest, TINY))
            cell = np.clip(
                ((a + b + c) / 3.0 + 1.0) * (MORTON_CELLS / 2.0), 0, MORTON_CELLS
            ).astype(np.int64)
            # 1100 makes all binary exponents of float64 positive.
            octave = np.clip(np.frexp(diameter)[1] + 1100, 0, 2000).astype(np.int64)
            x, y, z = spread_bits(cell)  # Interleaved, they are the place on a Z-shaped curve.
            keys.append(octave << 30 | x | y << 1 | z << 2)
            diameters.append(diameter)
        order = np.argsort(np.concatenate(keys), kind="stable")
        self.triangles = triangles[order]
        self.diameters = np.concatenate(diameters)[order]
        self.heights = np.concatenate(heights)[order]

    def blocks(self, size: int = TRIANGLES_PER_BLOCK) -> list[slice]:
        """Return slices of at most `size` consecutive triangles."""
        return [
            slice(i, min(i + size, len(self.triangles)))
            for i in range(0, len(self.triangles), size)
        ]

    def select(self, selection: Index) -> SortedTriangles:
        """Return selected triangles, at the same scale."""
        selected = copy(self)
        selected.triangles = self.triangles[selection]
        selected.diameters = self.diameters[selection]
        selected.heights = self.heights[selection]
        return selected


class TriangleBlock:
    """A block of triangles, with their normals, centers and edges.

    diameter: the largest. normals, centers: (3, k), (b-a) x (c-a) and the means of the corners.
    from_center: a and b less the centers, (3, k) each. edges: (3, k) columns in `middles` and
    `halves` of the edges opposite to a, b and c. middles, halves: (3, e) the middles of edges, and
    half of the differences of their ends.
    """

    def __init__(self, faces: SortedTriangles, run: slice):
        points = faces.points
        triangles = faces.triangles[run]
        a, b, c = (points[corner].T for corner in triangles.T)
        self.diameter = float(faces.diameters[run].max())
        self.normals = compensated_normals(a, b, c)
        self.centers = (a + b + c) / 3.0
        self.from_center = ((a - b) + (a - c)) / 3.0, ((b - a) + (b - c)) / 3.0
        # Each pair of ends as one number, so that triangles share the edges between them.
        ends = np.stack([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
        low, high = np.sort(ends.astype(np.int64)).transpose(2, 0, 1)
        codes, edges = np.unique(low * len(points) + high, return_inverse=True)
        self.edges = edges.reshape(3, -1)
        first, second = (points[end].T for end in np.divmod(codes, len(points)))
        self.middles = (first + second) / 2.0
        self.halves = (first - second) / 2.0
        self.lengths = np.sqrt((self.normals**2).sum(axis=0))


class PhaseMeans:
    """The values D - 1/2 of a block's triangles for a part of the rows of the wave vectors."""

    def __init__(self, block: TriangleBlock, waves: ListWaves | GridWaves, part: slice):
        self.block = block
        self.waves = waves
        # The deviations d of the phases at a and b, and exp(-i s0/2).
        self.first, self.second = (waves.dot(part, vectors) for vectors in block.from_center)
        self.half = waves.phase_factors(part, block.centers / 2.0)
        self.largest = np.sqrt((waves.vectors(part) ** 2).sum(axis=0).max()) * block.diameter
        # A corner is no farther from the mean of all than 2/3 of the diameter.
        self.terms = _series_terms(min(self.largest, MAX_SERIES_DIAMETER) * 2.0 / 3.0)
        if self.largest > MAX_SERIES_DIAMETER:
            self.middle = waves.phase_factors(part, block.middles)
            self.along = waves.dot(part, block.halves)

    def __call__(self, wave_rows: slice) -> tuple[Array, Array]:
        """Return (m, k) real and imaginary parts of D - 1/2 for some rows of the part."""
        a = self.first(wave_rows)
        b = self.second(wave_rows)
        c = -(a + b)
        if self.largest > MAX_SERIES_DIAMETER:
            return self._by_edges(wave_rows, a, b, c)
        real, imaginary = _series(a * a + a * b + b * b, a * b * c, self.terms)
        return _apply_phase(*self.half(wave_rows), real, imaginary)

    def _by_edges(
        self, wave_rows: slice, a: NDArray, b: NDArray, c: NDArray
    ) -> tuple[NDArray, NDArray]:
        """Return D - 1/2 from E at the edges, or by the series for pairs with a small Σ d². a, b,
        c: (m, k) the deviations d.
        """
        square = a * a + b * b + c * c
        cosine, sine = self.middle(wave_rows)
        phase = np.maximum(np.abs(self.along(wave_rows)), TINY)
        sinc = np.sin(phase) / phase
        small = np.flatnonzero(square < MAX_SERIES_SQUARE)
        series = self._series_of_pairs(small, self.waves.vectors(wave_rows), a, b, c)
        edge_a, edge_b, edge_c = self.block.edges
        # Smaller squares belong to the pairs that the series replaces. `square` is overwritten.
        negative = -np.maximum(square, MAX_SERIES_SQUARE / 2.0, out=square)
        real, imaginary = (
            (
                part_of_e.take(edge_a, 1, mode="clip") * a
                + part_of_e.take(edge_b, 1, mode="clip") * b
                + part_of_e.take(edge_c, 1, mode="clip") * c
            )
            / negative
            for part_of_e in (sine * sinc, cosine * sinc)
        )
        real -= 0.5
        real.reshape(-1)[small], imaginary.reshape(-1)[small] = series
        return real, imaginary

    def _series_of_pairs(
        self, pairs: NDArray, vectors: NDArray, a: NDArray, b: NDArray, c: NDArray
    ) -> tuple[NDArray, NDArray]:
        """Return D - 1/2 by the power series, for pairs (wave vector, triangle) with too little
        difference in phase.
        """
        row, column = np.divmod(pairs, len(self.block.lengths))
        a, b, c = (d.reshape(-1)[pairs] for d in (a, b, c))
        real, imaginary = _series(a * a + a * b + b * b, a * b * c, SPLIT_SERIES_TERMS)
        phase = sum(q[row] * x[column] for q, x in zip(vectors, self.block.centers / 2.0))
        return _apply_phase(np.cos(phase), np.sin(phase), real, imaginary)


def _apply_phase(
    cosine: NDArray, sine: NDArray, real: NDArray, imaginary: NDArray
) -> tuple[NDArray, NDArray]:
    """Return D - 1/2 from exp(-i s0/2) and exp(i s0) D - 1/2 = g."""
    # exp(-i s0) - 1 = fall + i turn
    turn = -2.0 * sine * cosine
    fall = -2.0 * sine * sine
    whole = real + 0.5
    return real - turn * imaginary + fall * whole, imaginary + fall * imaginary + turn * whole


def _series(square: NDArray, cube: NDArray, terms: int) -> tuple[NDArray, NDArray]:
    """Return real and imaginary part of the sum over n ≥ 2 of (-i)^n h_n / (n+2)!, from -e2 and
    e3.
    """
    # (-i)^n h_n is real for even n, and i times a real number for odd n.
    even = -square  # h_2, with the sign of (-i)^2
    odd = cube  # h_3, with the sign of (-i)^3 / i
    last_odd = np.zeros_like(square)
    real = even / 24.0
    imaginary = odd / 120.0
    for n in range(4, terms, 2):
        next_even = -(square * even + cube * last_odd)
        next_odd = cube * even - square * odd
        last_odd = odd
        even = next_even
        odd = next_odd
        real += even * (1.0 / factorial(n + 2))
        imaginary += odd * (1.0 / factorial(n + 3))
    return real, imaginary


def _series_terms(radius: float) -> int:
    """Return the number of terms needed for |d| up to radius: |h_n| is at most radius^n, as a mean
    of earlier ones. Terms below 2e-17 are less than the rounding of 1/2.
    """
    n = 4
    while radius**n / factorial(n + 2) > 2e-17:
        n += 2
    return n


# For Σ d² below MAX_SERIES_SQUARE: as Σ d = 0, the square of each d is at most 2/3 of the sum.
SPLIT_SERIES_TERMS = _series_terms(np.sqrt(MAX_SERIES_SQUARE * 2.0 / 3.0))
