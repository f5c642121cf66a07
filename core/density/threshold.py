# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The constant set of a trivariate: the body where a density on a grid is at least a threshold, and
its surface.

Soldea, Elber and Rivlin define a body as {f ≥ t} of a trivariate B-spline f. Here f is linear along
each axis between the samples, and the integrals are over the set itself: nothing is triangulated.

A cell with all eight corners on one side lies on that side, as f is a mean of them. In other cells,
f = a(x, y) + b(x, y) z along an axis, of the three the one along which f is most clearly monotone.
The body's columns then end at z = -a/b, and the integrand along z is a polynomial. The remaining
integral over x and y is smooth except along the lines by which the surface leaves the cell through
its floor (a = 0) or its ceiling (a + b = 0). Along y each of the two lines is met once at most, at
the root of a linear function; along x, these roots enter or leave the cell at the zeros of four
more. Between all these Gauss's rule converges geometrically if b has one sign, and else slower. In
each cell, rules with more and more points are compared; if the last two differ by too much, it is
cut in eight. The sum of the differences is the estimate of the error.

In a smooth density few cells need the finer rules, and hardly one is cut. In a noisy one most
would be cut again and again. Then the allowed difference grows until the work is within a limit:
the largest errors are reduced first, and the bound says what is left.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import (
    Array,
    ArrayLike,
    Mask,
    NDArray,
    float_array,
    gauss_legendre,
    number_array,
    power_table,
)
from ..verdict import MeasureError
from .findings import DENSITY_NON_FINITE, GRID_TRANSFORM_SINGULAR
from .spline_grid import contract
from .threshold_cells import TURNS, Cells, Columns, integrate

RULES = (3, 5, 8, 12)  # points along x and y; each rule is compared with the one before
TOLERANCE = (
    1e-11  # Relative to the volume: allowed difference of the rules in all uncut cells together.
)
AREA_TOLERANCE = 1e-9  # Relative to a cell's face: allowed difference in one cell.
# limit of parts: first per cut cell, plus second; the rest is in the bounds
MAX_PARTS = 64
MIN_PARTS = 1 << 13
MAX_CUT_CELLS = 1 << 21  # Limit of cells kept for measuring.
# Work relative to that of the first two rules: of the other rules, and of a cell that is cut in
# eight. Its limit is the first number for each cell and the second for all together, judged by a
# sample of cells.
WORKS = np.array([1.7, 4.0, 5.0])
WORK = 1.3
LEAST_WORK = 50_000.0
SAMPLE = 1 << 11
DOUBT = 4.0  # factor of the differences in cells without an axis of monotone values
CELLS_PER_BATCH = 1 << 10  # cut cells whose points are in memory at a time
CELLS_PER_SLAB = 1 << 21  # cells of the grid at a time
MEASURES = Measure.VOLUME, Measure.AREA, Measure.MASS  # of the sums, in this order
VOLUME = 0
MASS = 2


@dataclass(frozen=True, eq=False)
class ThresholdBody:
    """The body in which a density is at least a threshold.

    `volume`: its `rounding_error` includes the estimated error of the rules.
    `area`: moments of the surface on which the density is the threshold.
    `mass`: moments of mass, with the density itself inside; None if not requested.
    `cut_cells`: number of cells that the surface passes through.
    `clipped`: True if the body reaches the edge of the grid and is cut off there without a surface.
    """

    volume: Moments
    area: Moments
    mass: Moments | None
    cut_cells: int
    clipped: bool


@np.errstate(over="ignore", invalid="ignore")  # The caller checks for numbers out of range.
def threshold_body(
    samples: ArrayLike,
    threshold: float,
    order: int = 3,
    matrix: ArrayLike | None = None,
    background: float | None = None,
    with_density: bool = False,
    preview: bool = False,
    value: Callable[[NDArray], NDArray] | None = None,
) -> ThresholdBody:
    """Return the moments of the set where the trilinear interpolant reaches a threshold.

    The moments are about the position of the sample in the middle of the grid.

    Parameters
    ----------
    samples : (nx, ny, nz) array_like
        Densities, a memory map if larger than memory.
    threshold : float
    order : int
        Order of the moments.
    matrix : (4, 4) array_like, optional
        Affine: the sample (i, j, k) stands at matrix @ (i, j, k, 1); by default at (i, j, k).
    background : float, optional
        The density beyond the grid: a layer of it is added on every side. Without it, or if it is
        at least the threshold, the body is cut off at the edge of the grid.
    with_density : bool
        Also return the moments of mass, with the density itself inside.
    preview : bool
        Use the first rule alone, without a check: for a slider. The bounds then hold no estimate.
    value : callable, optional
        Converts a block of samples to densities.

    Returns
    -------
    ThresholdBody

    Raises
    ------
    MeasureError
        If a sample is not finite, or the matrix flattens the grid or is not finite.
    ValueError
        If the grid has no cells.

    Notes
    -----
    Soldea, Elber and Rivlin, section 4: the constant set of a trivariate.

    Examples
    --------
    >>> from body_moments.core.density import threshold_body
    >>> ramp = np.arange(5.0)[:, None, None] * np.ones((5, 3, 3))
    >>> body = threshold_body(ramp, 1.25)
    >>> round(body.volume.total, 12), round(body.area.total, 12), body.clipped
    (11.0, 4.0, True)
    """
    samples = number_array("samples", samples, "nx", "ny", "nz")
    if background is not None and background >= threshold:
        background = None
    margin = 0 if background is None else 1
    shape = np.array(samples.shape) + 2 * margin
    if (shape < 2).any():
        raise ValueError("two samples per axis")
    matrix = np.eye(4) if matrix is None else float_array("matrix", matrix, 4, 4)
    linear = matrix[:3, :3]
    if not np.isfinite(matrix).all() or not np.linalg.det(linear):
        raise MeasureError(GRID_TRANSFORM_SINGULAR)
    cofactors = np.linalg.det(linear) * np.linalg.inv(linear)  # they map the normals of the surface
    about = (shape - 1) // 2 - margin
    sums = _Sums(order, with_density, preview, cofactors @ cofactors.T)
    clipped = False
    count = 0
    cut = []
    for first, values in _slabs(samples, background, value):
        if not np.isfinite(values).all():
            raise MeasureError(DENSITY_NON_FINITE)
        inside = values >= threshold
        clipped = clipped or _reaches_edge(inside, first == 0, first + len(values) == shape[0])
        corners = _corner_counts(inside)
        origin = np.array([first, 0, 0]) - margin - about
        sums.add_whole_cells(values, corners == 8, origin)
        places = np.nonzero((corners > 0) & (corners < 8))
        cut.append(Cells.of_grid(values - threshold, places, origin))
        count += len(places[0])
        if sum(len(cells.size) for cells in cut) > MAX_CUT_CELLS or first + len(values) == shape[0]:
            sums.add_cut_cells(Cells.join(cut), threshold)
            cut = []
    about = about.astype(np.float64)

    errors = sums.estimates + (60 + 8 * order + np.log2(sums.terms + 1.0)) * U * sums.sizes
    # The scale of areas is in the sums.
    scaled_as = Measure.VOLUME, Measure.MASS, Measure.VOLUME
    volume, area, mass = (
        replace(Moments(raw, about, scaled, error).transform(matrix), measure=measure)
        for measure, raw, scaled, error in zip(MEASURES, sums.totals, scaled_as, errors)
    )
    return ThresholdBody(volume, area, mass if with_density else None, count, bool(clipped))


def _slabs(
    samples: NDArray, background: float | None, value: Callable[[NDArray], NDArray] | None
) -> Iterator[tuple[int, Array]]:
    """Yield slabs: the first index, and the planes up to the first of the next slab, padded by the
    background.
    """
    margin = 0 if background is None else 1
    planes = len(samples) + 2 * margin
    step = max(1, CELLS_PER_SLAB // max(samples.shape[1] * samples.shape[2], 1))
    for first in range(0, planes - 1, step):
        last = min(first + step + 1, planes)
        slab = np.asarray(samples[max(first - margin, 0) : last - margin], np.float64)
        slab = slab if value is None else value(slab)
        if background is not None:
            beside = int(first == 0), int(last == planes)
            slab = np.pad(slab, (beside, (1, 1), (1, 1)), constant_values=background)
        yield first, slab


def _reaches_edge(inside: Mask, first: bool, last: bool) -> bool:
    sides = (inside[:, 0], inside[:, -1], inside[:, :, 0], inside[:, :, -1])
    ends = ([inside[0]] if first else []) + ([inside[-1]] if last else [])
    return any(side.any() for side in (*sides, *ends))


def _corner_counts(inside: Mask) -> NDArray[np.int8]:
    """Return the number of inside corners of each cell."""
    counts = inside.view(np.int8)
    counts = counts[1:] + counts[:-1]
    counts = counts[:, 1:] + counts[:, :-1]
    return counts[:, :, 1:] + counts[:, :, :-1]


def _batches(cells: Cells) -> Iterator[tuple[Cells, tuple, float]]:
    """Yield batches of cells with the axes of their columns, and a factor of their estimates."""
    axes, is_monotone = cells.column_axes()
    for (axis, turn), doubt in product(enumerate(TURNS), (1.0, DOUBT)):
        chosen = np.flatnonzero((axes == axis) & (is_monotone == (doubt == 1.0)))
        for first in range(0, len(chosen), CELLS_PER_BATCH):
            yield cells[chosen[first : first + CELLS_PER_BATCH]], turn, doubt


class _Sums:
    """The moments so far, about the middle of the grid, (3, K) `totals` of MEASURES; the sizes of
    their terms, and estimates of their errors.
    """

    def __init__(self, order: int, with_density: bool, preview: bool, metric: NDArray) -> None:
        self.order = order
        self.with_density = with_density
        self.preview = preview
        self.metric = metric
        self.face = np.sqrt(np.trace(metric) / 3.0)  # roughly the area of a cell's face
        self.powers = monomials(order)
        self.totals, self.sizes, self.estimates = np.zeros((3, len(MEASURES), len(self.powers)))
        self.terms = 0

    def add_whole_cells(self, values: NDArray, whole: Mask, origin: NDArray) -> None:
        """Add cells of the grid that lie entirely inside."""
        if not whole.any():
            return
        mask = whole.astype(np.float64)
        tables = [
            _interval_moments(first + np.arange(n), self.order + 1)
            for first, n in zip(origin, whole.shape)
        ]
        full = [table[: self.order + 1] for table in tables]
        sizes = [np.abs(table) for table in full]
        self.totals[VOLUME] += self._contract(mask, full)
        self.sizes[VOLUME] += self._contract(mask, sizes)
        self.terms += sum(whole.shape)
        if not self.with_density:
            return
        rising = [
            table[1:] - (first + np.arange(table.shape[1])) * table[:-1]
            for first, table in zip(origin, tables)
        ]
        for place in np.ndindex(2, 2, 2):
            x, y, z = (slice(i, i + n) for i, n in zip(place, whole.shape))
            factors = [up if i else even - up for i, up, even in zip(place, rising, full)]
            block = mask * values[x, y, z]
            self.totals[MASS] += self._contract(block, factors)
            self.sizes[MASS] += self._contract(np.abs(block), sizes)

    def _contract(self, block: NDArray, factors: list[NDArray]) -> Array:
        """Return (K,) Σ block_ijk X[p,i] Y[q,j] Z[r,k]."""
        return contract(block, factors)[tuple(self.powers.T)]

    def add_cut_cells(self, cells: Cells, threshold: float) -> None:
        """Add the inside parts of cells that the surface passes through."""
        if not len(cells.size):
            return
        allowed = np.array(
            [
                TOLERANCE * (self.totals[VOLUME, 0] + len(cells.size) / 2.0) / len(cells.size),
                AREA_TOLERANCE * self.face,
            ]
        )
        allowed = allowed * self._tolerance_factor(cells, allowed)
        budget = MAX_PARTS * len(cells.size) + MIN_PARTS
        while len(cells.size):
            cells = Cells.join(
                [
                    self._add_batch(part, turn, doubt, threshold, allowed)
                    for part, turn, doubt in _batches(cells)
                ]
            ).cut_in_eight()
            signs = cells.corners >= 0.0
            inside = np.asarray(signs.all(axis=(1, 2, 3)))
            self._add_boxes(cells[inside], threshold)
            budget -= len(cells.size)
            cells = cells[~inside & signs.any(axis=(1, 2, 3))]
            if budget < 0 or (cells.size**3).sum() < allowed[0]:
                allowed[:] = np.inf

    def _tolerance_factor(self, cells: Cells, allowed: Array) -> float:
        """Return the least factor of the allowed differences that keeps the work within its limit,
        judged by a sample of the cells.

        So the largest differences are reduced first, and the others are in the bounds.
        """
        limit = WORK + LEAST_WORK / len(cells.size)
        if self.preview or limit >= 1.0 + WORKS.sum():
            return 1.0
        ratios = []
        for part, turn, doubt in _batches(cells[:: max(len(cells.size) // SAMPLE, 1)]):
            amounts = [integrate(part, turn, points, self.metric)[1] for points in RULES]
            estimates = doubt * np.abs(np.diff(amounts, axis=0))
            ratios.append((estimates / allowed[:, None]).max(axis=1))
        least = np.minimum.accumulate(np.concatenate(ratios, axis=1))
        factors = np.geomspace(1.0, max(least.max(), 1.0), 200)
        works = 1.0 + WORKS @ (least[..., None] > factors).mean(axis=1)
        return factors[np.argmax(works <= limit)]

    def _add_batch(
        self, cells: Cells, turn: tuple, doubt: float, threshold: float, allowed: Array
    ) -> Cells:
        """Add the cells that can be integrated to the tolerance; return the other cells."""
        before = None
        for points in RULES:
            columns, amounts = integrate(cells, turn, points, self.metric)
            if before is None and not self.preview:
                before = amounts
                continue
            estimates = doubt * np.abs(amounts - before) if before is not None else 0.0 * amounts
            good = np.asarray((estimates <= allowed[:, None]).all(axis=0))
            for part in columns:
                self._add_columns(part.take(good[part.cell]), cells, turn, threshold)
            kept = cells[good]
            self._add_largest(self.estimates, kept, threshold, *estimates[:, good])
            self._add_largest(self.sizes, kept, threshold, kept.size**3, amounts[1, good])
            cells = cells[~good]
            before = amounts[:, ~good]
            if good.all():
                break
        return cells

    def _add_columns(self, columns: Columns, cells: Cells, turn: tuple, threshold: float) -> None:
        size = cells.size[columns.cell, None]
        x0, y0, z0 = cells.origin[columns.cell][:, turn].T[..., None]
        place = [x0 + size * columns.x, y0 + size * columns.y]
        floor = columns.weight * size**2
        xs = power_table(place[0][:, 0], self.order)
        across = [floor * power for power in power_table(place[1], self.order)]
        levels, ends = (
            power_table(z0 + size * of, self.order + 1) for of in (columns.level, columns.end)
        )
        upward = 2.0 * columns.end[:, 0] - 1.0
        rows = {}
        for number, (p, q, r) in enumerate(self.powers[:, turn].tolist()):
            if (q, r) not in rows:
                inside = np.einsum("ij,ij->i", across[q], ends[r + 1] - levels[r + 1])
                surface = np.einsum("ij,ij,ij->i", across[q], columns.slope, levels[r])
                rows[q, r] = upward * inside / (r + 1), surface
            for total, sums in zip(self.totals, rows[q, r]):
                total[number] += (xs[p] * sums).sum()
        self.terms += floor.size
        if not self.with_density:
            return
        # The density is linear along a column, so that Gauss's rule is exact for the masses.
        height = columns.end - columns.level
        rise = np.ldexp(columns.growth, columns.exponent)
        bottom = threshold + np.ldexp(columns.density, columns.exponent)
        for node, weight in zip(*gauss_legendre((self.order + 1) // 2 + 1)):
            z = columns.level + node * height
            amounts = floor * size * np.abs(height) * weight * (bottom + rise * z)
            self._add_points(MASS, amounts, [*place, z0 + size * z], turn)

    def _add_points(
        self, measure: int, amounts: NDArray, points: list[NDArray], turn: tuple = TURNS[2]
    ) -> None:
        xs, ys, zs = (power_table(values, self.order) for values in points)
        for number, (p, q, r) in enumerate(self.powers[:, turn].tolist()):
            term = amounts * xs[p] * ys[q] * zs[r]
            self.totals[measure, number] += term.sum()
            self.sizes[measure, number] += np.abs(term).sum()

    def _add_boxes(self, cells: Cells, threshold: float) -> None:
        """Add whole cells, which lie entirely inside the body."""
        if not len(cells.size):
            return
        nodes, weights = gauss_legendre((self.order + 1) // 2 + 1)
        for place in np.ndindex(*[len(nodes)] * 3):
            u, v, w = nodes[list(place)]
            points = list((cells.origin + cells.size[:, None] * np.array([u, v, w])).T)
            volumes = weights[list(place)].prod() * cells.size**3
            self._add_points(VOLUME, volumes, points)
            if self.with_density:
                above = np.einsum(
                    "nijk,i,j,k->n", cells.corners, (1.0 - u, u), (1.0 - v, v), (1.0 - w, w)
                )
                self._add_points(MASS, volumes * (threshold + above), points)
        self.terms += len(cells.size)

    def _add_largest(
        self, sums: Array, cells: Cells, threshold: float, volumes: NDArray, areas: NDArray
    ) -> None:
        """Add the largest moments of volumes, areas and masses in cells to (3, K) sums."""
        reach = power_table((np.abs(cells.origin) + cells.size[:, None]).T, self.order)
        density = abs(threshold) + np.abs(cells.corners).max(axis=(1, 2, 3))
        largest = np.stack(
            [reach[p][0] * reach[q][1] * reach[r][2] for p, q, r in self.powers.tolist()]
        )
        sums += np.einsum("ki,mi->mk", largest, np.stack([volumes, areas, volumes * density]))


def _interval_moments(first: NDArray, order: int) -> Array:
    """Return (order + 1, n) ∫ t^l over the unit intervals that start at n points, by an exact
    rule.
    """
    nodes, weights = gauss_legendre(order // 2 + 1)
    points = first[:, None] + nodes
    return np.stack([(points**power) @ weights for power in range(order + 1)])
