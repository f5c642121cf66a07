# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of first moments by vertices: identities, rational arithmetic, and differences of
measurements.
"""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.moments.raw import monomials
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.statics.gradient import area_gradient, volume_gradient

from tests.core import bodies, exact

EYE = np.eye(3, dtype=int)
SHEAR = np.array([[1.0, 0.4, -0.2], [0.1, 0.7, 0.3], [0.0, -0.25, 1.5]])
BODIES = {
    "ball": bodies.sphere(2),
    "torus": bodies.moved(bodies.torus(9, 7), SHEAR, (0.5, -0.25, 0.125)),
    "far": bodies.moved(bodies.sphere(1), SHEAR, (1000.0, -500.0, 250.0)),
    "tiny": bodies.moved(bodies.torus(6, 5), 1e-4 * SHEAR, (1e-3, 0.0, 0.0)),
    "hollow": bodies.joined(
        bodies.box(high=(3, 3, 3)), bodies.inverted(bodies.box((1, 1, 1), (2, 2, 2)))
    ),
}
KINDS = {"volume": volume_gradient, "area": area_gradient}


def measured(part, kind):
    return polyhedron_moments(bodies.surface(part), area_order=3)[kind == "area"]


def size(part, kind):
    """The natural size of a derivative of the total."""
    points, triangles = part
    longest = np.ptp(points, axis=0).max()
    return longest ** (2 if kind == "volume" else 1) * len(triangles)


def dyadic(part):
    return np.round(part[0] * 64) / 64, part[1]


@pytest.fixture(params=BODIES)
def part(request):
    return BODIES[request.param]


@pytest.fixture(params=KINDS)
def kind(request):
    return request.param


def test_derivative_of_a_translation_follows_the_reference_point(part, kind):
    moments = measured(part, kind)
    gradient = KINDS[kind](bodies.surface(part), moments.about)
    total, longest = gradient.sum(axis=0), np.ptp(part[0], axis=0).max()
    assert np.abs(total[0]).max() <= 1e-15 * size(part, kind)
    assert np.abs(total[1:] - moments.total * EYE).max() <= 1e-15 * size(part, kind) * longest


def test_turning_the_body_turns_its_moments(part, kind):
    moments = measured(part, kind)
    gradient = KINDS[kind](bodies.surface(part), moments.about)
    places = part[0] - moments.about
    largest = 1e-15 * size(part, kind) * np.abs(places).max()
    for axis in range(3):
        turn = np.cross(EYE[axis], places)
        rate = np.einsum("nak,nk->a", gradient, turn)
        cross = np.cross(EYE[axis], np.eye(3)).T  # x -> axis × x
        assert abs(rate[0]) <= largest
        assert np.abs(rate[1:] - cross @ moments.raw[1:4]).max() <= largest * np.abs(places).max()


@pytest.mark.parametrize("name", ["ball", "torus", "hollow"])
def test_volume_derivatives_match_rational_arithmetic(name):
    points, triangles = dyadic(BODIES[name])
    about = np.array([0.25, -0.5, 0.125])
    gradient = volume_gradient(bodies.surface((points, triangles)), about, order=2)
    h = 2.0**-6
    for vertex in (0, len(points) // 2, len(points) - 1):
        for axis in range(3):

            def at(steps, vertex=vertex, axis=axis):
                moved = points.copy()
                moved[vertex, axis] += steps * h
                return exact.volume_moments(moved, triangles, about)[:10]

            near, far = ([a - b for a, b in zip(at(k), at(-k))] for k in (1, 2))
            # exact to degree 4
            truth = [(8 * one - other) / (12 * Fraction(h)) for one, other in zip(near, far)]
            for i in range(10):
                assert abs(Fraction(float(gradient[vertex, i, axis])) - truth[i]) <= 1e-13


@pytest.mark.parametrize("name", ["ball", "torus", "hollow"])
def test_area_derivatives_match_high_precision(name):
    points, triangles = dyadic(BODIES[name])
    about = np.array([0.25, -0.5, 0.125])
    gradient = area_gradient(bodies.surface((points, triangles)), about)
    h = 2.0**-20
    for vertex in (0, len(points) - 1):
        for axis in range(3):

            def at(steps, vertex=vertex, axis=axis):
                moved = points.copy()
                moved[vertex, axis] += steps * h
                touched = triangles[(triangles == vertex).any(axis=1)]
                return exact.area_moments(moved, touched, about, digits=60)[:4]

            near, far = ([a - b for a, b in zip(at(k), at(-k))] for k in (1, 2))
            truth = [(8 * one - other) / (12 * Fraction(h)) for one, other in zip(near, far)]
            for i in range(4):
                assert abs(Fraction(float(gradient[vertex, i, axis])) - truth[i]) <= 1e-13


def test_center_follows_with_nothing_more(kind):
    part = BODIES["torus"]
    moments = measured(part, kind).about_center()
    gradient = KINDS[kind](bodies.surface(part), moments.about)
    center = gradient[:, 1:] / moments.total
    rng = np.random.default_rng(1)
    step = rng.normal(size=part[0].shape)
    h = 1e-5

    def at(scale):
        return MassProperties.from_moments(measured((part[0] + scale * step, part[1]), kind))

    one, other = at(h), at(-h)
    assert (
        np.abs((one.center - other.center) / (2 * h) - np.einsum("nik,nk->i", center, step)).max()
        < 1e-8
    )


def test_distant_derivatives_match_near_ones():
    near = dyadic(bodies.sphere(2))
    far = bodies.moved(near, offset=(1024.0, -4096.0, 8192.0))
    one = volume_gradient(bodies.surface(near), np.zeros(3))
    other = volume_gradient(bodies.surface(far), np.array([1024.0, -4096.0, 8192.0]))
    assert np.array_equal(one, other)


def test_quads_are_derived_as_they_are_cut():
    quads = bodies.mesh(bodies.CORNERS * [3, 2, 1], bodies.SIDES.tolist())
    triangles = bodies.surface(bodies.box(high=(3, 2, 1)))
    for derive in KINDS.values():
        one, other = derive(quads, np.ones(3)), derive(triangles, np.ones(3))
        assert np.abs(one - other).max() < 1e-14


def test_box_corner_moves_volume_by_a_third_of_its_sides():
    points, triangles = bodies.box(high=(3, 2, 1))
    gradient = volume_gradient(bodies.surface((points, triangles)), np.zeros(3))[:, 0]
    normals = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]],
        points[triangles[:, 2]] - points[triangles[:, 0]],
    )
    for vertex in range(8):
        assert (
            np.abs(
                gradient[vertex] - normals[(triangles == vertex).any(axis=1)].sum(axis=0) / 6
            ).max()
            < 1e-14
        )


def test_a_triangle_without_area_and_a_loose_vertex_give_nothing():
    points, triangles = bodies.sphere(0)
    points = np.concatenate([points, [[9.0, 9.0, 9.0]]])
    more = np.concatenate([triangles, [[0, 0, 1], [2, 2, 2]]])
    for derive in KINDS.values():
        one, other = (
            derive(bodies.surface((points, triangles)), np.zeros(3)),
            derive(bodies.surface((points, more)), np.zeros(3)),
        )
        assert np.abs(one - other).max() <= 1e-14
        assert not one[-1].any() and not other[-1].any()


def test_empty_surface_has_no_derivatives():
    for derive in KINDS.values():
        nothing = derive(bodies.surface((np.zeros((0, 3)), np.zeros((0, 3), int))), np.zeros(3))
        assert nothing.shape == (0, 4, 3)


@pytest.mark.parametrize("power", [-20, 30])
def test_derivatives_scale_with_the_body(part, kind, power):
    points, triangles = part
    about = np.array([0.25, -0.5, 0.125])
    one = KINDS[kind](bodies.surface(part), about)
    other = KINDS[kind](
        bodies.surface((np.ldexp(points, power), triangles)), np.ldexp(about, power)
    )
    degree = power * (monomials(1).sum(axis=1) + (2 if kind == "volume" else 1))
    assert np.array_equal(other, np.ldexp(one, degree[:, None]))
