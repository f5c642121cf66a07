# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of samples of densities on a grid."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
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
from .findings import (
    GRID_EMPTY,
    GRID_WITHOUT_SURFACE,
    MASS_OVERFLOW,
)
from .mesh_body import MAX_MASS_MOMENT


@dataclass(frozen=True, eq=False)
class GridBody(Body):
    """Samples at matrix @ (i, j, k, 1), in meters, that stand for slope · sample + intercept.

    `samples`: one array, or (offset, array) block by block; `shape`: (3,) shape of the box that holds them.
    `background`: a value that counts as empty.
    `positions`: positions of the samples along each axis, or None for 0, 1, 2, …
    """

    any_order: ClassVar[bool] = True

    samples: Blocks | NDArray = field(kw_only=True)
    shape: Sequence[int] = ()
    matrix: NDArray[np.float64] = field(kw_only=True)
    options: GridOptions = GridOptions()
    background: float | None = None
    slope: float = field(kw_only=True)
    intercept: float = field(kw_only=True)
    positions: Positions = EVEN

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the voxels that are not empty; a grid has no area."""
        weigh = _Weights(self.options, self.background, self.slope, self.intercept)
        volume = _occupied(self.samples, self.shape, self.matrix, weigh, order, self.positions)
        return volume, Moments(np.zeros_like(volume.raw), volume.about, Measure.AREA) if area else None


class _Weights:
    """Densities of blocks of samples, kg/m³."""

    def __init__(self, options: GridOptions, background: float | None, slope: float, intercept: float):
        self._weigh = density_function(options, background)
        self._slope, self._intercept = slope, intercept

    def densities(self, block: NDArray) -> NDArray[np.float64]:
        scaled = self._slope != 1.0 or self._intercept != 0.0
        return self._weigh(block * self._slope + self._intercept if scaled else block)

    def occupied(self, block: NDArray) -> NDArray[np.float64]:
        """Return 1 for filled samples, 0 for empty ones."""
        return (self.densities(block) != 0.0).astype(np.float64)


def _occupied(
    samples: Blocks | NDArray, shape: Sequence[int], matrix: NDArray, weigh: _Weights, order: int, positions: Positions
) -> Moments:
    moments = grid_moments(samples, shape, matrix, order=order, value=weigh.occupied, positions=positions)
    return replace(moments, measure=Measure.VOLUME)


def density_body(
    samples: Blocks | NDArray,
    shape: Sequence[int],
    matrix: NDArray,
    options: GridOptions,
    background: float | None = None,
    findings: tuple[Finding, ...] = (),
    slope: float = 1.0,
    intercept: float = 0.0,
    progress: Callable[[int], None] = lambda samples: None,
    order: int = KNOWN_ORDER,
    positions: Positions = EVEN,
) -> GridBody:
    """Return the body of samples at matrix @ (i, j, k, 1), in meters, that stand for slope · sample + intercept.

    background: a value that counts as empty. progress: called with the number of samples about to be read. order: of
    the wanted mass moments. positions: of the samples along each axis, None for 0, 1, 2, …
    """
    if min(shape) < 1:
        raise ReadError(GRID_EMPTY)
    weigh = _Weights(options, background, slope, intercept)

    def densities(block: NDArray) -> NDArray[np.float64]:
        progress(block.size)
        return weigh.densities(block)

    mass = grid_moments(samples, shape, matrix, options.spline_order, value=densities, positions=positions)
    higher = None
    if order > KNOWN_ORDER:
        higher = grid_moments(samples, shape, matrix, options.spline_order, order, densities, positions)
    if not np.abs(mass.raw).max() < MAX_MASS_MOMENT:
        raise ReadError(MASS_OVERFLOW)
    if not mass.total > 0.0:
        raise ReadError(GRID_EMPTY)
    volume = _occupied(samples, shape, matrix, weigh, 3, positions)
    findings += (*empty_background_note(options, background), finding(GRID_WITHOUT_SURFACE))
    return GridBody(
        volume,
        Moments(np.zeros(1), volume.about, Measure.AREA),
        MeshHealth(closed=True),
        Method(Verdict.EXACT, Source.GRID),
        findings,
        mass=mass,
        higher_mass=higher,
        samples=samples,
        shape=shape,
        matrix=matrix,
        options=options,
        background=background,
        slope=slope,
        intercept=intercept,
        positions=positions,
    )
