# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points from triangles, against closed forms and a fine sampling."""

import math

import numpy as np
import pytest
from body_moments.core.mesh.point_triangle import triangle_distances, winding_number

from tests.close import close
from tests.core.bodies import moved, rotation, sphere

RIGHT = np.array([[[0.0, 0, 0], [4, 0, 0], [0, 3, 0]]])


@pytest.mark.parametrize(
    "point, distance",
    [
        ((1, 1, 2), 2.0),
        ((1, 1, -2), 2.0),
        ((1, 0.5, 0), 0.0),  # over the inside, and in it
        ((2, -3, 4), 5.0),
        ((-3, 1, 4), 5.0),
        ((4, 3, 0), 2.4),  # beyond each edge
        ((-3, -4, 0), 5.0),
        ((7, -4, 0), 5.0),
        ((-3, 7, 12), 13.0),
    ],
)  # beyond each corner
def test_planes_edges_and_corners(point, distance):
    for corners in (RIGHT, RIGHT[:, ::-1], np.roll(RIGHT, 1, axis=1)):
        assert triangle_distances(point, corners)[0] == pytest.approx(distance, abs=1e-14)


def test_many_triangles_are_no_nearer_than_their_samples():
    rng = np.random.default_rng(0)
    corners = rng.standard_normal((50, 3, 3))
    corners[:5, 2] = corners[:5, 0] + 1e-9  # slivers
    weights = rng.dirichlet((0.5, 0.5, 0.5), 20000)
    for point in rng.standard_normal((5, 3)):
        found = triangle_distances(point, corners)
        sampled = np.array([np.linalg.norm(weights @ one - point, axis=1).min() for one in corners])
        assert (found <= sampled + 1e-12).all() and (sampled - found < 0.1).all()


def test_a_triangle_without_area_is_its_edges():
    line, dot = [[0, 0, 0], [2, 0, 0], [1, 0, 0]], [[1, 1, 1]] * 3
    assert triangle_distances((1, 3, 4), np.array([line, dot], float)) == pytest.approx(
        [5.0, 13.0**0.5]
    )


def test_points_on_a_long_sliver_are_on_it():
    corners = np.array([[[0.1, 0.2, 0.3], [3.1, 0.2, 0.3], [1.7, 0.2 + 1e-6, 0.3]]])
    assert triangle_distances(corners[0].mean(axis=0), corners)[0] < 1e-14


def test_each_point_from_its_own_triangle():
    rng = np.random.default_rng(1)
    points, corners = rng.standard_normal((40, 3)), rng.standard_normal((40, 3, 3))
    corners[:5, 2] = corners[:5, 0] + 1e-9
    one_by_one = [triangle_distances(point, own[None])[0] for point, own in zip(points, corners)]
    assert close(triangle_distances(points, corners), one_by_one, 1e-12)
    assert triangle_distances(points[:0], corners[:0]).shape == (0,)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_rectangle_has_its_solid_angle_below_its_corner(way, size):
    corners = size * np.array([[0, 0, 2], [3, 0, 2], [3, 5, 2], [0, 5, 2]], float) * [1.0, 1.0, way]
    points, triangles = moved(
        (corners, np.array([[0, 1, 2], [0, 2, 3]])), rotation(2), (size, 2.0 * size, -size)
    )
    found = winding_number(points, triangles, (size, 2.0 * size, -size))
    assert close(
        found, way * math.atan(15.0 / (2.0 * math.sqrt(38.0))) / (4.0 * math.pi), rel=1e-13
    )
    assert close(
        winding_number(points, triangles[:, ::-1], (size, 2.0 * size, -size)), -found, rel=1e-13
    )


def test_points_inside_a_dense_or_doubled_surface_wind_1_or_2():
    points, triangles = sphere(6)
    for count in (1, 2):
        found = winding_number(points, np.tile(triangles, (count, 1)), (0.1, 0.2, -0.3))
        assert close(found, count, rel=1e-11)
    assert abs(winding_number(points, triangles, (1.1, 0.2, -0.3))) < 1e-11
