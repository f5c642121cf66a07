# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks before a process measures: options with files as values, and limits; findings about units
and unused options.

A failed check ends like wrong usage, with SystemExit(2) and a message.
"""

from argparse import Namespace
from collections.abc import Iterable, Iterator
from dataclasses import replace
from zipfile import is_zipfile

from ...core import density, files, scans
from ...core.fourier.wave_vectors import FrequencyGrid, wave_vectors
from ...core.measurement import Measurement
from ...core.numerics import Array
from ...core.verdict import Finding, MeasureError, finding, system_reason
from ..files.suffixes import file_suffix
from ..findings import OPTIONS_UNUSED
from ..parser import UsageError
from ..supervisor.listing import UNITLESS
from . import arguments, option_types

MAX_WAVE_VECTORS = option_types.MAX_GRID**3
OF_ARRAYS = ("spacing", "origin", "spline_order", "density_scale", "positions")


def prepare(options: Namespace) -> None:
    """Prepare a measurement: set `options.limits` of scans, and `options.waves`, the wave vectors
    of the transform.
    """
    try:
        if options.material is not None and options.material not in density.BY_NAME:
            material_names = ", ".join(sorted(density.BY_NAME))
            raise UsageError(
                "There is no material “{}”. Known are {}".format(options.material, material_names)
            )
        if options.polynomial is not None:
            density.parse_polynomial(options.polynomial)
        options.limits = replace(files.file_limits(), allow_outside=options.allow_outside)
    except (MeasureError, UsageError) as error:
        arguments.fail(str(error))
    try:
        options.waves = wave_vectors_of(options)
    except (MeasureError, UsageError) as error:
        arguments.fail("argument --{}: {}".format("grid" if options.q is None else "q", error))


def wave_vectors_of(options: Namespace) -> FrequencyGrid | Array | None:
    """Return the requested wave vectors, of a grid or a .npy file, or None.

    Raises MeasureError and UsageError.
    """
    dimension = 2 if options.flat else 3
    path = options.q
    if options.fourier is None:
        return None
    if path is None:
        return FrequencyGrid(options.grid, options.qmax, dimension)
    try:
        if not path.is_file() or is_zipfile(path):
            raise UsageError("{} is not a .npy file".format(path))
        array = scans.map_array(path)
    except OSError as error:
        raise UsageError("{} cannot be read: {}".format(path, system_reason(error))) from error
    if array.size > 3 * MAX_WAVE_VECTORS:
        raise UsageError("more than {} wave vectors. Use several files".format(MAX_WAVE_VECTORS))
    return wave_vectors(array, dimension)


def density_of(options: Namespace) -> float | None:
    """Return the density that was given as a number or as a material's name, else None."""
    return (
        options.density if options.material is None else density.BY_NAME[options.material].density
    )


def is_unitless(path: str | None) -> bool:
    return path is not None and file_suffix(path) in UNITLESS


def unused(names: Iterable[str]) -> Iterator[Finding]:
    """Yield a finding if there are unused options."""
    if options := arguments.words(names):
        yield finding(OPTIONS_UNUSED, options=options)


def file_findings(path: str | None, options: Namespace) -> Iterator[Finding]:
    """Yield findings if the unit of a mesh file was assumed, or options for other kinds of files
    are unused.
    """
    names = [*OF_ARRAYS, "label_table", *([] if is_unitless(path) else ["unit_scale"])]
    if is_unitless(path) and options.unit_scale is None:
        yield finding(scans.UNIT_ASSUMED, unit="m")
    yield from unused(name for name in names if getattr(options, name) is not None)


def body_findings(options: Namespace, measurement: Measurement) -> Iterator[Finding]:
    """Yield a finding if there are options for other kinds of bodies only."""
    applies = {
        "thickness": measurement.kind == "shell",
        "print": measurement.kind == "printed",
        "threshold": measurement.type in ("ARRAY", "VOLUME"),
        "label": measurement.type in ("ARRAY", "VOLUME"),
    }
    yield from unused(
        name for name in applies if getattr(options, name) is not None and not applies[name]
    )
