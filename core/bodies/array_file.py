# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan or array of densities in a file as a body, without any object."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..density.findings import POSITIONS_ONLY_AS_DENSITY
from ..density.grid_options import GridOptions
from ..measurement.body import Body
from ..measurement.measurement import Measurement
from ..measurement.settings import Settings
from ..moments.exponents import KNOWN_ORDER
from ..scans import Scan, read_scan, sample_matrix
from ..scans.findings import SCAN_UNSTATED
from ..scans.limits import DEFAULT_LIMITS, Limits
from ..scans.positions import Positions, place_samples, read_all_positions
from ..verdict.finding import Finding, ReadError, finding
from .density_grid import Samples, density_body
from .findings import (
    DENSITY_FROM_SAMPLES,
    GIVEN_DENSITY_IGNORED,
    GRID_AS_SHELL,
    GRID_DENSITY,
    GRID_TOO_LARGE,
    SAMPLES_POSITIONED,
)
from .reading import about_file, bare_reading, measure_reading
from .threshold import MAX_SAMPLES, TRILINEAR, ThresholdGrid, threshold_grid_body


@dataclass(frozen=True)
class ArrayOptions:
    """Options of a measured array file.

    spacing, origin: (x, y, z) in place of the file's own; unit_scale: meters per unit if the file has none;
    density_scale: kg/m³ that a sample of 1 stands for; threshold: smallest value inside the body, None for all; limits:
    of the file's size; positions: paths of files with the samples' positions, by axis, in units of unit_scale.
    """

    spacing: Sequence[float] | None = None
    origin: Sequence[float] | None = None
    spline_order: int = 1
    density_scale: float = 1.0
    threshold: float | None = None
    unit_scale: float | None = None
    limits: Limits = DEFAULT_LIMITS
    positions: Mapping[str, str] = field(default_factory=dict)


def measure_array(
    path: str,
    name: str,
    array: ArrayOptions,
    settings: Settings,
    progress: Callable[[int], None] = lambda samples: None,
) -> Measurement:
    """Return the mass properties of the samples in a file; `progress` gets the number of samples just read."""
    if settings.kind == "shell":
        raise ReadError(GRID_AS_SHELL, subject=name)
    with about_file(name):
        scan = read_scan(path, array.limits)
        matrix, findings = sample_matrix(scan, array.spacing, array.origin, array.unit_scale)
        positions = read_all_positions(array.positions, scan.samples.shape)
        matrix, positions = place_samples(matrix, positions, array.unit_scale or 1.0)
        if array.positions:
            findings = _with_positions(findings, array.positions)
        findings = (*scan.findings, *findings)
        if array.threshold is None:
            made = _density_body(scan, matrix, positions, array, settings, findings, progress)
        else:
            made = _threshold_body(name, scan, matrix, array, settings, findings, progress)
        reading = bare_reading(name, "ARRAY")
        density = None if made.mass is not None else settings.density
        return measure_reading(reading, made, replace(settings, density=density))


def _with_positions(findings: Iterable[Finding], files: Mapping[str, str]) -> tuple[Finding, ...]:
    """Return the findings with a note on the positions; without the missing spacing if all axes have positions."""
    unspaced = finding(SCAN_UNSTATED, part="spacing", option="spacing")
    kept = [one for one in findings if len(files) < 3 or one != unspaced]
    return (*kept, finding(SAMPLES_POSITIONED, axes=sorted(files)))


def _density_body(
    scan: Scan,
    matrix: NDArray[np.float64],
    positions: Positions,
    array: ArrayOptions,
    settings: Settings,
    findings: tuple[Finding, ...],
    progress: Callable[[int], None],
) -> Body:
    """Return the body of all samples, as densities."""
    grid = GridOptions(value_density=array.density_scale, spline_order=array.spline_order)
    shape = scan.samples.shape
    findings += (finding(GRID_DENSITY, samples=list(shape), cause=grid.meaning().as_record()),)
    if settings.density is not None:
        findings += (finding(GIVEN_DENSITY_IGNORED),)
    samples = Samples(scan.samples, shape, matrix, grid, None, scan.slope, scan.intercept, positions)
    body = density_body(samples, findings, progress, settings.order or KNOWN_ORDER)
    return replace(body, density_from=finding(DENSITY_FROM_SAMPLES))


def _threshold_body(
    name: str,
    scan: Scan,
    matrix: NDArray[np.float64],
    array: ArrayOptions,
    settings: Settings,
    findings: tuple[Finding, ...],
    progress: Callable[[int], None],
) -> Body:
    """Return the body at or above a threshold, filled with the given density, else with the samples as densities."""
    if array.positions:
        raise ReadError(POSITIONS_ONLY_AS_DENSITY, grid=name)
    filled = settings.density is None
    spline_order = max(array.spline_order, TRILINEAR)
    grid = GridOptions(
        threshold=array.threshold, filled=filled, value_density=array.density_scale, spline_order=spline_order
    )
    if spline_order > TRILINEAR and scan.samples.size > MAX_SAMPLES:
        raise ReadError(GRID_TOO_LARGE, grid=name, samples=list(scan.samples.shape))
    slowest = np.argsort([-abs(stride) for stride in scan.samples.strides], kind="stable")  # read in the file's order
    turned = np.eye(4)
    turned[:3, :3] = np.eye(3)[:, slowest]

    def values(block: NDArray) -> NDArray[np.float64]:
        progress(block.size)
        return block * scan.slope + scan.intercept

    samples = scan.samples.transpose(slowest)
    body = threshold_grid_body(
        ThresholdGrid(name, samples, matrix @ turned, None, values), grid, order=settings.order or KNOWN_ORDER
    )
    source = finding(DENSITY_FROM_SAMPLES) if filled else None
    return replace(body, findings=(*findings, *body.findings), density_from=source)
