# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and area moments of triangles and quads, to third order, with rigorous bounds of their errors.

The divergence theorem turns a body into cones from a reference point over its faces. Over the cone on a triangle
a, b, c with determinant w = a·((b-a) x (c-a)) a monomial f of degree n integrates to w / (2n + 6) · E[f], where E[f] is
its mean over the triangle; over the triangle itself to half its doubled area times E[f]. To second order that is the
formula of Sheynin and Tuzikov (2001): E[x] = s / 3 and E[x x'] = (s s' + a a' + b b' + c c') / 12 with s = a + b + c.
The third order is exact on small meshes and on request. On large ones it is found to within the third moments of
runs of neighbouring faces (see `blocks`), and `error` says so.

Rounding. Edges are taken before the reference point is subtracted, so that a determinant's error is relative to the
product of its edges, not to the body's size cubed; that keeps the bound small for fine meshes and far from the origin.
With u = 2^-53, edges e and e' and vertices within `reach` of the reference point, a determinant is off by at most
9 u reach·τ, where τ_x = |e_y e'_z| + |e_z e'_y| bounds |normal_x|.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .blocks import Faces, Sums
from .moments import Moments, U, monomials
from .surface import Surface

BLOCK = 16384  # triangles: calls cost little by then, and the scratch of two threads stays below 10 MB
EXACT_BLOCK = 4096  # triangles with four nodes each
EXACT = 20000  # triangles up to which the exact third order costs less than finding out that it is needed
CHUNK_POINTS = 512  # points whose coordinates are compared as one row
RANGE = 2.0 ** 100  # reaches beyond this, or below its inverse, are scaled, lest a product of six overflow or vanish
SUMMED = 128  # u: runs add up 32 terms, and numpy adds contiguous rows in pairs of sums of at most 128 in 8 lanes
EXPONENTS = monomials(3)
DEGREE = EXPONENTS.sum(axis=1)
FACTORS = np.where(np.arange(3) < EXPONENTS[:, :, None], np.arange(3)[:, None] + 1, 0)  # rows of [1, x, y, z]
CONE = 2.0 * DEGREE + 6.0  # ∫ f over a cone is w E[f] / this


def solid_moments(surface: Surface, threads: int = 1) -> Moments:
    """The volume moments to third order about the centre of the bounding box.

    Positive for outward faces, signed otherwise. An open surface is closed by the cone from that point.
    Raises ValueError for coordinates that are not finite and indices that name no point.
    """
    return _measure(surface, threads, area=False, shell=False, exact=False)[0]


def solid_and_area(surface: Surface, threads: int = 1, shell: bool = False) -> tuple[Moments, Moments]:
    """The volume moments as `solid_moments`, and the area: its moments to third order where `shell`, else order 0."""
    return _measure(surface, threads, area=True, shell=shell, exact=False)


def third_moments_exact(surface: Surface, threads: int = 1) -> Moments:
    """As `solid_moments`, with the third order exact to rounding whatever the size of the mesh."""
    return _measure(surface, threads, area=False, shell=False, exact=True)[0]


def _measure(surface: Surface, threads: int, *, area: bool, shell: bool, exact: bool) -> tuple[Moments, Moments]:
    count = len(surface.triangles) + 2 * len(surface.quads)
    if not count:
        zero = Moments(np.zeros(20), np.zeros(3), "volume")
        return zero, Moments(np.zeros(20 if shell else 1), np.zeros(3), "area")
    points = np.ascontiguousarray(surface.points)
    if points.dtype != np.float32:
        points = points.astype(np.float64, copy=False)
    for faces in (surface.triangles, surface.quads):
        if len(faces) and (faces.min() < 0 or faces.max() >= len(points)):
            raise ValueError("a face names a vertex that does not exist")
    low, high = _bounding_box(points)
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise ValueError("the coordinates are not all finite")
    center = low / 2.0 + high / 2.0
    if points.dtype == np.float32:
        center = center.astype(np.float32).astype(np.float64)  # then subtracting it is exact
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * U)
    largest = reach.max()
    if largest and not 1.0 / RANGE < largest < RANGE:
        return _rescaled(surface, int(np.log2(largest)), threads, area=area, shell=shell, exact=exact)
    exact = exact or count <= EXACT
    job = _Job(points, center, reach, surface.coordinate_error, count, area, shell, exact)
    size = EXACT_BLOCK if exact else BLOCK
    blocks = [(surface.triangles[i:i + size], False) for i in range(0, len(surface.triangles), size)]
    blocks += [(surface.quads[i:i + size // 2], True) for i in range(0, len(surface.quads), size // 2)]
    threads = max(1, min(threads, len(blocks) // 2))
    if threads == 1:
        sums = job.run(blocks)
    else:
        ends = [len(blocks) * i // threads for i in range(threads + 1)]
        with ThreadPoolExecutor(threads) as pool:
            sums, *others = pool.map(job.run, [blocks[a:b] for a, b in zip(ends, ends[1:])])
        for other in others:
            sums.add(other)
    return job.moments(sums)


def _bounding_box(points: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The least and the largest coordinates, compared along rows of many points: far faster than along three."""
    whole = len(points) // CHUNK_POINTS * CHUNK_POINTS
    low = high = points[whole:]
    if whole:
        wide = points[:whole].reshape(-1, 3 * CHUNK_POINTS)
        low = np.concatenate([low, wide.min(axis=0).reshape(-1, 3)])
        high = np.concatenate([high, wide.max(axis=0).reshape(-1, 3)])
    return low.min(axis=0).astype(np.float64), high.max(axis=0).astype(np.float64)


def _rescaled(surface: Surface, exponent: int, threads: int, **options: bool) -> tuple[Moments, Moments]:
    """The moments by way of a body of about unit size: 2^exponent times smaller, which rounds nothing."""
    triangles, faces = surface.all_triangles()
    points = np.ldexp(surface.points.astype(np.float64), -exponent)
    small = _Scaled(points, triangles, triangle_faces=faces, half_ulp=np.ldexp(surface.coordinate_error, -exponent))
    results = []
    for moments in _measure(small, threads, **options):
        powers = exponent * (DEGREE[:len(moments.raw)] + (3 if moments.of == "volume" else 2))
        results.append(replace(
            moments, raw=np.ldexp(moments.raw, powers), about=np.ldexp(moments.about, exponent),
            error=np.ldexp(moments.error, powers) + np.finfo(float).tiny, input=np.ldexp(moments.input, powers)))
    return results[0], results[1]


@dataclass(frozen=True, eq=False)
class _Scaled(Surface):
    """A surface in float64 whose source may have been float32."""

    half_ulp: NDArray[np.float64] | None = None

    @property
    def coordinate_error(self) -> NDArray[np.float64]:
        return self.half_ulp


@dataclass(frozen=True, eq=False)
class _Job:
    """One surface to be measured. points: (n, 3). reach: (3,) bounds |points - center|. half_ulp: (3,). count:
    triangles."""

    points: NDArray
    center: NDArray[np.float64]
    reach: NDArray[np.float64]
    half_ulp: NDArray[np.float64]
    count: int
    area: bool
    shell: bool
    exact: bool

    def run(self, blocks: list[tuple[NDArray, bool]]) -> Sums:
        """The sums over blocks of faces, each with whether they are quads. Safe in threads."""
        size = min(EXACT_BLOCK if self.exact else BLOCK, self.count)
        faces = Faces(self.points, self.center, size, area=self.area, shell=self.shell, exact=self.exact)
        for block, quads in blocks:
            faces.add((None if quads else _pairs(block)) or list(block.T), quads)
        if faces.flipped:
            flipped = np.concatenate(faces.flipped, axis=1)
            for i in range(0, flipped.shape[1], size // 2):
                faces.add(list(flipped[:, i:i + size // 2]))
        if not self.exact:
            faces.flush()
        return faces.sums

    def moments(self, sums: Sums) -> tuple[Moments, Moments]:
        """Volume and area, with their bounds."""
        raw = sums.volume / CONE
        error = self._error(raw, 9.0 * U * (self.reach @ sums.tau), sums.size, sums) / CONE
        error[10:] += sums.rest / 12.0
        moved = np.zeros(20)
        if self.half_ulp.any():
            moved = self._swept(sums) * _powers(self.reach + self.half_ulp)
        volume = Moments(raw, self.center, "volume", error + 8.0 * U * np.abs(raw), moved)
        if not self.area:
            return volume, Moments(np.zeros(1), self.center, "area")
        raw = sums.area / 2.0 if self.shell else np.array([sums.double / 2.0])
        error = self._error(raw, 9.0 * U * sums.tau.sum(), sums.double, sums) / 2.0
        if self.shell:
            error[10:] += sums.area_rest / 2.0
        moved = np.zeros(20)
        if self.half_ulp.any():
            reach, step = self.reach + self.half_ulp, np.linalg.norm(self.half_ulp)
            turned = step * (sums.edges + 2.0 * step * sums.count)
            moved = _powers(reach) * (turned + EXPONENTS @ (self.half_ulp / reach) * (self._swept(sums) / step))
        return volume, Moments(raw, self.center, "area", error + 8.0 * U * np.abs(raw), moved[:len(raw)])

    def _error(self, raw: NDArray, weight: float, size: float, sums: Sums) -> NDArray[np.float64]:
        """What rounding does to Σ w E[f]: the weights are off by `weight` in all; then come their products with the
        vectors, the sums, whose terms are up to ten times as large as the result, and underflow."""
        rounding = U * (8.0 * DEGREE + SUMMED + sums.parts) * np.array([1.0, 1.5, 2.5, 10.0])[DEGREE]
        error = weight + rounding * (size * (1.0 + 1e-9) + weight) + 1e-290 * sums.count
        return (error * _powers(self.reach))[:len(raw)]

    def _swept(self, sums: Sums) -> float:
        """The volume that the surface sweeps when its points move by their half ulps, for a closed surface."""
        step = np.linalg.norm(self.half_ulp)
        double = sums.double * (1.0 + 1e-9) if self.area else np.linalg.norm(sums.tau)
        return step * (double / 2.0 + step * sums.edges + 2.0 * step ** 2 * sums.count)


def _powers(reach: NDArray) -> NDArray[np.float64]:
    """(20,) the largest value of each monomial within reach."""
    return np.multiply.reduce(np.append(1.0, reach)[FACTORS].reshape(20, 9), axis=1)


def _pairs(triangles: NDArray) -> list[NDArray] | None:
    """The four corners, (k/2,) each, of quads where triangles 2i and 2i+1 are the halves of one, for every i; else None.

    Meshes that were triangulated from quads are like that, and two triangles that share an edge cost less than two
    loose ones. The first pair shows which of their corners meet.
    """
    first, second = triangles[0::2], triangles[1::2]
    if not len(second) or len(first) != len(second):
        return None
    for i in range(3):
        for j in range(3):
            ends = ((i, j), (i - 1, (j + 1) % 3))
            if all(first[0, a] == second[0, b] and np.array_equal(first[:, a], second[:, b]) for a, b in ends):
                return [first[:, i], first[:, (i + 1) % 3], first[:, i - 1], second[:, (j + 2) % 3]]
    return None
