# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables 2 and 3 of Soldea, Elber and Rivlin beside the numbers of core/density/spline_grid.py.

    python3 tests/project.py tables

What the paper leaves unsaid, and its Analytic columns fix: the unit is the patch's width W; samples
stand at (i - N/2) h, h = W / N; a sample is 1 strictly inside of the body, else 0; splines are
cubic with full supports. Its printed numbers are C++'s six digits, rounded again by hand.
"Discrete" is the sum over the samples as points.

The trivariate column differs from the discrete one by M k h² / 6 in each moment, the spread of the
splines, and by nothing else: that it is nearer to the analytic column is this constant partly
making up for the strict inequality.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, ROUND_HALF_UP, Decimal

import numpy as np

if "body_moments" not in sys.modules:
    from loading import load_checkout

    load_checkout()

from body_moments.core.density.spline_grid import grid_moments
from body_moments.core.inertia.mass_properties import MassProperties


@dataclass(frozen=True)
class Row:
    """One row of the paper. width: W; samples: N across W; radius and height in the same unit,
    height 0 for a sphere. printed: the columns as printed, for each method mass, I_xx and, of a
    cylinder, I_zz.
    """

    name: str
    width: int
    samples: int
    radius: int
    height: int
    printed: dict[str, tuple[str, ...]]

    @property
    def spacing(self) -> float:
        return self.width / self.samples

    @property
    def shape(self) -> tuple[int, int, int]:
        depth = 1 if not self.height else 4 if self.width == 4 else 2
        return self.samples, self.samples, self.samples * depth

    def grid(self) -> np.ndarray:
        """The samples, as uint8."""
        x, y, z = ((np.arange(n) - n // 2) * self.spacing for n in self.shape)
        across = x[:, None, None] ** 2 + y[:, None] ** 2
        if not self.height:
            return (across + z**2 < self.radius**2).astype(np.uint8)
        return ((across < self.radius**2) & (np.abs(z) < self.height / 2)).astype(np.uint8)

    def trivariate(self, grid: np.ndarray, spline_order: int = 4) -> tuple[float, ...]:
        """Mass, I_xx and I_zz, all about the center of mass."""
        matrix = np.diag([self.spacing] * 3 + [1.0])
        matrix[:3, 3] = -self.spacing * np.array(self.shape) / 2
        body = MassProperties.from_moments(grid_moments(grid, grid.shape, matrix, spline_order))
        return self._told(body.mass, body.inertia[0, 0], body.inertia[2, 2])

    def discrete(self, grid: np.ndarray) -> tuple[float, ...]:
        """Return the moments of the samples as points, in exact integers."""
        i, j, k = (np.arange(n) - n // 2 for n in grid.shape)
        planes = grid.sum(axis=2, dtype=np.int64)
        second = [
            int((planes.sum(axis=1) * i**2).sum()),
            int((planes.sum(axis=0) * j**2).sum()),
            int((grid.sum(axis=(0, 1), dtype=np.int64) * k**2).sum()),
        ]
        return self._told(
            int(planes.sum()) * self.spacing**3,
            (second[1] + second[2]) * self.spacing**5,
            (second[0] + second[1]) * self.spacing**5,
        )

    def analytic(self) -> tuple[float, ...]:
        r, h = self.radius, self.height
        if not h:
            mass = 4.0 / 3.0 * math.pi * r**3
            return self._told(mass, 0.4 * mass * r**2, 0.4 * mass * r**2)
        mass = math.pi * r**2 * h
        return self._told(mass, mass * (3 * r**2 + h**2) / 12, mass * r**2 / 2)

    def _told(self, mass: float, across: float, along: float) -> tuple[float, ...]:
        return (mass, across, along) if self.height else (mass, across)


def _row(name: str, width: int, samples: int, radius: int, height: int, *columns: str) -> Row:
    third = len(columns) // 3
    printed = {
        method: columns[i * third : (i + 1) * third]
        for i, method in enumerate(("trivariate", "discrete", "analytic"))
    }
    return Row(name, width, samples, radius, height, printed)


ROWS = (
    _row("S1", 6, 24, 3, 0, "111.30", "400.9", "111.30", "396.3", "113.10", "407.2"),
    _row("S2", 6, 48, 3, 0, "112.79", "406.5", "112.79", "405.3", "113.10", "407.2"),
    _row("S3", 6, 96, 3, 0, "112.98", "406.7", "112.98", "406.4", "113.10", "407.2"),
    _row("S4", 32, 128, 4, 0, "266.73", "1712", "266.73", "1701", "268.08", "1716"),
    _row("S5", 32, 128, 8, 0, "2141.6", "54860", "2141.6", "54771", "2144.7", "54903"),
    _row("S6", 32, 128, 16, 0, "17155", "1757e3", "17155", "1756e3", "17157", "1757e3"),
    _row(
        "C1",
        4,
        16,
        2,
        16,
        "189.98",
        "4117",
        "372.6",
        "189.98",
        "4109",
        "364.7",
        "201.06",
        "4490",
        "402.1",
    ),
    _row(
        "C2",
        4,
        32,
        2,
        16,
        "196.70",
        "4327",
        "389.9",
        "196.70",
        "4325",
        "387.9",
        "201.06",
        "4490",
        "402.1",
    ),
    _row(
        "C3",
        4,
        64,
        2,
        16,
        "199.53",
        "4423",
        "398.1",
        "199.5",
        "4422",
        "397.6",
        "201.06",
        "4490",
        "402.1",
    ),
    _row(
        "C4",
        32,
        128,
        4,
        16,
        "780.61",
        "19244",
        "6189",
        "780.61",
        "19211",
        "6157",
        "804.25",
        "20374",
        "6434",
    ),
    _row(
        "C5",
        32,
        128,
        8,
        32,
        "6359.9",
        "6359e2",
        "2030e2",
        "6359.9",
        "6356e2",
        "2028e2",
        "6434",
        "6520e2",
        "2059e2",
    ),
    _row(
        "C6",
        32,
        128,
        16,
        64,
        "51195",
        "2061e4",
        "6546e3",
        "51195",
        "2061e4",
        "6543e3",
        "51472",
        "2086e4",
        "6588e3",
    ),
)


def as_printed(value: float, printed: str) -> str:
    """The value written as the paper writes it: six digits as C++ prints them, then rounded to the
    digits of `printed`.
    """
    six = Decimal(value)
    six = six.quantize(Decimal((0, (1,), six.adjusted() - 5)), ROUND_HALF_EVEN)
    exponent = int(printed.partition("e")[2] or 0)
    digits = len(printed.partition("e")[0].partition(".")[2])
    mantissa = six.scaleb(-exponent).quantize(Decimal((0, (1,), -digits)), ROUND_HALF_UP)
    return "{:f}{:s}".format(mantissa, "e{:d}".format(exponent) if exponent else "")


def main() -> int:
    """Print every cell; 1 where one is not the paper's."""
    wrong = 0
    for title, rows, names in (
        ("Table 2: spheres", ROWS[:6], ("mass", "I_xx = I_yy = I_zz")),
        ("Table 3: cylinders", ROWS[6:], ("mass", "I_xx = I_yy", "I_zz")),
    ):
        print(title)
        print(
            "{:>4s}{:>16s}{:>10s}  {:<12s}{:<20s}{:>24s}{:>12s}{:>12s}".format(
                "row", "patch", "samples", "method", "", "ours", "as printed", "paper"
            )
        )
        for row in rows:
            grid = row.grid()
            count = int(grid.sum(dtype=np.int64))
            for method, values in (
                ("trivariate", row.trivariate(grid)),
                ("discrete", row.discrete(grid)),
                ("analytic", row.analytic()),
            ):
                for name, value, printed in zip(names, values, row.printed[method]):
                    ours = as_printed(value, printed)
                    wrong += ours != printed
                    print(
                        "{:>4s}{:>16s}{:>10d}  {:<12s}{:<20s}{:>24.15g}{:>12s}{:>12s}{:s}".format(
                            row.name,
                            "x".join(map(str, row.shape)),
                            count,
                            method,
                            name,
                            value,
                            ours,
                            printed,
                            "" if ours == printed else "  differs",
                        )
                    )
        print()
    cells = sum(len(columns) for row in ROWS for columns in row.printed.values())
    print("{:d} of {:d} cells are the paper's.".format(cells - wrong, cells))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
