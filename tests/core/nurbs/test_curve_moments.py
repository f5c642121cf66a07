# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of curves: what bounds their errors, and by which rules they are found."""

import numpy as np
import pytest
from body_moments.core.moments.moments import U, monomials
from body_moments.core.numerics.bspline import clamped_space
from body_moments.core.numerics.quadrature import gauss_legendre
from body_moments.core.nurbs import curve_moments
from body_moments.core.nurbs.curve import Curve
from body_moments.core.nurbs.curve_moments import length_moments, plane_moments

from tests.close import close
from tests.core.nurbs.test_curves import UP, polyline, ring

DEGREE = monomials(3).sum(axis=1)
SQUARE = np.array([(0, 0, 0), (4, 0, 0), (4, 2, 0), (0, 2, 0), (0, 0, 0)], float)
ARC = np.array([(1, 0, 0), (1, 1, 0), (0, 1, 0)], float)  # with weights 1, w, 1 the arc of a conic


@pytest.fixture
def rules(monkeypatch):
    """(pieces, points) of each rule by which pieces of curves are integrated, in their order."""
    asked, integrals = [], curve_moments._piece_integrals

    def note(net, anchor, points, density, order):
        asked.append((len(net), points))
        return integrals(net, anchor, points, density, order)

    monkeypatch.setattr(curve_moments, "_piece_integrals", note)
    return asked


@pytest.mark.parametrize("about", [None, (7.0, 1.0, 0.0)])
@pytest.mark.parametrize("size", [2.0**-10, 1.0, 2.0**6])
def test_what_rounding_leaves_of_a_region_is_512_units_of_its_outline_by_how_far_that_is(size, about):
    outline = [polyline(size * SQUARE), polyline(size * (SQUARE[::-1] / 4.0 + (1.0, 1.0, 0.0)))]
    place = size * (np.array([1.5, 1.0, 0.0]) if about is None else np.array(about))
    found = plane_moments(outline, UP, about=None if about is None else place)
    reach = max(np.linalg.norm(curve.points - place, axis=1).max() for curve in outline)
    assert close(found.about, place, rel=1e-14) and close(found.total, 7.5 * size**2, rel=1e-14)
    expected = 512.0 * U * 15.0 * size * reach ** (DEGREE + 1) / (DEGREE + 2)
    assert close(found.rounding_error, expected, rel=1e-12)


@pytest.mark.parametrize("size", [2.0**-10, 1.0, 2.0**6])
def test_what_rounding_leaves_of_a_wire_is_512_units_of_its_length_by_how_far_that_is(size):
    wires = [polyline(size * SQUARE), polyline(size * np.array([(1, 1, 1), (1, 5, 4)]))]
    found = length_moments(wires)
    assert close(found.about, size * np.array([2.0, 2.5, 2.0]), rel=1e-14) and close(found.total, 17.0 * size, 1e-14)
    reach = size * np.linalg.norm([2.0, 2.5, 2.0])
    assert close(found.rounding_error, 512.0 * U * 17.0 * size * reach**DEGREE, rel=0.03)


def by_rule(curve, about, points, density):
    """(20,) the integral of a density times monomials along a curve of one piece, by one rule."""
    nodes, weights = gauss_legendre(points)
    place, velocity = curve.evaluate(nodes) - about, curve.velocity(nodes)
    return (weights * density(place, velocity)) @ np.prod(place[:, None] ** monomials(3), axis=2)


def speed(place, velocity):
    return np.linalg.norm(velocity, axis=1)


def flux(place, velocity):
    return np.cross(place, velocity)[:, 2]


@pytest.mark.parametrize("size", [2.0**-10, 1.0, 2.0**6])
@pytest.mark.parametrize("weight", [0.1, 30.0, 1e9])
def test_what_two_rules_differ_by_is_the_estimate(monkeypatch, size, weight):
    """The worst of all moments by what it could be at most. Where a weight draws nearly all of a curve to its corner,
    the control polygon's length is added."""
    monkeypatch.setattr(curve_moments, "MAX_DEPTH", 0)
    arc = Curve(clamped_space(3), size * ARC, [1.0, weight, 1.0])
    about = np.array([3.0 * size, -size, 0.0])
    reach = size * np.sqrt(13.0)
    hidden = 2.0 * size if weight > 1e8 else 0.0
    coarse, fine = (by_rule(arc, about, points, flux) for points in (8, 12))
    apart = np.abs((fine - coarse) / reach**DEGREE).max() + reach * hidden
    found = plane_moments([arc], UP, about=about)
    assert (np.abs(found.raw - fine / (DEGREE + 2)) <= 1e-12 * reach ** (DEGREE + 2)).all()
    assert close(found.rounding_error, apart * reach**DEGREE / (DEGREE + 2), rel=1e-4)
    about = size * np.array([0.5, 0.5, 0.0])
    coarse, fine = (by_rule(arc, about, points, speed) for points in (8, 12))
    apart = np.abs((fine - coarse) / (size * np.sqrt(0.5)) ** DEGREE).max() + hidden
    found = length_moments([arc])
    assert close(found.raw[0], fine[0], rel=1e-12)
    assert close(found.rounding_error, apart * (size * np.sqrt(0.5)) ** DEGREE, rel=1e-4)


@pytest.mark.parametrize("order, degree, count", [(2, 0, 1), (2, 3, 3), (3, 0, 2), (4, 0, 3), (4, 1, 5), (4, 3, 8)])
def test_regions_of_polynomial_curves_take_as_many_points_as_their_degree_needs(rules, order, degree, count):
    points = [(k, k * (order - 1 - k), 0) for k in range(order)]
    plane_moments([Curve(clamped_space(order), points)], UP, degree)
    assert rules == [(1, count)]


def integrated(density, tolerance, largest=1.0, curve=None, order=0):
    line = polyline(np.array([(0.0, 0, 0), (1.0, 0, 0), (10.0, 0, 0)])) if curve is None else curve
    return curve_moments._integrate([line], density, largest, order, np.zeros(3), 1.0, tolerance)


@pytest.mark.parametrize("largest", [1.0, 2.0])
@pytest.mark.parametrize("piece, share", [(0, 5.0), (1, 9.0)])
def test_a_piece_is_done_where_rules_agree_to_the_tolerance_of_its_length_or_its_share(rules, largest, piece, share):
    """Of two pieces of lengths 1 and 9. As soon as it is, no finer rule is asked for."""
    for off, done in ((0.99, True), (1.01, False)):

        def density(place, _, off=off):
            inside = (place[0] > 1.0) == (piece == 1)
            return 1.0 + (place.shape[2] == 8) * inside * off * 1e-3 * share * largest

        rules.clear()
        values, estimate, length = integrated(density, 1e-3, largest)
        assert close(values, [2.0], rel=1e-12) and close(length, 10.0, rel=1e-12)
        assert rules == [(2, 8), (2, 12)] + [(1, 18)] * (not done)
        assert close(estimate, off * 1e-3 * share * largest, rel=1e-9) if done else estimate < 1e-12


def test_rules_grow_by_halves_and_then_pieces_are_halved_whose_share_stays_what_it_was(rules):
    """With halves, of length 5, that agree to the tolerance of the whole length of 10."""
    line = Curve(clamped_space(2), [(0, 0, 0), (10, 0, 0)])

    def density(place, _):
        _, pieces, points = place.shape
        return np.full(place.shape[1:], 1.0 + (points % 7 if pieces == 1 else (points == 8) * 0.009))

    values, estimate, length = integrated(density, 1e-3, curve=line)
    assert rules == [(1, 8), (1, 12), (1, 18), (1, 27), (2, 8), (2, 12)]
    assert close(values, [2.0], rel=1e-12) and close(estimate, 0.018, rel=1e-9) and close(length, 10.0, rel=1e-12)


def test_a_piece_is_halved_60_times(rules):
    """Where a density grows without bound, as 1 / x at an end: rules never agree there."""
    line = Curve(clamped_space(2), [(0, 0, 0), (1, 0, 0)])
    values, estimate, length = integrated(lambda place, velocity: velocity[0] / place[0], 1e-6, curve=line)
    assert [points for _, points in rules].count(27) == 60 and close(length, 1.0, rel=1e-12)
    last, before = (2.0 * (1.0 / np.arange(1, points + 1)).sum() for points in (12, 8))  # a rule's own sum of 1 / x
    assert close(values, [60.0 * np.log(2.0) + last], rel=1e-6) and close(estimate, last - before, rel=1e-4)


def nets(rational):
    """Two pieces: a corner of sides 3 and 4, and a line that turns back."""
    points = np.array([[(0, 0, 0), (3, 0, 0), (3, 4, 0)], [(1, 1, 0), (3, 1, 0), (2, 1, 0)]], float)
    weights = np.array([[1.0, 0.5, 2.0], [2.0, 1.0, 1.0]])[..., None]
    return np.concatenate([points * weights, weights], axis=2) if rational else points


@pytest.mark.parametrize("rational", [False, True])
def test_where_a_piece_may_turn_back_all_its_control_polygon_may_be_missed(rational):
    assert close(curve_moments._turn_back_lengths(nets(rational)), [0.0, 3.0], rel=1e-14)


@pytest.mark.parametrize("share, hides", [(0.9, False), (1.1, True)])
def test_a_weight_a_hundred_million_times_another_one_may_hide_all_of_a_piece(share, hides):
    net = nets(True)
    net[0, 1] *= 2.0 * share * 1e8
    assert close(curve_moments._undersampled_lengths(net), [7.0 * hides, 0.0], rel=1e-14)
    assert curve_moments._undersampled_lengths(nets(False)).tolist() == [0.0, 0.0]


def test_wires_are_measured_to_a_ten_trillionth_of_their_length():
    """Though coarser rules agree to a hundred times that."""
    for steep in (0.5, 0.8, 1.0, 1.3):
        arch = Curve(clamped_space(4), [(0, 0, 0), (1, steep, 0), (2, steep, 0), (3, 0, 0)])
        found = length_moments([arch], 0)
        assert found.rounding_error[0] <= 2e-13 * found.total


def test_regions_and_wires_have_moments_to_third_order():
    assert length_moments([ring()]).order == plane_moments([ring()], UP).order == 3


def test_a_curve_of_one_point_has_no_length():
    found = length_moments([Curve(clamped_space(3), np.full((3, 3), 2.0), [1.0, 2.0, 1.0])])
    assert not found.raw.any() and not found.rounding_error.any() and found.about.tolist() == [2.0, 2.0, 2.0]
