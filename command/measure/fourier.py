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
from ...core.scans.findings import FILE_NOT_REGULAR
from ...core.scans.numpy_files import map_array
from ...core.streams.findings import FILE_UNREADABLE
from ...core.verdict.finding import Finding, QueryError, finding, system_reason
from ..files.own_results import guard
from ..findings import WAVE_VECTORS_ARCHIVE, WAVE_VECTORS_TOO_MANY, WAVE_VECTORS_UNREADABLE
from ..options.option_types import MAX_GRID

MAX_WAVE_VECTORS = MAX_GRID**3


def wave_vectors_of(options: Namespace) -> FrequencyGrid | NDArray[np.float64] | None:
    """Return the requested wave vectors, or None if no transform was requested. Raises MeasureError."""
    if options.fourier is None:
        return None
    dimension = 2 if options.flat else 3
    if options.q is None:
        return FrequencyGrid(options.grid, options.qmax, dimension)
    return _read_wave_vectors(options.q, dimension)


def write(obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions) -> tuple[Finding, ...]:
    """Transform the object and write the file. Returns the decisions taken. Raises MeasureError and OSError."""
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
    check = guard("fourier", options.fourier in options.forced)
    spectrum.save(options.fourier, transform, options.frame, check, under_way.arrays)
    return findings


def _read_wave_vectors(path: Path, dimension: int = 3) -> NDArray[np.float64]:
    """Read the wave vectors of a .npy file. Raises MeasureError."""
    try:
        if path.exists() and not path.is_file():
            raise QueryError(WAVE_VECTORS_UNREADABLE, file=str(path), cause=finding(FILE_NOT_REGULAR).as_record())
        with open(path, "rb") as file:
            if is_zipfile(file):
                raise QueryError(WAVE_VECTORS_ARCHIVE, file=str(path))
        array = map_array(path)
    except OSError as error:
        cause = finding(FILE_UNREADABLE, error=system_reason(error))
        raise QueryError(WAVE_VECTORS_UNREADABLE, file=str(path), cause=cause.as_record()) from error
    if array.size > 3 * MAX_WAVE_VECTORS:
        raise QueryError(WAVE_VECTORS_TOO_MANY, count=array.size // 3, limit=MAX_WAVE_VECTORS)
    return wave_vectors(array, dimension)
