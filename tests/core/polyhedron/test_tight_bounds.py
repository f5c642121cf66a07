# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds are not only true but near: each has bodies whose error comes to a twentieth of it, so that one made twenty
times smaller is false."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import U, monomials
from body_moments.core.polyhedron import polyhedron_moments, third_order

from tests.core import bodies, exact

NEAR = 1.0 / 20.0
TRIANGLE = np.array([[0, 1, 2]])
TETRAHEDRON = (
    bodies.box()[0][[0, 1, 2, 4]] * (3.0, 2.0, 1.5) + 0.1,
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)

# (by the kernel for few triangles, of areas) of 2,500 the ones that come nearest
SEEDS = {
    (True, False): (816, 1197, 922),
    (True, True): (2103, 772, 829),
    (False, False): (915,),
    (False, True): (1275, 396, 425),
}


def moved_against(part, order, area):
    """(K,) for each monomial the change, by its bound, of moments when float32 points are moved by half an ulp along
    each axis, in the directions in which the moment grows. The reference point is far away, where a monomial is nearly
    as large everywhere as at its largest."""
    points, triangles = (part[0] @ bodies.rotation(1).T + 50.0).astype(np.float32), part[1]
    surface = Surface(points, triangles)
    about = points.mean(axis=0) - 12.0 * np.ptp(points, axis=0).max()

    def measure(of):
        return polyhedron_moments(of, order, area_order=order, about=about, exact=True)[int(area)]

    given, points = measure(surface), points.astype(float)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal, growth = np.cross(b - a, c - a), np.zeros_like(points)
    unit = normal / np.linalg.norm(normal, axis=1)[:, None]
    for k, side in enumerate((c - b, a - c, b - a)):
        np.add.at(growth, triangles[:, k], np.cross(unit, side) if area else normal)
    ratios = np.zeros(len(given.raw))
    for sign in (1.0, -1.0):
        moved = measure(Surface(points + sign * np.sign(growth) * surface.coordinate_error, triangles))
        ratios = np.maximum(ratios, np.abs(moved.raw - given.raw) / given.input_error)
    return ratios


@pytest.mark.parametrize("order", [3, 7])
@pytest.mark.parametrize("part", [bodies.sphere(2), bodies.sphere(4), bodies.torus(40, 30)])
def test_what_float32_has_moved_of_a_volume_comes_near_its_bound(part, order):
    ratios = moved_against(part, order, area=False)
    assert (ratios <= 1.0).all() and (ratios >= 0.3).all()


@pytest.mark.parametrize("order, small", [(3, True), (3, False), (7, True)])
def test_what_float32_has_moved_of_an_area_comes_near_its_bound(monkeypatch, order, small):
    if not small:
        monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    ratios = moved_against(TETRAHEDRON if order == 3 else bodies.sphere(2), order, area=True)
    assert (ratios <= 1.0).all() and (ratios >= NEAR).all()


@pytest.mark.parametrize("area", [False, True])
@pytest.mark.parametrize("small", [True, False])
def test_rounding_comes_near_its_bound(monkeypatch, small, area):
    """Of one triangle, far from the reference point."""
    if not small:
        monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    largest = np.zeros(20)
    for seed in SEEDS[small, area]:
        rng = np.random.default_rng(seed)
        points, about = rng.normal(size=(3, 3)), np.array([7.0, 5.0, 3.0]) * (1.0 + rng.random(3))
        found = polyhedron_moments(
            Surface(points, TRIANGLE), 3, area_order=3, about=about, exact=True, allow_open=True
        )[int(area)]
        truth = (exact.area_moments if area else exact.volume_moments)(points, TRIANGLE, about)
        errors = [abs(Fraction(float(value)) - right) for value, right in zip(found.raw, truth)]
        assert all(error <= Fraction(float(bound)) for error, bound in zip(errors, found.rounding_error))
        largest = np.maximum(largest, [float(e / Fraction(float(b))) for e, b in zip(errors, found.rounding_error)])
    degree = monomials(3).sum(axis=1)
    nearest = [largest[degree == k].max() >= NEAR for k in range(3)]
    assert nearest == [True] * 3 if small or not area else any(nearest)


@pytest.mark.parametrize("area", [False, True])
@pytest.mark.parametrize("small", [True, False])
def test_what_cancels_in_a_triangle_comes_near_its_bound(monkeypatch, small, area):
    """A cone from a point in the triangle's plane, which has no volume; a triangle of two edges along each other, which
    has no area: all that is found is rounding."""
    if not small:
        monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    largest = 0.0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        a, edge, other = rng.normal(size=(3, 3))
        points = np.array([a, a + edge, a + (edge * rng.random() if area else other)])
        about = a + edge * rng.normal() + other * rng.normal()
        found = polyhedron_moments(
            Surface(points, TRIANGLE), 3, area_order=3, about=about, exact=True, allow_open=True
        )[int(area)]
        truth = (exact.area_moments if area else exact.volume_moments)(points, TRIANGLE, about)
        error = float(abs(Fraction(float(found.raw[0])) - truth[0]) / Fraction(float(found.rounding_error[0])))
        assert error <= 1.0
        largest = max(largest, error)
    assert largest >= NEAR


@pytest.mark.parametrize("area", [False, True])
def test_what_is_left_out_of_third_moments_is_their_bound(monkeypatch, area):
    """Of one triangle the terms of third order about the middle of an edge are left out, and are the bound."""
    monkeypatch.setattr(third_order, "MAX_TRIANGLES_EXACT_THIRD", 0)
    monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    largest = np.zeros(20)
    for seed in range(40):
        rng = np.random.default_rng(seed)
        points = rng.normal(size=(3, 3))
        options = {"area_order": 3, "about": points.mean(axis=0) + 0.1 * rng.normal(size=3), "allow_open": True}
        fast, slow = (
            polyhedron_moments(Surface(points, TRIANGLE), 3, exact=whole, **options)[int(area)]
            for whole in (False, True)
        )
        ratios = np.abs(fast.raw - slow.raw) / fast.rounding_error
        assert (ratios <= 1.0).all()
        largest = np.maximum(largest, ratios)
    assert (largest[10:] >= 0.9).all()


@pytest.mark.parametrize("order", [4, 9])
@pytest.mark.parametrize("area", [False, True])
def test_rounding_of_high_orders_is_counted(order, area):
    """Sums of thousands of terms round by less than they may; what they may is counted: numpy adds 128 numbers up in 25
    steps, each sum of a block's slices comes to 200 and more, and each degree takes eight operations."""
    points, triangles = bodies.sphere(1)
    about = np.array([-5.0, -6.0, -7.0])  # where no monomial changes its sign
    volume, surface = polyhedron_moments(Surface(points, triangles), order, area_order=order, about=about)
    found = surface if area else volume
    size = (
        exact.area_moments(points, triangles, about, order=order)
        if area
        else exact.volume_moments(points, triangles, about, order, absolute=True)
    )
    degree = monomials(order).sum(axis=1)
    assert (found.rounding_error >= U * (200.0 + 7.0 * degree) * np.array([float(value) for value in size])).all()
    reach = np.abs(points - about).max(axis=0)
    weight = float(np.multiply(1.0 if area else 1.0 / 3.0, float(sum(map(float, size[:1])))))
    assert (
        found.rounding_error
        <= 1e3 * U * (1.0 + degree) * max(weight, float(size[0])) * np.prod(reach ** monomials(order), axis=1)
    ).all()


@pytest.mark.parametrize("area", [False, True])
def test_rounding_of_few_triangles_is_counted(area):
    """A product of matrices may add its terms up one by one: a step for each triangle, and eight for each degree."""
    points, triangles = bodies.sphere(2)
    about = np.array([-5.0, -6.0, -7.0])
    found = polyhedron_moments(Surface(points, triangles), 3, area_order=3, about=about)[int(area)]
    measure = exact.area_moments if area else exact.volume_moments
    size = measure(points, triangles, about, **({} if area else {"absolute": True}))
    steps = len(triangles) + 7.0 * monomials(3).sum(axis=1)
    assert (found.rounding_error >= U * steps * np.array([float(value) for value in size])).all()


@pytest.mark.parametrize("degree", [0, 1, 2])
@pytest.mark.parametrize("name", ["rounding_error", "input_error"])
def test_bounds_of_mass_properties_are_near(name, degree):
    """Moments of one degree that are off by their bounds, all signs tried at random, far from the reference point."""
    part = bodies.moved(bodies.box((0, 0, 0), (1, 2, 3)), bodies.rotation(1))
    moments = polyhedron_moments(bodies.surface(part), 3, area_order=0, about=(-30.0, -20.0, -25.0))[0]
    moments = replace(moments, rounding_error=np.zeros(20), input_error=np.zeros(20))
    delta = 1e-7 * np.abs(moments.raw) * (monomials(3).sum(axis=1) == degree)
    given = MassProperties.from_moments(replace(moments, **{name: delta}), density=1000.0)
    bound, largest = getattr(given, name), {"mass": 0.0, "center": 0.0, "inertia": 0.0}
    rng = np.random.default_rng(0)
    for _ in range(400):
        off = MassProperties.from_moments(
            replace(moments, raw=moments.raw + delta * rng.choice([-1.0, 1.0], 20)), density=1000.0
        )
        for key in largest:
            change = np.linalg.norm(np.asarray(getattr(off, key)) - getattr(given, key))
            largest[key] = max(largest[key], float(change / max(np.linalg.norm(bound[key]), 1e-300)))
    moved = {0: ("mass", "center", "inertia"), 1: ("center", "inertia"), 2: ("inertia",)}[degree]
    assert all(0.4 <= largest[key] <= 1.0 + 1e-3 for key in moved), largest
