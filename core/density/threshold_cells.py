# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cubes in which a density is linear along each axis, and their columns above a threshold (see
`threshold`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics import Array, Index, Mask, NDArray, gauss_legendre

# Row a is for columns along the axis a: the axes of the grid that are x, y and z of these columns.
TURNS = ((1, 2, 0), (2, 0, 1), (0, 1, 2))


@dataclass(frozen=True, eq=False)
class Cells:
    """Cubes: (n, 2, 2, 2) density minus threshold at their corners, (n, 3) positions of their first
    corners relative to the middle of the grid, and (n,) lengths of their edges.
    """

    corners: Array
    origin: Array
    size: Array

    @classmethod
    def of_grid(cls, values: NDArray, is_chosen: Mask, first: NDArray) -> Cells:
        """Return the chosen cells between the samples of a block.

        values: (nx, ny, nz) density minus threshold. is_chosen: (nx - 1, ny - 1, nz - 1). first:
        (3,) position of the sample (0, 0, 0).
        """
        indices = np.argwhere(is_chosen)
        corners = np.empty((len(indices), 2, 2, 2))
        for corner in np.ndindex(2, 2, 2):
            corners[:, *corner] = values[*(indices + corner).T]
        return cls(corners, np.asarray(indices + first, np.float64), np.ones(len(indices)))

    @classmethod
    def join(cls, parts: list[Cells]) -> Cells:
        return cls(
            *(
                np.concatenate([getattr(part, name) for part in parts])
                for name in cls.__annotations__
            )
        )

    def __len__(self) -> int:
        return len(self.size)

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
        """Return (n,) axes along which the density is most clearly monotone, and (n,) True if it is
        monotone along this axis.
        """
        # (n, axis, edge): the steps along the four edges of each axis, most of them positive
        steps = np.stack(
            [np.diff(self.corners, axis=axis).reshape(-1, 4) for axis in (1, 2, 3)], axis=1
        )
        steps *= np.copysign(1.0, steps.sum(axis=2, keepdims=True))
        least = steps.min(axis=2)
        axes = (least + 1e-3 * steps.max(axis=2)).argmax(axis=1)  # The largest step breaks ties.
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

    def take(self, is_chosen: Mask) -> Columns:
        """Return the chosen rows."""
        return Columns(*(values[is_chosen] for values in vars(self).values()))


@dataclass(frozen=True, eq=False)
class _Lines:
    """Lines along y through cells, at the Gauss points of x.

    cell: (m,) index of the cell. x: (m,) position in it. width: (m,) weight of x. ends: (4, m)
    density minus threshold where y and z are (0, 0), (0, 1), (1, 0), (1, 1). rise: (4, m) slopes of
    these along x.
    """

    cell: Index
    x: Array
    width: Array
    ends: Array
    rise: Array


def _lines_along_y(corners: NDArray, nodes: NDArray, weights: NDArray) -> _Lines:
    """Return the lines of cells with (n, 2, 2, 2) corners that are inside somewhere."""
    near, far = corners.reshape(-1, 2, 4).T.swapaxes(0, 1)  # (4, n) at x = 0, and at x = 1
    rise = far - near
    start, length = _smooth_intervals(near, far)
    middle = near[:, None] + (start + length / 2.0) * rise[:, None]
    interval, cell = np.nonzero((length > 0.0) & (middle > 0.0).any(axis=0))
    x = start[interval, cell, None] + length[interval, cell, None] * nodes
    ends = near[:, cell, None] + x * rise[:, cell, None]
    cell_of_line = np.repeat(cell, len(nodes))
    return _Lines(
        cell_of_line,
        x.ravel(),
        (length[interval, cell, None] * weights).ravel(),
        ends.reshape(4, -1),
        rise[:, cell_of_line],
    )


def _columns_of(corners: NDArray, points: int, metric: NDArray) -> list[Columns]:
    """Return the columns that cross the surface, and those that are entirely inside.

    corners: (n, 2, 2, 2) density minus threshold by x, y and the axis of the columns. points: of
    Gauss's rule, along x and along y. metric: (3, 3), gives the surface's area (`_square`).
    """
    nodes, weights = gauss_legendre(points)
    # The corners are scaled to at most 1, so that no product leaves the range of numbers.
    _, exponent = np.frexp(np.abs(corners).max(axis=(1, 2, 3)))
    lines = _lines_along_y(np.ldexp(corners, -exponent[:, None, None, None]), nodes, weights)
    rise_y = lines.ends[2:] - lines.ends[:2]  # (2, m) at the floor and at the ceiling
    start, length = _smooth_intervals(lines.ends[:2], lines.ends[2:])
    middle = lines.ends[:2, None] + (start + length / 2.0) * rise_y[:, None]
    floor_is_inside, ceiling_is_inside = middle >= 0.0
    # In an interval, either all columns cross the surface or none does.
    kinds = (
        (True, floor_is_inside != ceiling_is_inside),
        (False, floor_is_inside & ceiling_is_inside),
    )
    result = []
    for crosses, is_chosen in kinds:
        interval, line = np.nonzero(is_chosen & (length > 0.0))
        y = start[interval, line, None] + length[interval, line, None] * nodes
        weight = (lines.width[line] * length[interval, line])[:, None] * weights
        floor_y, ceiling_y = rise_y[:, line, None]
        floor = lines.ends[0, line, None] + y * floor_y
        growth = lines.ends[1, line, None] + y * ceiling_y - floor
        level = slope = np.zeros((len(line), 1))
        end = ceiling_is_inside[interval, line, None].astype(np.float64)
        if crosses:
            divisor = np.where(growth == 0.0, 1.0, growth)
            level = np.clip(-floor / divisor, 0.0, 1.0)
            rise_x = lines.rise[:, line, None]
            floor_x = rise_x[0] + y * (rise_x[2] - rise_x[0])
            ceiling_x = rise_x[1] + y * (rise_x[3] - rise_x[1])
            gradient_x = floor_x + level * (ceiling_x - floor_x)
            gradient_y = floor_y + level * (ceiling_y - floor_y)
            slope = np.sqrt(_square(metric, gradient_x, gradient_y, growth)) / np.abs(divisor)
        result.append(
            Columns(
                cell=lines.cell[line],
                x=lines.x[line, None],
                y=y,
                weight=weight,
                level=level,
                end=end,
                slope=slope,
                density=floor,
                growth=growth,
                exponent=exponent[lines.cell[line], None],
            )
        )
    return result


def _square(metric: NDArray, x: NDArray, y: NDArray, z: NDArray) -> Array:
    """Return the squares vᵀ metric v of vectors v = (x, y, z)."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = metric
    square = xx * x * x + yy * y * y + zz * z * z
    return square if not (xy or xz or yz) else square + 2.0 * (xy * x * y + xz * x * z + yz * y * z)


def _smooth_intervals(low: NDArray, high: NDArray) -> tuple[Array, Array]:
    """Return (k + 1, n) starts and lengths of the intervals into which roots of k linear functions
    cut [0, 1]; low, high: (k, n) their values at 0 and at 1.

    Intervals may have length 0, as a function without a root there counts as one with the root 0.
    """
    with np.errstate(divide="ignore"):
        roots = np.where((low < 0.0) != (high < 0.0), low / (low - high), 0.0)
    edges = np.zeros((len(low) + 2, low.shape[1]))
    edges[1:-1] = np.clip(np.sort(roots, axis=0), 0.0, 1.0)
    edges[-1] = 1.0
    return edges[:-1], np.diff(edges, axis=0)


def integrate(
    cells: Cells, turn: tuple, points: int, metric: NDArray
) -> tuple[list[Columns], Array]:
    """Return the columns of n cells by a rule of points², and (2, n): by this rule, the volume
    inside each cell and the area of the surface in it.

    turn: row of TURNS. metric: (3, 3), gives the surface's area (`_square`).
    """
    turned = cells.corners.transpose(0, *(1 + np.array(turn)))
    columns = _columns_of(turned, points, metric[np.ix_(turn, turn)])
    amounts = np.zeros((2, len(cells.size)))
    for part in columns:
        for total, height in zip(amounts, (np.abs(part.end - part.level), part.slope)):
            shares = (part.weight * height).sum(axis=1)
            total += np.bincount(part.cell, shares, len(cells.size))
    return columns, amounts * [cells.size**3, cells.size**2]
