# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of grids: samples as densities, and the values at or above a threshold."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..density import (
    LABELS_UNFIT,
    Blocks,
    GridOptions,
    ThresholdBody,
    density_function,
    empty_background_note,
    grid_moments,
    label_moments,
    smooth_threshold_body,
    threshold_body,
)
from ..measurement import Body
from ..moments import KNOWN_ORDER, Measure, Moments
from ..numerics import Array, NDArray
from ..scans import EVEN, SCAN_LABELS, Positions, count_labels
from ..verdict import Finding, MeshHealth, Method, Procedure, ReadError, Source, finding
from .findings import (
    DENSITY_FROM_GRID,
    GRID_EMPTY,
    GRID_WITHOUT_SURFACE,
    MASS_OVERFLOW,
    THRESHOLD_CLIPPED,
    THRESHOLD_MEASURED,
    THRESHOLD_NEEDS_FACTOR,
    THRESHOLD_NOT_REACHED,
)
from .mesh_body import MAX_MASS_MOMENT

MAX_SAMPLES = 1 << 29  # in the box that holds the grid
PREVIEW_CELLS = 1 << 18  # in a grid that follows a slider
TRILINEAR = 2
LARGEST_WHOLE = 1 << 53  # float64 holds all whole numbers below
FLOAT32_U = 2.0**-23  # relative error of a header's slope and intercept, in float32
MAX_ROUNDING = 0.01  # farther from a whole number, a label is a fraction


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a density at matrix @ (i, j, k, 1), in meters, that stand for slope · value +
    intercept.

    values: one array, or (offset, array) block by block. shape: (3,) shape of the box that holds
    them. background: a value that counts as empty. positions: of the samples along each axis, None
    for 0, 1, 2, …
    """

    values: Blocks | NDArray
    shape: Sequence[int]
    matrix: Array
    options: GridOptions = GridOptions()
    background: float | None = None
    slope: float = 1.0
    intercept: float = 0.0
    positions: Positions = EVEN

    @cached_property
    def _weigh(self) -> Callable[[NDArray], NDArray]:
        return density_function(self.options, self.background)

    def densities(self, block: NDArray) -> Array:
        """Return the densities, kg/m³, of a block of values."""
        scaled = self.slope != 1.0 or self.intercept != 0.0
        return self._weigh(block * self.slope + self.intercept if scaled else block)

    def volume_moments(self, order: int) -> Moments:
        """Return the moments of the voxels that are not empty."""

        def occupied(block: NDArray) -> Array:
            return (self.densities(block) != 0.0).astype(np.float64)

        return replace(self.grid_moments(occupied, 1, order), measure=Measure.VOLUME)

    def grid_moments(
        self, value: Callable[[NDArray], NDArray], spline_order: int, order: int
    ) -> Moments:
        """Return the moments of a function of the values, interpolated by a spline."""
        return grid_moments(
            self.values, self.shape, self.matrix, spline_order, order, value, self.positions
        )


@dataclass(frozen=True, eq=False)
class GridBody(Body):
    """The body of samples; a grid has no area."""

    any_order: ClassVar[bool] = True

    samples: Samples = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the voxels that are not empty; a grid has no area."""
        volume = self.samples.volume_moments(order)
        return volume, Moments(
            np.zeros_like(volume.raw), volume.about, Measure.AREA
        ) if area else None


def density_body(
    samples: Samples,
    findings: tuple[Finding, ...] = (),
    progress: Callable[[int], None] = lambda samples: None,
    order: int = KNOWN_ORDER,
) -> GridBody:
    """Return the body of samples, with its mass moments to an order, or raise ReadError if they are
    empty.

    progress: called with the number of samples about to be read.
    """
    if min(samples.shape) < 1:
        raise ReadError(GRID_EMPTY)

    def densities(block: NDArray) -> Array:
        progress(block.size)
        return samples.densities(block)

    mass = samples.grid_moments(densities, samples.options.spline_order, KNOWN_ORDER)
    higher = (
        samples.grid_moments(densities, samples.options.spline_order, order)
        if order > KNOWN_ORDER
        else None
    )
    if not np.abs(mass.raw).max() < MAX_MASS_MOMENT:
        raise ReadError(MASS_OVERFLOW)
    if not mass.total > 0.0:
        raise ReadError(GRID_EMPTY)
    volume = samples.volume_moments(KNOWN_ORDER)
    empty = empty_background_note(samples.options, samples.background)
    return GridBody(
        volume,
        Moments(np.zeros(1), volume.about, Measure.AREA),
        MeshHealth(closed=True),
        Method(Procedure.EXACT, Source.GRID),
        (*findings, *empty, finding(GRID_WITHOUT_SURFACE)),
        mass=mass,
        higher_mass=higher,
        samples=samples,
    )


@dataclass(frozen=True, eq=False)
class ThresholdGrid:
    """A dense array of grid values, and their places.

    `values`: (nx, ny, nz); the value (i, j, k) stands at matrix @ (i, j, k, 1), in meters.
    `background`: the value beyond the grid; None if it is not known.
    `value`: converts a block of stored values, if they stand for others.
    """

    name: str
    values: NDArray
    matrix: Array
    background: float | None
    value: Callable[[NDArray], Array] | None = None

    def coarse(self) -> ThresholdGrid:
        """Return the grid with every n-th value of each axis, coarse enough to follow a slider."""
        step = int(np.ceil((self.values.size / PREVIEW_CELLS) ** (1.0 / 3.0)))
        if step <= 1:
            return self
        return replace(
            self,
            values=self.values[::step, ::step, ::step],
            matrix=self.matrix @ np.diag([step, step, step, 1.0]),
        )

    def set_above(self, options: GridOptions, order: int, preview: bool = False) -> ThresholdBody:
        """Return the moments of the body of values at or above the threshold."""
        assert options.threshold is not None
        threshold = options.threshold
        if options.spline_order > TRILINEAR and not preview:
            values = self.values if self.value is None else self.value(self.values)
            return smooth_threshold_body(
                values,
                threshold,
                options.spline_order,
                order,
                self.matrix,
                self.background,
                options.filled,
            )
        return threshold_body(
            self.values,
            threshold,
            order,
            self.matrix,
            self.background,
            options.filled,
            preview,
            self.value,
        )

    def largest(self) -> float:
        """Return the largest value, NaN if there is none."""
        slabs = self.values if self.value is None else map(self.value, self.values)
        return max((float(np.nanmax(slab)) for slab in slabs if slab.size), default=float("nan"))


@dataclass(frozen=True, eq=False)
class ThresholdGridBody(Body):
    """The body of grid values at or above a threshold."""

    any_order: ClassVar[bool] = True

    grid: ThresholdGrid = field(kw_only=True)
    options: GridOptions = GridOptions()

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the body, and of the surface on which the values are the
        threshold.
        """
        above = self.grid.set_above(self.options._replace(filled=False), order)
        return above.volume, above.area if area else None


def threshold_grid_body(
    grid: ThresholdGrid, options: GridOptions, preview: bool = False, order: int = KNOWN_ORDER
) -> ThresholdGridBody:
    """Return the body of grid values at or above a threshold, with mass moments to `order`, or
    raise MeasureError.
    """
    if options.filled and options.table:
        raise ReadError(THRESHOLD_NEEDS_FACTOR)
    above = grid.set_above(options, KNOWN_ORDER, preview)
    if not above.volume.total > 0.0:
        raise ReadError(
            THRESHOLD_NOT_REACHED,
            grid=grid.name,
            threshold=options.threshold,
            largest=grid.largest(),
        )
    mass = higher = None
    if above.mass is not None:
        mass = above.mass * options.value_density
        if not np.abs(mass.raw).max() < MAX_MASS_MOMENT:
            raise ReadError(MASS_OVERFLOW)
        if not mass.total > 0.0:
            raise ReadError(GRID_EMPTY)
        weighed = grid.set_above(options, order).mass if order > KNOWN_ORDER else None
        higher = None if weighed is None else weighed * options.value_density
    findings = [
        finding(
            THRESHOLD_MEASURED, grid=grid.name, threshold=options.threshold, cells=above.cut_cells
        )
    ]
    if above.clipped:
        findings.append(finding(THRESHOLD_CLIPPED, grid=grid.name))
    label_count = 0 if preview else count_labels(grid.values)
    if label_count:
        findings.append(finding(SCAN_LABELS, count=label_count))
    return ThresholdGridBody(
        above.volume,
        above.area,
        MeshHealth(closed=not above.clipped),
        Method(Procedure.EXACT, Source.GRID),
        tuple(findings),
        mass=mass,
        higher_mass=higher,
        density_from=None if mass is None else finding(DENSITY_FROM_GRID, grid=grid.name),
        estimated=True,
        grid=grid,
        options=options,
    )


def label_value(label: int, slope: float = 1.0, intercept: float = 0.0) -> int:
    """Return the whole number that a stored label stands for, or raise ReadError."""
    value = label * slope + intercept
    if not abs(value) < LARGEST_WHOLE:
        raise ReadError(LABELS_UNFIT, cause="a label is too large")
    rounding = FLOAT32_U * max(abs(label * slope), abs(intercept))
    if abs(value - round(value)) > min(rounding, MAX_ROUNDING):
        raise ReadError(LABELS_UNFIT, cause="a sample is no whole number")
    return round(value)


def label_body(sums: NDArray, matrix: Array, findings: tuple[Finding, ...] = ()) -> Body:
    """Return the body of the voxels with these sums over (i, j, k), (20,) whole numbers.

    The voxel (i, j, k) is a box about matrix @ (i, j, k, 1), in meters.
    """
    volume = label_moments(sums).transform(matrix)
    return Body(
        volume,
        Moments(np.zeros(1), volume.about, Measure.AREA),
        MeshHealth(closed=True),
        Method(Procedure.EXACT, Source.GRID),
        (*findings, finding(GRID_WITHOUT_SURFACE)),
    )
