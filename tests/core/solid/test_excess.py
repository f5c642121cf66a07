# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Excess volume along lines with crossings made by hand."""

import numpy as np
import pytest
from body_moments.core.mesh.scan_lines import Crossings, LineGrids
from body_moments.core.solid.self_intersection import measure_excess

from tests.close import close

# row and column of each line, and its entries (1) and exits (-1)
LINES = {
    (0, 0): [(-1.0, 1)],  # a hole
    (0, 1): [(-2.0, 1), (-1.0, 1), (1.5, -1), (2.0, -1)],  # twice for 2.5
    (1, 0): [(-1.0, 1), (1.0, -1)],
    (1, 1): [(-1.0, -1), (0.5, 1)],  # inside out for 1.5
    (2, 1): [
        (-1.0, 1),
        (0.0, 1),
        (0.0625, -1),
        (1.0, -1),
    ],  # twice for as little as counts for nothing
    (2, 2): [(-3.0, 1), (-2.0, 1), (-1.0, 1), (1.0, -1), (2.0, -1), (3.0, -1)],  # up to three times
}


def crossings(parts=1, turned=1, order=None, apart=1):
    rows = [
        (row, column, part, along, turned * sign)
        for (row, column), ends in LINES.items()
        for part in range(parts)
        for along, sign in ends
    ]
    rows = [rows[k] for k in (range(len(rows)) if order is None else order)]
    row, column, triangle, along, sign = (np.array(values) for values in zip(*rows))
    return Crossings(
        np.zeros(len(rows), np.intp), row, column, triangle, along, sign, np.array([apart])
    )


@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("parts, apart", [(1, 1), (2, 1), (1, 3)])
@pytest.mark.parametrize("seed", [None, 0, 1])
def test_repeated_body_is_measured_part_by_part(turned, parts, apart, seed):
    grids = LineGrids.over_boxes(
        np.array([[-4.0, -2.0, -3.0]]), np.array([[4.0, 2.0, 3.0]]), np.array([64])
    )
    count = parts * sum(map(len, LINES.values()))
    order = None if seed is None else np.random.default_rng(seed).permutation(count)
    part = np.arange(parts) if parts > 1 else None
    found = measure_excess(crossings(parts, turned, order, apart), grids, np.array([0.0625]), part)
    area = float(np.prod(grids.cell[0])) * apart * parts
    assert close(found.volume[0], (2.5 + 1.5 + 1.0 + 2.0 * 2.0 + 1.0) * area, rel=1e-12)
    assert close(found.unsure[0], 1.0 / 6.0, rel=1e-12)
    second = 0.0
    for row, column, low, high, times in (
        (0, 1, -1.0, 1.5, 1),
        (1, 1, -1.0, 0.5, 1),
        (2, 2, -2.0, -1.0, 1),
        (2, 2, -1.0, 1.0, 2),
        (2, 2, 1.0, 2.0, 1),
    ):
        at = (
            np.zeros(1, np.intp),
            np.array([row]),
            np.array([column]),
            np.array([(low + high) / 2.0]),
        )
        second += times * (high - low) * area * grids.squared_distances(*at)[0]
    assert close(found.second_moment[0], second, rel=1e-12)


def test_lines_meeting_nothing_are_ignored():
    grids = LineGrids.over_boxes(np.zeros((2, 3)), np.ones((2, 3)), np.array([64, 64]))
    none = np.empty(0, np.intp)
    found = measure_excess(
        Crossings(none, none, none, none, np.empty(0), none, np.ones(2, np.intp)),
        grids,
        np.zeros(2),
    )
    assert (found.volume.tolist(), found.unsure.tolist()) == ([0.0, 0.0], [1.0, 1.0])
    assert found.second_moment.tolist() == [0.0, 0.0]
