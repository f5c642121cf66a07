# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks before a process measures: options with files as values, limits, and files that results would replace.

A failed check ends like wrong usage, with SystemExit(2) and a message.
"""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from pathlib import Path
from zipfile import is_zipfile

import numpy as np
from numpy.typing import NDArray

from ...core.density.materials import BY_NAME
from ...core.density.polynomial import parse_polynomial
from ...core.fourier.wave_vectors import FrequencyGrid, wave_vectors
from ...core.scans.limits import scan_limits
from ...core.scans.numpy_files import map_array
from ...core.verdict.finding import MeasureError, system_reason
from ..files import output
from ..parser import UsageError
from .arguments import fail, files_of_options
from .option_types import MAX_GRID

MAX_WAVE_VECTORS = MAX_GRID**3


def check(options: Namespace, opened: str | None) -> None:
    """Prepare a measurement and check output files, in a process that both measures and writes.

    opened: the file that this process has open, if any.
    """
    prepare(options)
    output.check_targets(options, files_of_options(options, options.files, opened))


def prepare(options: Namespace) -> None:
    """Prepare a measurement: set `options.limits` of scans, and `options.waves`, the wave vectors of the transform."""
    try:
        check_density(options)
        options.limits = replace(scan_limits(), allow_outside=options.allow_outside)
    except (MeasureError, UsageError) as error:
        fail(str(error))
    try:
        options.waves = wave_vectors_of(options)
    except (MeasureError, UsageError) as error:
        fail("argument --{}: {}".format("grid" if options.q is None else "q", error))


def wave_vectors_of(options: Namespace) -> FrequencyGrid | NDArray[np.float64] | None:
    """Return the requested wave vectors, or None if no transform was requested.

    Raises MeasureError and UsageError.
    """
    if options.fourier is None:
        return None
    dimension = 2 if options.flat else 3
    if options.q is None:
        return FrequencyGrid(options.grid, options.qmax, dimension)
    return _read_wave_vectors(options.q, dimension)


def _read_wave_vectors(path: Path, dimension: int) -> NDArray[np.float64]:
    """Read the wave vectors of a .npy file. Raises MeasureError and UsageError."""
    try:
        if not path.is_file() or is_zipfile(path):
            raise UsageError("{} is not a .npy file".format(path))
        array = map_array(path)
    except OSError as error:
        raise UsageError("{} cannot be read: {}".format(path, system_reason(error))) from error
    if array.size > 3 * MAX_WAVE_VECTORS:
        raise UsageError("more than {} wave vectors. Use several files".format(MAX_WAVE_VECTORS))
    return wave_vectors(array, dimension)


def check_density(options: Namespace) -> None:
    """Raise UsageError if the material is unknown, or MeasureError if the polynomial cannot be read."""
    if options.material is not None and options.material not in BY_NAME:
        raise UsageError("There is no material “{}”. Known are {}".format(options.material, ", ".join(sorted(BY_NAME))))
    if options.polynomial is not None:
        parse_polynomial(options.polynomial)


def density_of(options: Namespace) -> float | None:
    """Return the density that was given as a number or as a material's name, else None."""
    return options.density if options.material is None else BY_NAME[options.material].density
