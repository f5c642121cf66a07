# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of a voxel grid: its name, its use, and the meaning of its values."""

from __future__ import annotations

from typing import NamedTuple

from ..numerics import shortest_decimal
from ..verdict import Finding, ReadError, finding
from .findings import POSITIONS_ONLY_AS_DENSITY, VALUES_BY_TABLE, VALUES_SCALED


class GridOptions(NamedTuple):
    """Options of a grid.

    grid: its name, "" for the likeliest. solid: True to measure a level set as the solid that it
    bounds. threshold: smallest value inside the body, None for all of the grid. filled: True to
    fill this body with the grid's own density, not with one material. value_density: kg/m³ of a
    value of 1. table: a transfer table instead, "" for none. spline_order: 1 voxels, 2 trilinear, 4
    cubic. sample_positions: the positions of uneven samples, as `positions_text` writes them.
    label: the label of a label map to measure, 0 for all labels but 0; None for no label map.
    """

    grid: str = ""
    solid: bool = False
    threshold: float | None = None
    filled: bool = False
    value_density: float = 1.0
    table: str = ""
    spline_order: int = 1
    sample_positions: str = ""
    label: int | None = None

    @classmethod
    def from_settings(cls, settings, density: float | None = None) -> GridOptions:
        """Return the options of an object's settings. density: overrides the density of a value of
        1, and the table.
        """
        uses_table = settings.values_from == "TABLE" and density is None
        above_threshold = settings.grid_as == "THRESHOLD"
        return cls(
            grid=settings.grid,
            solid=settings.grid_as == "SOLID",
            threshold=shortest_decimal(settings.threshold) if above_threshold else None,
            filled=settings.threshold_fill == "GRID",
            value_density=shortest_decimal(settings.value_density if density is None else density),
            table=settings.transfer_table if uses_table else "",
            spline_order=settings.spline_order,
            sample_positions=settings.sample_positions,
            label=settings.label if settings.grid_as == "LABEL" else None,
        )

    @property
    def key(self) -> tuple:
        """Tuple of the options that the results depend on."""
        if self.label is not None:
            return self.grid, "label", self.label
        if self.threshold is not None and not self.filled:
            return self.grid, "threshold", self.threshold, self.spline_order
        key = self.grid, "solid" if self.solid else self.table or self.value_density
        if self.sample_positions:
            key = (*key, self.sample_positions)
        key = (*key, self.spline_order)
        return key if self.threshold is None else (*key, self.threshold)

    def needs_even_samples(self, grid: str) -> None:
        """Raise ReadError about the grid of this name if its samples are uneven."""
        if self.sample_positions:
            raise ReadError(POSITIONS_ONLY_AS_DENSITY, grid=grid)

    def meaning(self) -> Finding:
        """Return a note on the conversion of the grid's values to densities."""
        if self.table:
            return finding(VALUES_BY_TABLE, order=self.spline_order)
        return finding(VALUES_SCALED, density=self.value_density, order=self.spline_order)
