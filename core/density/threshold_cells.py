# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cubes in which a density is linear along each axis, and their columns above a threshold (see
`threshold`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..numerics import Array, Index, Mask, gauss_legendre

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
        return cls(corners, np.stack(places, axis=1) + origin, np.ones(len(i)))

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
        steps *= np.sign(steps.sum(axis=2, keepdims=True))
        least = steps.min(axis=2)
        axes = (least + 1e-3 * steps.max(axis=2)).argmax(axis=1)
        return axes, least[np.arange(len(axes)), axes] >= 0.0


@dataclass(frozen=True, eq=False)
class Columns:
    """Points on the floors of cells, each with the inside part of its column; those of a cell are
    consecutive.

    cell: (m,) index of the cell. x, y: position in it. weight: area of floor. low, high: ends of
    the inside part. level: z of the surface. slope: the surface's area per unit of floor, 0 if the
    column does not cross it. density: density minus threshold at z = 0. growth: its slope along z.
    """

    cell: Index
    x: Array
    y: Array
    weight: Array
    low: Array
    high: Array
    level: Array
    slope: Array
    density: Array
    growth: Array


def columns_of(corners: NDArray, points: int, metric: NDArray) -> Columns:
    """Return columns at the Gauss points between the lines where the surface leaves a cell; metric:
    of its area.
    """
    nodes, weights = gauss_legendre(points)
    _, exponent = np.frexp(np.abs(corners).max(axis=(1, 2, 3)))
    # so that no product leaves the range of numbers
    corners = np.ldexp(corners, -exponent[:, None, None, None])
    # by y and z: at x = 0, and along x
    near = corners[:, 0].reshape(-1, 4)
    step = corners[:, 1].reshape(-1, 4) - near
    start, length = _smooth_intervals(near, corners[:, 1].reshape(-1, 4))
    middle = near[:, None] + (start + length / 2.0)[..., None] * step[:, None]
    cell, part = np.nonzero((length > 0.0) & (middle > 0.0).any(axis=2))  # else all is outside
    x = start[cell, part, None] + length[cell, part, None] * nodes
    width = length[cell, part, None] * weights
    line = (near[cell, None] + x[..., None] * step[cell, None]).reshape(-1, 2, 2)  # (m, y, z)
    along_y = line[:, 1] - line[:, 0]
    start, length = _smooth_intervals(line[:, 0], line[:, 1])
    middle = line[:, 0, None] + (start + length / 2.0)[..., None] * along_y[:, None]
    inside = middle >= 0.0
    row, part = np.nonzero((length > 0.0) & inside.any(axis=2))
    # From here on, rows are intervals along y, and columns their points.
    cell = np.repeat(cell, points)[row]
    y = start[row, part, None] + length[row, part, None] * nodes
    weight = (width.ravel()[row] * length[row, part])[:, None] * weights
    along_x = step[cell, :, None]
    along_y = along_y[row, :, None]
    floor = line[row, 0, :1] + y * along_y[:, 0]
    growth = line[row, 0, 1:] + y * along_y[:, 1] - floor
    # Between the lines, a column meets the surface everywhere or nowhere.
    crossed = (inside[row, part, :1] != inside[row, part, 1:]) & (growth != 0.0)
    divisor = np.where(crossed, growth, 1.0)
    level = np.clip(-floor / divisor, 0.0, 1.0)
    floor_x = along_x[:, 0] + y * (along_x[:, 2] - along_x[:, 0])
    ceiling_x = along_x[:, 1] + y * (along_x[:, 3] - along_x[:, 1])
    slope_x = floor_x + level * (ceiling_x - floor_x)
    slope_y = along_y[:, 0] + level * (along_y[:, 1] - along_y[:, 0])
    slope = np.sqrt(_square(metric, slope_x, slope_y, growth)) / np.abs(divisor) * crossed
    low = np.where(crossed & (growth > 0.0), level, 0.0)
    high = np.where(crossed & (growth < 0.0), level, 1.0)
    exponent = exponent[cell, None]
    table = np.broadcast_arrays(
        cell[:, None],
        x.ravel()[row, None],
        y,
        weight,
        low,
        high,
        level,
        slope,
        np.ldexp(floor, exponent),
        np.ldexp(growth, exponent),
    )
    return Columns(*(values.ravel() for values in table))


def _square(metric: NDArray, x: NDArray, y: NDArray, z: NDArray) -> Array:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = metric
    square = xx * x * x + yy * y * y + zz * z * z
    return square if not (xy or xz or yz) else square + 2.0 * (xy * x * y + xz * x * z + yz * y * z)


def _smooth_intervals(low: NDArray, high: NDArray) -> tuple[Array, Array]:
    """Cut [0, 1] at roots of linear functions with end values (n, k); return the starts and lengths
    of the (n, k + 1) intervals.
    """
    with np.errstate(divide="ignore"):
        roots = np.where((low < 0.0) != (high < 0.0), low / (low - high), 0.0)
    edges = np.sort(np.pad(np.clip(roots, 0.0, 1.0), ((0, 0), (1, 0))), axis=1)
    edges = np.pad(edges, ((0, 0), (0, 1)), constant_values=1.0)
    return edges[:, :-1], np.diff(edges, axis=1)


def amounts_of(columns: Columns, cells: Cells) -> Array:
    """Return a (2, n) array: the volume inside each cell, and the area of the surface in the
    cell.
    """
    volumes, areas = (
        np.bincount(columns.cell, columns.weight * height, len(cells.size))
        for height in (columns.high - columns.low, columns.slope)
    )
    return np.stack([volumes * cells.size**3, areas * cells.size**2])


def compare_rules(
    cells: Cells, turn: tuple, rules: Sequence[int], metric: NDArray
) -> tuple[Columns, Array]:
    """Return the columns of the last rule, and (2, n) differences of cells' volumes and areas from
    the first rule.
    """
    metric = metric[np.ix_(turn, turn)]
    turned = cells.corners.transpose(0, *(1 + np.array(turn)))
    columns = [columns_of(turned, points, metric) for points in rules]
    amounts = [amounts_of(each, cells) for each in columns]
    return columns[-1], np.abs(amounts[-1] - amounts[0])
