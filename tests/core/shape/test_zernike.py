# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solid harmonics, Zernike moments and radial power against closed forms of balls, and by two ways
of the same body.
"""

from fractions import Fraction
from math import pi, sqrt

import numpy as np
import pytest
from body_moments.core.moments import couple, harmonic_moments, monomials
from body_moments.core.shape.zernike import (
    MAX_ORDER_BY_MOMENTS,
    _radial,
    degrees,
    descriptor_error,
    descriptors,
    radial_power,
    zernike_moments,
    zernike_quadrature,
)

from tests.close import close
from tests.core import bodies, shapes
from tests.core.bodies import ball
from tests.core.recursion import moments


def in_ball(part):
    """The body about its center, within the unit ball, and its moments to order 20."""
    points = part[0] - moments(part, 1).center
    points = points / np.linalg.norm(points, axis=1).max()
    return (points, part[1]), moments((points, part[1]), 20, np.zeros(3))


def test_a_full_ball_is_the_first_function_alone():
    found = descriptors(zernike_moments(ball(20), 20))
    assert len(found) == 121 and found[0] == pytest.approx(1.0)
    assert np.abs(found[1:]).max() < 1e-9  # the loss of raw moments of order 20


@pytest.mark.parametrize("radius", [0.3, 0.7])
def test_a_smaller_ball_by_the_closed_form(radius):
    """∫_0^a R_n0 r² dr, R_00 = √3, R_20 = √7 (5r² - 3)/2, R_40 = √11 (63r⁴ - 70r² + 15)/8."""
    found = zernike_moments(ball(20, radius), 20)
    a = radius
    wanted = {
        0: sqrt(3) * a**3 / 3,
        2: sqrt(7) * (a**5 - a**3) / 2,
        4: sqrt(11) * (9 * a**7 - 14 * a**5 + 5 * a**3) / 8,
    }
    for n, integral in wanted.items():
        assert found[n, 0][0].real == pytest.approx(sqrt(3) * integral, abs=1e-14)


def test_a_point_shows_the_addition_theorem():
    """Σ |Y_lm|² = (2l+1)/4π r^2l, whatever the direction."""
    for x in np.random.default_rng(0).normal(size=(5, 3)):
        raw = np.prod(x ** monomials(12), axis=1)
        r = np.linalg.norm(x)
        for (n, degree), one in harmonic_moments(raw, 12).items():
            wanted = (2 * degree + 1) / (4 * pi) * r ** (2 * n)
            assert close((np.abs(one) ** 2).sum(), wanted, rel=1e-10)


def test_three_points_couple_to_their_spanned_scalar():
    """(1 1 1) of three vectors is their determinant, by a known factor, and changes its sign in a
    mirror.
    """
    vectors = np.random.default_rng(1).normal(size=(3, 3))
    ones = [harmonic_moments(np.prod(v ** monomials(1), axis=1), 1)[1, 1] for v in vectors]
    wanted = (3 / (4 * pi)) ** 1.5 / sqrt(6) * np.linalg.det(vectors)
    assert abs(couple(*ones)) == pytest.approx(abs(wanted))
    mirrored = [
        harmonic_moments(np.prod((v * [-1, 1, 1]) ** monomials(1), axis=1), 1)[1, 1]
        for v in vectors
    ]
    assert couple(*mirrored) == pytest.approx(-couple(*ones))


@pytest.mark.parametrize(
    "part", [shapes.WEDGE, bodies.torus(12, 8), bodies.sphere(1), shapes.STEPPED]
)
def test_moments_and_quadrature_agree_to_the_reported_loss(part):
    body, found = in_ball(bodies.moved(part, bodies.rotation(3)))
    by_moments = zernike_moments(found.raw, 20)
    by_quadrature = zernike_quadrature(*body, 20)
    lost = descriptor_error(found.raw, 20)
    assert lost < 1e-9
    assert np.abs(descriptors(by_moments) - descriptors(by_quadrature)).max() < 10.0 * lost
    for key, one in by_moments.items():
        assert np.abs(one - by_quadrature[key]).max() < 1e-9


def test_quadrature_continues_beyond_the_moments():
    """Order 40 of an octahedron: the same turned, and of ever finer faces; and Parseval's sum is
    never passed.
    """
    body, _ = in_ball(bodies.sphere(0))
    first = zernike_quadrature(*body, 40)
    turned = zernike_quadrature(*bodies.moved(body, bodies.rotation(1)), 40)
    finer = zernike_quadrature(*shapes.refined(body, 2), 40)
    assert np.abs(descriptors(first) - descriptors(turned)).max() < 1e-12
    assert np.abs(descriptors(first) - descriptors(finer)).max() < 1e-12
    whole = 3 / (4 * pi) * bodies.volume(body)
    assert 0.96 * whole < (descriptors(first) ** 2).sum() < whole


def test_the_power_of_a_ball_is_known():
    q, radius = np.array([1e-9, 0.5, 1.0, 3.0, 8.0, 12.0]), 0.8
    power = radial_power(zernike_moments(ball(20, radius), 20), q)
    s = q * radius
    with np.errstate(invalid="ignore"):
        wanted = 4 * pi * (np.sin(s) - s * np.cos(s)) / q**3
    wanted[0] = 4 * pi / 3 * radius**3
    assert np.all(np.abs(power - wanted**2) < [1e-9, 1e-9, 1e-9, 1e-9, 1e-8, 1e-6])
    assert close(power[0], wanted[0] ** 2, 1e-13)


def test_high_frequency_power_matches_exact_bessel_functions():
    """For Ω_00 alone 4π/√3 (j_1(q)/q)², and for Ω_20 alone the same with √7 j_3(q)/q."""
    q = np.array([40.0, 150.5, 400.25])
    sine, cosine = np.sin(q), np.cos(q)
    j1, j3 = (
        (sine / q - cosine) / q,
        ((15.0 / q**3 - 6.0 / q) * sine - (15.0 / q**2 - 1.0) * cosine) / q,
    )
    scale = (4.0 * pi) ** 2 / 3.0
    for n, j in ((0, j1), (2, j3)):
        one = {(k, l): np.full(2 * l + 1, 0.1 * (k == n and l == 0) + 0j) for k, l in degrees(n)}
        assert close(radial_power(one, q), scale * (2 * n + 3) * (0.1 * j / q) ** 2, 1e-10)


def test_the_power_of_a_box_is_the_mean_of_its_products_of_sincs():
    half = np.array([0.5, 0.4, 0.3])
    body = bodies.box(-half, half)
    z = zernike_moments(moments(body, 20, np.zeros(3)).raw, 20)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    phi = np.arange(80) * 2 * pi / 80
    direction = np.stack(
        [
            np.outer(np.sqrt(1 - nodes**2), np.cos(phi)),
            np.outer(np.sqrt(1 - nodes**2), np.sin(phi)),
            np.outer(nodes, np.ones(80)),
        ],
        axis=-1,
    )
    q = np.array([1.0, 4.0, 9.0])
    power = radial_power(z, q)
    for i, value in enumerate(q):
        f = np.prod(2 * half * np.sinc(value * direction * half / pi), axis=-1)
        wanted = (weights[:, None] * f**2).sum() / 160
        assert abs(power[i] - wanted) < 1e-10


def test_radial_polynomials_are_orthogonal_on_the_disc():
    for m in range(MAX_ORDER_BY_MOMENTS + 1):
        radial = {
            n: [(m + 2 * i, float(c)) for i, c in enumerate(_radial((n - m) // 2, Fraction(m)))]
            for n, other in degrees(MAX_ORDER_BY_MOMENTS)
            if other == m
        }
        for n, terms in radial.items():
            assert sum(factor for _, factor in terms) == 1.0
            for k, others in radial.items():
                product = sum(
                    Fraction(a) * Fraction(b) / (s + t + 2) for s, a in terms for t, b in others
                )
                assert product == (Fraction(1, 2 * n + 2) if n == k else 0)
