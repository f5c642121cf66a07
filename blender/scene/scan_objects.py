# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume objects of scans. Blender takes voxels from .vdb files only, so one is written beside the scan."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import bpy
import numpy as np
from bpy.types import Context, Object
from numpy.typing import NDArray

from ...core.density.grid_values import positions_text
from ...core.numerics.float32 import shortest_decimal
from ...core.scans.formats import read_scan, sample_matrix, scan_suffix
from ...core.scans.limits import Limits
from ...core.scans.numpy_files import read_raw
from ...core.scans.positions import Positions, place_samples, read_all_positions
from ...core.scans.scan import Scan
from ...core.streams.findings import FILE_UNREADABLE
from ...core.verdict.finding import FileError, Finding, system_reason
from .findings import SCAN_NON_FINITE

GRID_NAME = "density"
SAMPLES_PER_SLAB = 1 << 22  # samples at a time


class PlacedScan(NamedTuple):
    """A scan with the (4, 4) map from its voxels to meters, uneven sample positions by axis, and findings.

    target: the .vdb file beside the scan.
    """

    scan: Scan
    matrix: NDArray[np.float64]
    positions: Positions
    findings: Sequence[Finding]
    target: Path


def read_placed(
    path: Path,
    limits: Limits,
    raw: tuple[Sequence[int], str, bool] | None,
    spacing: Sequence[float] | None,
    files: dict[str, str],
    unit: float,
) -> PlacedScan:
    """Read a scan and place its samples; files: of their positions, in `unit` meters, by axis. Raises FileError."""
    try:
        is_raw = scan_suffix(path) == ".raw"
        scan = read_raw(path, *raw, limits) if raw is not None and is_raw else read_scan(path, limits)
        positions = read_all_positions(files, scan.samples.shape)
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
    matrix, findings = sample_matrix(scan, tuple(map(shortest_decimal, spacing)) if spacing else None, None, None)
    matrix, positions = place_samples(matrix, positions, shortest_decimal(unit))
    for axis, row in enumerate(positions):
        if row is not None:  # Blender's voxels are even: the first and the last are where they belong
            matrix[:3, axis] *= row[-1] / (len(row) - 1)
    target = path.with_name(path.name[: -len(scan_suffix(path))] + ".vdb")
    return PlacedScan(scan, matrix, positions, (*scan.findings, *findings), target)


def write_volume(module: ModuleType, placed: PlacedScan, unit: float) -> float:
    """Write the scan whole, with `unit` meters per unit and a background unlike any value; return the least value."""
    scan, target, matrix = placed.scan, placed.target, placed.matrix.copy()
    matrix[:3] /= unit
    least, exact = np.inf, True
    for _, slab in _slabs(scan):
        if not np.isfinite(slab.min()) or not np.isfinite(slab.max()):
            raise FileError(SCAN_NON_FINITE)
        least = min(least, float(slab.min()))
        exact = exact and np.array_equal(slab.astype(np.float32), slab)
    kind, grid_of = (np.float32, module.FloatGrid) if exact else (np.float64, module.DoubleGrid)
    grid = grid_of(0.0 if least >= 0.0 else float(np.nextafter(kind(least), kind(-np.inf))))
    grid.name, grid.gridClass = GRID_NAME, "fog volume"
    grid.transform = module.createLinearTransform(matrix.T.tolist())
    for start, slab in _slabs(scan):
        grid.copyFromArray(np.ascontiguousarray(slab), ijk=(start, 0, 0))
    partial = target.with_name("{:s}.{:d}.partial.vdb".format(target.stem, os.getpid()))
    try:
        module.write(str(partial), grid)
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)
    return least


def _slabs(scan: Scan) -> Iterator[tuple[int, NDArray[np.float64]]]:
    samples = scan.samples
    planes = max(1, SAMPLES_PER_SLAB // (samples.shape[1] * samples.shape[2]))
    for start in range(0, samples.shape[0], planes):
        yield start, samples[start : start + planes].astype(np.float64) * scan.slope + scan.intercept


def add_volume(context: Context, placed: PlacedScan) -> Object:
    """Add a Volume object with the file of a scan, selected and active."""
    path = placed.target
    volume = bpy.data.volumes.new(path.stem)
    volume.filepath = str(path)
    obj = bpy.data.objects.new(path.stem, volume)
    obj.body_moments.grid, obj.body_moments.sample_positions = GRID_NAME, positions_text(placed.positions)
    context.collection.objects.link(obj)
    for previous in context.selected_objects:
        previous.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    return obj
