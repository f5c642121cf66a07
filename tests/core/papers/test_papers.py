# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The papers' formulae against each other and against plain integration, in rational arithmetic:
zero difference.
"""

import random
from fractions import Fraction
from itertools import product
from math import isqrt
from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import monomials
from body_moments.core.papers import durso_2005 as durso
from body_moments.core.papers import sheynin_tuzikov_2001 as sheynin_tuzikov
from body_moments.core.papers import zhang_chen_2001 as zhang_chen
from body_moments.core.papers.soldea_elber_rivlin_2002_phi import phi
from body_moments.core.polyhedron import polyhedron_moments

from tests.core import exact, rational

F = Fraction
STAR = [(0, 0), (3, 1), (6, 0), (5, 3), (6, 6), (3, 5), (0, 6), (1, 3)]
STAR_CAPS = [(0, 1, 7), (1, 2, 3), (3, 4, 5), (5, 6, 7), (1, 3, 5, 7)]


def exponents(order):
    return [tuple(row) for row in monomials(order).tolist()]


def box():
    """Off the origin, no two sides alike."""
    points = exact.box((F(7, 3), F(-5, 2), F(11, 7)), (F(5), F(1, 3), F(9, 2)))
    return points, exact.BOX_QUADS


def prism():
    """A concave eight-pointed star prism, sheared and moved off the origin: two concave n-gons and
    eight quads.
    """
    n = len(STAR)
    flat = [(F(x), F(y), F(z)) for z in (2, 5) for x, y in STAR]
    points = [(x + z / 3 + 4, y - z / 5 + 1, z + x / 7 - 3) for x, y, z in flat]
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return points, [*sides, tuple(range(n))[::-1], tuple(range(n, 2 * n))]


def tetrahedron(seed=1):
    rng = random.Random(seed)
    points = [
        tuple(F(rng.randint(-99, 99), rng.randint(1, 99)) for _ in range(3)) for _ in range(4)
    ]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    a, b, c, d = points
    if (
        sheynin_tuzikov.dot(
            sheynin_tuzikov.subtract(d, a),
            sheynin_tuzikov.cross(sheynin_tuzikov.subtract(b, a), sheynin_tuzikov.subtract(c, a)),
        )
        < 0
    ):
        faces = [face[::-1] for face in faces]
    return points, faces


BODIES = {"box": box, "concave prism": prism, "tetrahedron": tetrahedron}


def triangles(points, faces):
    """Convex faces as fans; the star's own caps as the convex pieces that they consist of."""
    cut = []
    for face in faces:
        if len(face) == len(STAR):
            pieces = [tuple(face[i] for i in cap) for cap in STAR_CAPS]
            cut += exact.fan(pieces)
        else:
            cut += exact.fan([face])
    return cut


@pytest.mark.parametrize("body", BODIES)
def test_durso_and_sheynin_tuzikov_agree_exactly_to_third_order(body):
    points, faces = BODIES[body]()
    truth = dict(zip(exponents(3), sheynin_tuzikov.volume_moments(points, faces, 3)))
    for rank, formula in enumerate(durso.FORMULAS):
        tensor = durso.tensor(points, faces, formula)
        for entry in product(range(3), repeat=rank):
            value = tensor[entry] if rank else tensor
            assert value - truth[tuple(entry.count(axis) for axis in range(3))] == 0


@pytest.mark.parametrize("body", BODIES)
def test_sheynin_tuzikov_matches_plain_integration_exactly(body):
    points, faces = BODIES[body]()
    cut = triangles(points, faces)
    rows = exponents(6)
    values = sheynin_tuzikov.volume_moments(points, faces, 6)
    chosen = rows if body == "tetrahedron" else rows[:20] + rows[20::7]  # the others share all code
    for row in chosen:
        assert values[rows.index(row)] == rational.enclosed(points, cut, row)


def test_add_on_recursion_is_within_bounds_of_sheynin_tuzikov():
    points, faces = prism()
    floats = np.array(points, float)
    cut = triangles(points, faces)
    found, _ = polyhedron_moments(Surface.from_triangles(floats, np.array(cut)), 6)
    truth = sheynin_tuzikov.volume_moments(
        rational.fractions(floats), cut, 6, [F(x) for x in found.about]
    )
    for value, bound, exactly in zip(found.raw, found.rounding_error, truth):
        assert abs(F(value) - exactly) <= F(bound)


def exact_root(square):
    root = F(isqrt(square.numerator), isqrt(square.denominator))
    assert root * root == square
    return root


def test_surface_moments_with_rational_areas_are_exact():
    points, faces = box()
    rows = exponents(6)
    values = sheynin_tuzikov.surface_moments(points, faces, 6, root=exact_root)
    cut = exact.fan(faces)
    double = []
    for a, b, c in cut:
        normal = sheynin_tuzikov.cross(
            sheynin_tuzikov.subtract(points[b], points[a]),
            sheynin_tuzikov.subtract(points[c], points[a]),
        )
        double.append(exact_root(sheynin_tuzikov.dot(normal, normal)))
    for row, value in zip(rows, values):
        assert value == rational.facets(points, cut, row, double)
    sides = [high - low for low, high in zip(points[0], points[-1])]
    assert values[0] == 2 * (sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0])


def test_moments_about_a_point_match_the_moved_body():
    points, faces = prism()
    about = (F(1, 3), F(-2), F(5, 7))
    moved = [tuple(x - o for x, o in zip(point, about)) for point in points]
    assert sheynin_tuzikov.volume_moments(
        points, faces, 4, about
    ) == sheynin_tuzikov.volume_moments(moved, faces, 4)


def test_printed_third_order_formula_is_wrong_and_asymmetric():
    for body, wrong in (("box", 12), ("concave prism", 27)):
        points, faces = BODIES[body]()
        right, printed = (
            durso.tensor(points, faces, f) for f in (durso.THIRD, durso.THIRD_AS_PRINTED)
        )
        assert sum(a != b for a, b in zip(right.ravel(), printed.ravel())) == wrong
        assert any(printed[i, j, k] != printed[j, i, k] for i, j, k in product(range(3), repeat=3))
        assert all(
            right[i, j, k] == right[j, i, k] == right[i, k, j]
            for i, j, k in product(range(3), repeat=3)
        )


def test_foot_of_a_face_without_area_is_its_first_corner():
    line = [(F(1), F(2), F(3)), (F(2), F(4), F(7)), (F(5, 2), F(5), F(9))]
    for face in ((0, 1, 2), (2, 0, 1), (1, 0)):
        assert durso.perpendicular_feet(line, [face]) == [line[face[0]]]


def test_durso_holds_at_any_order_with_any_apex_in_the_face():
    points, faces = prism()
    truth = sheynin_tuzikov.volume_moments(points, faces, 5)
    assert durso.moments(points, faces, 5) == truth
    assert durso.moments(points, faces, 5, durso.perpendicular_feet(points, faces)) == truth
    apexes = [
        tuple(3 * points[f[0]][i] - points[f[1]][i] - points[f[2]][i] for i in range(3))
        for f in faces
    ]
    assert durso.moments(points, faces, 5, apexes) == truth


def test_a_face_without_area_adds_nothing():
    points, faces = box()
    line = [*points, tuple((a + b) / 2 for a, b in zip(points[0], points[1]))]
    for formula in durso.FORMULAS:
        whole = durso.tensor(points, faces, formula)
        assert np.all(durso.tensor(line, [(0, 1, 0), *faces, (0, 8, 1)], formula) == whole)


def jittered():
    rng = random.Random(5)
    points, faces = box()
    return [tuple(x + F(rng.randint(-50, 50), 1000) for x in point) for point in points], faces


def test_durso_on_warped_faces_has_fan_volume_and_no_center():
    points, faces = jittered()
    means = [
        tuple(sum(points[i][axis] for i in face) / F(len(face)) for axis in range(3))
        for face in faces
    ]
    fans = durso.moments(points, faces, 1, means)
    assert durso.tensor(points, faces, durso.ZEROTH) == fans[0]
    offset = (F(10), F(20), F(30))
    moved = [tuple(x + t for x, t in zip(point, offset)) for point in points]
    first, shifted = (durso.tensor(p, faces, durso.FIRST) for p in (points, moved))
    defect = [s - f - fans[0] * t for s, f, t in zip(shifted, first, offset)]
    assert max(map(abs, defect)) > F(1, 1000)  # it belongs to no body
    moved_means = [tuple(x + t for x, t in zip(mean, offset)) for mean in means]
    moved_fans = durso.moments(moved, faces, 1, moved_means)
    assert [s - f - fans[0] * t for s, f, t in zip(moved_fans[1:], fans[1:], offset)] == [0, 0, 0]


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("turned", [False, True])
def test_zhang_chen_tetrahedra_agree_exactly_for_any_winding(body, turned):
    points, faces = BODIES[body]()
    cut = triangles(points, faces)
    truth = sheynin_tuzikov.volume_moments(points, faces, 4)
    if turned:
        cut = [face[::-1] for face in cut]
    assert zhang_chen.signed_volume(points, cut) == (-truth[0] if turned else truth[0])
    assert zhang_chen.mesh_moments(points, cut, exponents(4)) == truth


@pytest.mark.parametrize("turned", [False, True])
def test_zhang_chen_triangles_match_plain_integration_exactly(turned):
    points = [(F(x) / 3 + 2, F(y) - F(x, 5) - 7) for x, y in STAR]
    hole = [(F(3), F(-5)), (F(3), F(-4)), (F(7, 2), F(-4))]
    n = len(points)
    edges = [(i, (i + 1) % n) for i in range(n)] + [(n, n + 1), (n + 1, n + 2), (n + 2, n)]
    points = points + hole
    rows = [(p, q) for p in range(6) for q in range(6 - p)]
    truth = [rational.enclosed(points, edges, row) for row in rows]
    if turned:
        edges = [edge[::-1] for edge in edges]
    assert zhang_chen.signed_area(points, edges) == (-truth[0] if turned else truth[0]) != 0
    assert zhang_chen.mesh_moments(points, edges, rows) == truth


def test_tetrahedron_has_the_printed_moments():
    a, b, c = (F(1), F(2), F(3)), (F(-2), F(5), F(1)), (F(4), F(-1), F(7))
    zero = (F(0),) * 3
    volume = zhang_chen.signed_volume([zero, a, b, c], [(1, 2, 3)])
    moments = dict(zip(exponents(2), zhang_chen.mesh_moments([a, b, c], [(0, 1, 2)], exponents(2))))
    x = [corner[0] for corner in (a, b, c)]
    y = [corner[1] for corner in (a, b, c)]
    assert volume == moments[0, 0, 0] > 0
    assert moments[1, 0, 0] == volume / 4 * sum(x)
    squares = x[0] ** 2 + x[1] ** 2 + x[2] ** 2 + x[0] * x[1] + x[1] * x[2] + x[2] * x[0]
    assert moments[2, 0, 0] == volume / 10 * squares
    mixed = x[0] * (y[1] + y[2]) + x[1] * (y[0] + y[2]) + x[2] * (y[0] + y[1])
    assert moments[1, 1, 0] == volume / 10 * (x[0] * y[0] + x[1] * y[1] + x[2] * y[2] + mixed / 2)


@pytest.mark.parametrize("counts, order", [((18, 7), 0), ((19, 2), 1), ((19, 1), 2)])
def test_tensors_of_more_than_two_million_entries_are_refused(counts, order):
    """Refused before any computation: tensors of 126³, 38⁴ or 19⁵ entries."""
    spaces = tuple(SimpleNamespace(count=count) for count in counts)
    with pytest.raises(ValueError, match="entries"):
        phi(spaces, order)
    fewer = SimpleNamespace(count=counts[0] - 1), spaces[1]
    with pytest.raises(AttributeError):  # these have no functions
        phi(fewer, order)
