# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body of the grid values at or above a threshold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..density.grid_options import GridOptions
from ..density.smooth_threshold import smooth_threshold_body
from ..density.threshold import ThresholdBody, threshold_body
from ..measurement.body import Body
from ..moments.exponents import KNOWN_ORDER
from ..moments.moments import Moments
from ..verdict.finding import Finding, ReadError, finding
from ..verdict.health import MeshHealth
from ..verdict.method import Method, Source, Verdict
from .findings import (
    DENSITY_FROM_GRID,
    GRID_EMPTY,
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


@dataclass(frozen=True, eq=False)
class ThresholdGrid:
    """A dense array of grid values, and their places.

    `values`: (nx, ny, nz); the value (i, j, k) stands at matrix @ (i, j, k, 1), in meters.
    `background`: the value beyond the grid; None if it is not known.
    `value`: converts a block of stored values, if they stand for others.
    """

    name: str
    values: NDArray
    matrix: NDArray[np.float64]
    background: float | None
    value: Callable[[NDArray], NDArray[np.float64]] | None = None

    def coarse(self) -> ThresholdGrid:
        """Return the grid with every n-th value of each axis, coarse enough to follow a slider."""
        step = int(np.ceil((self.values.size / PREVIEW_CELLS) ** (1.0 / 3.0)))
        if step <= 1:
            return self
        return replace(
            self, values=self.values[::step, ::step, ::step], matrix=self.matrix @ np.diag([step, step, step, 1.0])
        )

    def set_above(self, options: GridOptions, order: int, preview: bool = False) -> ThresholdBody:
        """Return the moments of the body of values at or above the threshold."""
        assert options.threshold is not None
        threshold = options.threshold
        if options.spline_order > TRILINEAR and not preview:
            values = self.values if self.value is None else self.value(self.values)
            return smooth_threshold_body(
                values, threshold, options.spline_order, order, self.matrix, self.background, options.filled
            )
        return threshold_body(
            self.values, threshold, order, self.matrix, self.background, options.filled, preview, self.value
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
        """Return the moments of the body, and of the surface on which the values are the threshold."""
        above = self.grid.set_above(self.options._replace(filled=False), order)
        return above.volume, above.area if area else None


def threshold_grid_body(
    grid: ThresholdGrid, options: GridOptions, preview: bool = False, order: int = KNOWN_ORDER
) -> ThresholdGridBody:
    """Return the body of grid values at or above a threshold, with mass moments to `order`, or raise MeasureError."""
    if options.filled and options.table:
        raise ReadError(THRESHOLD_NEEDS_FACTOR)
    above = grid.set_above(options, KNOWN_ORDER, preview)
    if not above.volume.total > 0.0:
        raise ReadError(THRESHOLD_NOT_REACHED, grid=grid.name, threshold=options.threshold, largest=grid.largest())
    mass = None if above.mass is None else above.mass * options.value_density
    if mass is not None and not np.abs(mass.raw).max() < MAX_MASS_MOMENT:
        raise ReadError(MASS_OVERFLOW)
    if mass is not None and not mass.total > 0.0:
        raise ReadError(GRID_EMPTY)
    higher = None
    if mass is not None and order > KNOWN_ORDER:
        weighed = grid.set_above(options, order).mass
        higher = None if weighed is None else weighed * options.value_density
    return ThresholdGridBody(
        above.volume,
        above.area,
        MeshHealth(closed=not above.clipped),
        Method(Verdict.EXACT, Source.GRID),
        _findings(grid, options, above),
        mass=mass,
        higher_mass=higher,
        density_from=None if mass is None else finding(DENSITY_FROM_GRID, grid=grid.name),
        estimated=True,
        grid=grid,
        options=options,
    )


def _findings(grid: ThresholdGrid, options: GridOptions, above: ThresholdBody) -> tuple[Finding, ...]:
    measured = finding(THRESHOLD_MEASURED, grid=grid.name, threshold=options.threshold, cells=above.cut_cells)
    return (measured, finding(THRESHOLD_CLIPPED, grid=grid.name)) if above.clipped else (measured,)
