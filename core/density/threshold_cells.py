# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cubes in which a density is linear along each axis, and their columns above a threshold (see
`threshold`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..numerics import Array, Index, Mask, NDArray, gauss_legendre

# By the axis of a cell's columns: the axes along which x, y and the columns run.
TURNS = ((1, 2, 0), (2, 0, 1), (0, 1, 2))


@dataclass(frozen=True, eq=False)
class Cells:
    """Cubes: (n, 2, 2, 2) density minus threshold at corners, (n, 3) first corners from the middle,
    (n,) edges.
    """

    corners: Array
    origin: Array
    size: Array

    @classmethod
    def of_grid(cls, values: NDArray, places: tuple[NDArray, ...], origin: NDArray) -> Cells:
        i, j, k = places
        corners = np.empty((len(i), 2, 2, 2))
        for a, b, c in np.ndindex(2, 2, 2):
            corners[:, a, b, c] = values[i + a, j + b, k + c]
        return cls(corners, origin=np.stack(places, axis=1) + origin, size=np.ones(len(i)))

    @classmethod
    def join(cls, parts: list[Cells]) -> Cells:
        return cls(
            *(
                np.concatenate([getattr(part, name) for part in parts])
                for name in cls.__annotations__
            )
        )

    def __getitem__(self, chosen: slice | NDArray) -> Cells:
        return Cells(self.corners[chosen], self.origin[chosen], self.size[chosen])

    def cut_in_eight(self) -> Cells:
        """Cut each cube into eight; a density that is linear along the axes stays so in every
        part.
        """
        finer = self.corners
        for axis in (1, 2, 3):
            low, high = np.split(finer, 2, axis=axis)
            finer = np.concatenate([low, (low + high) / 2.0, high], axis=axis)
        half = self.size / 2.0
        parts = [
            Cells(
                finer[:, a : a + 2, b : b + 2, c : c + 2],
                self.origin + half[:, None] * np.array([a, b, c]),
                half,
            )
            for a, b, c in np.ndindex(2, 2, 2)
        ]
        return Cells.join(parts)

    def column_axes(self) -> tuple[Index, Mask]:
        """Return for n cells the axis along which the density is most clearly monotone, and whether
        it is.
        """
        steps = np.stack(
            [np.diff(self.corners, axis=axis).reshape(-1, 4) for axis in (1, 2, 3)], axis=1
        )
        steps *= np.copysign(1.0, steps.sum(axis=2, keepdims=True))
        least = steps.min(axis=2)
        axes = (least + 1e-3 * steps.max(axis=2)).argmax(axis=1)
        return axes, least[np.arange(len(axes)), axes] >= 0.0


@dataclass(frozen=True, eq=False)
class Columns:
    """Points on the floors of cells, each with the inside part of its column, in (m, k) arrays, or
    arrays that broadcast to them. Each row lies in one cell.

    cell: (m,) index of the cell. x, y: position in it. weight: area of floor. level: z of the
    surface, or of the floor if the column does not cross it. end: z of the other end of the inside
    part, 0 or 1, constant in a row. slope: the surface's area per unit of floor, or 0. density:
    density minus threshold at z = 0. growth: its slope along z; both in units of 2^exponent.
    """

    cell: Index
    x: Array
    y: Array
    weight: Array
    level: Array
    end: Array
    slope: Array
    density: Array
    growth: Array
    exponent: Index

    def take(self, chosen: Mask) -> Columns:
        """Return the chosen rows."""
        return Columns(*(values[chosen] for values in vars(self).values()))


def columns_of(corners: NDArray, points: int, metric: NDArray) -> list[Columns]:
    """Return columns at the Gauss points between the lines where the surface leaves a cell: those
    that cross the surface, and those that are inside.

    metric: of the surface's area.
    """
    nodes, weights = gauss_legendre(points)
    _, exponent = np.frexp(np.abs(corners).max(axis=(1, 2, 3)))
    # so that no product leaves the range of numbers
    near, far = np.ldexp(corners, -exponent[:, None, None, None]).reshape(-1, 2, 4).T.swapaxes(0, 1)
    step = far - near  # along x; (4, n) by y and z
    start, length = _smooth_intervals(near, far)
    middle = near[:, None] + (start + length / 2.0) * step[:, None]
    part, cell = np.nonzero((length > 0.0) & (middle > 0.0).any(axis=0))  # else all is outside
    x = start[part, cell, None] + length[part, cell, None] * nodes
    width = (length[part, cell, None] * weights).ravel()
    line = (near[:, cell, None] + x * step[:, cell, None]).reshape(4, -1)
    along_y = line[2:] - line[:2]  # at the floor and at the ceiling
    start, length = _smooth_intervals(line[:2], line[2:])
    middle = line[:2, None] + (start + length / 2.0) * along_y[:, None]
    below, above = middle >= 0.0
    x = x.ravel()
    cell = np.repeat(cell, points)
    # Between the lines, a column meets the surface everywhere or nowhere.
    result = []
    for crosses, chosen in ((True, below != above), (False, below & above)):
        part, row = np.nonzero(chosen & (length > 0.0))
        y = start[part, row, None] + length[part, row, None] * nodes
        weight = (width[row] * length[part, row])[:, None] * weights
        floor_y, ceiling_y = along_y[:, row, None]
        floor = line[0, row, None] + y * floor_y
        growth = line[1, row, None] + y * ceiling_y - floor
        level = slope = np.zeros((len(row), 1))
        end = above[part, row, None].astype(np.float64)
        if crosses:
            along_x = step[:, cell[row], None]
            divisor = np.where(growth == 0.0, 1.0, growth)
            level = np.clip(-floor / divisor, 0.0, 1.0)
            floor_x = along_x[0] + y * (along_x[2] - along_x[0])
            ceiling_x = along_x[1] + y * (along_x[3] - along_x[1])
            slope_x = floor_x + level * (ceiling_x - floor_x)
            slope_y = floor_y + level * (ceiling_y - floor_y)
            slope = np.sqrt(_square(metric, slope_x, slope_y, growth)) / np.abs(divisor)
        place = cell[row], x[row, None], y
        density = floor, growth, exponent[cell[row], None]
        result.append(Columns(*place, weight, level, end, slope, *density))
    return result


def _square(metric: NDArray, x: NDArray, y: NDArray, z: NDArray) -> Array:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = metric
    square = xx * x * x + yy * y * y + zz * z * z
    return square if not (xy or xz or yz) else square + 2.0 * (xy * x * y + xz * x * z + yz * y * z)


def _smooth_intervals(low: NDArray, high: NDArray) -> tuple[Array, Array]:
    """Cut [0, 1] at roots of linear functions with end values (k, n); return the starts and lengths
    of the (k + 1, n) intervals.
    """
    with np.errstate(divide="ignore"):
        roots = np.where((low < 0.0) != (high < 0.0), low / (low - high), 0.0)
    edges = np.zeros((len(low) + 2, low.shape[1]))
    edges[1:-1] = np.clip(np.sort(roots, axis=0), 0.0, 1.0)
    edges[-1] = 1.0
    return edges[:-1], np.diff(edges, axis=0)


def amounts_of(columns: Sequence[Columns], cells: Cells) -> Array:
    """Return a (2, n) array: the volume inside each cell, and the area of the surface in the
    cell.
    """
    amounts = np.zeros((2, len(cells.size)))
    for part in columns:
        for total, height in zip(amounts, (np.abs(part.end - part.level), part.slope)):
            shares = (part.weight * height).sum(axis=1)
            total += np.bincount(part.cell, shares, len(cells.size))
    return amounts * [cells.size**3, cells.size**2]


def integrate(
    cells: Cells, turn: tuple, points: int, metric: NDArray
) -> tuple[list[Columns], Array]:
    """Return the columns of a rule, and (2, n) volumes and areas of cells by it."""
    turned = cells.corners.transpose(0, *(1 + np.array(turn)))
    columns = columns_of(turned, points, metric[np.ix_(turn, turn)])
    return columns, amounts_of(columns, cells)
