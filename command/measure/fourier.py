# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the Fourier transform: its wave vectors, its object and its output."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from zipfile import is_zipfile

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender.bodies.flat.flat_fourier import FlatTransform, flat_transform
from ...blender.bodies.fourier import ObjectTransform, object_transform
from ...blender.settings.options import MeasureOptions
from ...blender.write import spectrum
from ...core.fourier.wave_vectors import FrequencyGrid, wave_vectors
from ...core.scans.numpy_files import map_array
from ...core.verdict.finding import Finding, system_reason
from ..files.own_results import guard
from ..options.option_types import MAX_GRID
from ..parser import UsageError

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


def write(obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions) -> tuple[Finding, ...]:
    """Write an object's Fourier transform to a file, and return findings. Raises MeasureError and OSError."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    under_way: ObjectTransform | FlatTransform
    if options.flat:
        unit = measure_options.unit_scale
        under_way = flat_transform(obj, depsgraph, options.waves, frame=options.frame, unit=unit)
    else:
        under_way = object_transform(obj, depsgraph, measure_options, options.waves, frame=options.frame)
    for _ in under_way.steps():
        pass
    transform, findings = under_way.result()
    spectrum.save(options.fourier, transform, options.frame, guard(options.force), under_way.arrays)
    return findings


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
