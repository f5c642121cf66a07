# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One-dimensional tables ∫ t^l B_i(t) dt, all that the moments of a trivariate B-spline need.

Soldea, Elber and Rivlin integrate t^l B_{i,k} by l nested sums (Theorem 4.2, kept in `core.papers` as the reference).
Over a full support the same integral has a closed form, positive if the knots are:

    ∫ t^l B_{i,k} = (t_{i+k} - t_i) / k · h_l(t_i, ..., t_{i+k}) / binomial(k + l, l),

h_l the complete homogeneous polynomial of the k + 1 knots: k B_{i,k} / (t_{i+k} - t_i) is the density of a mean of the
knots with weights uniform on a simplex.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.arguments import float_array

MAX_ORDER = 16  # Splines of higher order are refused: far above any use.


@dataclass(frozen=True, eq=False)
class SplineAxis:
    """The spline space of one direction of a trivariate spline, by (n + order,) ascending knots.

    order: the degree plus one: 1 voxels, 2 linear, 4 the paper's cubic. ValueError if the knots or the order make no
    such space.
    """

    knots: NDArray[np.float64]
    order: int

    def __post_init__(self) -> None:
        knots = float_array("knots", self.knots, "n")
        object.__setattr__(self, "knots", knots)
        if not 1 <= self.order <= MAX_ORDER:
            raise ValueError("order beyond 1…{:d}".format(MAX_ORDER))
        if len(knots) <= self.order:
            raise ValueError("too few knots")
        if not np.isfinite(knots).all() or (np.diff(knots) < 0.0).any():
            raise ValueError("knots must ascend")

    @classmethod
    def uniform(cls, count: int, order: int = 1, spacing: float = 1.0, origin: float = 0.0) -> SplineAxis:
        """Return an axis of `count` functions with full supports, the i-th centered at origin + i spacing."""
        return cls(origin + spacing * (np.arange(count + order, dtype=np.float64) - order / 2.0), order)

    @classmethod
    def at_positions(cls, positions: ArrayLike, order: int = 1) -> SplineAxis:
        """Return an axis with one function of full support around each sample. ValueError unless positions ascend."""
        x = float_array("positions", positions, "n")
        if len(x) < 2 or not np.isfinite(x).all() or not (np.diff(x) > 0.0).all():
            raise ValueError("positions must ascend")
        steps = np.arange(1, (order + 1) // 2 + 1)
        x = np.concatenate([x[0] - (x[1] - x[0]) * steps[::-1], x, x[-1] + (x[-1] - x[-2]) * steps])
        return cls(x if order % 2 == 0 else x[:-1] + np.diff(x) / 2.0, order)

    @property
    def count(self) -> int:
        """The number of functions, and so of coefficients."""
        return len(self.knots) - self.order

    @property
    def center(self) -> float:
        """The middle of the knots."""
        return float((self.knots[0] + self.knots[-1]) / 2.0)

    @property
    def width(self) -> float:
        """The widest support."""
        return float((self.knots[self.order :] - self.knots[: -self.order]).max())

    def reach(self, center: float) -> float:
        """Return the largest |t - center| in any support."""
        return float(np.abs(self.knots[[0, -1]] - center).max())

    def table(self, degree: int, center: float = 0.0) -> NDArray[np.float64]:
        """Return (degree + 1, count) ∫ (t - center)^l B_i(t) dt; `rounding_counts` bounds their roundings."""
        return full_support_integrals(self.knots - center, self.order, degree)

    def rounding_counts(self, degree: int) -> int:
        """Return the bound of a table entry's error in units of rounding, see `table`."""
        return 2 * (self.order + 1) + 3 * degree + 6


def full_support_integrals(knots: ArrayLike, order: int, degree: int) -> NDArray[np.float64]:
    """Return (degree + 1, n) ∫ t^l B_i over full supports, by the closed form; knots may be repeated."""
    knots = np.asarray(knots, np.float64)
    count = len(knots) - order
    h = np.zeros((degree + 1, count))
    h[0] = 1.0
    for j in range(order + 1):  # times the series of 1 / (1 - t z)
        for power in range(1, degree + 1):
            h[power] += knots[j : j + count] * h[power - 1]
    h *= (knots[order:] - knots[:count]) / order
    for power in range(1, degree + 1):
        h[power] /= math.comb(order + power, power)
    return h
