# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves that run along the sides of a domain, and how far from them they may."""

import numpy as np
import pytest
from body_moments.core.cad.trimmed import Piece, flat_region, trims_nothing
from body_moments.core.nurbs import reverse_curves
from body_moments.core.verdict import MeasureError

from tests.core.polygons import polygon

DOMAIN = (1.0, 3.0), (-2.0, 6.0)
SIZE = np.array([2.0, 8.0])
A, B, C, D = np.array([(1.0, -2.0), (3.0, -2.0), (3.0, 6.0), (1.0, 6.0)])
NOISE = 1e-7  # float32 rounding, as a share of the domain in each direction


def lines(*corners):
    return [Piece(np.array(ends), True) for ends in zip(corners[:-1], corners[1:])]


def polyline(*corners, straight=True):
    return Piece(np.array(corners), straight)


@pytest.mark.parametrize("first", range(4))
@pytest.mark.parametrize("way", [1, -1])
def test_once_around_from_any_corner_in_either_sense(first, way):
    corners = [(A, B, C, D)[(first + way * step) % 4] for step in range(5)]
    assert trims_nothing(lines(*corners), DOMAIN) and trims_nothing([polyline(*corners)], DOMAIN)
    assert trims_nothing(lines(*corners, *corners[1:]), DOMAIN) is False  # twice
    assert trims_nothing(lines(*corners[:-1]), DOMAIN) is False  # open
    # there and back
    assert trims_nothing(lines(*corners[:3], corners[1], corners[0]), DOMAIN) is False
    assert trims_nothing(lines(*corners[:2], *corners[:1], *corners[1:]), DOMAIN) is False


@pytest.mark.parametrize("share, is_near", [(0.9, True), (1.1, False)])
@pytest.mark.parametrize("side", range(4))
def test_a_smooth_curve_stays_along_one_side(share, is_near, side):
    corners = [(A, B, C, D)[(side + step) % 4] for step in range(5)]
    middle = (corners[0] + corners[1]) / 2.0
    inward = np.sign((A + C) / 2.0 - middle) * (middle != (A + C) / 2.0)
    for sense in (1.0, -1.0):
        control = middle + sense * share * NOISE * SIZE * inward
        smooth = polyline(corners[0], control, corners[1], straight=False)
        assert trims_nothing([smooth, *lines(*corners[1:])], DOMAIN) == is_near
    bent = polyline(*corners[:3], straight=False)
    assert trims_nothing([bent, *lines(*corners[2:])], DOMAIN) is False
    assert trims_nothing([polyline(*corners[:3]), *lines(*corners[2:])], DOMAIN)


@pytest.mark.parametrize("at", [0.0, 0.3])
def test_seams_and_poles_may_be_anywhere(at):
    """Of a cylinder, cone, sphere and torus that close along s, with a seam at any s."""
    a, b, c, d = np.array(
        [(1 + 2 * at, -2), (3 + 2 * at, -2), (3 + 2 * at, 6), (1 + 2 * at, 6)], np.float64
    )
    poles, closed = ((False, False), (True, True)), (True, False)
    around = lines(a, b, c, d, a)
    assert trims_nothing(around, DOMAIN, closed) and trims_nothing(
        around[::-1], DOMAIN, (True, True)
    )
    assert trims_nothing([around[0], *lines(c, d)], DOMAIN, closed)  # two circles, and no seam
    assert trims_nothing(lines(b, c) + lines(d, a), DOMAIN, closed, poles) and trims_nothing(
        around, DOMAIN, closed, poles
    )
    assert trims_nothing(lines(a, b, c, d, a), DOMAIN, (False, False)) == (at == 0.0)
    assert not trims_nothing(lines(b, c) + lines(d, a), DOMAIN, closed)  # the circles are missing
    # a seam run twice the same way
    assert not trims_nothing(lines(b, c) + lines(a, d), DOMAIN, closed, poles)
    # circles that bound no band
    assert not trims_nothing([around[0], *lines(d, c)], DOMAIN, closed)
    middle = np.array([0.0, 1.0])
    # a part of it
    assert not trims_nothing(lines(a, b, b + middle, a + middle, a), DOMAIN, closed, poles)


def test_edge_across_the_domain_trims_despite_ends_on_sides():
    middle = (A + B) / 2.0
    assert trims_nothing(lines(A, middle, (C + D) / 2.0, D, A), DOMAIN) is False
    assert trims_nothing(lines(A, C, D, A), DOMAIN) is False


def test_directed_loops_may_touch_but_not_cross():
    up = np.array([0.0, 0.0, 1.0])
    square = polygon((0, 0), (2, 0), (2, 2), (0, 2))
    corner = polygon((2, 2), (3, 2), (3, 3), (2, 3))
    assert flat_region([square, corner], up).area_moments(0, np.zeros(3)).total == 5.0
    twisted = polygon((0, 0), (3, 3), (3, 0), (1, 4))  # lobes of different signs
    overlapping = polygon((1, 1), (3, 1), (3, 3), (1, 3))
    cornered = polygon((0, 0), (2, 2), (3, 3), (3, 0), (1, 4))  # the same, a corner on an edge
    sides = np.linspace([(0, 0), (3, 3), (3, 0), (1, 4)], [(3, 3), (3, 0), (1, 4), (0, 0)], 31)
    fine = polygon(*np.moveaxis(sides[:-1], 1, 0).reshape(-1, 2))  # the same, in short curves
    crossing = [[loop] for loop in (twisted, cornered, fine)]
    for loops in (*crossing, *([reverse_curves(one)] for (one,) in crossing)):
        with pytest.raises(MeasureError):
            flat_region(loops, up)
    with pytest.raises(MeasureError):
        flat_region([square, overlapping], up)
