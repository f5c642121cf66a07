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
    """
    if not options.sample_positions:
        return EVEN
    rows: list[Array | None] = []
    all_known = _parsed_positions(options.sample_positions)
    for axis, begin, count in zip(AXES, low, shape):
        known = None if all_known is None else all_known.get(axis)
        if all_known is None or known is not None and not 0 <= begin <= begin + count <= len(known):
            raise ReadError(POSITIONS_DAMAGED, grid=grid)
        rows.append(known)
    x, y, z = rows
    return x, y, z


def density_function(
    options: GridOptions, background: float | None
) -> Callable[[NDArray], NDArray]:
    """Return a function from values to densities, kg/m³, 0 for the background; it raises ReadError
    for bad ones.
    """
    pairs = parse_table(options.table) if options.table else None

    def weighed(values: NDArray) -> Array:
        if pairs is not None and not np.isfinite(values).all():
            raise ReadError(DENSITY_NON_FINITE)
        densities = values * options.value_density if pairs is None else np.interp(values, *pairs)
        if background is not None:
            densities[values == background] = 0.0
        if densities.min() < 0.0:
            raise ReadError(VALUES_NEGATIVE, density=float(densities.min()))
        return densities

    return weighed


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
    """Return positions as JSON for an object, in voxels, scaled so that the last sample keeps its
    place in Blender.
    """
    known = {
        axis: (row * ((len(row) - 1) / row[-1])).tolist()
        for axis, row in zip(AXES, positions)
        if row is not None
    }
    return json.dumps(known, separators=(",", ":")) if known else ""


def _parsed_positions(text: str) -> dict[str, Array] | None:
    """Return the positions by axis, or None if `positions_text` cannot have written the text."""
    try:
        rows = {axis: np.array(row, np.float64) for axis, row in json.loads(text).items()}
    except (ValueError, TypeError, AttributeError, RecursionError):
        return None
    ascending = all(
        row.ndim == 1 and len(row) > 1 and (np.diff(row) > 0.0).all() for row in rows.values()
    )
    return rows if ascending and all(np.isfinite(row).all() for row in rows.values()) else None


def parse_table(text: str) -> tuple[Array, Array]:
    """Return (n,) values, ascending, and (n,) densities in kg/m³; MeasureError if the text is no
    such table.
    """
    entries = []
    for pair in re.split(r"[,;\n]", text):
        words = pair.split()
        if not words:
            continue
        try:
            value, density = map(float, words)
        except ValueError:
            raise MeasureError(TRANSFER_TABLE_SYNTAX, part=pair.strip()) from None
        entries.append((value, density))
    table = np.array(entries, np.float64).reshape(-1, 2)
    rises = (np.diff(table[:, 0]) > 0.0).all()
    if len(table) < 2 or not (np.isfinite(table).all() and rises and (table[:, 1] >= 0.0).all()):
        raise MeasureError(TRANSFER_TABLE_NUMBERS)
    return table[:, 0], table[:, 1]
