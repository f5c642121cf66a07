# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of voxel grids: densities, or the solid that a level set bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ....core.density.spline_grid import Blocks, grid_moments
from ....core.measurement.body import Body
from ....core.moments.exponents import KNOWN_ORDER
from ....core.moments.moments import Measure, Moments
from ....core.scans.positions import AXES, EVEN, Positions
from ....core.verdict.finding import Finding, ReadError, finding
from ....core.verdict.health import MeshHealth
from ....core.verdict.method import Method, Source, Verdict
from ...read.grids.volume import VolumeReading, volume_reading
from ...read.reading import Part, Reading, to_si
from ...read.tracking import tracking_paused
from ...settings.density import density_key, grid_key
from ...settings.grid import GridOptions
from ...settings.grid_values import density_function, empty_background_note, sample_positions
from ..body import MAX_MASS_MOMENT, MeshBody
from ..findings import (
    DENSITY_FROM_GRID,
    GRID_AS_SHELL,
    GRID_DENSITY,
    GRID_EMPTY,
    GRID_IS_LEVEL_SET,
    GRID_IS_NOT_LEVEL_SET,
    GRID_WITHOUT_SURFACE,
    LEVEL_SET_MEASURED,
    MASS_OVERFLOW,
    SAMPLES_POSITIONED,
)
from ..mesh.mesh import mesh_body
from ..request import Request
from .threshold import threshold_grid, threshold_grid_body

MEASURED_AS = frozenset({"solid", "shell", "wire"})  # shells and wires are refused


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


def read(request: Request) -> VolumeReading | None:
    """Return the grid that an object shows; None if it shows polygons, or no volume."""
    obj = request.obj
    if obj.type != "VOLUME" and "NODES" not in [modifier.type for modifier in obj.modifiers]:
        return None
    with ExitStack() as opened:
        opened.enter_context(tracking_paused())
        reading = opened.enter_context(volume_reading(obj, request.depsgraph, obj.body_moments.grid))
        if reading is None:
            return None
        if request.settings.kind != "solid":
            raise ReadError(GRID_AS_SHELL)
        request.opened.push(opened.pop_all())
    return reading


def body(reading: VolumeReading, request: Request) -> Body:
    """Return the body of one grid, or raise MeasureError if there is none."""
    obj, density, options = request.obj, request.given.density, request.settings
    order = KNOWN_ORDER if options.order is None else options.order
    made = grid_body(
        reading, GridOptions.from_settings(obj.body_moments, density), request.settings.unit, options.threads, order
    )
    key = grid_key(obj, density) if obj.type == "VOLUME" else density_key(obj, (), request.scene)
    source = None if made.mass is None else finding(DENSITY_FROM_GRID, grid=reading.grid)
    return replace(made, density_from=source, density_key=key)


def grid_body(
    reading: VolumeReading, options: GridOptions, unit: float, threads: int = 1, order: int = KNOWN_ORDER
) -> Body:
    """Return the body of one grid, with its mass moments to an order. Raises MeasureError if the grid has no body."""
    if options.threshold is not None:
        options.needs_even_samples(reading.grid)
        return threshold_grid_body(threshold_grid(reading, unit), options, order=order)
    if options.solid:
        return _solid(reading, unit, threads)
    if reading.level_set:
        raise ReadError(GRID_IS_LEVEL_SET, grid=reading.grid)
    positions = sample_positions(options, reading.grid, reading.low, reading.shape)
    first = np.eye(4)
    first[:3, 3] = [low if row is None else 0.0 for low, row in zip(reading.low, positions)]
    shape = [count if row is None else len(row) for count, row in zip(reading.shape, positions)]
    matrix = to_si(reading.matrix[None], unit)[0] @ reading.to_object @ first
    density = finding(GRID_DENSITY, samples=list(reading.shape), cause=options.meaning().as_record())
    axes = [axis for axis, row in zip(AXES, positions) if row is not None]
    findings = (density, finding(SAMPLES_POSITIONED, axes=axes)) if axes else (density,)
    return density_body(
        _whole_axes(reading, positions),
        shape,
        matrix,
        options,
        reading.background,
        findings,
        order=order,
        positions=positions,
    )


def _whole_axes(reading: VolumeReading, positions: Positions) -> Blocks:
    """Return the blocks of a grid, from the start of an axis if it has positions (outer samples need neighbors)."""
    offset = [0 if row is None else int(low) for low, row in zip(reading.low, positions)]

    def blocks() -> Iterator[tuple[tuple[int, int, int], NDArray]]:
        for (i, j, k), block in reading.blocks():
            yield (i + offset[0], j + offset[1], k + offset[2]), block

    return blocks if any(offset) else reading.blocks


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
    """Return the body of samples at matrix @ (i, j, k, 1), in meters, that stand for slope · sample + intercept."""
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


def _solid(reading: VolumeReading, unit: float, threads: int) -> MeshBody:
    """Return the body that a level set bounds, by its polygons."""
    if reading.level_set is False:
        raise ReadError(GRID_IS_NOT_LEVEL_SET, grid=reading.grid)
    surface = reading.polygons()
    if not len(surface.quads):
        raise ReadError(GRID_EMPTY, grid=reading.grid)
    shown = Reading(
        reading.name,
        reading.type,
        reading.matrix,
        reading.rotation,
        reading.location,
        [Part(surface, reading.matrix[None])],
    )
    bounded = mesh_body(shown, unit, shell=False, union=False, threads=threads)
    measured = finding(LEVEL_SET_MEASURED, grid=reading.grid, polygons=len(surface.quads))
    method = Method(bounded.method.verdict, Source.GRID)
    return replace(bounded, method=method, findings=(measured, *bounded.findings))
