# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the Fourier transform: at which wave vectors, of which object, and where it goes."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.fourier.wave_vectors import Grid, wave_vectors
from ..bodies.fourier import object_transform
from ..settings.options import MeasureOptions
from ..write import spectrum
from .results import guard

LARGEST_GRID = 256  # frequencies along an axis: its arrays take a few gigabytes


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
                parser.error("argument --{}: it needs --fourier OUT.npz".format(name))
        return
    if (options.q is None) == (options.grid is None):
        parser.error("argument --fourier: it needs either --q Q.npy or --grid N --qmax Q")
    if (options.grid is None) != (options.qmax is None):
        parser.error("arguments --grid and --qmax go together")
    if len(options.files) > 1 or len(options.object or ()) > 1:
        parser.error("argument --fourier: it takes one object of one FILE")
    if not target.parent.is_dir():
        parser.error("argument --fourier: there is no folder {}".format(target.parent))
    if target.is_dir():
        parser.error("argument --fourier: {} is a folder".format(target))
    for one, other in ((target, options.q), (target, options.output), (options.output, options.q)):
        if one is not None and other is not None and one.resolve() == other.resolve():
            parser.error("argument --fourier: {} is named twice".format(one))
    try:
        options.waves = Grid(options.grid, options.qmax) if options.q is None else _listed(options.q)
    except ValueError as error:
        parser.error("argument --{}: {}".format("grid" if options.q is None else "q", error))


def write(obj: bpy.types.Object, options: Namespace, wanted: MeasureOptions) -> tuple[str, ...]:
    """Transform the object and write the file. Returns the decisions taken. Raises `Unreadable` and OSError."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    under_way = object_transform(obj, depsgraph, wanted, options.waves, frame=options.frame)
    for _ in under_way.steps():
        pass
    found, notes = under_way.result()
    spectrum.save(options.fourier, found, options.frame, guard("fourier", options.fourier in options.forced))
    return notes


def _listed(path: Path) -> NDArray[np.float64]:
    try:
        array = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise ValueError("{} cannot be read as an .npy file: {}".format(path, error)) from error
    if not isinstance(array, np.ndarray):
        array.close()
        raise ValueError("{} holds several arrays; an .npy file of one is needed".format(path))
    return wave_vectors(array, 3)


def _count(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = 0
    if not 2 <= value <= LARGEST_GRID:
        raise ArgumentTypeError("{!r} is not a number of frequencies, 2 to {}".format(text, LARGEST_GRID))
    return value
