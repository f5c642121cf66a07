# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The use of a grid: its choice, and the meaning of its values."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.density.transfer_function import parse_table
from ...core.numerics.float32 import shortest_decimal
from ...core.scans.positions import AXES, EVEN, Positions
from ...core.verdict.finding import Finding, ReadError, finding
from .findings import (
    BACKGROUND_EMPTY,
    POSITIONS_DAMAGED,
    POSITIONS_OF_OTHER_SAMPLES,
    POSITIONS_ONLY_AS_DENSITY,
    VALUES_BY_TABLE,
    VALUES_BY_TABLE_SPLINE,
    VALUES_NEGATIVE,
    VALUES_NON_FINITE_FOR_TABLE,
    VALUES_SCALED,
    VALUES_SCALED_SPLINE,
)


@dataclass(frozen=True)
class GridOptions:
    """Options of a grid.

    grid: its name, "" for the likeliest. solid: a level set as the solid it bounds. threshold: smallest value inside
    the body, None for all of the grid; filled: with the grid's own density, not with one material. value_density: kg/m³
    of a value of 1; table: a transfer table instead, "" for none. spline_order: 1 voxels, 2 trilinear, 4 cubic.
    sample_positions: of uneven samples, as `positions_text` writes it.
    """

    grid: str = ""
    solid: bool = False
    threshold: float | None = None
    filled: bool = False
    value_density: float = 1.0
    table: str = ""
    spline_order: int = 1
    sample_positions: str = ""

    @classmethod
    def from_settings(cls, settings, density: float | None = None) -> GridOptions:
        """Return the options of an object's settings.

        density: overrides the density of a value of 1, and the table.
        """
        table = settings.transfer_table if settings.values_from == "TABLE" and density is None else ""
        return cls(
            settings.grid,
            settings.grid_as == "SOLID",
            shortest_decimal(settings.threshold) if settings.grid_as == "THRESHOLD" else None,
            settings.threshold_fill == "GRID",
            shortest_decimal(settings.value_density if density is None else density),
            table,
            settings.spline_order,
            settings.sample_positions,
        )

    @property
    def key(self) -> tuple:
        """Key of all that the numbers depend on."""
        if self.threshold is not None and not self.filled:
            return self.grid, "threshold", self.threshold, self.spline_order
        values = (self.grid, "solid") if self.solid else (self.grid, self.table or self.value_density)
        if self.sample_positions:
            values = (*values, self.sample_positions)
        return (*values, self.spline_order) if self.threshold is None else (*values, self.spline_order, self.threshold)

    def positions(self, grid: str, low: NDArray, shape: Sequence[int]) -> Positions:
        """Return the positions of all samples of the scan along each axis, in voxels.

        grid: its name. ReadError if they are unknown in the box from `low` on.
        """
        if not self.sample_positions:
            return EVEN
        rows: list[NDArray[np.float64] | None] = []
        all_known = _parsed_positions(self.sample_positions)
        if all_known is None:
            raise ReadError(POSITIONS_DAMAGED, grid=grid)
        for axis, begin, count in zip(AXES, low, shape):
            known = all_known.get(axis)
            if known is not None and not 0 <= begin <= begin + count <= len(known):
                raise ReadError(POSITIONS_OF_OTHER_SAMPLES, grid=grid, axis=axis, count=len(known))
            rows.append(known)
        x, y, z = rows
        return x, y, z

    def needs_even_samples(self, grid: str) -> None:
        """Raise ReadError if samples are uneven.

        grid: its name.
        """
        if self.sample_positions:
            raise ReadError(POSITIONS_ONLY_AS_DENSITY, grid=grid)

    def to_densities(self, background: float | None) -> Callable[[NDArray], NDArray]:
        """Return a function from values to densities in kg/m³; it raises ReadError if it cannot convert them.

        The background, if any, is empty, at any value.
        """
        pairs = parse_table(self.table) if self.table else None

        def weighed(values: NDArray) -> NDArray[np.float64]:
            if pairs is not None and not np.isfinite(values).all():
                raise ReadError(VALUES_NON_FINITE_FOR_TABLE)
            densities = values * self.value_density if pairs is None else np.interp(values, *pairs)
            if background is not None:
                densities[values == background] = 0.0
            if densities.min() < 0.0:
                raise ReadError(VALUES_NEGATIVE, density=float(densities.min()))
            return densities

        return weighed

    def empty_background_note(self, background: float | None) -> tuple[Finding, ...]:
        """Return a finding if the background would have a density, but counts as empty."""
        if background is None or not np.isfinite(background):
            return ()
        density = np.interp(background, *parse_table(self.table)) if self.table else background * self.value_density
        return (finding(BACKGROUND_EMPTY, value=float(background)),) if density else ()

    def meaning(self) -> Finding:
        """Return the meaning of a value."""
        spline = {"order": self.spline_order} if self.spline_order > 1 else {}
        if self.table:
            return finding(VALUES_BY_TABLE_SPLINE if spline else VALUES_BY_TABLE, **spline)
        return finding(VALUES_SCALED_SPLINE if spline else VALUES_SCALED, density=self.value_density, **spline)


def positions_text(positions: Positions) -> str:
    """Return positions as text for an object: in voxels, with the first and last sample's places in Blender."""
    known = {axis: (row * ((len(row) - 1) / row[-1])).tolist() for axis, row in zip(AXES, positions) if row is not None}
    return json.dumps(known, separators=(",", ":")) if known else ""


def _parsed_positions(text: str) -> dict[str, NDArray[np.float64]] | None:
    """Return the rows by their axes; None if the text is not from `positions_text`."""
    try:
        rows = {axis: np.array(row, np.float64) for axis, row in json.loads(text).items()}
    except (ValueError, TypeError, AttributeError, RecursionError):
        return None
    ascending = all(row.ndim == 1 and len(row) > 1 and (np.diff(row) > 0.0).all() for row in rows.values())
    return rows if ascending and all(np.isfinite(row).all() for row in rows.values()) else None
