# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments add, scale and map exactly; their bounds hold.

The oracle is rational arithmetic on boxes and simplices.
"""

import math
import re
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia import MassProperties, pose_matrix
from body_moments.core.moments import are_similarities, normalize, sum_of_images
from body_moments.core.moments.raw import (
    Measure,
    Moments,
    U,
    monomial_count,
    monomial_index,
    monomials,
    sum_moments,
)

from tests.close import close
from tests.core.findings import refused

ORDER = 4


def box_moments(low, high, order=ORDER, about=(0, 0, 0)):
    """Exact: the product of one-dimensional integrals."""

    def one(i, n):
        a, b = Fraction(low[i]) - Fraction(about[i]), Fraction(high[i]) - Fraction(about[i])
        return (b ** (n + 1) - a ** (n + 1)) / (n + 1)

    return [one(0, p) * one(1, q) * one(2, r) for p, q, r in monomials(order).tolist()]


def simplex_moments(order=ORDER):
    """Exact: p! q! r! / (p+q+r+3)! over the unit simplex."""
    f = math.factorial
    return [Fraction(f(p) * f(q) * f(r), f(p + q + r + 3)) for p, q, r in monomials(order).tolist()]


def mapped_exactly(exact, matrix, about, order=ORDER):
    """The image of exact moments (about 0) under an affine map, by expanding the polynomials term
    by term.
    """
    linear = [[Fraction(float(x)) for x in row] for row in np.asarray(matrix)[:3, :3]]
    offset = [
        Fraction(float(t)) - Fraction(float(o)) for t, o in zip(np.asarray(matrix)[:3, 3], about)
    ]
    det = sum(
        linear[0][i]
        * (
            linear[1][(i + 1) % 3] * linear[2][(i + 2) % 3]
            - linear[1][(i + 2) % 3] * linear[2][(i + 1) % 3]
        )
        for i in range(3)
    )

    def times(polynomial, i):
        out = {}
        for key, value in polynomial.items():
            for axis in range(4):
                factor = offset[i] if axis == 3 else linear[i][axis]
                new = tuple(k + (a == axis) for a, k in enumerate(key))
                out[new] = out.get(new, 0) + value * factor
        return out

    image = []
    for powers in monomials(order).tolist():
        polynomial = {(0, 0, 0): Fraction(1)}
        for i, n in enumerate(powers):
            for _ in range(n):
                polynomial = times(polynomial, i)
        image.append(
            abs(det) * sum(value * exact[monomial_index(*key)] for key, value in polynomial.items())
        )
    return image


def floats(exact, about=(0, 0, 0), of="volume"):
    return Moments(
        np.array([float(x) for x in exact]),
        np.array(about, float),
        of,
        rounding_error=np.array([float(abs(Fraction(float(x)) - x)) for x in exact]),
    )


def assert_within_bound(moments, exact):
    off = [abs(Fraction(float(value)) - true) for value, true in zip(moments.raw, exact)]
    assert all(delta <= Fraction(float(bound)) for delta, bound in zip(off, moments.rounding_error))


def test_monomial_order_matches_index():
    table = monomials(6)
    assert len(table) == monomial_count(6) == 84
    assert [monomial_index(*row) for row in table.tolist()] == list(range(84))
    expected = ["000", "100", "010", "001", "200", "110", "101", "020", "011", "002"]
    assert ["{}{}{}".format(*row) for row in table[:10].tolist()] == expected


MAPS = {
    "rotation": [[0.6, -0.8, 0, 3], [0.8, 0.6, 0, -2], [0, 0, 1, 1]],
    "mirror": [[-1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0]],
    "shear": [[1, 0.75, 0, 0], [0, 1, -0.3, 0], [0, 0, 1, 2]],
    "uneven": [[2, 0, 0, 0], [0, 0.1, 0, 0], [0, 0, 30, 0]],
    "flat": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]],
    "far": [[1, 0, 0, 1e6], [0, 1, 0, -2e6], [0, 0, 1, 3e6]],
    "tiny": [[1e-9, 0, 0, 1e-9], [0, 1e-9, 0, 0], [0, 0, 1e-9, 0]],
    "random": np.random.default_rng(5).normal(size=(3, 4)).tolist(),
}


@pytest.mark.parametrize("order", [ORDER, 9])
@pytest.mark.parametrize("name", MAPS)
def test_an_affine_map_is_exact_within_its_bound(name, order):
    matrix = np.vstack([MAPS[name], [0, 0, 0, 1]])
    exact = simplex_moments(order)
    image = floats(exact).transform(matrix)
    assert np.array_equal(image.about, matrix[:3, 3])
    assert_within_bound(image, mapped_exactly(exact, matrix, image.about, order))
    # Not vacuous: what a few roundings of the positions and of the largest moment amount to.
    if order == ORDER:
        assert image.rounding_error.max() <= 1e-14 * (np.abs(matrix).max() + 1.0) * max(
            np.abs(image.raw).max(), 1e-40
        )
    many = sum_of_images(floats(exact), np.array([matrix, matrix])).about_point(image.about)
    assert (
        np.abs(many.raw - 2.0 * image.raw) <= many.rounding_error + 2.0 * image.rounding_error
    ).all()


def test_a_shift_follows_the_binomial_theorem_and_comes_back():
    exact = box_moments((0, 0, 0), (1, 2, 3))
    body = floats(exact).about_point((0.5, 1, 1.5))
    assert_within_bound(body, box_moments((0, 0, 0), (1, 2, 3), about=(0.5, 1, 1.5)))
    assert_within_bound(body.about_point((0, 0, 0)), exact)
    assert np.allclose(body.about_center().raw[1:4], 0, atol=1e-14)


def test_bodies_add_whatever_points_they_are_about():
    left = floats(box_moments((0, 0, 0), (1, 1, 1), about=(5, 5, 5)), about=(5, 5, 5))
    right = floats(box_moments((1, 0, 0), (2, 1, 1)))
    whole = box_moments((0, 0, 0), (2, 1, 1), about=(5, 5, 5))
    assert_within_bound(left + right, whole)
    assert_within_bound(sum_moments([left, right]), whole)
    assert np.array_equal((left + right).about, (5, 5, 5))


def test_bounds_of_a_sum_are_the_sums_of_the_bounds():
    raw, own = np.arange(1.0, 5.0), np.array([0.5, 0.25, 0.125, 1.0])
    parts = [
        Moments(raw, np.zeros(3), Measure.VOLUME, k * own, 8.0 * k * own) for k in (1.0, 2.0, 4.0)
    ]
    total = sum_moments(parts)
    assert close(total.raw, 3.0 * raw, 0.0) and close(total.input_error, 56.0 * own, 1e-14)
    assert (total.rounding_error >= 7.0 * own).all() and close(
        total.rounding_error, 7.0 * own, 1e-14
    )


def test_instances_are_the_sum_of_their_maps():
    rng = np.random.default_rng(1)
    some = np.tile(np.eye(4), (60, 1, 1))
    some[:, :3] += rng.normal(size=(60, 3, 4))
    which = rng.integers(60, size=1500)  # more than one block of maps
    exact = simplex_moments(3)
    total = sum_of_images(floats(exact), some[which])
    each = [mapped_exactly(exact, m, total.about, 3) for m in some]
    true = [sum(column) for column in zip(*(each[i] for i in which))]
    total = total.truncate(3)
    assert_within_bound(total, true)
    assert np.allclose(
        total.raw, [float(x) for x in true], rtol=1e-13, atol=1e-9 * abs(total.raw).max()
    )


@pytest.mark.parametrize("point", [(0.5, 1.0, 1.5), (-1e-3, 0.0, 0.0), (300.0, -1e4, 7.0)])
def test_shift_at_order_20_is_exact_within_a_tight_bound(point):
    low, high = (-1, -1, -1), (1, 2, 3)
    body = floats(box_moments(low, high, 20))
    shifted = body.about_point(point)
    exact = box_moments(low, high, 20, point)
    assert_within_bound(shifted, exact)
    # the sum of the sizes of the binomial theorem's terms
    reach = np.abs([low, high]).max(axis=0) + np.abs(point)
    largest = 24.0 * np.prod(reach ** monomials(20), axis=1)
    assert (shifted.rounding_error <= 1e-13 * largest).all()


@pytest.mark.parametrize("of", ["volume", "area", "mass"])
def test_a_frame_is_a_turn_about_its_origin(of):
    exact = simplex_moments(7)
    # columns are the axes
    rotation = np.array([[0.6, 0.0, 0.8], [0.8, 0.0, -0.6], [0.0, 1.0, 0.0]])
    body = floats(exact, of=of).in_frame(rotation, (1.0, -2.0, 0.5))
    to_frame = np.eye(4)
    to_frame[:3, :3], to_frame[:3, 3] = rotation.T, rotation.T @ [-1.0, 2.0, -0.5]
    assert body.measure == of and not body.about.any()
    true = mapped_exactly(exact, to_frame, (0, 0, 0), 7)
    scale = np.abs(np.array(true, float)).max()
    assert np.allclose(body.raw, [float(x) for x in true], rtol=1e-13, atol=1e-14 * scale)


def central_box(sides, order):
    """Exact central moments of a box."""
    half = [Fraction(side) / 2 for side in sides]
    return box_moments([-h for h in half], half, order)


@pytest.mark.parametrize("by", ["size", "gyration"])
@pytest.mark.parametrize("size", [1.0, 1e-7, 3e4])
def test_normalized_moments_have_no_unit_and_know_no_place(by, size):
    sides, order = (1, 2, 3), 7
    body = floats(box_moments((5, -3, 2), (6, -1, 5), order)).transform(
        np.diag([size, size, size, 1.0])
    )
    body = Moments(
        body.raw,
        body.about,
        input_error=1e-9 * np.abs(body.raw) * (body.raw > 0),
        rounding_error=body.rounding_error,
    )
    found = normalize(body, by)
    n = monomials(order).sum(axis=1)
    central = np.array([float(x) for x in central_box(sides, order)])
    gyration = np.sqrt(14.0 / 12.0)
    expected = central / 6.0 ** (1 + n / 3) if by == "size" else central / 6.0 / gyration**n
    assert close(found.raw[0], 1.0, rel=1e-14) and not found.about.any()
    assert (np.abs(found.raw - expected) <= found.rounding_error + 1e-14 * np.abs(expected)).all()
    assert np.allclose(found.raw, expected, rtol=1e-7, atol=1e-7)
    assert (found.input_error > 0).any()
    if by == "gyration":
        assert found.raw[[4, 7, 9]].sum() == pytest.approx(1.0, rel=1e-10)


def test_measure_is_one_of_four_names():
    assert Moments(np.ones(1), np.zeros(3), "area").measure is Measure.AREA
    with pytest.raises(ValueError):
        Moments(np.ones(1), np.zeros(3), "weight")


def test_masses_are_normalized_by_their_gyration_as_volumes_are():
    body = floats(box_moments((-1, 0, 1), (2, 1, 4)))
    mass = Moments(body.raw, body.about, Measure.MASS, body.rounding_error, body.input_error)
    found, truth = normalize(mass, "gyration"), normalize(body, "gyration")
    assert (found.raw == truth.raw).all() and found.measure == truth.measure == Measure.MASS
    assert normalize(body).measure == Measure.VOLUME
    for lengths in (mass, Moments(body.raw, body.about, Measure.LENGTH)):
        with pytest.raises(ValueError, match="gyration"):
            normalize(lengths)


def test_areas_are_normalized_to_an_area_of_one():
    body = Moments(np.array([4.0, 0, 0, 0, 8.0, 0, 0, 2.0, 0, 0]), np.zeros(3), "area")
    assert normalize(body).raw[4] == pytest.approx(8.0 / 4.0**2)
    assert normalize(body, "gyration")[2, 0, 0] == pytest.approx(0.8)


@pytest.mark.parametrize("by", ["size", "gyration"])
def test_normalized_bounds_hold_for_bodies_moved_within_theirs(by):
    rng = np.random.default_rng(0)
    exact = np.array([float(x) for x in box_moments((0, 0, 0), (1, 2, 3), 6)])
    for _ in range(50):
        delta = 1e-6 * np.abs(exact) * rng.uniform(-1, 1, len(exact))
        told = normalize(
            Moments(exact + delta, np.zeros(3), rounding_error=np.abs(delta) + 1e-20), by
        )
        true = normalize(Moments(exact, np.zeros(3)), by)
        assert (np.abs(told.raw - true.raw) <= told.rounding_error + true.rounding_error).all()
        assert told.rounding_error.max() < 1e-3


@pytest.mark.parametrize("by", ["size", "gyration"])
@pytest.mark.parametrize("wrong", range(10))
def test_normalized_bounds_hold_for_any_inexact_moment(by, wrong):
    exact = np.array([float(x) for x in box_moments((0, 0, 0), (1, 2, 3), 4, (0.5, 1, 1.5))])
    true = normalize(Moments(exact, np.zeros(3)), by)
    for size in (1e-6, 1e-2):
        delta = np.zeros(len(exact))
        delta[wrong] = size * exact[[0, 0, 0, 0, 4, 4, 4, 7, 7, 9][wrong]]
        for way in (delta, -delta):
            off = normalize(Moments(exact + way, np.zeros(3), rounding_error=np.abs(delta)), by)
            limit = off.rounding_error + true.rounding_error
            away = np.abs(off.raw - true.raw)
            assert (away <= limit).all() and limit.max() < 300.0 * away.max() + 1e-12


def test_moments_without_scale_cannot_be_normalized():
    with refused("normalization_undefined"):
        normalize(Moments(np.zeros(10), np.zeros(3)))


def test_scaling_by_a_density_scales_the_bounds():
    body = floats(simplex_moments())
    heavy = body * 7850.0
    assert_within_bound(heavy, [7850 * x for x in simplex_moments()])
    assert (3.0 * body)[0, 0, 0] == (body * 3.0)[0, 0, 0]
    raw = np.array([4.0, -1.0, 0.0, 2.0])
    found = Moments(raw, np.zeros(3), "volume", 1e-15 * np.ones(4), 1e-9 * np.ones(4)) * -2.5
    assert close(found.rounding_error, 2.5e-15 + 5.0 * U * np.abs(raw), rel=1e-12)
    assert close(found.raw, -2.5 * raw, rel=0.0) and close(found.input_error, 2.5e-9, rel=1e-14)


def test_areas_follow_similarities_only():
    area = Moments(np.ones(10), np.zeros(3), "area")
    doubled = area.transform(np.diag([2.0, -2.0, 2.0, 1.0]))
    assert close(doubled.total, 4.0, rel=1e-14)
    with pytest.raises(ValueError, match="similarity"):
        area.transform(np.diag([2.0, 1.0, 1.0, 1.0]))
    maps = np.array([np.diag([3.0, 3.0, -3.0]), np.diag([1.0, 1.0, 1.001]), np.zeros((3, 3))])
    assert are_similarities(maps).tolist() == [True, False, False]


def test_rounding_bound_holds_the_defect_of_a_float32_map():
    c, s = np.float32(0.6), np.float32(0.8)
    matrix = np.diag([1.0, 1.0, 1.0, 1.0])
    matrix[:2, :2] = [[c, -s], [s, c]]
    area = Moments(np.array([1.0, 0, 0, 0]), np.zeros(3), "area")
    for images, count in (
        (area.transform(matrix), 1),
        (sum_of_images(area, np.stack([matrix] * 3)), 3),
    ):
        for normal in np.eye(3):  # a unit square grows by the map's cofactors
            truth = (
                count
                * np.linalg.det(matrix[:3, :3])
                * np.linalg.norm(np.linalg.inv(matrix[:3, :3]).T @ normal)
            )
            assert (
                abs(images.total - truth) <= images.rounding_error[0] < 1e-6
                and not images.input_error.any()
            )


def test_input_bounds_map_with_the_body():
    body = Moments(
        np.array([1.0, 0, 0, 0]), np.zeros(3), input_error=np.array([1e-7, 2e-7, 2e-7, 2e-7])
    )
    image = body.transform([[2, 0, 0, 10], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]])
    assert close(image.input_error[0], 8e-7, rel=1e-6)
    assert image.about_point((0, 0, 0)).input_error[1] >= 10 * 8e-7


def test_stacked_totals_match_single_bodies():
    stack = Moments(np.arange(8.0).reshape(2, 4), np.zeros((2, 3)))
    assert stack.total.tolist() == [0.0, 4.0] == [stack.at(k).total for k in range(2)]
    assert Moments(np.arange(24.0).reshape(2, 3, 4), np.zeros((2, 3, 3))).total.tolist() == [
        [0, 4, 8],
        [12, 16, 20],
    ]


@pytest.mark.parametrize(
    "exponents", [(-1, 0, 0), (0, 0, -1), (5, -1, 0), (3, 0, 0), (1, 1, 1), (np.int64(-1), 0, 0)]
)
def test_exponents_without_moment_are_an_index_error(exponents):
    moments = Moments(np.arange(10.0), np.zeros(3))
    named = "({:d}, {:d}, {:d}) to order 2".format(*exponents)
    for body in (moments, moments.at(None)):
        with pytest.raises(IndexError, match=re.escape(named)):
            body[exponents]


@pytest.mark.parametrize(
    "exponents", [1, (1, 0), (1, 0, 0, 0), (1.0, 0, 0), slice(2), "xyz", None, ...]
)
def test_indices_other_than_three_integers_are_a_type_error(exponents):
    with pytest.raises(TypeError, match="not 3 integer exponents"):
        Moments(np.arange(10.0), np.zeros(3))[exponents]


def test_negative_exponents_have_no_monomial():
    for exponents in (
        (-1, 0, 0),
        (0, -1, 1),
        (np.array([0, 1]), np.array([0, -1]), np.array([0, 0])),
    ):
        with pytest.raises(IndexError, match="negative"):
            monomial_index(*exponents)


def test_iteration_over_moments_yields_their_exponents():
    moments = Moments(np.arange(20.0), np.zeros(3))
    assert [moments[exponents] for exponents in moments] == list(range(20)) and len(moments) == 20
    assert (1, 1, 1) in moments and (4, 0, 0) not in moments
    stack = Moments(np.zeros((5, 4)), np.zeros((5, 3)))
    assert len(stack) == 4 and list(stack) == [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


def test_dense_moments_of_a_box_are_products():
    """The array of an image: array[p, q, r] = Σ x^p y^q z^r, zero if p + q + r exceeds the
    order.
    """
    raw = np.array(box_moments((0, 0, 0), (1, 2, 3), 4), float)
    dense = Moments(raw, np.zeros(3)).to_dense()
    powers = [np.array([side ** (n + 1) / (n + 1) for n in range(5)]) for side in (1.0, 2.0, 3.0)]
    truth = np.einsum("p,q,r->pqr", *powers)
    truth[np.indices(truth.shape).sum(axis=0) > 4] = 0.0
    assert close(dense, truth, rel=1e-14)
    stack = Moments(np.stack([raw, 2.0 * raw]), np.zeros((2, 3)))
    assert np.array_equal(stack.to_dense(), np.stack([dense, 2.0 * dense]))


def test_numpy_numbers_on_the_left_scale_moments():
    moments = Moments(np.arange(10.0), np.zeros(3))
    for factor in (np.float64(2.0), np.array(2.0), np.int64(2)):
        assert np.array_equal((factor * moments).raw, 2.0 * moments.raw)


@pytest.mark.parametrize(
    "matrix",
    [
        2.0 * np.eye(3),
        np.diag([1.0, 1.0, -1.0]),
        np.ones((3, 3)),
        np.eye(3) + 1e-4 * np.eye(3, k=1),
        np.full((3, 3), np.nan),
    ],
)
def test_frames_other_than_rotations_are_refused(matrix):
    moments = Moments(
        np.array([1.0, *np.zeros(3), 1.0, 0.0, 0.0, 2.0, 0.0, 4.0, *np.zeros(10)]), np.zeros(3)
    )
    properties = MassProperties.from_moments(moments)
    for turn in (
        lambda: moments.in_frame(matrix, np.zeros(3)),
        lambda: properties.in_frame(matrix, np.zeros(3)),
        lambda: pose_matrix(np.zeros(3), matrix),
    ):
        with pytest.raises(ValueError, match="(rotation|axes) must be (a rotation|finite)"):
            turn()


def test_float32_rotations_are_frames():
    angle = 0.7
    rotation = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]],
        np.float32,
    )
    moments = Moments(np.array([1.0, 1.0, 0.0, 0.0]), np.zeros(3))
    assert close(moments.in_frame(rotation, np.zeros(3))[1, 0, 0], np.cos(angle), rel=1e-6)


@pytest.mark.parametrize("measure", ["volume", "area", "length"])
def test_vanishing_images_are_refused(measure):
    moments = Moments(np.ones(4), np.zeros(3), measure)
    tiny = np.diag([1e-200, 1e-200, 1e-200, 1.0])
    with refused("object_size"):
        moments.transform(tiny)
    with refused("object_size"):
        sum_of_images(moments, [np.eye(4), tiny])
    small = np.diag([1e-60, 1e-60, 1e-60, 1.0])
    assert close(Moments(np.ones(4), np.zeros(3)).transform(small).total, 1e-180, rel=1e-14)


def test_flattening_maps_leave_no_volume():
    for flat in (
        np.diag([1.0, 1.0, 0.0, 1.0]),
        np.diag([1.0, 0.0, 0.0, 1.0]),
        np.diag([0.0, 0.0, 0.0, 1.0]),
    ):
        assert Moments(np.ones(4), np.zeros(3)).transform(flat).total == 0.0


def test_only_bodies_of_one_measure_add():
    with pytest.raises(TypeError, match="unsupported operand"):
        Moments(np.ones(4), np.zeros(3)) + 1.0
    with pytest.raises(ValueError, match="parts must not be empty"):
        sum_moments([])
    with pytest.raises(ValueError, match="different measures"):
        sum_moments([Moments(np.ones(1), np.zeros(3)), Moments(np.ones(1), np.zeros(3), "area")])


@pytest.mark.parametrize(
    "matrix", [np.eye(3), np.full((4, 4), np.nan), np.eye(4)[None], np.zeros((0, 4, 4))]
)
def test_invalid_maps_are_refused(matrix):
    body = Moments(np.ones(20), np.zeros(3))
    with pytest.raises(ValueError, match="matrix must be"):
        body.transform(matrix)
    if matrix.ndim < 3 or not len(matrix):
        with pytest.raises(ValueError, match="matrices must"):
            sum_of_images(body, matrix)


@pytest.mark.parametrize("point", [(1, 2), (1, 2, np.nan), (np.inf, 0, 0)])
def test_invalid_points_are_refused(point):
    with pytest.raises(ValueError, match="point must be"):
        Moments(np.ones(20), np.zeros(3)).about_point(point)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("count", [1, 7, 300])
def test_bounds_of_sums_of_images_say_something(size, count):
    """They are some roundings of the moments of the absolute values, which all images have about
    the sum's center.
    """
    rng = np.random.default_rng(count)
    body = floats(box_moments((0, 0, 0), (1, 2, 3)))
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3, :3] = size * rng.normal(size=(count, 3, 3))
    matrices[:, :3, 3] = 3.0 * size * rng.normal(size=(count, 3))
    total = sum_of_images(body, matrices)
    volume = 6.0 * np.abs(np.linalg.det(matrices[:, :3, :3])).sum()
    reach = (
        np.linalg.norm(matrices[:, :3, :3], axis=(1, 2)).max() * 4.0
        + np.ptp(matrices[:, :3, 3], axis=0).max()
    )
    assert (
        total.rounding_error
        <= (400.0 + 4.0 * count) * U * volume * reach ** monomials(ORDER).sum(axis=1)
    ).all()


@pytest.mark.parametrize("by, order", [("size", 0), ("gyration", 1)])
def test_moments_without_center_or_extent_are_not_normalized(by, order):
    body = floats(box_moments((-1, -1, -1), (1, 1, 1)))
    with refused("normalization_undefined"):
        normalize(body.truncate(order), by)
    assert normalize(body.truncate(order + 1), by).order == order + 1
