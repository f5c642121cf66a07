# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Support polygons: boxes, wedges and tables that stand, lean and fall, under gravity along any
direction.
"""

from itertools import product
from math import atan2, hypot, pi

import numpy as np
import pytest
from body_moments.core.statics.support import find_support, ground_axes, support_of_contacts

from tests.close import close

EXACT = 1e-12
BOX = np.array(list(product((0.0, 4.0), (0.0, 2.0), (0.0, 6.0))))
TURN = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))[0]


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e7])
@pytest.mark.parametrize("turn", [np.eye(3), TURN], ids=["upright", "turned"])
def test_a_box_stands_by_its_narrow_side(turn, size):
    down = turn @ (0.0, 0.0, -1.0)
    support = find_support(size * BOX @ turn.T, size * turn @ (2.0, 1.25, 3.0), down)
    assert support.stands and len(support.polygon) == 4
    assert close(support.margin, 0.75 * size, EXACT)
    assert close(support.height, 3.0 * size, EXACT)
    assert close(support.tipping_angle, atan2(0.75, 3.0), EXACT)
    assert np.abs(support.direction - turn @ (0.0, 1.0, 0.0)).max() < EXACT
    assert np.abs(support.foot - size * turn @ (2.0, 1.25, 0.0)).max() < EXACT * size * 6.0


def test_corners_go_counter_clockwise_seen_from_above():
    corners = find_support(BOX, (2.0, 1.0, 3.0)).polygon
    x, y = corners[:, 0], corners[:, 1]
    assert close((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2.0, 8.0, EXACT)


def test_a_wedge_tips_over_its_edge():
    """A leaning prism with its center beyond its base by 1/4."""
    wedge = np.array(
        [(x, y, z) for y in (0.0, 1.0) for x, z in ((0.0, 0.0), (1.0, 0.0), (2.5, 2.0), (1.5, 2.0))]
    )
    center = np.array([1.25, 0.5, 1.0])
    support = find_support(wedge, center)
    assert not support.stands
    assert close(support.margin, -0.25, EXACT)
    assert close(support.tipping_angle, -atan2(0.25, 1.0), EXACT)
    assert close(support.direction, [1.0, 0.0, 0.0], EXACT)
    assert find_support(wedge - (0.0, 0.0, 5.0), center - (0.3, 0.0, 5.0)).stands


def test_a_fall_over_a_corner_goes_away_from_it():
    support = find_support(BOX, (7.0, 6.0, 3.0))
    assert close(support.margin, -5.0, EXACT)
    assert np.abs(support.direction - (0.6, 0.8, 0.0)).max() < EXACT


def test_table_stands_on_the_polygon_of_its_legs():
    legs = np.array([(x, y, 0.0) for x in (0.0, 2.0) for y in (0.0, 1.0)])
    top = np.array([(x, y, 1.0) for x in (-1.0, 3.0) for y in (-1.0, 2.0)])
    points = np.concatenate([legs, top])
    assert close(find_support(points, (1.0, 0.5, 1.0)).margin, 0.5, EXACT)
    assert not find_support(points, (2.5, 0.5, 1.0)).stands


def test_tolerance_is_relative_to_the_body():
    for size in (1e-6, 1.0, 1e6):
        raised = size * BOX + np.where(BOX[:, :1] > 0.0, (0.0, 0.0, 1e-4 * size), 0.0)
        center = size * np.array([2.0, 1.0, 3.0])
        assert len(find_support(raised, center).polygon) == 2
        assert len(find_support(raised, center, tolerance=0.9 * 1e-4 / 6.0).polygon) == 2
        assert len(find_support(raised, center, tolerance=1.1 * 1e-4 / 6.0).polygon) == 4


@pytest.mark.parametrize("turn", [np.eye(3), TURN], ids=["upright", "turned"])
def test_support_polygon_is_on_the_ground_below_the_body(turn):
    place = np.array([7.0, -3.0, 11.0])
    support = find_support(
        BOX @ turn.T + place, turn @ (2.0, 1.25, 3.0) + place, turn @ (0.0, 0.0, -1.0)
    )
    wanted = BOX[BOX[:, 2] == 0.0] @ turn.T + place
    apart = np.linalg.norm(support.polygon[:, None] - wanted, axis=2)
    assert (
        apart.shape == (4, 4)
        and apart.min(axis=0).max() < 1e-13
        and apart.min(axis=1).max() < 1e-13
    )
    assert np.abs(support.up - turn[:, 2]).max() < 1e-14


@pytest.mark.parametrize(
    "foot, margin, direction",
    [
        ((1.0, 0.5), 0.5, (0, -1)),
        ((0.25, 1.0), 0.25, (-1, 0)),
        ((2.0, 1.25), 0.2, (0.6, 0.8)),
        ((1.0, -2.0), -2.0, (0, -1)),
        ((4.0, -2.0), -2.0, (0, -1)),
    ],
)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_three_legged_stool_stands_or_falls_by_the_nearest_side(foot, margin, direction, size):
    legs = size * np.array([(0, 0, 0), (4, 0, 0), (0, 3, 0)])
    support = support_of_contacts(legs, size * np.array((*foot, 1.0)))
    assert (
        close(support.margin, size * margin, EXACT)
        and np.abs(support.direction - (*direction, 0)).max() < EXACT
    )


def test_body_on_an_edge_or_a_point_does_not_stand():
    on_edge = np.array([(0, 0, 0), (0, 2, 0), (1, 0, 1), (1, 2, 1), (-1, 0, 1), (-1, 2, 1)], float)
    support = find_support(on_edge, (0.0, 1.0, 0.6))
    assert support.margin == 0.0 and not support.stands
    support = find_support(on_edge, (0.0, 3.0, 0.6))
    assert close(support.margin, -1.0, EXACT)
    on_point = np.array([(0, 0, 0), (1, 0, 1), (-1, 1, 1), (-1, -1, 1)], float)
    support = find_support(on_point, (0.3, 0.4, 0.5))
    assert close(support.margin, -0.5, EXACT)
    assert np.abs(support.direction - (0.6, 0.8, 0.0)).max() < EXACT
    assert not find_support(on_point, (0.0, 0.0, 0.5)).stands


@pytest.mark.parametrize("size", [1e-6, 0.3, 1e6])
@pytest.mark.parametrize("shares", [(-1.0, 2.0), (0.0, 1.0)], ids=["within", "at an end"])
def test_body_above_a_line_falls_across_it(size, shares):
    ends = size * np.array([[share, 2.0 * share, 0.0] for share in shares])
    support = support_of_contacts(ends, (0.0, 0.0, size))
    assert support.margin == 0.0 and support.height == size
    across = support.direction @ (1.0, 2.0, 0.0)
    assert (
        close(np.linalg.norm(support.direction), 1.0, EXACT)
        and abs(across) < EXACT
        and support.direction[2] == 0.0
    )
    support = support_of_contacts(np.zeros((1, 3)), (0.0, 0.0, size))
    assert support.margin == 0.0 and close(np.linalg.norm(support.direction), 1.0, EXACT)
    assert support.direction[2] == 0.0


def test_margin_of_a_disc_matches_its_polygon():
    count = 2000
    angles = 2.0 * pi / count * np.arange(count)
    rim = np.stack([np.cos(angles), np.sin(angles), np.zeros(count)], axis=1)
    points = np.concatenate([rim, rim + (0.0, 0.0, 1.0), 0.5 * rim])
    support = find_support(points, (0.0, 0.0, 0.5))
    assert len(support.polygon) == count
    assert close(support.margin, np.cos(pi / count), EXACT)


def test_contacts_at_several_heights_count_by_their_plumb_lines():
    support = support_of_contacts([(0, 0, 0), (2, 0, 1), (2, 2, -1), (0, 2, 5)], (0.5, 1.0, 3.0))
    assert close(support.margin, 0.5, EXACT) and close(support.height, 4.0, EXACT)
    assert close(support.direction, (-1.0, 0.0, 0.0), EXACT)


@pytest.mark.parametrize("down", [(0, 0, -9.81), (1, 2, 3), (0, 1e-9, 0)])
def test_axes_of_the_ground_are_a_rotation_with_up(down):
    axes = ground_axes(down)
    assert np.abs(axes.T @ axes - np.eye(3)).max() < EXACT
    assert close(np.linalg.det(axes), 1.0, EXACT)
    assert np.abs(axes[:, 2] + np.array(down) / hypot(*down)).max() < EXACT


def test_middle_of_a_triangle_is_its_centroid():
    corners = np.array([(0.0, 0.0, 1.0), (3.0, 0.0, 1.0), (0.0, 6.0, 1.0)])
    assert close(support_of_contacts(corners, (9.0, 9.0, 5.0)).target(None), (1.0, 2.0, 1.0), EXACT)
    assert close(
        support_of_contacts(corners[:2], (9.0, 9.0, 5.0)).target(None), (1.5, 0.0, 1.0), EXACT
    )


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("margin", [0.0, 0.1, 0.25])
def test_nearest_target_has_the_margin_and_no_nearer_point_has(seed, margin):
    """The oracle tries a fine grid of points."""
    rng = np.random.default_rng(seed)
    contacts = np.concatenate([rng.uniform(-1.0, 1.0, (12, 2)), np.zeros((12, 1))], axis=1)
    center = np.array([*rng.uniform(-2.0, 2.0, 2), 1.5])
    support = support_of_contacts(contacts, center)
    target = support.target(margin)
    assert support_of_contacts(contacts, target).margin >= min(margin, support.margin) - 1e-9
    line = np.linspace(-1.0, 1.0, 41)
    grid = [np.array([x, y, 0.0]) for x in line for y in line]
    good = [point for point in grid if support_of_contacts(contacts, point).margin >= margin]
    nearest = min(np.linalg.norm(point - support.foot) for point in good)
    assert np.linalg.norm(target - support.foot) <= nearest + 1e-9


def test_too_large_margin_leads_to_the_middle():
    square = np.array([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 2.0, 0.0), (0.0, 2.0, 0.0)])
    assert close(support_of_contacts(square, (5.0, 0.5, 1.0)).target(1.5), (1.0, 1.0, 0.0), EXACT)


@pytest.mark.parametrize("x, near", [(0.05, True), (0.5, False), (-1.0, True)])
def test_foot_near_an_edge_is_known(x, near):
    square = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 2.0, 0.0), (0.0, 2.0, 0.0)]
    assert support_of_contacts(square, (x, 1.0, 1.0)).is_near_edge == near


def test_tolerance_leaves_out_corners_of_no_weight():
    angles = 2.0 * pi / 2000 * np.arange(2000)
    rim = np.stack([np.cos(angles), np.sin(angles), np.zeros(2000)], axis=1)
    coarse, exact = (
        support_of_contacts(rim, (0, 0, 1), tolerance=1e-4),
        support_of_contacts(rim, (0, 0, 1)),
    )
    assert len(coarse.polygon) < 300 and 0.0 <= exact.margin - coarse.margin < 3e-4
