# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Areas of images under uneven maps, against digits of the mapped triangles' own."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import sheared_areas as images
from body_moments.core.polyhedron.sheared_areas import area_of_images

from tests.close import close
from tests.core import exact

RNG = np.random.default_rng(5)
TRIANGLES = np.array(exact.fan(exact.BOX_QUADS))


def truth(points, triangles, linear):
    """The area of the images with exact coordinates."""
    total = Fraction(0)
    for matrix in linear:
        rows = [[Fraction(float(x)) for x in row] for row in matrix]
        mapped = [[sum(r * Fraction(float(x)) for r, x in zip(row, point)) for row in rows] for point in points]
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
    box = Surface(np.array(exact.box((0, 0, 0), (1, 1, 1)), np.float32), quads=np.array(exact.BOX_QUADS))
    found = area_of_images(box, np.array([np.diag([1.0, 2.0, 3.0]), np.diag([4.0, 1.0, 1.0])]))
    assert close(found.total, 22.0 + 18.0, rel=1e-15)


def test_what_float32_may_have_moved_is_bounded():
    points = RNG.uniform(0.0, 100.0, (8, 3))
    linear = RNG.standard_normal((3, 3, 3))
    found = area_of_images(Surface(points.astype(np.float32), TRIANGLES), linear)
    off = abs(float(truth(points, TRIANGLES, linear) - Fraction(found.total)))
    assert 0.0 < off < found.input_error[0] < 1e-5 * found.total


def test_faces_that_are_points_may_have_had_the_area_of_the_largest_triangle_of_their_box_each():
    h, count = 1e-3, 20
    points, triangles = np.zeros((3, 3)), np.tile(np.arange(3), (count, 1))
    found = area_of_images(Surface(points, triangles, displacement=np.full(3, h)), np.eye(3)[None])
    largest = np.sqrt(3.0) / 4.0 * (2.0 * np.sqrt(2.0) * h) ** 2  # of three corners of a cube of side 2h
    assert found.total == 0.0 and count * largest <= found.input_error[0] <= 8.0 * count * largest


@pytest.mark.parametrize("at_a_time", [1 << 17, 20])
def test_bounds_are_those_that_are_derived(monkeypatch, at_a_time):
    """Nine and two roundings of each cofactor and of its terms, for the terms of the normals; one more for each block,
    and 128 for the sum. What storing moves, from the edges and the steps."""
    monkeypatch.setattr(images, "PRODUCTS_PER_BLOCK", at_a_time)
    points, linear, h = RNG.standard_normal((8, 3)), RNG.standard_normal((2, 3, 3)), np.array([1e-3, 3e-3, 5e-3])
    found = area_of_images(Surface(points, TRIANGLES, displacement=h), linear)
    blocks = -(-len(TRIANGLES) // max(1, at_a_time // len(linear)))
    rounded, moved = (128 + blocks) * found.total, 0.0
    for j, k in ((1, 2), (2, 0), (0, 1)):
        terms = steps = 0.0
        for a, b, c in points[TRIANGLES]:
            first, second = np.abs(b - a), np.abs(c - a)
            terms += first[j] * second[k] + first[k] * second[j]
            steps += 2.0 * ((first + second)[j] * h[k] + (first + second)[k] * h[j]) + 8.0 * h[j] * h[k]
        for matrix in linear:
            for row in range(3):
                upper, lower = matrix[(row + 1) % 3], matrix[(row + 2) % 3]
                cofactor = abs(upper[j] * lower[k] - upper[k] * lower[j])
                rounded += (9.0 * cofactor + 2.0 * (abs(upper[j] * lower[k]) + abs(upper[k] * lower[j]))) * terms / 2.0
                moved += cofactor * steps / 2.0
    assert found.about.tolist() == [0.0, 0.0, 0.0]
    assert close(found.input_error, [moved], rel=1e-12)
    assert close(found.rounding_error, [2.0**-53 * rounded], rel=1e-8)
    assert found.rounding_error[0] >= 2.0**-53 * rounded * (1.0 + 1e-10)


def test_many_maps_and_faces_go_in_blocks(monkeypatch):
    points, linear = RNG.standard_normal((8, 3)), RNG.standard_normal((7, 3, 3))
    surface = Surface.from_triangles(points, TRIANGLES)
    whole = area_of_images(surface, linear)
    monkeypatch.setattr(images, "PRODUCTS_PER_BLOCK", 20)
    assert close(area_of_images(surface, linear).total, whole.total, rel=1e-15)
