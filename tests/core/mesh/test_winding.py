# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solid angles of open surfaces, compared with the closed form of a rectangle."""

import math

import numpy as np
import pytest
from body_moments.core.mesh.point_triangle import winding_number

from tests.close import close
from tests.core.bodies import moved, rotation, sphere


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_rectangle_has_its_solid_angle_below_its_corner(way, size):
    corners = size * np.array([[0, 0, 2], [3, 0, 2], [3, 5, 2], [0, 5, 2]], float) * [1.0, 1.0, way]
    points, triangles = moved((corners, np.array([[0, 1, 2], [0, 2, 3]])), rotation(2), (size, 2.0 * size, -size))
    found = winding_number(points, triangles, (size, 2.0 * size, -size))
    assert close(found, way * math.atan(15.0 / (2.0 * math.sqrt(38.0))) / (4.0 * math.pi), rel=1e-13)
    assert close(winding_number(points, triangles[:, ::-1], (size, 2.0 * size, -size)), -found, rel=1e-13)


def test_points_inside_a_dense_or_doubled_surface_wind_1_or_2():
    points, triangles = sphere(6)
    for count in (1, 2):
        found = winding_number(points, np.tile(triangles, (count, 1)), (0.1, 0.2, -0.3))
        assert close(found, count, rel=1e-11)
    assert abs(winding_number(points, triangles, (1.1, 0.2, -0.3))) < 1e-11
