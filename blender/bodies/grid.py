# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of voxel grids: densities, or the solid that a level set bounds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...core import measurement, moments, scans
from ...core.bodies import (
    DENSITY_FROM_GRID,
    GRID_AS_SHELL,
    GRID_DENSITY,
    GRID_EMPTY,
    GRID_TOO_LARGE,
    MAX_SAMPLES,
    SAMPLES_POSITIONED,
    MeshBody,
    Part,
    Samples,
    ThresholdGrid,
    density_body,
    label_body,
    threshold_grid_body,
    to_si,
)
from ...core.density import Blocks, GridOptions, sample_positions, sum_labels
from ...core.numerics import Array, NDArray
from ...core.verdict import Method, ReadError, Source, finding
from ..read import tracking, volume
from ..read.findings import GRID_UNSUPPORTED, IS_LEVEL_SET
from ..settings.density import density_key, grid_key
from .findings import LEVEL_SET_MEASURED
from .mesh import mesh_body
from .request import Request

MEASURED_AS = frozenset({"solid", "shell", "printed", "wire"})  # all but solids are refused


def read(request: Request) -> volume.VolumeReading | None:
    """Return the grid that an object shows; None if it shows polygons, or no volume."""
    obj = request.obj
    if obj.type != "VOLUME" and "NODES" not in [modifier.type for modifier in obj.modifiers]:
        return None
    request.opened.enter_context(tracking.tracking_paused())
    reading = request.opened.enter_context(
        volume.volume_reading(obj, request.depsgraph, obj.body_moments.grid)
    )
    if reading is not None and request.settings.kind != "solid":
        raise ReadError(GRID_AS_SHELL)
    return reading


def body(reading: volume.VolumeReading, request: Request) -> measurement.Body:
    """Return the body of one grid, or raise MeasureError if there is none."""
    obj = request.obj
    density = request.given.density
    options = GridOptions.from_settings(obj.body_moments, density)
    result = _grid_body(reading, options, request.settings)
    key = grid_key(obj, density) if obj.type == "VOLUME" else density_key(obj, (), request.scene)
    source = None if result.mass is None else finding(DENSITY_FROM_GRID, grid=reading.grid)
    return replace(result, density_from=source, density_key=key)


def _grid_body(
    reading: volume.VolumeReading, options: GridOptions, settings: measurement.Settings
) -> measurement.Body:
    """Return the body of one grid, with its mass moments to the order of the settings.

    Raises MeasureError if the grid has no body.
    """
    unit = settings.unit
    order = moments.KNOWN_ORDER if settings.order is None else settings.order
    if options.threshold is not None:
        options.needs_even_samples(reading.grid)
        return threshold_grid_body(threshold_grid(reading, unit), options, order=order)
    if options.label is not None:
        options.needs_even_samples(reading.grid)
        return _label(reading, options.label, unit)
    if options.solid:
        return _solid(reading, unit, settings.threads)
    if reading.level_set:
        raise ReadError(GRID_UNSUPPORTED, fault=IS_LEVEL_SET, grid=reading.grid)
    positions = sample_positions(options, reading.grid, reading.low, reading.shape)
    # An axis with positions begins at their zero, any other one at the first sample.
    low = [first if row is None else 0.0 for first, row in zip(reading.low, positions)]
    matrix = _matrix_to_world(reading, unit) @ moments.affine_matrices(np.eye(3), low)
    samples = Samples(
        _whole_axes(reading, positions),
        [count if row is None else len(row) for count, row in zip(reading.shape, positions)],
        matrix,
        options,
        reading.background,
        positions=positions,
    )
    meaning = options.meaning().as_record()
    findings = [finding(GRID_DENSITY, samples=list(reading.shape), cause=meaning)]
    axes = [axis for axis, row in zip(scans.AXES, positions) if row is not None]
    if axes:
        findings.append(finding(SAMPLES_POSITIONED, axes=axes))
    return density_body(samples, tuple(findings), order=order)


def _matrix_to_world(reading: volume.VolumeReading, unit: float) -> Array:
    """Return the (4, 4) map from a grid's indices to the world, m."""
    return to_si(reading.matrix[None], unit)[0] @ reading.to_object


def _label(reading: volume.VolumeReading, label: int, unit: float) -> measurement.Body:
    """Return the body of the voxels with a label; label 0 stands for all labels but 0."""
    sums = sum_labels(reading.blocks)
    chosen = [total for value, total in sums.items() if value and label in (0, value)]
    if not chosen:
        raise ReadError(
            scans.LABEL_ABSENT,
            file=reading.grid,
            labels=[label],
            others=sorted(sums.keys() - {0}),
            remedy="Label",
        )
    to_first = moments.affine_matrices(np.eye(3), reading.low)
    return label_body(np.sum(chosen, axis=0), _matrix_to_world(reading, unit) @ to_first)


def _whole_axes(reading: volume.VolumeReading, positions: scans.Positions) -> Blocks:
    """Return the blocks of a grid, with places counted from the start of each axis that has
    positions (outer samples need neighbors), and from the first sample of others.
    """
    offset = [0 if row is None else int(low) for low, row in zip(reading.low, positions)]

    def blocks() -> Iterator[tuple[tuple[int, int, int], NDArray]]:
        for (i, j, k), block in reading.blocks():
            yield (i + offset[0], j + offset[1], k + offset[2]), block

    return blocks if any(offset) else reading.blocks


def _solid(reading: volume.VolumeReading, unit: float, threads: int) -> MeshBody:
    """Return the body inside a level set, by its polygons."""
    if reading.level_set is False:
        raise ReadError(
            GRID_UNSUPPORTED,
            fault="is not a level set. Set Measure As to Density",
            grid=reading.grid,
        )
    surface = reading.polygons()
    if not len(surface.quads):
        raise ReadError(GRID_EMPTY, grid=reading.grid)
    polygons = replace(reading, parts=[Part(surface, reading.matrix[None])], findings=[])
    result = mesh_body(polygons, unit, shell=False, union=False, threads=threads)
    measured = finding(LEVEL_SET_MEASURED, grid=reading.grid, polygons=len(surface.quads))
    method = Method(result.method.procedure, Source.GRID)
    return replace(result, method=method, findings=(measured, *result.findings))


def threshold_grid(reading: volume.VolumeReading, unit: float) -> ThresholdGrid:
    """Return the values of a grid as one array, or raise ReadError if it is a level set or too
    large.
    """
    if reading.level_set:
        raise ReadError(GRID_UNSUPPORTED, fault=IS_LEVEL_SET, grid=reading.grid)
    if np.prod(reading.shape, dtype=np.float64) > MAX_SAMPLES:
        raise ReadError(GRID_TOO_LARGE, grid=reading.grid, samples=list(reading.shape))
    values = np.full(reading.shape, reading.background, np.float32)
    for (i, j, k), block in reading.blocks():
        if block.dtype.itemsize > 4:  # float32 would round these values
            values = values.astype(np.float64, copy=False)
        values[i : i + block.shape[0], j : j + block.shape[1], k : k + block.shape[2]] = block
    matrix = _matrix_to_world(reading, unit) @ moments.affine_matrices(np.eye(3), reading.low)
    return ThresholdGrid(reading.grid, values, matrix, float(reading.background))
