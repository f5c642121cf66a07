# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The wave vectors of the Fourier transform that --q, or --grid and --qmax, ask for."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from zipfile import is_zipfile

import numpy as np
from numpy.typing import NDArray

from ...core.fourier.wave_vectors import FrequencyGrid, wave_vectors
from ...core.scans.numpy_files import map_array
from ...core.verdict.finding import system_reason
from ..parser import UsageError
from .option_types import MAX_GRID

MAX_WAVE_VECTORS = MAX_GRID**3


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
