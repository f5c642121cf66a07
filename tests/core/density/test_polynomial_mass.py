# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polynomial densities: mass moments against rational arithmetic, in any frame, at any place and
size.
"""

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from body_moments.core.density import (
    Polynomial,
    local_coordinates,
    parse_polynomial,
    polynomial_mass_of_images,
)
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.point_triangle import winding_number
from body_moments.core.moments import Moments, sum_of_images
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.close import close
from tests.core import bodies, exact

PRISM = (
    [(0.0, 0.0), (3.0, 0.0), (3.5, 1.0), (1.0, 1.0), (1.0, 2.5), (0.0, 2.0)],
    -0.25,
    0.5,
    [(0, 1, 2, 3), (0, 3, 4, 5)],
)
DENSITIES = [
    "1000 + 20*z",
    "7",
    "3 - x/4 + x*y + z**2/8",
    "(1 + x + y + z)**4",
    "x**6 + y**5*z**2 + 1/3",
    "0",
]


def prism(offset=(0.0, 0.0, 0.0)):
    points, faces = exact.prism(*PRISM)
    return [tuple(a + b for a, b in zip(point, offset)) for point in points], exact.fan(faces)


def moments_of(points, triangles, order, about=None):
    """Moments rounded once from rational ones: half an ulp each, and a bound that says so."""
    about = np.asarray(np.mean(points, axis=0) if about is None else about, float)
    raw = np.array(
        [float(value) for value in exact.volume_moments(points, triangles, about, order)]
    )
    return Moments(
        raw, about, "volume", rounding_error=np.abs(raw) * 2.0**-53, input_error=np.abs(raw) * 1e-9
    )


def truth(points, triangles, terms, about):
    """The rational mass moments to third order about a point, by developing the density's terms
    about it.
    """
    about = [Fraction(value) for value in np.asarray(about, float).tolist()]
    degree = max((sum(powers) for powers in terms), default=0)
    rows = exact.monomials(3 + degree)
    volume = dict(
        zip(rows, exact.volume_moments(points, triangles, [float(a) for a in about], 3 + degree))
    )
    local = {}
    for powers, value in terms.items():
        for i in range(powers[0] + 1):
            for j in range(powers[1] + 1):
                for k in range(powers[2] + 1):
                    lower = (i, j, k)
                    factor = value
                    for n, m, a in zip(powers, lower, about):
                        factor *= comb(n, m) * a ** (n - m)
                    local[lower] = local.get(lower, 0) + factor
    return [
        sum(
            value * volume[tuple(a + b for a, b in zip(row, powers))]
            for powers, value in local.items()
        )
        for row in exact.MONOMIALS
    ]


def within(found, expected):
    return all(
        abs(Fraction(value) - true) <= Fraction(bound)
        for value, true, bound in zip(found.raw.tolist(), expected, found.rounding_error.tolist())
    )


@pytest.mark.parametrize("text", DENSITIES)
@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (1024.0, -2048.0, 512.0)])
def test_mass_moments_are_exact_within_their_bounds(text, offset):
    points, triangles = prism(offset)
    density = parse_polynomial(text)
    volume = moments_of(points, triangles, 3 + density.degree)
    found = polynomial_mass_of_images(volume, density, np.eye(4)[None])
    assert found.measure == "mass" and found.order == 3
    assert within(found, truth(points, triangles, density.terms, found.about))
    size = polynomial_mass_of_images(
        volume, Polynomial({p: abs(v) for p, v in density.terms.items()}), np.eye(4)[None]
    ).raw[0]
    assert found.rounding_error[0] <= 1e-12 * abs(size)


def test_a_density_given_far_away_loses_no_digits():
    """(z - 10000)² on a body at 10000: its expanded coefficients cancel to nothing, the rational
    ones do not.
    """
    points, triangles = prism((0.0, 0.0, 10000.0))
    density = parse_polynomial("(z - 10000)**2 + 1")
    found = polynomial_mass_of_images(moments_of(points, triangles, 5), density, np.eye(4)[None])
    expected = truth(points, triangles, density.terms, found.about)
    assert within(found, expected)
    assert close(found.total, float(expected[0]), rel=1e-13)
    assert found.rounding_error[0] < 1e-11 * found.total


@pytest.mark.parametrize("text", ["7", "2 + z/1000**6"])
@pytest.mark.parametrize("step", [0.0, 0.6])
def test_bounds_hold_for_a_body_with_lost_position(text, step):
    """It is a few units large and 2^60 away, where numbers are 256 apart."""
    far = [Fraction(2) ** 60, -(Fraction(2) ** 59), Fraction(2) ** 60]
    points, triangles = prism((step, -step, step))
    matrix = np.eye(4)
    matrix[:3, 3] = [float(value) for value in far]
    density = parse_polynomial(text)
    found = polynomial_mass_of_images(
        moments_of(points, triangles, 3 + density.degree), density, matrix[None]
    )
    images = [[Fraction(x) + shift for x, shift in zip(point, far)] for point in points]
    assert within(found, truth(images, triangles, density.terms, found.about))


def placed(points, matrix):
    """Rational images of points under a map of floats, as floats; the map is chosen so that they
    need no rounding.
    """
    rows = [[Fraction(float(value)) for value in row] for row in matrix]
    images = [
        [sum(a * Fraction(x) for a, x in zip(row[:3], point)) + row[3] for row in rows[:3]]
        for point in points
    ]
    assert all(Fraction(float(value)) == value for image in images for value in image)
    return [tuple(float(value) for value in image) for image in images]


MAPS = {
    "moved": [[1, 0, 0, 5], [0, 1, 0, -3], [0, 0, 1, 0.25], [0, 0, 0, 1]],
    "turned": [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]],
    "mirrored": [[-1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
    "uneven": [[2, 0, 0, 0], [0, 0.5, 0, 1], [0, 0, 3, -1], [0, 0, 0, 1]],
    "sheared": [[1, 0.5, 0, 0], [0, 1, 0.25, 0], [0.125, 0, 1, 8], [0, 0, 0, 1]],
    "tiny": [[2.0**-20, 0, 0, 0], [0, 2.0**-20, 0, 0], [0, 0, 2.0**-20, 0], [0, 0, 0, 1]],
}


@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize("text", ["1000 + 20*z", "2 + x*y + z**2 + x**3/16"])
def test_world_density_stays_in_place_while_the_body_moves(name, text):
    """The truth is the mapped body itself, in rationals."""
    points, triangles = prism()
    matrix = np.array(MAPS[name], float)
    density = parse_polynomial(text)
    found = polynomial_mass_of_images(
        moments_of(points, triangles, 3 + density.degree), density, matrix[None]
    )
    faces = [face[::-1] for face in triangles] if np.linalg.det(matrix) < 0 else triangles
    assert within(found, truth(placed(points, matrix), faces, density.terms, found.about))


@settings(deadline=None, max_examples=40)
@given(
    st.lists(st.floats(-1e3, 1e3, width=32), min_size=1, max_size=56),
    st.lists(st.integers(-24, 24), min_size=9, max_size=9),
    st.lists(st.integers(-(2**12), 2**12), min_size=3, max_size=3),
)
@example([1e3 / (k + 3) for k in range(165)], [8, 0, 0, 0, 8, 0, 0, 0, 8], [0, 0, 0])
def test_the_bound_holds_for_any_density_and_any_map(coefficients, linear, offset):
    """Maps of eighths and a body of quarters: images need no rounding, and the truth is
    rational.
    """
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = np.reshape(linear, (3, 3)) / 8.0, offset
    points, triangles = prism()
    density = Polynomial.from_list([*map(Fraction, coefficients)])
    found = polynomial_mass_of_images(
        moments_of(points, triangles, 3 + density.degree), density, matrix[None]
    )
    faces = [face[::-1] for face in triangles] if np.linalg.det(matrix) < 0 else triangles
    assert within(found, truth(placed(points, matrix), faces, density.terms, found.about))


@pytest.mark.parametrize("name", ["moved", "turned", "mirrored", "uneven", "tiny"])
def test_own_density_moves_turns_and_mirrors_with_the_body(name):
    """Along its own axes a scaled body is the body with scaled coordinates: measure that, and map
    it rigidly.
    """
    points, triangles = prism()
    matrix = np.array(MAPS[name], float)
    density = parse_polynomial("2 + x*y + z**2")
    found = polynomial_mass_of_images(
        moments_of(points, triangles, 5), density, matrix[None], local_coordinates(matrix[None])
    )
    assert local_coordinates(matrix[None]).shape == (1, 4, 4)
    size = np.linalg.norm(matrix[:3, :3], axis=0)
    scaled = [tuple(point * size) for point in np.array(points)]
    rigid = matrix.copy()
    rigid[:3, :3] /= size
    raw = np.array([float(v) for v in truth(scaled, triangles, density.terms, (0, 0, 0))])
    expected = Moments(raw, np.zeros(3), "mass").transform(rigid).about_point(found.about)
    degree = np.repeat([0, 1, 2, 3], [1, 3, 6, 10])
    scale = np.abs(expected.raw[0]) * np.abs(np.array(scaled)).max() ** degree
    assert (np.abs(found.raw - expected.raw) <= 3e-13 * scale).all()


def test_many_images_sum_and_constant_density_is_a_factor():
    rng = np.random.default_rng(5)
    points, triangles = prism()
    volume = moments_of(points, triangles, 5)
    maps = np.tile(np.eye(4), (1500, 1, 1))  # more than a block
    maps[:, :3, :3] += rng.normal(size=(1500, 3, 3)) * 0.2
    maps[:, :3, 3] = rng.normal(size=(1500, 3)) * 10.0
    density = parse_polynomial("50 + x*y - z**2/1000")
    together = polynomial_mass_of_images(volume, density, maps, about=(0, 0, 0))
    each = [
        polynomial_mass_of_images(volume, density, maps[part], about=(0, 0, 0))
        for part in (slice(0, 1), slice(1, 2), slice(2, 600), slice(600, None))
    ]
    total = np.sum([one.raw for one in each], axis=0)
    bound = together.rounding_error + np.sum([one.rounding_error for one in each], axis=0)
    assert (np.abs(together.raw - total) <= bound).all() and (
        bound < 1e-9 * np.abs(total).max()
    ).all()
    constant, plain = (
        polynomial_mass_of_images(volume, parse_polynomial("7"), maps),
        sum_of_images(volume, maps),
    )
    assert (
        np.abs(constant.raw - 7.0 * plain.raw)
        <= constant.rounding_error + 7.0 * plain.rounding_error
    ).all()


def test_the_input_bound_follows_the_density():
    points, triangles = prism()
    volume = moments_of(points, triangles, 4)
    one, ten = (
        polynomial_mass_of_images(volume, parse_polynomial(text), np.eye(4)[None]).input_error
        for text in ("1 + z", "10 + 10*z")
    )
    assert close(ten, 10.0 * one, rel=1e-5) and one[0] >= volume.input_error[0]


def test_a_cylinder_with_a_linear_density():
    """A 256-gon prism of circumradius R, 0 ≤ z ≤ h, ρ = a + b z: m = A h (a + b h / 2) and
    z_c = (a h / 2 + b h² / 3) / (a + b h / 2); about the axis I = m k² with the polygon's own k².
    """
    n, radius, height, a, b = 256, 0.5, 2.0, 1000.0, 20.0
    angle = 2.0 * np.pi * np.arange(n) / n
    outline = list(zip((radius * np.cos(angle)).tolist(), (radius * np.sin(angle)).tolist()))
    points, faces = exact.prism(outline, 0.0, height, [tuple(range(n))])
    found = polynomial_mass_of_images(
        moments_of(points, exact.fan(faces), 4), parse_polynomial("1000 + 20*z"), np.eye(4)[None]
    )
    area = n / 2.0 * radius**2 * np.sin(2.0 * np.pi / n)
    body = MassProperties.from_moments(found)
    assert body.mass == pytest.approx(area * height * (a + b * height / 2.0), rel=1e-14)
    z = (a * height / 2.0 + b * height**2 / 3.0) / (a + b * height / 2.0)
    assert body.center == pytest.approx([0.0, 0.0, z], abs=1e-14)
    # a regular polygon about its center
    gyration = radius**2 / 6.0 * (2.0 + np.cos(2.0 * np.pi / n))
    assert body.inertia[2, 2] == pytest.approx(body.mass * gyration, rel=1e-13)


def test_a_ball_with_a_radial_density_by_refinement():
    """ρ = r²: M = 4 π / 5 and I = (8 π / 3) / 7 in the limit; inscribed polyhedra come from below,
    four times nearer with each halving of the edges.
    """
    wrong = []
    for level in (2, 3):
        points, triangles = bodies.sphere(level)
        volume = moments_of(points.tolist(), triangles.tolist(), 5, (0, 0, 0))
        body = MassProperties.from_moments(
            polynomial_mass_of_images(
                volume, parse_polynomial("x**2 + y**2 + z**2"), np.eye(4)[None]
            )
        )
        wrong.append(
            [1.0 - body.mass / (0.8 * np.pi), 1.0 - body.inertia[0, 0] / (8.0 * np.pi / 21.0)]
        )
    ratio = np.array(wrong[0]) / np.array(wrong[1])
    assert (np.array(wrong) > 0.0).all() and (ratio > 3.6).all() and (ratio < 4.1).all()


def test_insufficient_order_is_refused():
    with pytest.raises(ValueError, match="below"):
        polynomial_mass_of_images(
            moments_of(*prism(), 3), parse_polynomial("x**4"), np.eye(4)[None]
        )


def test_the_winding_number_tells_inside_from_outside():
    points, triangles = prism()
    points, triangles = np.array(points), np.array(triangles)
    assert winding_number(points, triangles, (0.5, 0.5, 0.0)) == pytest.approx(1.0, abs=1e-12)
    # in the notch
    assert winding_number(points, triangles, (2.0, 2.0, 0.0)) == pytest.approx(0.0, abs=1e-12)
    assert winding_number(points, triangles[:, ::-1], (0.5, 0.5, 0.0)) == pytest.approx(
        -1.0, abs=1e-12
    )
