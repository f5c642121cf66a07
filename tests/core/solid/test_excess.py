# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lines measure of what counts more than once, or less than not at all: crossings made by hand."""

import numpy as np
import pytest
from body_moments.core.mesh.scan_lines import Crossings, LineGrids
from body_moments.core.solid.self_intersection import measure_excess

from tests.close import close

# of each line the row and the column, and where it enters (1) and leaves (-1)
LINES = {
    (0, 0): [(-1.0, 1)],  # a hole
    (0, 1): [(-2.0, 1), (-1.0, 1), (1.5, -1), (2.0, -1)],  # twice for 2.5
    (1, 0): [(-1.0, 1), (1.0, -1)],
    (1, 1): [(-1.0, -1), (0.5, 1)],  # inside out for 1.5
    (2, 1): [(-1.0, 1), (0.0, 1), (0.0625, -1), (1.0, -1)],  # twice for as little as counts for nothing
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
    return Crossings(np.zeros(len(rows), np.intp), row, column, triangle, along, sign, np.array([apart]))


@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("parts, apart", [(1, 1), (2, 1), (1, 3)])
@pytest.mark.parametrize("seed", [None, 0, 1])
def test_what_is_there_more_than_once_is_measured_part_by_part(turned, parts, apart, seed):
    grids = LineGrids.over_boxes(np.array([[-4.0, -2.0, -3.0]]), np.array([[4.0, 2.0, 3.0]]), np.array([64]))
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
        at = np.zeros(1, np.intp), np.array([row]), np.array([column]), np.array([(low + high) / 2.0])
        second += times * (high - low) * area * grids.squared_distances(*at)[0]
    assert close(found.second_moment[0], second, rel=1e-12)


def test_lines_that_meet_nothing_say_nothing():
    grids = LineGrids.over_boxes(np.zeros((2, 3)), np.ones((2, 3)), np.array([64, 64]))
    none = np.empty(0, np.intp)
    found = measure_excess(
        Crossings(none, none, none, none, np.empty(0), none, np.ones(2, np.intp)), grids, np.zeros(2)
    )
    assert (found.volume.tolist(), found.unsure.tolist()) == ([0.0, 0.0], [1.0, 1.0])
    assert found.second_moment.tolist() == [0.0, 0.0]


@pytest.mark.parametrize("crossed", [0, 1])
def test_bodies_are_measured_one_by_one_and_of_those_that_no_line_meets_nothing_is_known(crossed):
    low, high = np.zeros((2, 3)), np.array([[1.0, 2.0, 3.0], [8.0, 6.0, 4.0]])
    grids = LineGrids.over_boxes(low, high, np.array([64, 64]))
    one = crossings()
    moved = Crossings(one.body + crossed, one.row, one.column, one.triangle, one.along, one.sign, np.ones(2, np.intp))
    found = measure_excess(moved, grids, np.array([0.0625, 0.0625]))
    truth, unsure = np.zeros(2), np.ones(2)
    truth[crossed], unsure[crossed] = 10.0 * np.prod(grids.cell[crossed]), 1.0 / 6.0
    assert close(found.volume, truth, rel=1e-12) and close(found.unsure, unsure, rel=1e-12)
    assert (found.second_moment > 0.0).tolist() == [crossed == 0, crossed == 1]


@pytest.mark.parametrize("signs, unsure", [([1, -1], 0.0), ([1, 1], 1.0), ([1], 1.0), ([1, -1, 1], 1.0)])
def test_a_single_line_is_sure_where_it_leaves_as_often_as_it_enters(signs, unsure):
    grids = LineGrids.over_boxes(np.zeros((1, 3)), np.ones((1, 3)), np.array([64]))
    zero, along = np.zeros(len(signs), np.intp), np.linspace(-0.5, 0.5, len(signs))
    found = measure_excess(
        Crossings(zero, zero, zero, zero, along, np.array(signs), np.ones(1, np.intp)), grids, np.zeros(1)
    )
    assert (found.volume.tolist(), found.unsure.tolist()) == ([0.0], [unsure])


def test_where_as_much_is_inside_as_is_inside_out_neither_is_too_much():
    grids = LineGrids.over_boxes(np.zeros((1, 3)), np.ones((1, 3)), np.array([64]))
    zero = np.zeros(4, np.intp)
    along, sign = np.array([-1.0, 0.5, -1.0, 0.5]), np.array([1, -1, -1, 1])
    both = Crossings(zero, zero, np.array([0, 0, 1, 1]), zero, along, sign, np.array([1]))
    found = measure_excess(both, grids, np.zeros(1))
    assert (found.volume.tolist(), found.unsure.tolist()) == ([0.0], [0.0])
