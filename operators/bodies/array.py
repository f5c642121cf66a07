# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan or array of densities in a file as a body, without any object."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.measurement import Measurement
from ...core.scans.formats import read_scan, sample_matrix
from ...core.scans.limits import DEFAULT_LIMITS, Limits
from ...core.scans.positions import place_samples, read_all_positions
from ...core.verdict.finding import Finding, MeasureError, ReadError, finding
from ..read import Reading
from ..settings.grid import GridOptions
from ..settings.options import MeasureOptions, ResolvedOptions
from .body import KNOWN_ORDER
from .grid import density_body
from .measurement import measurement_of
from .request import Request


@dataclass(frozen=True)
class ArrayOptions:
    """spacing, origin: (x, y, z) in place of the file's own; unit_scale: metres per unit where the file has none;
    density_scale: kg/m³ where a sample is 1; limits: of what the file may ask for; positions: files of the
    samples' positions by axis, in units of unit_scale."""

    spacing: Sequence[float] | None = None
    origin: Sequence[float] | None = None
    spline_order: int = 1
    density_scale: float = 1.0
    unit_scale: float | None = None
    limits: Limits = DEFAULT_LIMITS
    positions: Mapping[str, str] = field(default_factory=dict)


def measure_array(
    path: str,
    name: str,
    array: ArrayOptions,
    options: MeasureOptions,
    progress: Callable[[int], None] = lambda samples: None,
) -> Measurement:
    """The mass properties of the samples in a file. progress: called with how many samples have been read since the
    last time. Raises MeasureError."""
    if options.kind == "shell":
        raise ReadError("grid_as_shell", subject=name)
    try:
        scan = read_scan(path, array.limits)
        matrix, findings = sample_matrix(scan, array.spacing, array.origin, array.unit_scale)
        positions = read_all_positions(array.positions, scan.samples.shape)
        matrix, positions = place_samples(matrix, positions, array.unit_scale or 1.0)
        if array.positions:
            findings = _with_positions(findings, array.positions)
        grid = GridOptions(
            value_density=array.density_scale, spline_order=array.spline_order, negative="array_negative"
        )
        shape = scan.samples.shape
        density = finding("array_density", samples=list(shape), cause=grid.meaning().as_record())
        findings = (*scan.findings, *findings, density)
        if options.density is not None:
            findings += (finding("given_density_ignored"),)
        scale = scan.slope, scan.intercept
        samples = density_body(
            scan.samples, shape, matrix, grid, None, findings, *scale, progress, options.order or KNOWN_ORDER, positions
        )
        reading = Reading(name, "ARRAY", np.eye(4), np.eye(3), np.zeros(3))
        used = ResolvedOptions.of(options, kind="solid", density=None, thickness=0.0, overlap="signed", wall="thin")
        body = replace(samples, density_from=finding("density_from_samples"), density_key=repr(grid.key))
        return measurement_of(reading, body, Request(used, 1.0))
    except MeasureError as error:
        error.about(name)
        raise
    except OSError as error:
        reason = (error.strerror or str(error)).rstrip(".")
        raise ReadError("file_unreadable", subject=name, error=reason) from error


def _with_positions(findings: Iterable[Finding], files: Mapping[str, str]) -> tuple[Finding, ...]:
    """What was decided of the places of samples, where files say them: of all three, no spacing is missing."""
    kept = [one for one in findings if len(files) < 3 or one.code != "scan_without_spacing"]
    return (*kept, finding("samples_positioned", axes=sorted(files)))
