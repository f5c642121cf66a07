# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the Fourier transform: at which wave vectors, of which object, and where it goes."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from pathlib import Path
from zipfile import is_zipfile

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.fourier.wave_vectors import FrequencyGrid, wave_vectors
from ...core.scans.numpy_files import map_array
from ...core.verdict.finding import Finding, MeasureError, QueryError, finding
from ..bodies.fourier import object_transform
from ..settings.options import MeasureOptions
from ..write import spectrum
from .results import guard

MAX_GRID = 256  # frequencies along an axis: its arrays take a few gigabytes
MAX_WAVE_VECTORS = MAX_GRID**3


def add_options(parser: ArgumentParser, positive: Callable[[str], float]) -> None:
    """--fourier and what belongs to it. positive: the type of a positive number."""
    add = parser.add_argument
    add(
        "--fourier",
        type=Path,
        metavar="OUT.npz",
        help="write the Fourier transform of the one object: q, and F = ∫exp(-i q·x)dV in m³, in the frame",
    )
    add("--q", type=Path, metavar="Q.npy", help="at these wave vectors: rows of 3 numbers, in rad/m")
    add(
        "--grid",
        type=_count,
        metavar="N",
        help="or on a grid of N³ of them: (j - h) Q / h along each axis, with h = N // 2 and j from 0 to N - 1",
    )
    add("--qmax", type=positive, metavar="Q", help="the largest along each axis of the grid, in rad/m")


def check(options: Namespace, parser: ArgumentParser) -> None:
    """Ends with a message where the options do not go together, and makes `options.waves` of them."""
    options.waves = None
    target = options.fourier
    if target is None:
        for name in ("q", "grid", "qmax"):
            if getattr(options, name) is not None:
                parser.error(str(finding("usage_needs_fourier", option=name)))
        return
    if (options.q is None) == (options.grid is None):
        parser.error(str(finding("usage_fourier_points")))
    if (options.grid is None) != (options.qmax is None):
        parser.error(str(finding("usage_grid_and_qmax")))
    if len(options.files) > 1 or len(options.object or ()) > 1:
        parser.error(str(finding("usage_fourier_one_object")))
    for first, second in ((target, options.q), (target, options.output), (options.output, options.q)):
        if first is not None and second is not None and first.resolve() == second.resolve():
            parser.error(str(finding("usage_path_twice", path=str(first))))
    try:
        options.waves = (
            FrequencyGrid(options.grid, options.qmax) if options.q is None else _read_wave_vectors(options.q)
        )
    except MeasureError as error:
        parser.error(
            str(finding("usage_value", option="grid" if options.q is None else "q", cause=error.finding.as_record()))
        )


def write(obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions) -> tuple[Finding, ...]:
    """Transform the object and write the file. Returns the decisions taken. Raises MeasureError and OSError."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    under_way = object_transform(obj, depsgraph, measure_options, options.waves, frame=options.frame)
    for _ in under_way.steps():
        pass
    transform, findings = under_way.result()
    spectrum.save(options.fourier, transform, options.frame, guard("fourier", options.fourier in options.forced))
    return findings


def _read_wave_vectors(path: Path) -> NDArray[np.float64]:
    """Those of a .npy file. Raises MeasureError."""
    try:
        if path.exists() and not path.is_file():
            raise QueryError("wave_vectors_unreadable", file=str(path), cause=finding("file_not_regular").as_record())
        with open(path, "rb") as file:
            if is_zipfile(file):
                raise QueryError("wave_vectors_archive", file=str(path))
        array = map_array(path)
    except OSError as error:
        cause = finding("file_unreadable", error=error.strerror or str(error))
        raise QueryError("wave_vectors_unreadable", file=str(path), cause=cause.as_record()) from error
    if array.size > 3 * MAX_WAVE_VECTORS:
        raise QueryError("wave_vectors_too_many", count=array.size // 3, limit=MAX_WAVE_VECTORS)
    return wave_vectors(array, 3)


def _count(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = 0
    if not 2 <= value <= MAX_GRID:
        raise ArgumentTypeError(str(finding("usage_frequency_count", text=text, limit=MAX_GRID)))
    return value
