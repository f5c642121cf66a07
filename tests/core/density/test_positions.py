# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids of unevenly spaced samples: their moments against rational arithmetic, their knots, their
files.
"""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density import grid_moments
from body_moments.core.density.spline_grid import SplineAxis
from body_moments.core.moments.raw import monomials
from body_moments.core.scans.formats import place_samples, read_all_positions, read_positions
from body_moments.core.verdict import FileError, finding
from body_moments.tests.close import close

SHAPE = (3, 4, 5)
POSITIONS = (
    np.array([-0.75, 0.5, 1.0]),
    None,
    np.array([10.0, 10.125, 12.0, 12.5, 17.0]),
)


def exact_knots(row, order):
    """Positions for even orders, middles of them for odd ones; beyond the ends the last distance
    again.
    """
    x = [Fraction(float(value)) for value in row]
    first, last, n = x[1] - x[0], x[-1] - x[-2], len(x)

    def at(i):
        if i < 0:
            return x[0] + i * first
        return x[i] if i < n else x[-1] + (i - n + 1) * last

    if order % 2 == 0:
        return [at(i - order // 2) for i in range(n + order)]
    return [(at(i - (order + 1) // 2) + at(i - (order - 1) // 2)) / 2 for i in range(n + order)]


def exact_table(knots, order, degree):
    """∫ t^l B_i(t) dt with B_i as polynomials on each span, by the recursion of Cox and de Boor."""
    count = len(knots) - order
    table = [[Fraction(0)] * count for _ in range(degree + 1)]
    for j in range(len(knots) - 1):
        low, high = knots[j], knots[j + 1]
        if low == high:
            continue
        rows = {i: [Fraction(int(i == j))] for i in range(len(knots) - 1)}
        for k in range(2, order + 1):
            found = {}
            for i in range(len(knots) - k):
                total = [Fraction(0)] * k
                for source, sign, origin, width in (
                    (rows[i], 1, knots[i], knots[i + k - 1] - knots[i]),
                    (rows[i + 1], -1, knots[i + k], knots[i + k] - knots[i + 1]),
                ):
                    for power, value in enumerate(source):
                        if value and width:
                            total[power + 1] += sign * value / width
                            total[power] -= sign * value * origin / width
                found[i] = total
            rows = found
        for i in range(count):
            for power, value in enumerate(rows[i]):
                for degree_of_t, row in enumerate(table):
                    n = power + degree_of_t + 1
                    row[i] += value * (high**n - low**n) / n
    return table


def exact_moments(samples, positions, spline_order, order):
    """About the origin, by exponents."""
    tables = []
    for axis, row in enumerate(positions):
        row = np.arange(samples.shape[axis]) if row is None else row
        tables.append(exact_table(exact_knots(row, spline_order), spline_order, order))
    found = {}
    for exponents in monomials(order).tolist():
        total = Fraction(0)
        for index, value in np.ndenumerate(samples):
            if value:
                product = Fraction(float(value))
                for table, power, i in zip(tables, exponents, index):
                    product *= table[power][i]
                total += product
        found[tuple(exponents)] = total
    return found


@pytest.mark.parametrize("spline_order", [1, 2, 3, 4, 5])
def test_moments_match_rational_arithmetic_within_bounds(spline_order):
    samples = np.random.default_rng(spline_order).integers(0, 9, SHAPE).astype(float)
    order = 6
    found = grid_moments(
        samples, SHAPE, np.eye(4), spline_order, order, positions=POSITIONS
    ).about_point(np.zeros(3))
    truth = exact_moments(samples, POSITIONS, spline_order, order)
    for value, bound, exponents in zip(found.raw, found.rounding_error, monomials(order).tolist()):
        exact = truth[tuple(exponents)]
        assert abs(Fraction(float(value)) - exact) <= Fraction(float(bound))
        assert close(float(value), float(exact), 1e-11)
    assert found.rounding_error[0] <= 1e-12 * found.total


def test_high_orders_of_moments_and_of_splines():
    samples = np.random.default_rng(7).integers(1, 9, (2, 2, 4)).astype(float)
    positions = (None, np.array([0.0, 3.0]), np.array([-1.0, -0.5, 0.0, 2.0]))
    for spline_order, order in ((1, 20), (2, 20), (4, 20), (16, 2)):
        found = grid_moments(
            samples, samples.shape, np.eye(4), spline_order, order, positions=positions
        )
        exact = exact_moments(samples, positions, spline_order, 2)
        about = found.about_point(np.zeros(3))
        for exponents in monomials(2).tolist():
            index = int(np.flatnonzero((monomials(order) == exponents).all(axis=1))[0])
            assert close(about.raw[index], float(exact[tuple(exponents)]), 1e-12)
    exact = exact_moments(samples, positions, 4, 12)
    found = grid_moments(samples, samples.shape, np.eye(4), 4, 12, positions=positions).about_point(
        np.zeros(3)
    )
    wrong = [
        abs(Fraction(float(value)) - exact[tuple(exponents)]) > Fraction(float(bound))
        for value, bound, exponents in zip(found.raw, found.rounding_error, monomials(12).tolist())
    ]
    assert not any(wrong)


@pytest.mark.parametrize("spline_order", range(1, 17))
def test_even_positions_match_the_uniform_grid(spline_order):
    samples = np.random.default_rng(1).uniform(0, 1, SHAPE)
    plain = grid_moments(samples, SHAPE, np.diag([2.0, 3.0, 0.5, 1.0]), spline_order)
    rows = tuple(np.arange(count) * step for count, step in zip(SHAPE, (2.0, 3.0, 0.5)))
    found = grid_moments(samples, SHAPE, np.eye(4), spline_order, positions=rows).about_point(
        plain.about
    )
    assert np.abs(found.raw - plain.raw).max() <= 1e-13 * np.abs(plain.raw).max()
    assert np.array_equal(
        SplineAxis.at_positions(np.arange(5), spline_order).knots,
        SplineAxis.uniform(5, spline_order).knots,
    )


def test_density_linear_between_samples_matches_trilinear_spline():
    """With order 2 the spline goes through the samples, however far apart they are."""
    rows = [np.cumsum(np.random.default_rng(axis).uniform(0.1, 2.0, 6)) for axis in range(3)]
    axis = SplineAxis.at_positions(rows[0], 2)
    assert np.array_equal(axis.knots[1:-1], rows[0])
    cells = SplineAxis.at_positions(rows[0], 1)
    assert (cells.knots[1:-1] > rows[0][:-1]).all() and (cells.knots[1:-1] < rows[0][1:]).all()


@pytest.mark.parametrize("wrong", [[1.0], [], [0.0, 0.0], [1.0, 0.0], [0.0, np.nan], [0.0, np.inf]])
def test_wrong_positions_raise_value_error(wrong):
    with pytest.raises(ValueError, match="positions must ascend"):
        SplineAxis.at_positions(wrong)


def test_positions_of_another_count_raise_value_error():
    with pytest.raises(ValueError):
        grid_moments(np.ones(SHAPE), SHAPE, np.eye(4), positions=(None, None, [0.0, 1.0]))


def test_far_away_positions_keep_their_digits():
    """A grid a million units away: moments about its own center are those of one at the origin."""
    near = np.array([0.0, 0.25, 1.0, 1.5])
    samples = np.random.default_rng(2).integers(1, 9, (2, 2, 4)).astype(float)
    results = []
    for distance in (0.0, 2.0**20):
        matrix, relative = place_samples(np.eye(4), (None, None, near + distance), 1.0)
        found = grid_moments(samples, samples.shape, matrix, 4, 3, positions=relative)
        assert found.center[2] > distance
        results.append(found.about_center().raw)
    assert np.abs(results[0] - results[1]).max() <= 1e-9 * np.abs(results[0]).max()
    assert close(results[0][0], results[1][0], 1e-14)


def test_positions_follow_the_axes_directions():
    turn = np.array(
        [[0.0, -2.0, 0.0, 5.0], [3.0, 0.0, 0.0, 6.0], [0.0, 0.0, -0.5, 7.0], [0.0, 0.0, 0.0, 1.0]]
    )
    matrix, (x, y, z) = place_samples(
        turn, (None, np.array([4.0, 5.0]), np.array([1.0, 2.0, 4.0])), 0.5
    )
    assert x is None and y.tolist() == [0.0, 1.0] and z.tolist() == [0.0, 1.0, 3.0]
    assert np.array_equal(matrix @ (0, 1, 3, 1), [-2.5, 6.0, -2.0, 1.0])
    assert np.array_equal(matrix @ (1, 0, 0, 1), [-2.0, 9.0, -0.5, 1.0])


def test_positions_are_read_for_any_axes():
    rng = np.random.default_rng(4)
    matrix = np.eye(4)
    matrix[:3] = rng.normal(size=(3, 4))
    rows = tuple(np.cumsum(rng.uniform(0.1, 1.0, count)) for count in SHAPE)
    placed, relative = place_samples(matrix, rows, 0.25)
    directions = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    for place in np.ndindex(SHAPE):
        found = placed @ [*(row[i] for row, i in zip(relative, place)), 1.0]
        truth = directions @ [0.25 * row[i] for row, i in zip(rows, place)]
        assert np.abs(found[:3] - truth).max() <= 1e-14
    same, none = place_samples(matrix, (None, None, None), 0.25)
    assert (same == matrix).all() and same is not matrix and none == (None, None, None)


def saved(tmp_path, array, name="z.npy"):
    np.save(tmp_path / name, array)
    return tmp_path / name


@pytest.mark.parametrize(
    "array, code, values",
    [
        (np.array([0.0, 1.0, 1.0]), "positions_not_ascending", {"axis": "z", "place": 2}),
        (np.array([0.0, -2.0, 1.0]), "positions_not_ascending", {"axis": "z", "place": 1}),
        (np.array([0.0, np.nan, np.nan]), "positions_not_ascending", {"axis": "z", "place": 1}),
        (np.array([0.0, 1.0, np.inf]), "positions_not_ascending", {"axis": "z", "place": 2}),
        (
            np.array([0.0, 1.0]),
            "positions_count",
            {"axis": "z", "array": "2 float64", "samples": 3},
        ),
        (
            np.zeros((3, 1)),
            "positions_count",
            {"axis": "z", "array": "3 x 1 float64", "samples": 3},
        ),
        (
            np.array(["0", "1", "2"]),
            "positions_count",
            {"axis": "z", "array": "3 <U1", "samples": 3},
        ),
        (
            np.array([0.0, 1.0, 2j]),
            "positions_count",
            {"axis": "z", "array": "3 complex128", "samples": 3},
        ),
        (
            np.array([0, 1, 2], object),
            "file_damaged",
            {
                "cause": {
                    "code": "damage_incomplete",
                    "values": {"kind": "NumPy array", "error": "ValueError"},
                }
            },
        ),
    ],
)
def test_wrong_position_files_are_refused(tmp_path, array, code, values):
    path = saved(tmp_path, array)
    with pytest.raises(FileError) as caught:
        read_positions(path, "z", 3)
    assert caught.value.finding == finding(
        code, file="z.npy", **values
    ) and caught.value.reason.endswith(".")


def test_missing_text_and_damaged_files_are_refused(tmp_path):
    for name, content in (
        ("a.npy", None),
        ("b.npy", b"0 1 2\n"),
        ("c.npy", b""),
        ("d.npy", b"\x93NUMPY\1\0"),
    ):
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(FileError) as caught:
            read_positions(tmp_path / name, "z", 3)
        assert caught.value.reason.endswith(".")
    path = saved(tmp_path, np.arange(3.0), "e.npy")
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(FileError):
        read_positions(path, "z", 3)


def test_whole_numbers_two_samples_and_one(tmp_path):
    path = saved(tmp_path, np.array([0, 1, 5], np.int16))
    assert read_positions(path, "z", 3).tolist() == [0.0, 1.0, 5.0]
    for axis, other in (("x", 1), ("y", 2), ("z", 0)):
        rows = read_all_positions({axis: path}, (3, 3, 3))
        assert rows["xyz".index(axis)].tolist() == [0.0, 1.0, 5.0] and rows[other] is None
        assert sum(row is None for row in rows) == 2
    assert read_positions(saved(tmp_path, np.array([1.0, 4.0]), "two.npy"), "x", 2).tolist() == [
        1.0,
        4.0,
    ]
    with pytest.raises(FileError) as caught:
        read_positions(saved(tmp_path, np.array([1.0]), "one.npy"), "x", 1)
    assert caught.value.finding.code == "positions_count"
