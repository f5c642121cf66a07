# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Impossible inertias are found on both sides of each limit; possible ones raise no complaint."""

import numpy as np
import pytest
from body_moments.core.robots.plausibility import Hull, impossible, least_density, spread_directions
from body_moments.core.robots.stated import StatedInertial

from tests.close import close
from tests.core import bodies

CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


def codes(mass, center, tensor, hull=None, **more):
    tensor = np.diag(tensor) if np.ndim(tensor) == 1 else np.array(tensor)
    return [
        found.code
        for found in impossible(StatedInertial(mass, np.array(center, float), tensor, **more), hull)
    ]


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e5])
@pytest.mark.parametrize("sides", [(1.0, 1.0, 1.0), (1.0, 0.5, 0.1)])
def test_box_distance_covers_faces_edges_and_corners(size, sides):
    turn, draw = bodies.rotation(2), np.random.default_rng(1)
    hull = Hull(size * CUBE * sides @ turn.T)
    assert close(hull.size, np.linalg.norm(np.ptp(hull.points, axis=0)), 1e-14)
    for point in draw.normal(size=(60, 3)) * 2.0:
        truth = np.linalg.norm(np.maximum(np.abs(point) - sides, 0.0))
        found = hull.distance(size * turn @ point) / size
        assert abs(found - truth) <= 1e-9 * (truth + 1.0) and (truth > 0.0 or found == 0.0)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_invalid_numbers_are_reported_first(wrong):
    assert (
        codes(wrong, (0, 0, 0), (1, 1, 1))
        == codes(1.0, (0, wrong, 0), (1, 1, 1))
        == ["inertial_not_finite"]
    )
    if np.isnan(wrong):
        assert codes(-1.0, (0, 0, 0), (1, 1, wrong)) == ["inertial_not_finite"]


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e3])
def test_masses_and_moments_must_meet_positivity_and_triangle(scale):
    assert (
        codes(0.0, (0, 0, 0), (1, 1, 1))
        == codes(-2.0, (0, 0, 0), (1, 1, 1))
        == ["inertial_not_positive"]
    )
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
    assert found.values["value"] == -0.5


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_moment_within_rounding_is_called_zero(seed, scale):
    for moment, near in ((0.0, 0.0), (-1e-13, 0.1)):
        tensor = scale * np.diag([moment, 1.0, 1.0])
        (found,) = impossible(StatedInertial(1.0, np.zeros(3), tensor, bodies.rotation(seed)), None)
        assert found.code == "inertial_not_positive" and close(
            found.values["value"], moment * scale, near
        )


def test_excess_spread_between_axes_is_found():
    """An octahedron is thinnest along the diagonals, of a third of the variance that it allows
    along its axes.
    """
    directions, draw = spread_directions(400), np.random.default_rng(2).normal(size=(1000, 3))
    assert directions.shape == (400, 3) and close((directions**2).sum(axis=1), 1.0, 1e-14)
    # equally many below and above
    assert np.abs(directions[:, 2] + directions[::-1, 2]).max() < 1e-14
    draw /= np.linalg.norm(draw, axis=1)[:, None]
    assert (draw @ directions.T).max(axis=1).min() > np.cos(0.14)
    assert (directions @ directions.T - 2.0 * np.eye(400)).max() < np.cos(0.15)
    octahedron = Hull(np.concatenate([np.eye(3), -np.eye(3)]))
    # a variance of a half everywhere
    (found,) = impossible(StatedInertial(1.0, np.zeros(3), np.eye(3)), octahedron)
    direction = np.array(found.values["direction"])
    assert found.code == "inertial_spread_outside" and close(direction @ direction, 1.0, 1e-12)
    assert np.abs(direction).min() > 0.55 and close(
        found.values["factor"], 0.5 / np.abs(direction).max() ** 2, 1e-12
    )


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turn", [np.eye(3), bodies.rotation(8)])
def test_center_must_lie_in_the_hull_with_limited_spread(size, turn):
    hull, mass = Hull(size * CUBE @ turn.T), 3e-6 * size**3
    solid = mass * size**2 * np.full(3, 2.0 / 3.0)

    def said(center, tensor):
        return codes(mass, size * turn @ center, turn @ np.diag(tensor) @ turn.T, hull)

    assert said(np.array([1.0, 0.0, 0.0]) * 0.5, solid * 0.5) == []
    step = hull.size / size * 1e-3
    assert said(np.array([1.0 + 0.8 * step, 0, 0]), solid * 1e-6) == []
    assert said(np.array([1.0 + 1.2 * step, 0, 0]), solid * 1e-6) == ["inertial_center_outside"]
    assert said(np.zeros(3), solid) == []
    # all mass in the corners: variance 1 along each axis, which is the most
    corners = mass * size**2 * np.full(3, 2.0)
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


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_mass_may_spread_a_thousandth_across_a_flat_hull(size):
    hull = Hull(size * CUBE * (3.0, 2.0, 0.0))
    for share, is_outside in ((0.9e-3, False), (1.1e-3, True)):
        mass = size**3
        tensor = mass * spread(np.array([1.0, 1.0, share * 52.0]) * size**2)
        found = impossible(StatedInertial(mass, np.zeros(3), tensor), hull)
        assert [one.code for one in found] == ["inertial_spread_outside"] * is_outside
        if is_outside:
            assert close(found[0].values["factor"], 1.1, 1e-9)
            assert close(np.abs(found[0].values["direction"]), [0.0, 0.0, 1.0], 1e-12)


def test_impossible_inertia_is_reported_with_numbers():
    hull, tensor = Hull(CUBE), 1e-6 * np.eye(3)
    (found,) = impossible(StatedInertial(-2.0, np.zeros(3), tensor), hull)
    assert found.values == {"part": "mass", "value": -2.0, "unit": "kg"}
    (found,) = impossible(StatedInertial(1e-5, np.array([0.0, 3.0, 0.5]), tensor), hull)
    assert found.code == "inertial_center_outside" and close(found.values["distance"], 2.0, 1e-9)
    (found,) = impossible(StatedInertial(1e-6, np.zeros(3), np.diag([1e-6, 1e-6, 2.001e-6])), hull)
    assert found.code == "inertial_triangle_slightly" and close(found.values["excess"], 5e-4, 1e-9)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_least_density_of_an_ellipsoid_is_its_own(size):
    """The bound is sharp for even ellipsoids up to the rounding; others are above."""
    axes = size * np.array([0.5, 0.7, 0.9])
    for density, is_possible in ((22_000.0, True), (23_000.0, False)):
        mass = density * 4.0 / 3.0 * np.pi * axes.prod()
        tensor = mass / 5.0 * spread(axes**2)
        bound = least_density(mass, np.sort(np.diag(tensor)))
        assert 0.99 * density < bound < density
        found = impossible(StatedInertial(mass, np.zeros(3), tensor, bodies.rotation(3)), None)
        assert [one.code for one in found] == ["inertial_too_dense"] * (not is_possible)
    sides = 2.0 * axes
    mass = 7850.0 * sides.prod()
    bound = least_density(mass, np.sort(np.diag(mass / 12.0 * spread(sides**2))))
    share = 12.0**1.5 / (4.0 / 3.0 * np.pi * 125.0**0.5)
    assert 0.99 * share * 7850.0 < bound < share * 7850.0


def test_thin_sheet_of_osmium_is_possible():
    """Rounded digits may hide the thickness of a nearly flat tensor: its density is not decided."""
    sides = np.array([1.0, 1.0, 1e-4])
    mass = 22_590.0 * sides.prod()
    assert impossible(StatedInertial(mass, np.zeros(3), mass / 12.0 * spread(sides**2)), None) == []
