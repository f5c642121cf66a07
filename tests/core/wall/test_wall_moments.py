# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls to any order: against fractions, and against a quadrature of the prisms that make them."""

import math
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.exponents import monomials
from body_moments.core.numerics.quadrature import gauss_legendre, triangle_rule
from body_moments.core.wall import offset_solid, wall_moments
from body_moments.core.wall.moments import _strip_moments

from tests.core.bodies import box, grid, sphere, without


def quadrature(wall, inward, outward, order):
    """∫ x^α J ds dλ over all prisms, exact but for rounding: another way than by the sides."""
    table = monomials(order)
    raw, size = np.zeros((2, len(table)))
    nodes, weights = gauss_legendre(order // 2 + 3)
    share, at = triangle_rule(order // 2 + 3)
    points, vectors = wall.points - wall.about, wall.vectors
    for node, weight in zip(-inward + (inward + outward) * nodes, (inward + outward) * weights):
        corners, steps = (points + node * vectors)[wall.triangles], vectors[wall.triangles]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        for column, own in zip(share.T, at):
            place = np.einsum("k,mki->mi", column, corners)
            jacobian = np.einsum("mi,mi->m", normal, np.einsum("k,mki->mi", column, steps))
            values = np.prod(place[:, None] ** table, axis=2)
            raw += weight * own * jacobian @ values
            size += weight * own * np.abs(jacobian) @ np.abs(values)
    return raw, size


@pytest.mark.parametrize(
    "part",
    [sphere(1), without(sphere(1), 0, 1), grid(2), without(box(), 2, 3)],
    ids=["closed", "open", "flat", "tub"],
)
@pytest.mark.parametrize("inward, outward", [(0.05, 0.0), (0.0, 0.2), (0.03, 0.07)])
@pytest.mark.parametrize("order", [4, 9])
def test_wall_moments_match_their_prisms(part, inward, outward, order):
    points = part[0] @ np.array([[1.0, 0.2, 0.0], [0.0, 0.8, 0.1], [0.1, 0.0, 1.3]]) + [
        3.0,
        -1.0,
        2.0,
    ]
    wall = offset_solid(Surface(points, part[1]))
    found = wall_moments(wall, inward, outward, order)
    raw, size = quadrature(wall, inward, outward, order)
    assert (np.abs(found.raw - raw) <= found.rounding_error + 1e-13 * size).all()
    assert (
        found.rounding_error[20:] <= 1e-9 * size[20:].max()
    ).all()  # a bound that says something
    assert not found.input_error.any()
    assert (
        np.abs(found.raw[:20] - wall.moments(inward, outward).raw) <= found.rounding_error[:20]
    ).all()


@pytest.mark.parametrize("thickness", [Fraction(1, 4), Fraction(1, 1024)])
def test_a_hollow_box_is_a_difference_of_boxes(thickness):
    points, triangles = box((-1, -1, -1), (1, 1, 1))
    found = wall_moments(offset_solid(Surface(points, triangles)), float(thickness), 0.0, 20)
    for powers, value, bound in zip(monomials(20).tolist(), found.raw, found.rounding_error):
        exact = Fraction(0)
        if not any(power % 2 for power in powers):
            whole, hollow = (
                math.prod(2 * side ** (n + 1) / (n + 1) for n in powers)
                for side in (Fraction(1), 1 - thickness)
            )
            exact = whole - hollow
        assert abs(Fraction(value) - exact) <= Fraction(bound)
        assert bound <= 1e-10


def test_storing_points_as_float32_is_in_the_bounds():
    points, triangles = without(sphere(2), 0)
    exact = offset_solid(Surface(points + 0.3, triangles))
    stored = offset_solid(Surface((points + 0.3).astype(np.float32), triangles))
    found, truth = (wall_moments(wall, 0.0, 0.1, 8) for wall in (stored, exact))
    apart = np.abs(found.raw - truth.about_point(found.about).raw)
    assert (apart <= found.input_error + found.rounding_error + truth.rounding_error).all()
    assert (found.input_error[20:] < 1e-4 * np.abs(found.raw[20:]).max()).all() and apart[
        20:
    ].max() > 0.0


def product(*polynomials):
    """Multiply polynomials in u and w: {(i, j): coefficient}."""
    result = {(0, 0): Fraction(1)}
    for one in polynomials:
        before, result = result, {}
        for (i, j), left in before.items():
            for (k, m), right in one.items():
                result[i + k, j + m] = result.get((i + k, j + m), 0) + left * right
    return result


def strip_truth(corners, powers):
    """∫ x^α over the cones from the origin on bilinear patches, (4, k, 3), in fractions."""
    total = Fraction(0)
    for a, b, c, d in np.moveaxis(corners, 1, 0):
        a, b, c, d = ([Fraction(float(x)) for x in corner] for corner in (a, b, c, d))
        place = [{(0, 0): a[i], (1, 0): b[i] - a[i], (0, 1): d[i] - a[i]} for i in range(3)]
        for i in range(3):
            place[i][1, 1] = a[i] - b[i] + c[i] - d[i]
        along = [{(0, 0): p[1, 0], (0, 1): p[1, 1]} for p in place]
        across = [{(0, 0): p[0, 1], (1, 0): p[1, 1]} for p in place]
        for i, j, k, sign in (
            (0, 1, 2, 1),
            (1, 2, 0, 1),
            (2, 0, 1, 1),
            (0, 2, 1, -1),
            (1, 0, 2, -1),
            (2, 1, 0, -1),
        ):
            factors = [place[n] for n in range(3) for _ in range(powers[n])]
            flux = product(place[i], along[j], across[k], *factors)
            total += sign * sum(value / ((m + 1) * (n + 1)) for (m, n), value in flux.items())
    return total / (sum(powers) + 3)


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-9])
def test_strips_far_beyond_their_size_are_within_bounds(size):
    rng = np.random.default_rng(7)
    corners = rng.uniform(-1, 1, (1, 4, 3)) + size * rng.uniform(-1, 1, (4, 4, 3))
    corners[:, 0, 0] -= corners[0, 0, 0]  # one through the plane x = 0, where its place cancels
    found = _strip_moments(corners, np.zeros(3), 3)
    for powers, value, bound in zip(monomials(3).tolist(), found.raw, found.rounding_error):
        assert abs(Fraction(value) - strip_truth(corners, powers)) <= Fraction(bound)
        assert bound <= 1e-12 * size**2
