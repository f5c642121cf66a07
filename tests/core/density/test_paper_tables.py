# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables 2 and 3 of Soldea, Elber and Rivlin, cell by cell: counts, then numbers, then strings."""

import pytest

from tools.paper_tables import ROWS, as_printed, main

COUNTS = {
    "S1": 7123,
    "S2": 57747,
    "S3": 462751,
    "S4": 17071,
    "S5": 137059,
    "S6": 1097911,
    "C1": 193 * 63,
    "C2": 793 * 127,
    "C3": 3205 * 255,
    "C4": 793 * 63,
    "C5": 3205 * 127,
    "C6": 12849 * 255,
}
# mass, discrete moments, trivariate moments; exact but for the last ones' thirds
NUMBERS = {
    "S1": (111.296875, (396.3046875,), (400.942057291666667,)),
    "S4": (266.734375, (1701.234375,), (1712.348307291666667,)),
    "S5": (2141.546875, (54770.796875,), (54860.02799479166667,)),
    "S6": (17154.859375, (1756491.46875,), (1757206.25455729166667,)),
    "C1": (189.984375, (4108.69921875, 364.7109375), (4116.615234375, 372.626953125)),
    "C6": (
        51195.234375,
        (20609802.24609375, 6543365.7421875),
        (20611935.380859375, 6545498.876953125),
    ),
}


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_every_cell_of_the_paper_is_reproduced(row):
    grid = row.grid()
    count = int(grid.sum(dtype=int))
    assert count == COUNTS[row.name]
    trivariate, discrete = row.trivariate(grid), row.discrete(grid)
    mass = count * row.spacing**3
    smoothing = mass * 4 * row.spacing**2 / 6
    assert trivariate[0] == pytest.approx(mass, rel=1e-12)
    assert trivariate[1:] == pytest.approx([value + smoothing for value in discrete[1:]], rel=1e-12)
    if row.name in NUMBERS:
        mass, points, smooth = NUMBERS[row.name]
        assert discrete == (mass, *points)
        assert trivariate == pytest.approx((mass, *smooth), rel=1e-12)
    for method, values in (
        ("trivariate", trivariate),
        ("discrete", discrete),
        ("analytic", row.analytic()),
    ):
        assert tuple(map(as_printed, values, row.printed[method])) == row.printed[method]


@pytest.mark.parametrize("order", [1, 2, 3, 5])
def test_only_the_cubic_order_matches_the_paper(order):
    row = ROWS[0]
    assert as_printed(row.trivariate(row.grid(), order)[1], "400.9") != "400.9"


def test_the_command_prints_all_cells(capsys):
    assert main() == 0
    assert "90 of 90 cells are the paper's." in capsys.readouterr().out
