# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of a patch whose control points move, from tables made once for its function space.

Soldea, Elber and Rivlin (section 3) precompute Φ, integrals of products of six and more basis functions, and contract
them with the control points. Every entry of Φ is a difference of products of two integrals over one parameter each, so
that all there is to precompute are the basis functions at the Gauss points of each direction: 20 kB instead of 0.4 to
140 MB for an 8 x 8 bicubic patch, and fewer operations (`phi` is their scheme, to compare with). A control point acts
on k x k' spans only; the others' contributions are kept.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .bspline import Space
from .moments import Moments, monomials
from .patch import Patch
from .patch_moments import exact_points
from .quadrature import gauss

TILE = 8  # spans along each direction that are evaluated together
RATIONAL = 16  # Gauss points in a span of a rational patch


@lru_cache(maxsize=64)
def _table(space: Space, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Values and derivatives of all functions at the Gauss points of all spans, (2, spans * points, functions), and
    the weights of those points."""
    nodes, weights = gauss(points)
    low, high = space.intervals.T
    size = (high - low)[:, None]
    found = space.derivatives(space.spans[:, None], low[:, None] + size * nodes, 1)
    table = np.zeros((2, len(low) * points, space.functions))
    rows = np.arange(len(low) * points).reshape(len(low), points, 1)
    columns = (space.spans[:, None] + np.arange(1 - space.order, 1))[:, None]
    for k in (0, 1):
        table[k, rows, columns] = found[k]
    return table, (size * weights).ravel()


class Evaluator:
    """A patch in a fixed function space, its control points free to move.

    Gauss rules are exact for polynomial patches. For rational ones they have 16 points a span and come without an
    estimate, which `patch_moments` gives. order: of the moments. about: (3,) what they are taken about, by default the
    mean of the control points. The flux of one patch is a body's only together with those of the others. with_area:
    also keep `area`, of the patch as last evaluated, by the same points: an approximation.
    """

    def __init__(self, patch: Patch, order: int = 2, about: NDArray | None = None, with_area: bool = False):
        self.spaces, self.order, self.with_area = patch.spaces, order, with_area
        self.about = np.asarray(patch.points.mean(axis=(0, 1)) if about is None else about, np.float64)
        self.rational = patch.weights is not None
        self.counts = [RATIONAL if self.rational else exact_points(space.order, order) for space in self.spaces]
        self.tables, self.steps = zip(*(_table(space, n) for space, n in zip(self.spaces, self.counts)))
        # which control point stands behind each basis function: one that a closed direction repeats stands twice
        self._rows = np.ix_(*(np.arange(space.functions) % space.count for space in self.spaces))
        self._divisor = monomials(order).sum(axis=1) + 3.0
        self._pairs = _pair_monomials(order)
        self._tiles = [[slice(start, min(start + TILE, len(space.spans)))
                        for start in range(0, len(space.spans), TILE)] for space in self.spaces]
        self.sums = np.zeros((*(len(space.spans) for space in self.spaces), len(self._divisor) + 1))
        self.area = 0.0
        self._parts: NDArray | None = None
        self.net = self._extended(patch.points, patch.weights)
        self.whole = len(self._tiles[0]) == len(self._tiles[1]) == 1

    def _extended(self, points: NDArray, weights: NDArray | None) -> NDArray[np.float64]:
        """(3 or 4, functions, functions) homogeneous control points about the reference point."""
        net = np.moveaxis(points - self.about, -1, 0)
        if self.rational:
            weights = np.ones(points.shape[:2]) if weights is None else weights
            net = np.concatenate([net * weights, weights[None]])
        return np.ascontiguousarray(net[(slice(None), *self._rows)])

    def moments(self, points: NDArray, weights: NDArray | None = None) -> Moments:
        """All moments for these control points (count_s, count_t, 3): the flux through the patch, about `about`."""
        self.net = self._extended(np.asarray(points, np.float64), weights)
        if self.whole:
            self._parts = None  # those of single spans are not kept
            return self._made(self._flux(slice(0, self.sums.shape[0]), slice(0, self.sums.shape[1]), False))
        for rows in self._tiles[0]:
            for columns in self._tiles[1]:
                self.sums[rows, columns] = self._flux(rows, columns, True)
        self._parts = self.sums.sum(axis=1)
        return self._made(self._parts.sum(axis=0))

    def move(self, i: int, j: int, point: NDArray, weight: float = 1.0) -> Moments:
        """All moments after control point (i, j) has moved: only the spans on which it acts are evaluated.

        `moments` must have been called for the others.
        """
        if self._parts is None:
            self._fill()
        place = np.asarray(point, np.float64) - self.about
        value = np.append(place * weight, weight) if self.rational else place
        for a in range(i, self.spaces[0].functions, self.spaces[0].count):
            for b in range(j, self.spaces[1].functions, self.spaces[1].count):
                self.net[:, a, b] = value
        for a in range(i, self.spaces[0].functions, self.spaces[0].count):
            for b in range(j, self.spaces[1].functions, self.spaces[1].count):
                rows, columns = (self._touched(space, k) for space, k in zip(self.spaces, (a, b)))
                if rows.start < rows.stop and columns.start < columns.stop:
                    self.sums[rows, columns] = self._flux(rows, columns, True)
                    self._parts[rows] = self.sums[rows].sum(axis=1)
        return self._made(self._parts.sum(axis=0))

    def _fill(self) -> None:
        for rows in self._tiles[0]:
            for columns in self._tiles[1]:
                self.sums[rows, columns] = self._flux(rows, columns, True)
        self._parts = self.sums.sum(axis=1)

    @staticmethod
    def _touched(space: Space, function: int) -> slice:
        """The spans on which a basis function is not zero."""
        return slice(int(np.searchsorted(space.spans, function)),
                     int(np.searchsorted(space.spans, function + space.order)))

    def _made(self, sums: NDArray) -> Moments:
        self.area = float(sums[-1])
        return Moments(sums[:-1] / self._divisor, self.about)

    def _flux(self, rows: slice, columns: slice, each: bool) -> NDArray[np.float64]:
        """The sums over some spans of s and some of t: for each pair of them, or together."""
        spans = (rows, columns)
        parts = []
        for space, count, table, step, part in zip(self.spaces, self.counts, self.tables, self.steps, spans):
            first = int(space.spans[part.start]) - space.order + 1
            last = int(space.spans[part.stop - 1]) + 1
            points = slice(part.start * count, part.stop * count)
            parts.append((table[:, points, first:last], step[points], slice(first, last)))
        (along, step, own), (across, stride, other) = parts
        net = self.net[:, own, other]
        half = np.matmul(along.reshape(-1, along.shape[2]), net)  # (d, 2 m, k')
        m = along.shape[1]
        both = np.matmul(half, across[0].T)  # S and S_s, one below the other
        s, s_along = both[:, :m], both[:, m:]
        s_across = np.matmul(half[:, :m], across[1].T)
        if self.rational:
            bottom = 1.0 / s[3]
            s = s[:3] * bottom
            s_along, s_across = ((row[:3] - s * row[3]) * bottom for row in (s_along, s_across))
        (x, y, z), (a, b, c), (d, e, f) = s, s_along, s_across
        normal = b * f - c * e, c * d - a * f, a * e - b * d
        weights = step[:, None] * stride
        flux = x * normal[0]
        flux += y * normal[1]
        flux += z * normal[2]
        flux *= weights
        area = np.zeros(0)
        if self.with_area:
            area = np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2) * weights
        left, right, places = self._pairs
        basis = np.empty((left, *flux.shape))
        basis[0] = 1.0
        for k, (lower, axis) in enumerate(right, 1):
            np.multiply(basis[lower], s[axis], out=basis[k])
        weighted = basis * flux
        if not each:
            gram = np.matmul(weighted.reshape(left, -1), basis.reshape(left, -1).T)
            return np.append(gram.reshape(-1)[places], area.sum())
        shape = (left, rows.stop - rows.start, self.counts[0], columns.stop - columns.start, self.counts[1])
        gram = np.einsum("aumvn,bumvn->uvab", weighted.reshape(shape), basis.reshape(shape))
        found = gram.reshape(*gram.shape[:2], -1)[..., places]
        area = area.reshape(shape[1:]).sum(axis=(1, 3)) if self.with_area else np.zeros(found.shape[:2])
        return np.concatenate([found, area[..., None]], axis=2)


@lru_cache
def _pair_monomials(order: int) -> tuple[int, tuple[tuple[int, int], ...], NDArray[np.intp]]:
    """Monomials of half the order, whose products are all those of the order: how many, how each is a lower one times
    a coordinate, and where in the table of products each monomial stands."""
    lower = [tuple(row) for row in monomials((order + 1) // 2).tolist()]
    made = []
    for row in lower[1:]:
        axis = next(k for k in range(3) if row[k])
        made.append((lower.index(tuple(n - (k == axis) for k, n in enumerate(row))), axis))
    products = {}
    for i, a in enumerate(lower):
        for j, b in enumerate(lower):
            products.setdefault(tuple(p + q for p, q in zip(a, b)), i * len(lower) + j)
    return len(lower), tuple(made), np.array([products[tuple(row)] for row in monomials(order).tolist()])
