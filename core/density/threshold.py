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
from .spline_grid import contract, full_support_integrals
from .threshold_cells import TURNS, Cells, Columns, integrate

RULES = (3, 5, 8, 12)  # Points along x and y; each rule is compared with the one before.
# Relative to the volume: allowed difference of the rules in all cells together that the surface
# crosses.
TOLERANCE = 1e-11
AREA_TOLERANCE = 1e-9  # Relative to a cell's face: allowed difference in one cell.
# Cells are cut in eight until there are this many parts for each crossed cell, plus these for all
# together; the differences that remain are in the bounds.
MAX_PARTS_PER_CELL = 64
MIN_PARTS = 1 << 13
MAX_CROSSED_CELLS = 1 << 21  # crossed cells that are collected before they are integrated
# Measured times of the third rule, of the fourth, and of a cut in eight, in units of the time of
# the first two rules. All together are limited to MAX_WORK_PER_CELL for each cell, plus MIN_WORK.
EXTRA_WORK = np.array([1.7, 4.0, 5.0])
MAX_WORK_PER_CELL = 1.3
MIN_WORK = 50_000.0
SAMPLE_CELLS = 1 << 11  # cells by which the work is estimated
DOUBT = 4.0  # factor of the differences in cells without an axis of monotone values
CELLS_PER_BATCH = 1 << 10  # crossed cells whose points are in memory at a time
CELLS_PER_SLAB = 1 << 21  # cells of the grid at a time
MEASURES = Measure.VOLUME, Measure.AREA, Measure.MASS  # the rows of the sums
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
    sums = _Sums(order, threshold, with_density, preview, metric=cofactors @ cofactors.T)
    clipped = False
    crossed_count = 0
    collected: list[Cells] = []
    for first, values in _slabs(samples, background, value):
        if not np.isfinite(values).all():
            raise MeasureError(DENSITY_NON_FINITE)
        is_last = first + len(values) == shape[0]
        inside = values >= threshold
        clipped = clipped or _reaches_edge(inside, first == 0, is_last)
        corners = _corner_counts(inside)
        origin = np.array([first, 0, 0]) - margin - about
        sums.add_whole_cells(values, corners == 8, origin)
        crossed = Cells.of_grid(values - threshold, (corners > 0) & (corners < 8), origin)
        collected.append(crossed)
        crossed_count += len(crossed)
        if sum(map(len, collected)) > MAX_CROSSED_CELLS or is_last:
            sums.add_crossed_cells(Cells.join(collected))
            collected = []

    # Roundings of a term, by its order, and of pairwise sums; 60 is chosen with a margin.
    errors = sums.estimates + (60 + 8 * order + np.log2(sums.terms + 1.0)) * U * sums.sizes
    # In the grid's coordinates, the sums of areas are already those of the mapped surface, and
    # masses are those of the unmapped body. So the map leaves the first alone, as it leaves a mass,
    # and scales the second, as it scales a volume.
    mapped_as = Measure.VOLUME, Measure.MASS, Measure.VOLUME
    volume, area, mass = (
        replace(
            Moments(raw, about.astype(np.float64), kind, error).transform(matrix), measure=measure
        )
        for measure, kind, raw, error in zip(MEASURES, mapped_as, sums.totals, errors)
    )
    return ThresholdBody(volume, area, mass if with_density else None, crossed_count, clipped)


def _slabs(
    samples: NDArray, background: float | None, value: Callable[[NDArray], NDArray] | None
) -> Iterator[tuple[int, Array]]:
    """Yield slabs of densities, each with the index of its first plane.

    A slab includes the first plane of the next one. With a background, the grid has one more layer
    on every side.
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


def _reaches_edge(inside: Mask, is_first: bool, is_last: bool) -> bool:
    """Return whether the body reaches the edge of the grid in a slab."""
    sides = [inside[:, 0], inside[:, -1], inside[:, :, 0], inside[:, :, -1]]
    if is_first:
        sides.append(inside[0])
    if is_last:
        sides.append(inside[-1])
    return any(bool(side.any()) for side in sides)


def _corner_counts(inside: Mask) -> NDArray[np.int8]:
    """Return the number of inside corners of each cell."""
    counts = inside.view(np.int8)
    counts = counts[1:] + counts[:-1]
    counts = counts[:, 1:] + counts[:, :-1]
    return counts[:, :, 1:] + counts[:, :, :-1]


def _batches(cells: Cells) -> Iterator[tuple[Cells, tuple, float]]:
    """Yield batches of cells, the row of TURNS for their columns, and a factor of their errors."""
    axes, is_monotone = cells.column_axes()
    for (axis, turn), (monotone, doubt) in product(enumerate(TURNS), ((True, 1.0), (False, DOUBT))):
        chosen = np.flatnonzero((axes == axis) & (is_monotone == monotone))
        for first in range(0, len(chosen), CELLS_PER_BATCH):
            yield cells[chosen[first : first + CELLS_PER_BATCH]], turn, doubt


class _Sums:
    """Sums of moments about the middle of the grid, one row for each of MEASURES.

    totals: (3, K) the moments so far. sizes: (3, K) bounds of the sums of their terms' magnitudes.
    estimates: (3, K) estimates of the errors of the rules. terms: bounds the length of any sum.
    metric: (3, 3), gives the area of the mapped surface (`threshold_cells.integrate`).
    """

    def __init__(
        self, order: int, threshold: float, with_density: bool, preview: bool, metric: NDArray
    ) -> None:
        self.order = order
        self.threshold = threshold
        self.with_density = with_density
        self.preview = preview
        self.metric = metric
        self.face_area = np.sqrt(np.trace(metric) / 3.0)  # roughly, of a mapped cell
        self.powers = monomials(order)
        self.totals, self.sizes, self.estimates = np.zeros((3, len(MEASURES), len(self.powers)))
        self.terms = 0

    def add_whole_cells(self, values: NDArray, whole: Mask, origin: NDArray) -> None:
        """Add cells of a slab that lie entirely inside.

        values: (nx, ny, nz) densities. whole: (nx - 1, ny - 1, nz - 1) True for these cells.
        origin: (3,) position of the first value.
        """
        if not whole.any():
            return
        mask = whole.astype(np.float64)
        starts = [first + np.arange(n) for first, n in zip(origin, whole.shape)]
        tables = [
            full_support_integrals(np.append(start, start[-1] + 1.0), 1, self.order + 1)
            for start in starts
        ]
        constant = [table[: self.order + 1] for table in tables]
        sizes = [np.abs(table) for table in constant]
        self.totals[VOLUME] += self._contract(mask, constant)
        self.sizes[VOLUME] += self._contract(mask, sizes)
        self.terms += sum(whole.shape)
        if not self.with_density:
            return
        # Each corner adds its density times a function that falls from 1 at this corner to 0 at the
        # others: along each axis t - start for the far corners, 1 - (t - start) for the near ones.
        rising = [table[1:] - start * table[:-1] for start, table in zip(starts, tables)]
        falling = [even - up for even, up in zip(constant, rising)]
        for corner in np.ndindex(2, 2, 2):
            x, y, z = (slice(i, i + n) for i, n in zip(corner, whole.shape))
            factors = [up if i else down for i, up, down in zip(corner, rising, falling)]
            block = mask * values[x, y, z]
            self.totals[MASS] += self._contract(block, factors)
            self.sizes[MASS] += self._contract(np.abs(block), sizes)

    def _contract(self, block: NDArray, factors: list[NDArray]) -> Array:
        """Return (K,) Σ block_ijk X[p,i] Y[q,j] Z[r,k]."""
        return contract(block, factors)[tuple(self.powers.T)]

    def add_crossed_cells(self, cells: Cells) -> None:
        """Add the inside parts of cells that the surface crosses, and the surface in them."""
        if not len(cells):
            return
        # Crossed cells count as half full.
        volume_per_cell = (self.totals[VOLUME, 0] + len(cells) / 2.0) / len(cells)
        allowed = np.array([TOLERANCE * volume_per_cell, AREA_TOLERANCE * self.face_area])
        allowed = allowed * self._tolerance_factor(cells, allowed)
        remaining_parts = MAX_PARTS_PER_CELL * len(cells) + MIN_PARTS
        while len(cells):
            inexact = [self._add_exact_cells(*batch, allowed) for batch in _batches(cells)]
            cells = Cells.join(inexact).cut_in_eight()
            inside = cells.corners >= 0.0
            remaining_parts -= len(cells)
            cells = cells[np.asarray(inside.any(axis=(1, 2, 3)))]
            # Too many parts, or parts too small to matter: the next pass adds them all, with their
            # differences in the estimates.
            if remaining_parts < 0 or (cells.size**3).sum() < allowed[0]:
                allowed[:] = np.inf

    def _tolerance_factor(self, cells: Cells, allowed: Array) -> float:
        """Return the least factor of the (2,) allowed differences of volume and area that keeps the
        work within its limit.

        So the largest differences are reduced first, and the others are in the bounds.
        """
        limit = MAX_WORK_PER_CELL + MIN_WORK / len(cells)
        if self.preview or limit >= 1.0 + EXTRA_WORK.sum():
            return 1.0
        ratios = []
        for batch, turn, doubt in _batches(cells[:: max(len(cells) // SAMPLE_CELLS, 1)]):
            amounts = [integrate(batch, turn, points, self.metric)[1] for points in RULES]
            differences = doubt * np.abs(np.diff(amounts, axis=0))
            ratios.append((differences / allowed[:, None]).max(axis=1))
        # (rule, cell): a cell needs the next rule, or the cut, as long as all ratios up to this
        # rule exceed the factor.
        least_ratio = np.minimum.accumulate(np.concatenate(ratios, axis=1))
        # Of 200 factors, up to one that no cell exceeds, the first with little enough work.
        factors = np.geomspace(1.0, max(least_ratio.max(), 1.0), 200)
        work = 1.0 + EXTRA_WORK @ (least_ratio[..., None] > factors).mean(axis=1)
        return factors[np.argmax(work <= limit)]

    def _add_exact_cells(self, cells: Cells, turn: tuple, doubt: float, allowed: Array) -> Cells:
        """Add the cells of a batch with rules that differ by no more than the (2,) allowed
        differences of volume and area; return the other cells.
        """
        rules = RULES
        coarser = None
        if not self.preview:
            rules = RULES[1:]
            _, coarser = integrate(cells, turn, RULES[0], self.metric)
        for points in rules:
            columns, amounts = integrate(cells, turn, points, self.metric)
            errors = 0.0 * amounts if coarser is None else doubt * np.abs(amounts - coarser)
            is_exact = np.asarray((errors <= allowed[:, None]).all(axis=0))
            for part in columns:
                self._add_columns(part.take(is_exact[part.cell]), cells, turn)
            exact = cells[is_exact]
            self._add_largest(self.estimates, exact, *errors[:, is_exact])
            self._add_largest(self.sizes, exact, exact.size**3, amounts[1, is_exact])
            cells = cells[~is_exact]
            coarser = amounts[:, ~is_exact]
            if not len(cells):
                break
        return cells

    def _add_columns(self, columns: Columns, cells: Cells, turn: tuple) -> None:
        """Add the inside parts of columns, and the surface at their ends.

        turn: row of TURNS; x, y, z are the axes of the columns.
        """
        size = cells.size[columns.cell, None]
        x0, y0, z0 = cells.origin[columns.cell][:, turn].T[..., None]
        x = x0 + size * columns.x
        y = y0 + size * columns.y
        floor = columns.weight * size**2
        x_powers = power_table(x[:, 0], self.order)
        floor_y_powers = [floor * power for power in power_table(y, self.order)]
        level_powers = power_table(z0 + size * columns.level, self.order + 1)
        end_powers = power_table(z0 + size * columns.end, self.order + 1)
        upward = 2.0 * columns.end[:, 0] - 1.0  # 1 if the end is the ceiling, -1 if it is the floor
        # By (q, r): for each row of columns, ∫ y^q z^r over the volume and over the surface.
        row_integrals = {}
        for number, (p, q, r) in enumerate(self.powers[:, turn].tolist()):
            if (q, r) not in row_integrals:
                rises = end_powers[r + 1] - level_powers[r + 1]
                inside = np.einsum("ij,ij->i", floor_y_powers[q], rises)
                surface = np.einsum(
                    "ij,ij,ij->i", floor_y_powers[q], columns.slope, level_powers[r]
                )
                row_integrals[q, r] = upward * inside / (r + 1), surface
            for total, integrals in zip(self.totals, row_integrals[q, r]):
                total[number] += (x_powers[p] * integrals).sum()
        self.terms += floor.size
        if not self.with_density:
            return
        # The density is linear along a column, so that Gauss's rule is exact for the masses.
        height = columns.end - columns.level
        rise = np.ldexp(columns.growth, columns.exponent)
        bottom = self.threshold + np.ldexp(columns.density, columns.exponent)
        for node, weight in zip(*gauss_legendre((self.order + 1) // 2 + 1)):
            z = columns.level + node * height
            amounts = floor * size * np.abs(height) * weight * (bottom + rise * z)
            xs, ys, zs = (power_table(values, self.order) for values in (x, y, z0 + size * z))
            for number, (p, q, r) in enumerate(self.powers[:, turn].tolist()):
                term = amounts * xs[p] * ys[q] * zs[r]
                self.totals[MASS, number] += term.sum()
                self.sizes[MASS, number] += np.abs(term).sum()

    def _add_largest(self, sums: Array, cells: Cells, volumes: NDArray, areas: NDArray) -> None:
        """Add to (3, K) sums the largest moments that (n,) volumes and areas within n cells may
        have.
        """
        reach = power_table((np.abs(cells.origin) + cells.size[:, None]).T, self.order)
        density = abs(self.threshold) + np.abs(cells.corners).max(axis=(1, 2, 3))
        largest = np.stack(
            [reach[p][0] * reach[q][1] * reach[r][2] for p, q, r in self.powers.tolist()]
        )
        sums += np.einsum("ki,mi->mk", largest, np.stack([volumes, areas, volumes * density]))
