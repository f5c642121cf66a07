# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan or array of densities in a file as a body, without any object."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.measurement import Measurement
from ...core.scans.formats import placed, read_scan
from ..read import Reading, Unreadable
from ..settings.grid import GridOptions
from ..settings.options import MeasureOptions
from .grid import density_body
from .mass import Weighed
from .measurement import as_measurement, to_order

REMEDY = (
    "Write densities into the file first, or import the scan in Blender, where a transfer table makes densities "
    "of CT numbers."
)


@dataclass(frozen=True)
class ArrayOptions:
    """spacing, origin: (x, y, z) in place of the file's own; unit_scale: metres per unit where the file has none;
    density_scale: kg/m³ where a sample is 1."""

    spacing: Sequence[float] | None = None
    origin: Sequence[float] | None = None
    spline_order: int = 1
    density_scale: float = 1.0
    unit_scale: float | None = None


def measure_array(path: str, name: str, array: ArrayOptions, options: MeasureOptions) -> Measurement:
    """The mass properties of the samples in a file. Raises `Unreadable` with the reason."""
    if options.kind == "shell":
        raise Unreadable(name, "A grid of voxels is no sheet; measure it as a solid.")
    try:
        scan = read_scan(path)
        matrix, notes = placed(scan, array.spacing, array.origin, array.unit_scale)
        grid = GridOptions(value_density=array.density_scale, spline_order=array.spline_order, remedy=REMEDY)
        notes = (
            *scan.notes,
            *notes,
            "Its density is an array of {:d} x {:d} x {:d} samples. {:s}".format(*scan.samples.shape, grid.told()),
        )
        if options.density is not None:
            notes += ("Its samples are densities, so the given density was not used.",)
        body = density_body(scan.samples, scan.samples.shape, matrix, grid, None, notes, scan.slope, scan.intercept)
        reading = Reading(name, "ARRAY", np.eye(4), np.eye(3), np.zeros(3))
        used = replace(options, kind="solid", density=None, thickness=0.0, overlap="signed", wall="thin")
        weighed = Weighed(body.mass, "samples")
        return to_order(as_measurement(None, reading, body, used, 1.0, weighed, repr(grid.key)), body, used)
    except (ValueError, OSError) as error:
        reason = error.strerror + "." if isinstance(error, OSError) and error.strerror else str(error)
        raise Unreadable(name, reason) from error
