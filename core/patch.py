# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tensor-product B-spline patches, polynomial or rational, and their values at Gauss points of many cells at once.

The normal of a patch is ∂S/∂s x ∂S/∂t, s being the direction of the first axis of its control points. Blender's faces
run the other way round their two directions: with v as s and u as t both agree.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .bspline import Space
from .curve import Curve, checked_points
from .quadrature import gauss, gauss_and_ends

DERIVATIVES = (((0, 0),), ((0, 0), (1, 0), (0, 1)), ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))


@dataclass(frozen=True, eq=False)
class Patch:
    """spaces: of s and t. points: (count_s, count_t, 3). weights: (count_s, count_t) positive, or None: polynomial."""

    spaces: tuple[Space, Space]
    points: NDArray[np.float64]
    weights: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        points, weights = checked_points(self.points, self.weights, (self.spaces[0].count, self.spaces[1].count))
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "weights", weights)

    def mapped(self, matrix: NDArray) -> Patch:
        """Its image under an affine map (4, 4): that of its control points."""
        return replace(self, points=self.points @ np.asarray(matrix)[:3, :3].T + np.asarray(matrix)[:3, 3])

    def turned(self) -> Patch:
        """The same surface with its other side out."""
        return Patch(self.spaces[::-1], self.points.swapaxes(0, 1), None if self.weights is None else self.weights.T)

    def grid(self, s: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """(len(s), len(t), 3) its points."""
        return self.combined(*(space.matrix(np.asarray(values)) for space, values in zip(self.spaces, (s, t))))

    def combined(self, *tables: NDArray) -> NDArray[np.float64]:
        """(m, n, 3) its points where its control points weigh what two tables, (m, count_s) and (n, count_t), say."""
        points = self.points
        if self.weights is not None:
            points = points * self.weights[..., None]
            bottom = np.einsum("ai,bi->ab", np.einsum("ai,ij->aj", tables[0], self.weights), tables[1])
        top = np.einsum("ajd,bj->abd", np.einsum("ai,ijd->ajd", tables[0], points), tables[1])
        return top if self.weights is None else top / bottom[..., None]

    def side(self, axis: int, end: int) -> Curve:
        """The curve that bounds the patch where s (axis 0) or t (axis 1) is first (end 0) or last (end 1)."""
        space = self.spaces[axis]
        weigh = space.matrix(np.array([space.domain[end]]))[0]
        points, weights = self.points, self.weights
        if weights is None:
            return Curve(self.spaces[1 - axis], np.tensordot(weigh, points, (0, axis)))
        bottom = np.tensordot(weigh, weights, (0, axis))
        top = np.tensordot(weigh, points * weights[..., None], (0, axis))
        return Curve(self.spaces[1 - axis], top / bottom[:, None], bottom)

    def samples(self, each: int) -> NDArray[np.float64]:
        """A grid of points, each + 1 to every span and direction, ends included."""
        steps = []
        for space in self.spaces:
            low, high = space.intervals.T
            inner = low[:, None] + (high - low)[:, None] * (np.arange(each) / each)
            steps.append(np.append(inner.ravel(), high[-1]))
        return self.grid(*steps)


@dataclass(frozen=True, eq=False)
class Cells:
    """Rectangles of the parameters of one patch, each within one span of s and one of t.

    spans: (c, 2). low, size: (c, 2) where they begin and how long their sides are. rows: (c, 2) which of the spans of
    each direction they are, None for parts of spans.
    """

    spans: NDArray[np.int64]
    low: NDArray[np.float64]
    size: NDArray[np.float64]
    rows: NDArray[np.int64] | None = None

    @classmethod
    def of(cls, patch: Patch) -> Cells:
        """Every span of s by every span of t, one cell each."""
        one, other = patch.spaces
        rows = np.stack([np.repeat(np.arange(len(one.spans)), len(other.spans)),
                         np.tile(np.arange(len(other.spans)), len(one.spans))], axis=1)
        spans = np.stack([one.spans[rows[:, 0]], other.spans[rows[:, 1]]], axis=1)
        bounds = np.stack([one.intervals[rows[:, 0]], other.intervals[rows[:, 1]]], axis=1)
        return cls(spans, bounds[..., 0], bounds[..., 1] - bounds[..., 0], rows)

    def __len__(self) -> int:
        return len(self.spans)

    def __getitem__(self, rows) -> Cells:
        return Cells(self.spans[rows], self.low[rows], self.size[rows], None if self.rows is None else self.rows[rows])

    def split(self) -> Cells:
        """Each cell as four."""
        half = self.size / 2.0
        corners = np.array([[0, 0], [0, 1], [1, 0], [1, 1]], np.float64)
        return Cells(np.repeat(self.spans, 4, axis=0), (self.low[:, None] + corners * half[:, None]).reshape(-1, 2),
                     np.repeat(half, 4, axis=0))


@lru_cache(maxsize=32)
def span_tables(space: Space, points: int, most: int, ends: bool) -> tuple[tuple[NDArray, ...], NDArray]:
    """Basis functions and their derivatives at the Gauss points of all spans, each (s, points, order), and the weights
    of those points (s, points), with `ends` those of the spans too: patches and their caps share spaces. Not to be
    written to."""
    nodes, weights = gauss_and_ends(points) if ends else gauss(points)
    low, high = space.intervals.T
    size = (high - low)[:, None]
    return tuple(space.derivatives(space.spans[:, None], low[:, None] + size * nodes, most)), size * weights


def at_gauss_points(patch: Patch, cells: Cells, points: tuple[int, int], most: int, origin: NDArray,
                    ends: bool = False) -> tuple[list[NDArray[np.float64]], NDArray[np.float64]]:
    """The patch and its derivatives at Gauss points of cells, and the weights of those points.

    points: how many along s and t. most: the highest derivative, 1 or 2. origin: (3,) what is subtracted. ends: the
    cells' sides too, without weight.
    Returns S, S_s, S_t and with most = 2 S_ss, S_st, S_tt, each (3, c, m, n), and the weights (c, m, n).
    """
    tables, steps, controls = [], [], []
    for axis, (space, number) in enumerate(zip(patch.spaces, points)):
        if cells.rows is None:
            nodes, weights = gauss_and_ends(number) if ends else gauss(number)
            size = cells.size[:, axis, None]
            tables.append(space.derivatives(cells.spans[:, axis, None], cells.low[:, axis, None] + size * nodes, most))
            steps.append(size * weights)
        else:
            found, step = span_tables(space, number, most, ends)
            own = cells.rows[:, axis]
            tables.append([table[own] for table in found])
            steps.append(step[own])
        controls.append(space.controls(cells.spans[:, axis]))
    rows = controls[0][:, :, None], controls[1][:, None, :]
    net = patch.points[rows].transpose(3, 0, 1, 2)  # (3, c, k, k')
    home = net[:, :, 0, 0]  # what is added up is as small as the cell, and so is its rounding
    net = net - home[:, :, None, None]
    home = (home - origin[:, None])[:, :, None, None]
    if patch.weights is not None:
        weights = patch.weights[rows]
        net = np.concatenate([net * weights, weights[None]])
    half = [np.matmul(table, net) for table in tables[0]]
    across = [np.ascontiguousarray(table.swapaxes(-1, -2)) for table in tables[1]]
    found = [np.matmul(half[i], across[j]) for i, j in DERIVATIVES[most]]
    if patch.weights is not None:
        found = _divided(found)
    found[0] = found[0] + home
    return found, steps[0][:, :, None] * steps[1][:, None, :]


def _divided(found: list[NDArray]) -> list[NDArray[np.float64]]:
    """The derivatives of the quotient from those of the numerator and, in the last row, the denominator."""
    bottom = found[0][3]
    s = found[0][:3] / bottom
    first = [(row[:3] - s * row[3]) / bottom for row in found[1:3]]
    result = [s, *first]
    for row, (i, j) in zip(found[3:], ((0, 0), (0, 1), (1, 1))):
        mixed = first[i] * found[1 + j][3] + first[j] * found[1 + i][3]
        result.append((row[:3] - mixed - s * row[3]) / bottom)
    return result
