# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that a grid of voxels is: a density, or for a level set the solid that it bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.density.spline_grid import Blocks, grid_moments
from ...core.moments.moments import Measure, Moments
from ...core.verdict.finding import Finding, ReadError, finding
from ...core.verdict.health import MeshReport
from ..read import Part, Reading
from ..read.volume import VolumeReading
from ..settings.grid import GridOptions
from .body import MeasuredBody
from .mass import MAX_MASS_MOMENT
from .mesh import mesh_body


def grid_body(reading: VolumeReading, options: GridOptions, unit: float, threads: int = 1) -> MeasuredBody:
    """The body of one grid. unit: metres per Blender unit. MeasureError where there is none."""
    if options.solid:
        return _solid(reading, unit, threads)
    if reading.level_set:
        raise ReadError("grid_is_level_set", grid=reading.grid)
    scaled = np.diag([unit, unit, unit, 1.0])
    first = np.eye(4)
    first[:3, 3] = reading.low
    matrix = scaled @ reading.matrix @ reading.to_object @ first
    density = finding(
        "grid_density", grid=reading.grid, samples=list(reading.shape), cause=options.meaning().as_record()
    )
    return density_body(reading.blocks, reading.shape, matrix, options, reading.background, (density,))


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
) -> MeasuredBody:
    """The body of samples at matrix @ (i, j, k, 1), in metres, that stand for slope · sample + intercept.

    background: a value that counts as empty. progress: called with how many samples are about to be read.
    """
    if min(shape) < 1:
        raise ReadError("grid_empty")
    weigh = options.to_densities(background)

    def densities(block: NDArray) -> NDArray[np.float64]:
        progress(block.size)
        return weigh(block if slope == 1.0 and intercept == 0.0 else block * slope + intercept)

    mass = grid_moments(samples, shape, matrix, options.spline_order, value=densities)
    if not np.abs(mass.raw).max() < MAX_MASS_MOMENT:
        raise ReadError("mass_overflow")
    if not mass.total > 0.0:
        raise ReadError("grid_empty")

    def held(order: int) -> Moments:
        moments = grid_moments(
            samples, shape, matrix, order=order, value=lambda block: (densities(block) != 0.0).astype(np.float64)
        )
        return replace(moments, measure=Measure.VOLUME)

    def to_order(order: int, area: bool) -> tuple[Moments, Moments | None]:
        volume = held(order)
        return volume, Moments(np.zeros_like(volume.raw), volume.about, Measure.AREA) if area else None

    volume = held(3)
    findings += (*options.empty_background_note(background), finding("grid_without_surface"))
    return MeasuredBody(
        volume,
        Moments(np.zeros(1), volume.about, Measure.AREA),
        MeshReport(closed=True),
        "grid exact",
        findings,
        mass=mass,
        moments=to_order,
    )


def _solid(reading: VolumeReading, unit: float, threads: int) -> MeasuredBody:
    """What a level set bounds, by its polygons."""
    if not reading.level_set:
        raise ReadError("grid_is_not_level_set", grid=reading.grid)
    surface = reading.polygons()
    if not len(surface.triangles) and not len(surface.quads):
        raise ReadError("level_set_empty", grid=reading.grid)
    shown = Reading(
        reading.name,
        reading.type,
        reading.matrix,
        reading.rotation,
        reading.location,
        [Part(surface, reading.matrix[None])],
    )
    body = mesh_body(shown, unit, shell=False, union=False, threads=threads)
    polygons = len(surface.triangles) + len(surface.quads)
    measured = finding("level_set_measured", grid=reading.grid, polygons=polygons)
    return replace(body, method="grid " + body.method, findings=(measured, *body.findings))
