# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to order 12 against closed forms: the box exactly; round bodies in the limit of finer
meshes, whose moments come nearer with the square of the step, so that three meshes tell the limit
to many more digits.

With G = Γ: A_pq = ∫ cos^p sin^q = 2 G((p+1)/2) G((q+1)/2) / G((p+q+2)/2), and the disc's moments
are R^(p+q+2) A_pq / (p+q+2), p and q even.
"""

from fractions import Fraction
from math import comb, gamma, prod

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import monomials
from body_moments.core.polyhedron import polyhedron_moments
from hypothesis import given

from tests.close import close
from tests.core import exact
from tests.core.bodies import grid_torus
from tests.core.strategies import holds, seeds

ORDER = 12
TABLE = [tuple(row) for row in monomials(ORDER).tolist()]


def half_gammas(p, q, r):
    return 2.0 * prod(gamma((k + 1) / 2) for k in (p, q, r))


def circle(p, q):
    return (
        0.0
        if p % 2 or q % 2
        else 2.0 * gamma((p + 1) / 2) * gamma((q + 1) / 2) / gamma((p + q + 2) / 2)
    )


def disc(p, q, radius):
    return radius ** (p + q + 2) * circle(p, q) / (p + q + 2)


def between(low, high, r):
    return (high ** (r + 1) - low ** (r + 1)) / (r + 1)


def ellipsoid_volume(p, q, r, axes=(1.0, 0.75, 0.5)):
    if p % 2 or q % 2 or r % 2:
        return 0.0
    n = p + q + r
    return (
        prod(a ** (k + 1) for a, k in zip(axes, (p, q, r)))
        * half_gammas(p, q, r)
        / ((n + 3) * gamma((n + 3) / 2))
    )


def cone_volume(p, q, r, radius=0.8, height=1.2):
    return disc(p, q, radius) * height ** (r + 1) / (p + q + r + 3)


def torus_volume(p, q, r, major=1.0, minor=0.4):
    return circle(p, q) * sum(
        comb(p + q + 1, k) * major ** (p + q + 1 - k) * disc(k, r, minor) for k in range(p + q + 2)
    )


def torus_surface(p, q, r, major=1.0, minor=0.4):
    return circle(p, q) * sum(
        comb(p + q + 1, k) * major ** (p + q + 1 - k) * minor ** (k + r + 1) * circle(k, r)
        for k in range(p + q + 2)
    )


def slice_volume(p, q, r, radius=1.0, low=-0.5, high=0.75):
    """Return the moments of a ball between two planes."""
    if p % 2 or q % 2:
        return 0.0
    m = (p + q + 2) // 2
    return disc(p, q, 1.0) * sum(
        comb(m, k) * (-1) ** k * radius ** (2 * (m - k)) * between(low, high, 2 * k + r)
        for k in range(m + 1)
    )


def lathe(profile, n):
    """The body that an outline in the half-plane (radius, z), from the axis to the axis, sweeps in
    n steps.
    """
    turn = np.arange(n) * (2.0 * np.pi / n)
    rings = [
        np.stack([r * np.cos(turn), r * np.sin(turn), np.full(n, z)], axis=1)
        for r, z in profile[1:-1]
    ]
    points = np.concatenate([[[0.0, 0.0, profile[0][1]]], *rings, [[0.0, 0.0, profile[-1][1]]]])
    i, last = np.arange(n), len(points) - 1
    j = (i + 1) % n
    bottom = np.stack([np.zeros(n, int), 1 + j, 1 + i], axis=1)
    top = np.stack([np.full(n, last), last - n + i, last - n + j], axis=1)
    starts = 1 + n * np.arange(len(rings) - 1)[:, None]
    quads = np.stack([starts + i, starts + j, starts + n + j, starts + n + i], axis=-1).reshape(
        -1, 4
    )
    return Surface(points, np.concatenate([bottom, top]), quads)


def ellipsoid(n, axes=(1.0, 0.75, 0.5)):
    angle = np.linspace(-np.pi / 2, np.pi / 2, n // 2 + 1)
    ball = lathe([(max(np.cos(t), 0.0), np.sin(t)) for t in angle], n)
    return Surface(ball.points * axes, ball.triangles, ball.quads)


def cylinder(n):
    return lathe([(0.0, -0.25), (0.8, -0.25), (0.8, 1.0), (0.0, 1.0)], n)


def cone(n):
    return lathe([(0.0, 0.0), (0.8, 1.2), (0.0, 1.2)], n)


def slice_of_ball(n):
    angle = np.linspace(np.arcsin(-0.5), np.arcsin(0.75), n // 2 + 1)
    return lathe([(0.0, -0.5), *((np.cos(t), np.sin(t)) for t in angle), (0.0, 0.75)], n)


def torus(n):
    points, quads = grid_torus(n, n)
    return Surface(points, quads=quads)


BODIES = {
    "ellipsoid": (ellipsoid, ellipsoid_volume, None),
    "sphere": (
        lambda n: ellipsoid(n, (1.0, 1.0, 1.0)),
        lambda p, q, r: ellipsoid_volume(p, q, r, (1, 1, 1)),
        lambda p, q, r: (
            0.0 if p % 2 or q % 2 or r % 2 else half_gammas(p, q, r) / gamma((p + q + r + 3) / 2)
        ),
    ),
    "cylinder": (cylinder, lambda p, q, r: disc(p, q, 0.8) * between(-0.25, 1.0, r), None),
    "cone": (cone, cone_volume, None),
    "torus": (torus, torus_volume, torus_surface),
    "ball between planes": (slice_of_ball, slice_volume, None),
}


@pytest.mark.parametrize("name", BODIES)
def test_finer_meshes_come_to_the_closed_form_at_the_right_rate(name):
    body, *forms = BODIES[name]
    meshes = [
        polyhedron_moments(body(n), ORDER, area_order=ORDER, about=np.zeros(3))
        for n in (48, 96, 192)
    ]
    for number, form in enumerate(forms):
        if form is None:
            continue
        truth = np.array([form(*powers) for powers in TABLE])
        coarse, fine, finest = (moments[number].raw for moments in meshes)
        limit = (
            64.0 * finest - 20.0 * fine + coarse
        ) / 45.0  # without the second and the fourth power of the step
        scale = np.abs(truth).max()
        assert (np.abs(limit - truth) <= 2e-6 * np.abs(truth) + 1e-14 * scale).all()
        some = np.abs(truth) > 0.0
        assert some.sum() >= 84  # the others are zero by symmetry, and are so in the mesh
        off = [np.abs(moments - truth)[some] for moments in (coarse, fine, finest)]
        assert (off[2] < 0.02 * np.abs(truth[some])).all() and (off[2] > 0.0).all()
        order = np.log2(off[1] / off[2])
        assert (
            np.median(order) == pytest.approx(2.0, abs=0.02) and (np.abs(order - 2.0) < 0.5).all()
        )


def test_a_box_off_the_origin_is_its_closed_form_to_order_12():
    low, high = (1, -2, 3), (3, 1, 8)
    points = np.array(exact.box(low, high), float)
    volume, area = polyhedron_moments(
        Surface(points, quads=np.array(exact.BOX_QUADS)), ORDER, area_order=ORDER
    )
    about = volume.about.tolist()
    truth = exact.box_moments(
        [a - c for a, c in zip(low, about)], [b - c for b, c in zip(high, about)], ORDER
    )
    for value, right, bound in zip(volume.raw, truth, volume.rounding_error):
        assert abs(Fraction(float(value)) - right) <= Fraction(float(bound))
        assert abs(float(value) - float(right)) <= 1e-14 * float(truth[-1])
    even = [i for i, powers in enumerate(TABLE) if not any(k % 2 for k in powers)]
    assert max(abs(volume.raw[i] / float(truth[i]) - 1.0) for i in even) < 1e-14
    at_origin = volume.about_point(np.zeros(3))
    right = np.array([float(value) for value in exact.box_moments(low, high, ORDER)])
    assert np.allclose(at_origin.raw, right, rtol=1e-11, atol=0.0)
    sides = 0.0  # the surface: integrals of x⁴ z² over the six sides
    half = [(b - a) / 2 for a, b in zip(low, high)]
    for axis in range(3):
        rest = [2.0 * half[j] ** (k + 1) / (k + 1) for j, k in enumerate((4, 0, 2)) if j != axis]
        sides += 2.0 * half[axis] ** (4, 0, 2)[axis] * rest[0] * rest[1]
    assert close(area[4, 0, 2], sides, rel=1e-14)


@holds(3)
@given(seed=seeds)
def test_a_corner_tetrahedron_is_dirichlets_integral(seed):
    a, b, c = np.random.default_rng(seed).integers(1, 9, 3).tolist()
    points = np.array([(0, 0, 0), (a, 0, 0), (0, b, 0), (0, 0, c)], float)
    surface = Surface(points, np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]))
    volume, _ = polyhedron_moments(surface, ORDER, about=np.zeros(3))
    truth = exact.corner_tetrahedron_moments(a, b, c, ORDER)
    assert (
        max(abs(float(value) / float(right) - 1.0) for value, right in zip(volume.raw, truth))
        < 1e-14
    )
