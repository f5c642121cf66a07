# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of a grid as densities, and the positions of its samples."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence

import numpy as np

from ..numerics import Array, NDArray
from ..scans import AXES, EVEN, Positions
from ..verdict import Finding, MeasureError, ReadError, finding
from .findings import (
    BACKGROUND_EMPTY,
    DENSITY_NON_FINITE,
    POSITIONS_DAMAGED,
    TRANSFER_TABLE_NUMBERS,
    TRANSFER_TABLE_SYNTAX,
    VALUES_NEGATIVE,
)
from .grid_options import GridOptions


def sample_positions(
    options: GridOptions, grid: str, low: NDArray, shape: Sequence[int]
) -> Positions:
    """Return the scan's sample positions by axis, in voxels, None for even ones, or raise
    ReadError.

    grid: its name. low, shape: (3,) index of the first sample in use and number of samples in use.
    """
    if not options.sample_positions:
        return EVEN
    positions = _parsed_positions(options.sample_positions)
    if positions is None:
        raise ReadError(POSITIONS_DAMAGED, grid=grid)
    for axis, begin, count in zip(AXES, low, shape):
        if axis in positions and not 0 <= begin <= begin + count <= len(positions[axis]):
            raise ReadError(POSITIONS_DAMAGED, grid=grid)
    x, y, z = map(positions.get, AXES)
    return x, y, z


def density_function(
    options: GridOptions, background: float | None
) -> Callable[[NDArray], NDArray]:
    """Return a function from values to densities, kg/m³, 0 for the background.

    It raises ReadError for negative densities, and for values beyond a table.
    """
    table = parse_table(options.table) if options.table else None

    def to_densities(values: NDArray) -> Array:
        if table is None:
            densities = values * options.value_density
        elif np.isfinite(values).all():
            densities = np.interp(values, *table)
        else:
            raise ReadError(DENSITY_NON_FINITE)
        if background is not None:
            densities[values == background] = 0.0
        if densities.min() < 0.0:
            raise ReadError(VALUES_NEGATIVE, density=float(densities.min()))
        return densities

    return to_densities


def empty_background_note(options: GridOptions, background: float | None) -> tuple[Finding, ...]:
    """Return a finding if the background would have a density, but counts as empty."""
    if background is None or not np.isfinite(background):
        return ()
    if options.table:
        density = np.interp(background, *parse_table(options.table))
    else:
        density = background * options.value_density
    return (finding(BACKGROUND_EMPTY, value=float(background)),) if density else ()


def positions_text(positions: Positions) -> str:
    """Return uneven positions as JSON for an object, in voxels, scaled so that the last sample
    keeps its place in Blender; "" if all are even.
    """
    scaled = {
        axis: (row * ((len(row) - 1) / row[-1])).tolist()
        for axis, row in zip(AXES, positions)
        if row is not None
    }
    return json.dumps(scaled, separators=(",", ":")) if scaled else ""


def _parsed_positions(text: str) -> dict[str, Array] | None:
    """Return the positions by axis, or None if `positions_text` cannot have written the text."""
    try:
        positions = {axis: np.array(row, np.float64) for axis, row in json.loads(text).items()}
    except (ValueError, TypeError, AttributeError, RecursionError):
        return None
    for row in positions.values():
        if row.ndim != 1 or len(row) < 2 or not np.isfinite(row).all():
            return None
        if not (np.diff(row) > 0.0).all():
            return None
    return positions


def parse_table(text: str) -> tuple[Array, Array]:
    """Return (n,) ascending values and (n,) densities in kg/m³, two or more, or raise MeasureError
    if the text is no such table.
    """
    pairs = []
    for part in re.split(r"[,;\n]", text):
        words = part.split()
        if not words:
            continue
        try:
            value, density = map(float, words)
        except ValueError:
            raise MeasureError(TRANSFER_TABLE_SYNTAX, part=part.strip()) from None
        pairs.append((value, density))
    values, densities = np.array(pairs, np.float64).reshape(-1, 2).T
    is_finite = np.isfinite(values).all() and np.isfinite(densities).all()
    is_ascending = len(values) > 1 and (np.diff(values) > 0.0).all()
    if not (is_finite and is_ascending and (densities >= 0.0).all()):
        raise MeasureError(TRANSFER_TABLE_NUMBERS)
    return values, densities
