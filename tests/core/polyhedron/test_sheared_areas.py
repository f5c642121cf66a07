# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Areas of images under uneven maps, against digits of the mapped triangles' own."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron.integration import area_of_images

from tests.close import close
from tests.core import exact

RNG = np.random.default_rng(5)
TRIANGLES = np.array(exact.fan(exact.BOX_QUADS))


def truth(points, triangles, linear):
    """The area of the images with exact coordinates."""
    total = Fraction(0)
    for matrix in linear:
        rows = [[Fraction(float(x)) for x in row] for row in matrix]
        mapped = [
            [sum(r * Fraction(float(x)) for r, x in zip(row, point)) for row in rows]
            for point in points
        ]
        total += area(mapped, triangles)
    return total


def area(points, triangles):
    """To forty digits; exact.area_moments takes floats only."""
    total, root = Fraction(0), 10**40
    for i, j, k in triangles:
        u = [b - a for a, b in zip(points[i], points[j])]
        v = [b - a for a, b in zip(points[i], points[k])]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        square = sum(x * x for x in n) * root * root
        total += Fraction(exact.isqrt(square.numerator // square.denominator), 2 * root)
    return total


@pytest.mark.parametrize("offset", [0.0, 1e4])
@pytest.mark.parametrize("size", [1.0, 1e-5, 1e6])
def test_areas_of_images_are_exact_to_their_bounds(offset, size):
    points = size * (RNG.standard_normal((8, 3)) + offset)
    linear = RNG.standard_normal((5, 3, 3))
    linear[0] = np.diag([1.0, -3.0, 0.01])
    linear[1] = [[1, 2, 0], [0, 1, 0], [0, 0, 1]]
    linear[2, 2] = linear[2, 1]  # it flattens
    found = area_of_images(Surface.from_triangles(points, TRIANGLES), linear)
    right = truth(points, TRIANGLES, linear)
    assert abs(Fraction(found.total) - right) <= Fraction(float(found.rounding_error[0]))
    assert found.rounding_error[0] < 1e-12 * found.total
    assert found.input_error[0] == 0.0


def test_a_box_stretched_along_its_edges():
    box = Surface(
        np.array(exact.box((0, 0, 0), (1, 1, 1)), np.float32), quads=np.array(exact.BOX_QUADS)
    )
    found = area_of_images(box, np.array([np.diag([1.0, 2.0, 3.0]), np.diag([4.0, 1.0, 1.0])]))
    assert close(found.total, 22.0 + 18.0, rel=1e-14)


def test_float32_storage_error_of_areas_is_bounded():
    points = RNG.uniform(0.0, 100.0, (8, 3))
    linear = RNG.standard_normal((3, 3, 3))
    found = area_of_images(Surface(points.astype(np.float32), TRIANGLES), linear)
    off = abs(float(truth(points, TRIANGLES, linear) - Fraction(found.total)))
    assert 0.0 < off < found.input_error[0] < 1e-5 * found.total
