# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid filled with the density of a Volume object's grid; both objects keep their places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ....core.bodies.findings import (
    DENSITY_FROM_GRID,
    GRID_DENSITY,
    GRID_EMPTY,
    GRID_IS_LEVEL_SET,
    GRID_TOO_LARGE,
    MASS_OVERFLOW,
)
from ....core.bodies.mesh_body import MAX_MASS_MOMENT, MeshBody
from ....core.bodies.reading import attribute_to_source, to_si
from ....core.density.grid_options import GridOptions
from ....core.density.grid_values import density_function, empty_background_note
from ....core.density.voxel_fill import MAX_VOXELS, inside_moments
from ....core.moments.moments import Measure, Moments
from ....core.solid.measure import SolidIntegrals
from ....core.verdict.finding import MeasureError, ReadError, finding
from ....core.verdict.method import Method, Source, Verdict
from ....core.verdict.tolerances import NEGLIGIBLE
from ...read.findings import OBJECT_UNREADABLE, VOLUME_WITHOUT_GRIDS
from ...read.grids.volume import VolumeReading, volume_reading
from ...read.tracking import tracking_paused
from ..findings import DENSITY_GRID_ELSEWHERE, OPEN_SURFACE_OF_GRID, OUTSIDE_GRID
from ..request import Request

MAX_OUTSIDE_SHARE = 1e-9  # of the volume: a smaller share outside the grid is rounding


def filled_by_volume(body: MeshBody, request: Request, order: int) -> MeshBody:
    """Return the solid with the density of the Volume object that its settings name, or raise MeasureError."""
    name, source = request.obj.name, request.obj.body_moments.density_volume
    grid = GridOptions.from_settings(source.body_moments)
    try:
        with tracking_paused(), volume_reading(source, request.depsgraph, grid.grid) as volume:
            if volume is None:
                raise ReadError(VOLUME_WITHOUT_GRIDS)
            filled = voxel_filled_body(body, volume, grid, request.settings.unit, name, order)
            origin = finding(DENSITY_FROM_GRID, grid=volume.grid).of_sources([source.name])
            return replace(filled, density_from=origin)
    except MeasureError as error:
        if error.subject == name:  # the error is about the solid already
            raise
        raise ReadError(OBJECT_UNREADABLE, subject=name, object=source.name, cause=error.finding.as_record()) from error


def voxel_filled_body(
    body: MeshBody, reading: VolumeReading, options: GridOptions, unit: float, name: str, order: int
) -> MeshBody:
    """Return the body of the object `name` with mass moments to an order, from the grid's densities inside it."""
    names = {"grid": reading.grid, "object": reading.name}
    options.needs_even_samples(reading.grid)
    if body.method.verdict == Verdict.OPEN:
        raise ReadError(OPEN_SURFACE_OF_GRID, subject=name)
    if reading.level_set:
        raise ReadError(GRID_IS_LEVEL_SET, subject=name, **names)
    shift = np.eye(4)
    shift[:3, 3] = reading.low - 0.5  # from corners of voxels, not from their centers
    matrix = to_si(reading.matrix[None], unit)[0] @ reading.to_object @ shift
    if min(reading.shape) < 1 or not abs(np.linalg.det(matrix[:3, :3])) > 0.0:
        raise ReadError(GRID_EMPTY, subject=name, **names)
    inverse = np.linalg.inv(matrix)
    triangles = np.concatenate(
        [_corners(solid, inverse @ place) for solid, matrices in body.solids for place in matrices]
    )
    low = np.clip(np.floor(triangles.min(axis=(0, 1))), 0, np.array(reading.shape) - 1).astype(np.int64)
    high = np.clip(np.ceil(triangles.max(axis=(0, 1))), low + 1, reading.shape).astype(np.int64)
    if np.prod((high - low).astype(float)) > MAX_VOXELS:
        raise ReadError(GRID_TOO_LARGE, subject=name, **names, samples=(high - low).tolist())
    moments, volume = inside_moments(triangles - low, _box_densities(reading, options, low, high), order)
    volume *= abs(np.linalg.det(matrix[:3, :3]))
    shift[:3, 3] = low
    mass = replace(replace(moments, measure=Measure.VOLUME).transform(matrix @ shift), measure=Measure.MASS)
    mass = replace(mass, input_error=_input_error(body, mass))
    if not np.abs(mass.raw).max() < MAX_MASS_MOMENT:
        raise ReadError(MASS_OVERFLOW)
    if not mass.total > mass.rounding_error[0]:
        raise ReadError(DENSITY_GRID_ELSEWHERE, subject=name, **names)
    meaning = options._replace(spline_order=1).meaning()
    findings = [
        finding(GRID_DENSITY, samples=list(reading.shape), cause=meaning.as_record()).of_sources([reading.name]),
        *empty_background_note(options, reading.background),
    ]
    outside = float(1.0 - volume / body.volume.total)
    if outside > MAX_OUTSIDE_SHARE:
        findings.append(finding(OUTSIDE_GRID, slight=outside < NEGLIGIBLE, share=outside))
    return replace(
        body,
        mass=mass,
        method=Method(body.method.verdict, Source.GRID),
        estimated=True,
        findings=(
            *body.findings,
            *findings,
            *(attribute_to_source(result, reading.name, name) for result in reading.findings),
        ),
    )


def _corners(solid: SolidIntegrals, matrix: NDArray) -> NDArray[np.float64]:
    """Return (n, 3, 3) triangles of the measured surface, in the grid's coordinates, outward."""
    surface = solid.repaired_surface.transform(matrix[:3, :3], matrix[:3, 3])
    return surface.points[surface.all_triangles()[0]].astype(np.float64, copy=False)


def _box_densities(reading: VolumeReading, options: GridOptions, low: NDArray, high: NDArray) -> NDArray[np.float64]:
    """Return the densities, kg/m³, of the voxels from index `low` up to, but without, `high`."""
    to_densities = density_function(options, reading.background)
    densities = np.zeros(high - low)
    for start, block in reading.blocks():
        start = np.array(start)
        begin, end = np.maximum(start, low), np.minimum(start + block.shape, high)
        if (begin < end).all():
            in_block = tuple(slice(a, b) for a, b in zip(begin - start, end - start))
            densities[tuple(slice(a, b) for a, b in zip(begin - low, end - low))] = to_densities(
                block[in_block].astype(np.float64)
            )
    return densities


def _input_error(body: MeshBody, mass: Moments) -> NDArray[np.float64]:
    """Return the solid's input error, scaled by the ratio of largest moments or of totals, whichever is larger."""
    solid = body.volume if mass.order <= body.volume.order else body.moments(mass.order, False)[0]
    solid = solid.about_point(mass.about).truncate(mass.order)
    scale = np.abs(mass.raw).max() / max(np.abs(solid.raw).max(), np.finfo(float).tiny)
    return solid.input_error * max(scale, mass.total / solid.total)
