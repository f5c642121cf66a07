# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What no body has is found, from both sides of each limit; what a body has is never complained of."""

import numpy as np
import pytest
from body_moments.core.robots.plausibility import Hull, _nearest_shares, _sphere, impossible
from body_moments.core.robots.stated import StatedInertial

from tests.close import close
from tests.core import bodies

CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


def codes(mass, center, tensor, hull=None, **more):
    tensor = np.diag(tensor) if np.ndim(tensor) == 1 else np.array(tensor)
    return [found.code for found in impossible(StatedInertial(mass, np.array(center, float), tensor, **more), hull)]


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e5])
@pytest.mark.parametrize("sides", [(1.0, 1.0, 1.0), (1.0, 0.5, 0.1)])
def test_the_distance_from_a_box_is_that_of_its_faces_edges_and_corners(size, sides):
    turn, draw = bodies.rotation(2), np.random.default_rng(1)
    hull = Hull(size * CUBE * sides @ turn.T)
    assert close(hull.size, np.linalg.norm(np.ptp(hull.points, axis=0)), 1e-15)
    for point in draw.normal(size=(60, 3)) * 2.0:
        truth = np.linalg.norm(np.maximum(np.abs(point) - sides, 0.0))
        found = hull.distance(size * turn @ point) / size
        assert abs(found - truth) <= 1e-9 * (truth + 1.0) and (truth > 0.0 or found == 0.0)


def test_variance_is_at_most_the_product_of_the_ways_to_both_sides():
    hull = Hull(CUBE * (3.0, 2.0, 1.0))
    found = hull.spread_limit(np.array([1.0, -0.5, 0.0]), np.eye(3))
    assert close(found, [2.0 * 4.0, 2.5 * 1.5, 1.0], 1e-15)
    assert (hull.spread_limit(np.array([4.0, 0.0, 0.0]), np.eye(3)) == [0.0, 4.0, 1.0]).all()


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_numbers_that_are_none_come_first(wrong):
    assert codes(wrong, (0, 0, 0), (1, 1, 1)) == codes(1.0, (0, wrong, 0), (1, 1, 1)) == ["inertial_not_finite"]
    if np.isnan(wrong):
        assert codes(-1.0, (0, 0, 0), (1, 1, wrong)) == ["inertial_not_finite"]


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e9])
def test_masses_and_moments_are_positive_and_no_moment_exceeds_the_sum_of_the_others(scale):
    assert codes(0.0, (0, 0, 0), (1, 1, 1)) == codes(-2.0, (0, 0, 0), (1, 1, 1)) == ["inertial_mass_not_positive"]
    for tensor, said in (
        ((1.0, 1.0, 1.0), []),
        ((1.0, 1.0, 2.0), []),
        ((1.0, 1.0, 2.0 + 1e-9), ["inertial_triangle_slightly"]),
        ((1.0, 1.0, 2.0 * 1.0009), ["inertial_triangle_slightly"]),
        ((1.0, 1.0, 2.0 * 1.0011), ["inertial_triangle"]),
        ((0.0, 1.0, 1.0), ["inertial_not_positive"]),
        ((-0.1, 1.0, 1.0), ["inertial_not_positive"]),
        ((0.0, 0.0, 0.0), ["inertial_not_positive"]),
    ):
        for turn in (np.eye(3), bodies.rotation(5)):
            tensor = np.array(tensor)
            if turn[0, 0] != 1.0 and not tensor.all():
                continue  # zero to rounding
            assert codes(scale, (0, 0, 0), scale * np.diag(tensor), rotation=turn) == said
    (found,) = impossible(StatedInertial(1.0, np.zeros(3), np.diag([1.0, 1.0, 3.0])), None)
    assert found.values["moments"] == [1.0, 1.0, 3.0] and close(found.values["excess"], 0.5, 1e-12)
    (found,) = impossible(StatedInertial(1.0, np.zeros(3), np.diag([-0.5, 1.0, 3.0])), None)
    assert found.values["moment"] == -0.5


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_moment_that_is_zero_to_rounding_is_called_zero(seed, scale):
    for moment, near in ((0.0, 0.0), (-1e-13, 0.1)):
        tensor = scale * np.diag([moment, 1.0, 1.0])
        (found,) = impossible(StatedInertial(1.0, np.zeros(3), tensor, bodies.rotation(seed)), None)
        assert found.code == "inertial_not_positive" and close(found.values["moment"], moment * scale, near)


def test_mass_that_spreads_too_far_between_the_axes_is_found_by_directions_all_around():
    """An octahedron is thinnest along the diagonals, of a third of the variance that it allows along its axes."""
    directions, draw = _sphere(400), np.random.default_rng(2).normal(size=(1000, 3))
    assert directions.shape == (400, 3) and close((directions**2).sum(axis=1), 1.0, 1e-14)
    assert np.abs(directions[:, 2] + directions[::-1, 2]).max() < 1e-14  # as many below as above
    draw /= np.linalg.norm(draw, axis=1)[:, None]
    assert (draw @ directions.T).max(axis=1).min() > np.cos(0.14)
    assert (directions @ directions.T - 2.0 * np.eye(400)).max() < np.cos(0.15)
    octahedron = Hull(np.concatenate([np.eye(3), -np.eye(3)]))
    (found,) = impossible(StatedInertial(1.0, np.zeros(3), np.eye(3)), octahedron)  # a variance of a half everywhere
    direction = np.array(found.values["direction"])
    assert found.code == "inertial_spread_outside" and close(direction @ direction, 1.0, 1e-12)
    assert np.abs(direction).min() > 0.55 and close(found.values["factor"], 0.5 / np.abs(direction).max() ** 2, 1e-12)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turn", [np.eye(3), bodies.rotation(8)])
def test_the_center_lies_in_the_hull_and_the_mass_spreads_no_further(size, turn):
    hull, mass = Hull(size * CUBE @ turn.T), 3.0
    solid = mass * size**2 * np.full(3, 2.0 / 3.0)

    def said(center, tensor):
        return codes(mass, size * turn @ center, turn @ np.diag(tensor) @ turn.T, hull)

    assert said(np.array([1.0, 0.0, 0.0]) * 0.5, solid * 0.5) == []
    step = hull.size / size * 1e-3
    assert said(np.array([1.0 + 0.8 * step, 0, 0]), solid * 1e-6) == []
    assert said(np.array([1.0 + 1.2 * step, 0, 0]), solid * 1e-6) == ["inertial_center_outside"]
    assert said(np.zeros(3), solid) == []
    corners = mass * size**2 * np.full(3, 2.0)  # all mass in the corners: variance 1 along each axis, which is the most
    assert said(np.zeros(3), corners) == []
    assert said(np.zeros(3), corners * 1.1) == ["inertial_spread_outside"]
    most = 1.005 + 1e-3 * (hull.size / size) ** 2  # along x, and half of it across
    for less, codes_said in ((1e-4, []), (-1e-4, ["inertial_spread_outside"])):
        tensor = mass * size**2 * np.array([1.0, most - less + 0.5, most - less + 0.5])
        assert said(np.zeros(3), tensor) == codes_said
    long = mass * size**2 * np.array([0.02, 1.1, 1.1])
    (found,) = impossible(StatedInertial(mass, np.zeros(3), turn @ np.diag(long) @ turn.T), hull)
    assert found.code == "inertial_spread_outside" and close(found.values["factor"], 1.09, 0.01)
    assert abs(np.array(found.values["direction"]) @ turn[:, 0]) > 0.99


def spread(variances):
    """The tensor of a kilogram with these variances along the axes."""
    return np.diag(np.sum(variances) - np.array(variances))


@pytest.mark.parametrize("variances", [(8.8, 4.0, 1.08), (9.15, 4.0, 1.2)])
def test_the_direction_that_is_said_is_that_in_which_the_mass_spreads_too_far_for_its_limit(variances):
    """Along the short side, though along the long one it spreads farther, or exceeds its limit by more."""
    hull = Hull(CUBE * (3.0, 2.0, 1.0))
    (found,) = impossible(StatedInertial(1.0, np.zeros(3), spread(variances)), hull)
    assert found.code == "inertial_spread_outside" and close(found.values["factor"], variances[2], 1e-12)
    assert close(np.abs(found.values["direction"]), [0.0, 0.0, 1.0], 1e-12)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_of_a_flat_hull_the_mass_may_spread_across_by_a_thousandth_of_the_size(size):
    hull = Hull(size * CUBE * (3.0, 2.0, 0.0))
    for share, is_outside in ((0.9e-3, False), (1.1e-3, True)):
        tensor = spread(np.array([1.0, 1.0, share * 52.0]) * size**2)
        found = impossible(StatedInertial(1.0, np.zeros(3), tensor), hull)
        assert [one.code for one in found] == ["inertial_spread_outside"] * is_outside
        if is_outside:
            assert close(found[0].values["factor"], 1.1, 1e-9)
            assert close(np.abs(found[0].values["direction"]), [0.0, 0.0, 1.0], 1e-12)


def test_what_is_impossible_is_said_with_its_numbers():
    hull, tensor = Hull(CUBE), 1e-6 * np.eye(3)
    (found,) = impossible(StatedInertial(-2.0, np.zeros(3), tensor), hull)
    assert found.values == {"mass": -2.0}
    (found,) = impossible(StatedInertial(1.0, np.array([0.0, 3.0, 0.5]), tensor), hull)
    assert found.code == "inertial_center_outside" and close(found.values["distance"], 2.0, 1e-9)
    (found,) = impossible(StatedInertial(1.0, np.zeros(3), np.diag([1e-6, 1e-6, 2.001e-6])), hull)
    assert found.code == "inertial_triangle_slightly" and close(found.values["excess"], 5e-4, 1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_the_distance_from_scattered_points_is_no_more_than_that_of_the_nearest(seed):
    """Of a ball it is that of the ball, but for the gaps between its points."""
    draw = np.random.default_rng(seed)
    points = draw.normal(size=(4000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    hull = Hull(points * [1.0, 1.0, (1.0, 1e-3, 0.0, 5.0)[seed]])
    for point in draw.normal(size=(20, 3)) * [2.0, 2.0, (2.0, 2e-3, 1e-3, 9.0)[seed]]:
        found = hull.distance(point)
        assert found <= (1.0 + 1e-12) * np.linalg.norm(hull.points - point, axis=1).min()
        if seed == 0:
            assert abs(found - max(np.linalg.norm(point) - 1.0, 0.0)) < 0.01
    corner = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    assert close(Hull(corner).distance(np.array([0.25, 0.25, -0.5])), 0.5, 1e-12)
    assert close(Hull(corner[1:2]).distance(np.zeros(3)), 1.0, 1e-12)


@pytest.mark.parametrize("corners", [1, 2, 3])
def test_the_distance_is_that_from_the_corner_edge_or_face_in_front_of_all_other_points(corners):
    draw = np.random.default_rng(corners)
    for seed in range(40):
        height, points = draw.uniform(0.5, 2.0), draw.normal(size=(30, 3))
        points[:, 2] = height + np.abs(points[:, 2])
        points[:corners, 2] = height
        shares = draw.dirichlet(np.ones(corners))  # of the point in front of the origin
        points[:corners, :2] -= shares @ points[:corners, :2]
        hull = Hull(points @ bodies.rotation(seed).T)
        assert abs(hull.distance(np.zeros(3)) - height) <= 2e-9 * hull.size


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_a_step_to_the_nearest_point_of_a_plane_ends_at_the_first_side_and_comes_nearer(corners):
    draw = np.random.default_rng(corners)
    for _ in range(200):
        points = draw.normal(size=(corners, 3)) + draw.normal(size=3)
        shares = draw.dirichlet(np.ones(corners))
        chosen, found = _nearest_shares(points, list(range(corners)), shares)
        nearest = found @ points[chosen]
        assert (found > 0.0).all() and close(found.sum(), 1.0, 1e-12)
        assert np.abs((points[chosen] - nearest) @ nearest).max() <= 1e-12  # nothing is left along the plane of those
        assert np.linalg.norm(nearest) <= np.linalg.norm(shares @ points) * (1.0 + 1e-12)
        assert chosen == chosen_by_steps(points, shares)


def chosen_by_steps(points, shares):
    """Step by step toward the nearest point of the plane, as far as to the first corner whose share falls to zero."""
    left = list(range(len(points)))
    while True:
        gram = np.block([[points[left] @ points[left].T, np.ones((len(left), 1))], [np.ones(len(left)), 0.0]])
        wanted = (
            np.linalg.solve(gram, [*[0.0] * len(left), 1.0])[:-1]
            if len(left) < 4
            else np.linalg.solve(np.vstack([points[left].T, np.ones(4)]), [0.0, 0.0, 0.0, 1.0])
        )
        ways = [(have / (have - want), k) for k, (have, want) in enumerate(zip(shares, wanted)) if want <= 0.0]
        if not ways:
            return left
        way, first = min(ways)
        shares = np.delete(shares + way * (wanted - shares), first)
        del left[first]


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("share", [1e-2, 1e-9, 1e-10, 1e-11])
def test_next_to_a_corner_the_distance_is_that_from_it(size, share):
    """But for what is rounding of the size."""
    hull = Hull(size * (CUBE - 1.0))  # a corner at the origin
    away = hull.size * share
    assert close(hull.distance(np.full(3, away / 3.0**0.5)), away, 1e-9)
    assert hull.distance(np.full(3, 1e-3 * hull.size * 1e-10)) == 0.0 == hull.distance(np.zeros(3))


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_the_distance_is_found_within_a_billionth_of_the_size(size):
    """The nearest corner's own plane leaves a tenth of a millionth to gain."""
    slope = 1e-7
    hull = Hull(size * np.array([(0, 0, 1), (1, 0, 1 - slope), (0, 1, 2), (1, 1, 2)]))
    assert close(hull.distance(np.zeros(3)), size / np.hypot(1.0, slope), 2e-9)
