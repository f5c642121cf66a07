# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves as wires and as rims of flat regions, against closed forms and polygons of straight
pieces.
"""

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs import (
    Curve,
    chords_cross,
    length_moments,
    planar_region,
    plane_moments,
    self_intersects,
)

from tests.close import close
from tests.core.exact_splines import ROUND, circle
from tests.core.findings import refused

UP = np.array([0.0, 0.0, 1.0])


def ring(radius=1.0, center=(0.0, 0.0, 0.0)):
    corners, weights = circle()
    return Curve(ROUND, np.c_[corners, np.zeros(8)] * radius + center, weights)


def polyline(points):
    count = len(points)
    return Curve(SplineSpace((0.0, *map(float, range(count)), count - 1.0), 2, count), points)


def rotation(seed=0):
    matrix, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def test_the_wire_of_a_circle():
    moments = length_moments([ring(2.0)])
    assert abs(moments.total / (4.0 * np.pi) - 1.0) <= 1e-14
    assert abs(moments[2, 0, 0] / (8.0 * np.pi) - 1.0) <= 1e-14
    assert (
        moments.measure == "length"
        and abs(moments.total - 4.0 * np.pi) <= moments.rounding_error[0]
    )
    body = MassProperties.from_moments(moments, 3.0)
    assert close(body.principal.moments, 12.0 * np.pi * np.array([2.0, 2.0, 4.0]), rel=1e-13)


def test_the_length_of_a_parabola_is_its_closed_form():
    parabola = Curve(clamped_space(3), [(0, 0, 0), (0.5, 0, 0), (1, 1, 0)])  # y = x²
    exact = np.sqrt(5.0) / 2.0 + np.arcsinh(2.0) / 4.0
    moments = length_moments([parabola], 0)
    assert abs(moments.total - exact) <= moments.rounding_error[0] <= 1e-11


def test_length_estimate_of_a_cusp_holds():
    # symmetric, its speed zero half-way
    cusp = Curve(clamped_space(4), [(0, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0)])
    moments = length_moments([cusp], 0)
    t = (np.arange(2_000_000) + 0.5) / 2_000_000
    speed = np.linalg.norm(
        3 * ((1 - t) ** 2)[:, None] * [1, 1, 0]
        + (6 * t * (1 - t))[:, None] * [-1, 0, 0]
        + (3 * t**2)[:, None] * [1, -1, 0],
        axis=1,
    )
    assert abs(moments.total - speed.mean()) <= moments.rounding_error[0] + 1e-11
    assert moments.rounding_error[0] <= 1e-9


def test_the_region_of_a_circle_is_exact():
    moments = plane_moments([ring(2.0, (5.0, 1.0, 3.0))], UP)
    assert abs(moments.total / (4.0 * np.pi) - 1.0) <= 1e-14
    central = moments.about_center()
    assert np.abs(moments.center - [5.0, 1.0, 3.0]).max() <= 1e-14
    assert abs(central[2, 0, 0] / (4.0 * np.pi) - 1.0) <= 1e-14
    assert abs(central[0, 0, 2]) <= 1e-13 and abs(central[3, 0, 0]) <= 1e-13


@pytest.mark.parametrize("degree", [2, 3, 5])
def test_the_region_under_a_polynomial_is_exact(degree):
    """Between y = x^n, raised to that degree, and the axis, over [0, 1]."""
    order = degree + 1
    points = [(i / degree, 1.0 if i == degree else 0.0, 0.0) for i in range(order)]
    curves = [Curve(clamped_space(order), points), polyline([(1, 1, 0), (1, 0, 0), (0, 0, 0)])]
    moments = plane_moments(curves, -UP, about=np.zeros(3))
    for p in range(4):
        for q in range(4 - p):
            exact = Fraction(1, (q + 1) * (p + degree * (q + 1) + 1))
            assert abs(moments[p, q, 0] - float(exact)) <= 1e-14


def test_holes_are_left_out_and_islands_in_them_are_not():
    for turn in (np.eye(3), rotation()):
        rings = [
            Curve(c.space, c.points @ turn.T, c.weights)
            for c in (ring(1.0), ring(3.0), ring(2.0).reverse())
        ]
        curves, normal = planar_region(rings)
        moments = plane_moments(curves, normal)
        assert abs(moments.total / (np.pi * (9.0 - 4.0 + 1.0)) - 1.0) <= 1e-13
        assert abs(normal @ turn[:, 2]) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_holes_and_outlines_have_no_unit(size):
    rings = [ring(radius * size).reverse() for radius in (1.0, 0.5)]
    assert close(plane_moments(*planar_region(rings)).total, 0.75 * np.pi * size**2, rel=1e-13)


@pytest.mark.parametrize("far", [0.0, 1e3, 1e6, 1e8])
def test_distant_region_is_measured_while_its_points_are_known(far):
    rings = [ring(radius, (far, -far, 0.0)) for radius in (1.0, 0.5)]
    curves, normal = planar_region(rings)
    moments = plane_moments(curves, normal)
    assert abs(moments.total / (0.75 * np.pi) - 1.0) <= 1e-14 + 1e-15 * far
    if far == 1e8:
        with refused("curves_bound_nothing"):
            planar_region(rings, 2.0**-24 * far)


def test_a_reversed_curve_is_the_same_run_backwards():
    for curve in (
        ring(),
        Curve(clamped_space(4, (0.25,)), np.random.default_rng(0).uniform(-1, 1, (5, 3))),
    ):
        assert np.abs(curve.samples(5)[::-1] - curve.reverse().samples(5)).max() <= 1e-14


@pytest.mark.parametrize(
    "curves, code",
    [
        ([polyline([(0, 0, 0), (1, 0, 0), (1, 1, 0)])], "curves_bound_nothing"),
        (
            [polyline([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0), (0, 0, 0)])],
            "curves_bound_nothing",
        ),
        (
            [polyline([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 0)])],
            "curves_bound_nothing",
        ),
        (  # crossing at half of one edge and two thirds of another
            [polyline([(0, 0, 0), (3, 3, 0), (3, 0, 0), (1, 4, 0), (0, 0, 0)])],
            "curves_bound_nothing",
        ),
        (  # crossing at a corner on an edge
            [polyline([(0, 0, 0), (2, 2, 0), (3, 3, 0), (3, 0, 0), (1, 4, 0), (0, 0, 0)])],
            "curves_bound_nothing",
        ),
        ([polyline([(1, 0, 0), (1, 0, 0)])], "curves_bound_nothing"),  # a closed curve of one point
        ([ring(), ring(1.0, (0.5, 0.0, 0.0))], "curves_bound_nothing"),
    ],
)
def test_curves_bounding_no_region_are_refused(curves, code):
    with refused(code):
        planar_region(curves)


def test_lengths_follow_a_similarity_and_no_other_map():
    moments = length_moments([ring()])
    assert (
        abs(moments.transform(np.diag([2.0, 2.0, 2.0, 1.0])).total / (4.0 * np.pi) - 1.0) <= 1e-14
    )
    with pytest.raises(ValueError):
        moments.transform(np.diag([2.0, 1.0, 1.0, 1.0]))


@pytest.mark.parametrize("weight", [1e-6, 1e-3, 1e3, 1e5, 1e7])
def test_heavy_and_light_weights_are_measured_to_rounding(weight):
    """The arc of a conic, P' = 2 (w (1 - t)² (P1 - P0) + t (1 - t) (P2 - P0) + w t² (P2 - P1)) /
    W², in pieces that grow finer towards its end.
    """
    weights = ring().weights.copy()
    weights[1] = weight
    steps = np.concatenate([[0.0], 0.5 ** np.arange(60.0, 0.0, -1.0)])
    nodes, parts = np.polynomial.legendre.leggauss(30)
    size = np.diff(steps)[:, None]
    t = steps[:-1, None] + size * (nodes + 1.0) / 2.0
    bottom = (1 - t) ** 2 + 2 * weight * t * (1 - t) + t**2
    speed = (
        2.0 * np.hypot(t * (1 - t) + weight * t**2, weight * (1 - t) ** 2 + t * (1 - t)) / bottom**2
    )
    exact = (speed * parts * size).sum() + 1.5 * np.pi  # its other half is as long
    moments = length_moments([Curve(ROUND, ring().points, weights)], 0)
    assert abs(moments.total - exact) <= 1e-12
    assert moments.rounding_error[0] <= 1e-11


def test_length_estimate_of_reversing_lines_holds():
    """Turns closer to an end than any point of a rule, against the sums between the turns."""
    rng = np.random.default_rng(1)
    for _ in range(60):
        order = int(rng.integers(3, 6))
        x = rng.uniform(-1.0, 1.0, order)
        line = Curve(clamped_space(order), np.stack([x, 0.0 * x, 0.0 * x], axis=1))
        slope = sum(
            c
            * (order - 1)
            * comb(order - 2, i)
            * np.polynomial.Polynomial([0, 1]) ** i
            * np.polynomial.Polynomial([1, -1]) ** (order - 2 - i)
            for i, c in enumerate(np.diff(x))
        )
        turns = slope.roots()
        turns = np.sort(
            turns.real[(np.abs(turns.imag) < 1e-12) & (turns.real > 0.0) & (turns.real < 1.0)]
        )
        places = slope.integ()(np.concatenate([[0.0], turns, [1.0]]))
        found = length_moments([line], 0)
        assert abs(found.total - np.abs(np.diff(places)).sum()) <= found.rounding_error[0] <= 1e-9


@pytest.mark.parametrize("ratio", [1.0, 0.25, 4.0])
def test_turns_between_rule_points_are_found(ratio):
    """x' = (t - 0.5)² - h², negative for a moment: rules without a point there agree upon a wrong
    length. Weights that each are so many times the one before make the same curve by other
    parameters.
    """
    for h in (0.1, 0.01, 1e-3):
        # Control points of t³/3 - t²/2 + (1/4 - h²) t.
        x = np.array([0.0, (0.25 - h * h) / 3.0, 0.0, 1.0 / 12.0 - h * h])
        x[2] = 2.0 * x[1] - 1.0 / 6.0
        weights = None if ratio == 1.0 else ratio ** np.arange(4.0)
        line = Curve(clamped_space(4), np.stack([x, 0.0 * x, 0.0 * x], axis=1), weights)
        found = length_moments([line], 0)
        assert abs(found.total - (x[3] + 8.0 * h**3 / 3.0)) <= found.rounding_error[0] <= 1e-11


@pytest.mark.parametrize("weight", [1e12, 1e16, 1e20, 1e30, 1e38])
def test_arc_drawn_to_its_corner_by_a_weight_is_measured(weight):
    """Points near the two sides of the corner are seen, or count as error."""
    weights = ring().weights.copy()
    weights[1] = weight
    corner = Curve(ROUND, ring().points, weights)
    length, area = length_moments([corner], 0), plane_moments([corner], UP)
    assert abs(length.total - (2.0 + 1.5 * np.pi)) <= length.rounding_error[0] + 100.0 / weight
    assert abs(area.total - (1.0 + 0.75 * np.pi)) <= area.rounding_error[0] + 100.0 / weight


@pytest.mark.parametrize("gap", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("turn", [0.0, 0.05, 0.3])
def test_rings_with_crossing_samples_are_told_apart(gap, turn):
    c, s = np.cos(turn), np.sin(turn)
    inner = Curve(
        ROUND, ring(1.0 - gap).points @ [[c, s, 0], [-s, c, 0], [0, 0, 1]], ring().weights
    )
    moments = plane_moments(*planar_region([inner, ring()]))
    assert close(moments.total, np.pi * (1.0 - (1.0 - gap) ** 2), rel=1e-11)


@pytest.mark.parametrize("turn", [1, -1])
def test_a_narrow_bend_does_not_run_through_itself(turn):
    """Many short chords on one side and few long ones on the other: the middles of both cross."""
    inner = [(2.0 - k / 4.0, abs(4.0 - k)) for k in range(9)]
    for tip, crosses in ((-0.3, False), (0.5, True)):
        loop = np.array([(0.0, 3.7), (1.0, tip), (2.0, 3.7), *inner])[::turn]
        assert self_intersects(loop, 1e-6) is crosses
        assert chords_cross([(loop + np.roll(loop, 1, axis=0)) / 2.0], 1e-6, touch=False)
