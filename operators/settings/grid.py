# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the values of a grid are taken: which grid, and what a value stands for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.density.transfer_function import parse_table
from ...core.numerics.float32 import decimal


@dataclass(frozen=True)
class GridOptions:
    """How a grid is taken.

    grid: its name, "" for the likeliest. solid: a level set as the solid it bounds. value_density: kg/m³ where a value
    is 1; table: a transfer table instead, "" for none. spline_order: 1 voxels, 2 trilinear, 4 cubic.
    remedy: what to do about negative densities.
    """

    grid: str = ""
    solid: bool = False
    value_density: float = 1.0
    table: str = ""
    spline_order: int = 1
    remedy: str = (
        "Give a transfer table for what its values stand for; a level set can be measured as the solid that it bounds."
    )

    @classmethod
    def of(cls, settings, density: float | None = None) -> GridOptions:
        """From an object's settings. density: overrides what a value of 1 stands for, and the table."""
        table = settings.transfer_table if settings.values_from == "TABLE" and density is None else ""
        return cls(
            settings.grid,
            settings.grid_as == "SOLID",
            decimal(settings.value_density if density is None else density),
            table,
            settings.spline_order,
        )

    @property
    def key(self) -> tuple:
        """What the numbers depend on."""
        values = (self.grid, "solid") if self.solid else (self.grid, self.table or self.value_density)
        return (*values, self.spline_order)

    def weigh(self, background: float | None) -> Callable[[NDArray], NDArray]:
        """What makes densities in kg/m³ of values. The background, if any, is empty, whatever its value."""
        pairs = parse_table(self.table) if self.table else None

        def weighed(values: NDArray) -> NDArray[np.float64]:
            if pairs is not None and not np.isfinite(values).all():
                raise ValueError(
                    "It has values that are not finite, for which no transfer table has a density; remove them."
                )
            densities = values * self.value_density if pairs is None else np.interp(values, *pairs)
            if background is not None:
                densities[values == background] = 0.0
            if densities.min() < 0.0:
                raise ValueError(
                    "It has negative densities, down to {:.6g} kg/m³. {:s}".format(densities.min(), self.remedy)
                )
            return densities

        return weighed

    def left_empty(self, background: float | None) -> tuple[str, ...]:
        """A sentence where the background would have a density if it did not count as empty."""
        if background is None or not np.isfinite(background):
            return ()
        density = np.interp(background, *parse_table(self.table)) if self.table else background * self.value_density
        return ("Voxels that hold the background, {:.6g}, count as empty.".format(background),) if density else ()

    def told(self) -> str:
        """What a value stands for, as a sentence."""
        text = (
            "Its values became densities by the transfer table."
            if self.table
            else "A value of 1 is taken as {:.6g} kg/m³.".format(self.value_density)
        )
        if self.spline_order > 1:
            text += " Its values are the coefficients of a spline of order {:d}, which smooths them.".format(
                self.spline_order
            )
        return text
