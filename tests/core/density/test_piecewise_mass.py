# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A density for each triangle or corner: against rational arithmetic, closed forms, and the sum
over the parts.
"""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density.piecewise_mass import (
    part_densities,
    sheet_mass_moments,
    solid_mass_moments,
    to_mass_moments,
)
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import Moments
from body_moments.core.solid.measure import measure_solid

from tests.close import close
from tests.core import bodies, exact

FAR = (4096.0, -8192.0, 2048.0)


def sheet(part, density, dtype=np.float64, **more):
    surface = bodies.surface(part, dtype)
    like = measure_solid(surface, shell=True).area
    return sheet_mass_moments(
        surface.points, surface.triangles, np.asarray(density, float), like, **more
    )


def linear_truth(points, triangles, density, about):
    """∫ ρ x^α dA with ρ linear on each triangle, by multiplying out: each factor of the integrand
    is the sum of its corners' values times barycentric coordinates λ, and ∫ λ0^a λ1^b λ2^c dA = 2 A
    a! b! c! / (a+b+c+2)!.
    """
    from itertools import product
    from math import factorial, isqrt

    root = 10**40
    sums = [Fraction(0)] * 20
    for triangle, rho in zip(triangles, density):
        corner = [
            [Fraction(float(v)) - Fraction(float(o)) for v, o in zip(points[i], about)]
            for i in triangle
        ]
        u, v = ([b - a for a, b in zip(corner[0], corner[k])] for k in (1, 2))
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        square = sum(n * n for n in normal)
        double = Fraction(
            isqrt(square.numerator * square.denominator * root * root), square.denominator * root
        )
        for at, powers in enumerate(exact.MONOMIALS):
            axes = [axis for axis, n in enumerate(powers) for _ in range(n)]
            # the corner of each factor and of the density
            for choice in product(range(3), repeat=len(axes) + 1):
                value = Fraction(float(rho[choice[-1]]))
                for axis, k in zip(axes, choice):
                    value *= corner[k][axis]
                counts = [choice.count(k) for k in range(3)]
                weight = Fraction(
                    factorial(counts[0]) * factorial(counts[1]) * factorial(counts[2]),
                    factorial(len(choice) + 2),
                )
                sums[at] += double * weight * value
    return sums


def within(found, expected):
    return all(
        abs(Fraction(value) - true) <= Fraction(bound)
        for value, true, bound in zip(found.raw.tolist(), expected, found.rounding_error.tolist())
    )


@pytest.mark.parametrize("offset", [(0, 0, 0), FAR])
@pytest.mark.parametrize("scale", [1.0, 2.0**-40, 2.0**30])
def test_a_density_linear_on_each_triangle_is_exact(offset, scale):
    rng = np.random.default_rng(1)
    points, triangles = bodies.moved(bodies.sphere(1), np.diag([1.0, 2.0, 0.5]))
    points = (np.round(points * 1024) / 1024 + offset) * scale
    density = np.round(rng.random(len(points)) * 4096) / 16
    found = sheet((points, triangles), density[triangles])
    expected = linear_truth(points, triangles, density[triangles], found.about)
    assert within(found, expected)
    assert (
        found.rounding_error[0] < 1e-9 * found.total
        if offset[0]
        else found.rounding_error[0] < 1e-12 * found.total
    )
    assert found.measure == "area" and not found.input_error.any()


CORNERS = np.array([[1, 2, -1], [4, 1, 2], [2, 7, 1], [3, 3, 9]])
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def part_moments(parts, whole):
    """The volume moments of each part, negative for cavities."""
    triangles = [parts.triangles[parts.part == k] for k in range(parts.number)]
    return [solid_mass_moments(parts.points, rows, np.ones(len(rows)), whole) for rows in triangles]


def test_a_density_constant_on_the_corners_is_one_on_the_faces():
    part = bodies.sphere(2)
    density = np.random.default_rng(2).random(len(part[1])) * 1000.0
    by_face, by_corner = sheet(part, density), sheet(part, np.repeat(density[:, None], 3, axis=1))
    assert (
        np.abs(by_face.raw - by_corner.raw) <= by_face.rounding_error + by_corner.rounding_error
    ).all()
    one = sheet(part, np.ones(len(part[1])))
    plain = measure_solid(bodies.surface(part), shell=True).area
    assert (np.abs(one.raw - plain.raw) <= one.rounding_error + plain.rounding_error).all()


def test_square_sheet_with_linear_density_matches_closed_form():
    """ρ = x on the unit square: M = 1/2, centre (2/3, 1/2), I about it (1/24, 1/36, 5/72)."""
    part = bodies.grid(5)
    found = sheet(part, part[0][part[1], 0])
    body = MassProperties.from_moments(to_mass_moments(found))
    assert close(body.mass, 0.5, rel=1e-14)
    assert body.center == pytest.approx([2 / 3, 1 / 2, 0.0], abs=1e-14)
    assert close(np.diag(body.inertia), [1 / 24, 1 / 36, 5 / 72], rel=1e-13)
    # to third order: ∫ x · x³ = 1/5, ∫ x · x² y = 1/8, ∫ x · x y² = 1/9, ∫ x y³ = 1/8
    about = found.about_point((0, 0, 0))
    assert close(
        [about[3, 0, 0], about[2, 1, 0], about[1, 2, 0], about[0, 3, 0]],
        [1 / 5, 1 / 8, 1 / 9, 1 / 8],
        rel=1e-13,
    )


def test_float32_storage_error_is_within_the_input_bound():
    points, triangles = bodies.sphere(2)
    points = points / 3.0 + 100.0
    density = np.random.default_rng(3).random(len(points)) * 7.0
    single = points.astype(np.float32), triangles
    found = sheet(
        single, density.astype(np.float32).astype(float)[triangles], np.float32, stored=True
    )
    about = found.about
    exactly = sheet((points, triangles), density[triangles]).about_point(about)
    assert (
        np.abs(found.raw - exactly.raw)
        <= found.input_error + found.rounding_error + exactly.rounding_error
    ).all()
    assert found.input_error[0] < 1e-2 * found.total


PARTS = bodies.joined(
    bodies.box((0, 0, 0), (1, 2, 3)),
    bodies.moved(bodies.sphere(1), offset=(5, 0, 0)),
    bodies.moved(bodies.torus(12, 8), offset=(0, 6, 0)),
)


@pytest.mark.parametrize("offset", [(0, 0, 0), FAR])
def test_the_parts_add_up_to_the_whole(offset):
    part = bodies.moved(PARTS, offset=offset)
    solid = measure_solid(bodies.surface(part))
    parts = solid.parts()
    each = part_moments(parts, solid.volume)
    assert parts.number == 3 and parts.host_part.tolist() == [0, 1, 2]
    total = np.sum([one.raw for one in each], axis=0)
    assert (
        np.abs(total - solid.volume.raw)
        <= solid.volume.rounding_error + np.sum([one.rounding_error for one in each], axis=0)
    ).all()
    for i, one in enumerate(each):
        expected = exact.volume_moments(
            part[0].tolist(), parts.triangles[parts.part == i].tolist(), one.about
        )
        assert within(one, expected)


def test_a_density_for_each_part_is_exact():
    solid = measure_solid(bodies.surface(PARTS))
    parts = solid.parts()
    density = np.array([7820.0, 1240.0, 3.5])
    found = solid_mass_moments(parts.points, parts.triangles, density[parts.part], solid.volume)
    expected = [0] * 20
    for i, value in enumerate(density):
        own = exact.volume_moments(
            PARTS[0].tolist(), parts.triangles[parts.part == i].tolist(), found.about
        )
        expected = [a + Fraction(value) * b for a, b in zip(expected, own)]
    assert within(found, expected)
    assert found.rounding_error[0] < 1e-12 * found.total


def test_a_two_material_dumbbell():
    """Two boxes of steel and wood, each 1 m³, 4 m apart: the centre is at the mean weighted by
    their densities.
    """
    part = bodies.joined(bodies.box((0, 0, 0), (1, 1, 1)), bodies.box((4, 0, 0), (5, 1, 1)))
    solid = measure_solid(bodies.surface(part))
    parts = solid.parts()
    found = part_densities(parts, np.repeat([7820.0, 680.0], 12))
    assert found.density.tolist() == [7820.0, 680.0] and not found.has_several_materials.any()
    body = MassProperties.from_moments(
        to_mass_moments(
            solid_mass_moments(
                parts.points, parts.triangles, found.density[parts.part], solid.volume
            )
        )
    )
    assert body.mass == pytest.approx(8500.0, rel=1e-14)
    assert close(body.center, [(7820 * 0.5 + 680 * 4.5) / 8500, 0.5, 0.5], rel=1e-14)
    arm = 7820 * 680 / 8500 * 16.0
    assert np.diag(body.inertia) == pytest.approx(
        [8500 / 6, 8500 / 6 + arm, 8500 / 6 + arm], rel=1e-13
    )


def test_a_part_of_several_materials_takes_their_mean_by_area():
    """A box of 1 x 2 x 3 whose two 2 x 3 sides are of another material: 12 of its 22 m²."""
    part = bodies.box((0, 0, 0), (1, 2, 3))
    normal = np.cross(
        part[0][part[1][:, 1]] - part[0][part[1][:, 0]],
        part[0][part[1][:, 2]] - part[0][part[1][:, 0]],
    )
    faces = np.where(np.abs(normal[:, 0]) > 0.0, 100.0, 1000.0)
    found = part_densities(measure_solid(bodies.surface(part)).parts(), faces)
    assert found.has_several_materials.tolist() == [True] and found.first_face.tolist() == [0]
    assert found.density[0] == pytest.approx((12 * 100.0 + 10 * 1000.0) / 22, rel=1e-14)


def test_caps_have_no_say_in_the_density_and_carry_it():
    part = bodies.without(bodies.box((0, 0, 0), (1, 1, 1)), *bodies.TOP)
    solid = measure_solid(bodies.surface(part))
    parts = solid.parts()
    assert solid.method == "capped" and (parts.face == -1).any()
    found = part_densities(parts, np.full(12, 500.0))
    assert found.density.tolist() == [500.0] and not found.has_several_materials.any()
    mass = solid_mass_moments(
        parts.points, parts.triangles, found.density[parts.part], solid.volume
    )
    assert mass.total == pytest.approx(500.0, rel=1e-14)


def test_no_faces_have_no_moments():
    like = Moments(np.ones(10), np.zeros(3), "area", input_error=np.ones(10))
    for density in (np.zeros(0), np.zeros((0, 3))):
        found = sheet_mass_moments(CORNERS * 1.0, TRIANGLES[:0], density, like)
        assert (
            not found.raw.any() and not found.rounding_error.any() and not found.input_error.any()
        )
    none = solid_mass_moments(CORNERS * 1.0, TRIANGLES[:0], np.zeros(0), like)
    assert not none.raw.any() and not none.rounding_error.any() and not none.input_error.any()
    for measure in (solid_mass_moments, sheet_mass_moments):
        assert close(
            measure(CORNERS * 1.0, TRIANGLES, np.full(4, 1e-3), like).input_error,
            np.full(10, 1e-3),
            rel=0.0,
        )


@pytest.mark.parametrize("turned", [False, True])
def test_cavity_removes_the_material_around_it(turned):
    """A steel box with a painted hole, in which a ball of cork lies; turned inside out as a whole
    it is the same.
    """
    box, hole = bodies.box((0, 0, 0), (4, 4, 4)), bodies.inverted(bodies.box((1, 1, 1), (3, 3, 3)))
    cork = bodies.box((1.5, 1.5, 1.5), (2.5, 2.5, 2.5))
    part = bodies.joined(box, hole, cork)
    if turned:
        part = bodies.inverted(part)
    solid = measure_solid(bodies.surface(part))
    parts = solid.parts()
    found = part_densities(parts, np.repeat([8000.0, 1.0, 200.0], 12))
    assert found.density.tolist() == [8000.0, 8000.0, 200.0]
    assert found.has_foreign_cavity_material.tolist() == [False, True, False]
    assert not found.has_several_materials.any()
    # painted with two that come to the same together, and with its own alone
    for one, other, foreign in ((7000.0, 9000.0, True), (8000.0, 8000.0, False)):
        faces = np.repeat([8000.0, one, other, 200.0], [12, 6, 6, 12])
        mixed = part_densities(parts, faces)
        assert mixed.has_foreign_cavity_material.tolist() == [False, foreign, False]
        assert (
            mixed.density.tolist() == found.density.tolist()
            and not mixed.has_several_materials.any()
        )
    mass = solid_mass_moments(
        parts.points, parts.triangles, found.density[parts.part], solid.volume
    )
    assert mass.total == pytest.approx(8000.0 * (64 - 8) + 200.0, rel=1e-14)


@pytest.mark.parametrize(
    "make",
    [
        lambda: bodies.surface(bodies.with_flipped(PARTS, 0, 30)),
        lambda: bodies.surface(bodies.inverted(PARTS)),
        lambda: bodies.surface(bodies.soup(PARTS)),
        lambda: bodies.surface(bodies.without(PARTS, 5, 40)),
        lambda: Surface(bodies.CORNERS * 2.0, quads=bodies.SIDES.copy()),
        lambda: bodies.mesh(
            np.concatenate([bodies.CORNERS, bodies.CORNERS + (3, 0, 0)]),
            [*bodies.SIDES[:, ::-1].tolist(), *(bodies.SIDES + 8).tolist()],
        ),
    ],
)
def test_parts_of_repaired_bodies_add_up(make):
    solid = measure_solid(make())
    parts = solid.parts()
    total = np.sum([one.raw for one in part_moments(parts, solid.volume)], axis=0)
    assert np.allclose(
        total, solid.volume.raw, rtol=1e-12, atol=1e-12 * np.abs(solid.volume.raw).max()
    )
    assert parts.face.max() < 1 + np.unique(parts.face[parts.face >= 0]).size
