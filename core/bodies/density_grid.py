# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of samples of densities on a grid."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..density.grid_options import GridOptions
from ..density.grid_values import density_function, empty_background_note
from ..density.spline_grid import Blocks, grid_moments
from ..measurement.body import Body
from ..moments.exponents import KNOWN_ORDER
from ..moments.moments import Measure, Moments
from ..scans.positions import EVEN, Positions
from ..verdict.finding import Finding, ReadError, finding
from ..verdict.health import MeshHealth
from ..verdict.method import Method, Source, Verdict
from .findings import GRID_EMPTY, GRID_WITHOUT_SURFACE, MASS_OVERFLOW
from .mesh_body import MAX_MASS_MOMENT


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a density at matrix @ (i, j, k, 1), in meters, that stand for slope · value + intercept.

    values: one array, or (offset, array) block by block. shape: (3,) shape of the box that holds them. background: a
    value that counts as empty. positions: of the samples along each axis, None for 0, 1, 2, …
    """

    values: Blocks | NDArray
    shape: Sequence[int]
    matrix: NDArray[np.float64]
    options: GridOptions = GridOptions()
    background: float | None = None
    slope: float = 1.0
    intercept: float = 0.0
    positions: Positions = EVEN

    @cached_property
    def _weigh(self) -> Callable[[NDArray], NDArray]:
        return density_function(self.options, self.background)

    def densities(self, block: NDArray) -> NDArray[np.float64]:
        """Return the densities, kg/m³, of a block of values."""
        scaled = self.slope != 1.0 or self.intercept != 0.0
        return self._weigh(block * self.slope + self.intercept if scaled else block)

    def volume_moments(self, order: int) -> Moments:
        """Return the moments of the voxels that are not empty."""

        def occupied(block: NDArray) -> NDArray[np.float64]:
            return (self.densities(block) != 0.0).astype(np.float64)

        return replace(self.grid_moments(occupied, 1, order), measure=Measure.VOLUME)

    def grid_moments(self, value: Callable[[NDArray], NDArray], spline_order: int, order: int) -> Moments:
        """Return the moments of a function of the values, interpolated by a spline."""
        return grid_moments(self.values, self.shape, self.matrix, spline_order, order, value, self.positions)


@dataclass(frozen=True, eq=False)
class GridBody(Body):
    """The body of samples; a grid has no area."""

    any_order: ClassVar[bool] = True

    samples: Samples = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the voxels that are not empty; a grid has no area."""
        volume = self.samples.volume_moments(order)
        return volume, Moments(np.zeros_like(volume.raw), volume.about, Measure.AREA) if area else None


def density_body(
    samples: Samples,
    findings: tuple[Finding, ...] = (),
    progress: Callable[[int], None] = lambda samples: None,
    order: int = KNOWN_ORDER,
) -> GridBody:
    """Return the body of samples, with its mass moments to an order, or raise ReadError if they are empty.

    progress: called with the number of samples about to be read.
    """
    if min(samples.shape) < 1:
        raise ReadError(GRID_EMPTY)

    def densities(block: NDArray) -> NDArray[np.float64]:
        progress(block.size)
        return samples.densities(block)

    mass = samples.grid_moments(densities, samples.options.spline_order, KNOWN_ORDER)
    higher = None
    if order > KNOWN_ORDER:
        higher = samples.grid_moments(densities, samples.options.spline_order, order)
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
        Method(Verdict.EXACT, Source.GRID),
        (*findings, *empty, finding(GRID_WITHOUT_SURFACE)),
        mass=mass,
        higher_mass=higher,
        samples=samples,
    )
