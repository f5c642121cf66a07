# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What bounds the errors of walls: prism by prism, along the boundary and as a whole, against closed forms."""

from dataclasses import replace
from fractions import Fraction
from math import isqrt

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import PAIRWISE_SUM_ROUNDINGS, U, monomials
from body_moments.core.wall import walls
from body_moments.core.wall.directions import offset_directions
from body_moments.core.wall.walls import JACOBIAN_ROUNDINGS, first_positive_root, offset_solid

from tests.close import close
from tests.core import bodies

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float), np.array([[0, 1, 2], [0, 2, 3]])


def prisms(corners, vectors):
    return walls._Prisms(np.array(corners, float), np.zeros(3), np.array(vectors, float))


def exact_root(a, b, c, error=(0, 0, 0)):
    """The first positive root of a + b s + c s² less an error, in fractions to 60 digits; None where there is none."""
    a, b, c = (Fraction(float(x)) - Fraction(float(e)) for x, e in zip((a, b, c), error))
    if a <= 0:
        return Fraction(0)
    square = b * b - 4 * a * c
    if square < 0:
        return None
    digits = 10**60
    root = Fraction(isqrt(square.numerator * square.denominator * digits**2), square.denominator * digits)
    return 2 * a / (root - b) if root > b else None


@pytest.mark.parametrize("scale", [1.0, 2.0**-40, 2.0**40])
@pytest.mark.parametrize("unit", [1.0, 2.0**-12, 2.0**12])
def test_a_prism_is_good_up_to_the_first_root_and_no_farther(scale, unit):
    """Real roots of either sign, of sizes far apart; none; double ones, which rounding may have split."""
    roots = [(3.0, 7.0), (3.0, -7.0), (-3.0, 7.0), (-3.0, -7.0), (1.0, 1e9), (-1.0, 1e9), (1e9, -1e-3), (0.3, 0.31)]
    rows = [(1.0, -1.0 / p - 1.0 / q, 1.0 / p / q) for p, q in roots]
    rows += [(1.0, 0.0, 1.0), (1.0, -1.9, 1.0), (1.0, 1.0, 4.0), (1.0, -0.1, 0.0), (1.0, 0.5, 0.0), (1.0, 0.0, 0.0)]
    rows += [(1.0, 0.25, -1e-13), (1.0, -0.25, -1e-13), (0.125, 0.0, -2.0)]
    columns = scale * np.array(rows).T * np.array([[1.0], [1.0 / unit], [1.0 / unit**2]])
    found = first_positive_root(np.repeat(columns[:, None], 3, axis=1), np.zeros_like(columns))
    for value, row in zip(found.tolist(), columns.T):
        truth = exact_root(*row)
        if truth is None:
            assert value == np.inf
        else:
            b, product = float(row[1]) ** 2, 4.0 * float(row[0] * row[2])
            near = 64.0 * U * (1.0 + (b + abs(product)) / abs(b - product) if b != product else 1.0)
            assert truth * (1 - Fraction(near)) <= Fraction(value) <= truth


def test_a_double_root_is_one_however_it_is_rounded():
    rng = np.random.default_rng(3)
    twice = rng.uniform(0.1, 10.0, 200)
    columns = np.array([np.ones(200), -2.0 / twice, 1.0 / twice**2])
    found = first_positive_root(np.repeat(columns[:, None], 3, axis=1), np.zeros_like(columns))
    assert (np.abs(found / twice - 1.0) < 1e-6).all()
    squares = [Fraction(float(b)) ** 2 - 4 * Fraction(float(c)) for _, b, c in columns.T]
    assert min(squares) < 0 < max(squares)


def test_the_first_of_three_quadratics_counts_and_what_rounding_may_have_raised_is_taken_off():
    straight = np.array([[1.0, 1.0, 1.0], [-0.5, -0.25, 0.125], [0.0, 0.0, 0.0]])
    assert close(first_positive_root(straight[:, :, None], np.zeros((3, 1))), np.array([2.0]), rel=64 * U)
    error = np.array([[0.5], [0.25], [0.125]])
    truth = min(exact_root(*column, error[:, 0]) for column in straight.T)
    assert close(first_positive_root(straight[:, :, None], error), np.array([float(truth)]), rel=64 * U)
    for lost in (1.0, 1.5):
        assert first_positive_root(straight[:, :, None], np.array([[lost], [0.0], [0.0]])).tolist() == [0.0]


def jacobian(corners, vectors):
    """(3, 3) of Fractions: coefficients in s of the Jacobian at each corner."""
    p, d = ([[Fraction(float(x)) for x in row] for row in rows] for rows in (corners, vectors))

    def minus(a, b):
        return [x - y for x, y in zip(a, b)]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    e, g, f, h = minus(p[1], p[0]), minus(p[2], p[0]), minus(d[1], d[0]), minus(d[2], d[0])
    normals = cross(e, g), [x + y for x, y in zip(cross(e, h), cross(f, g))], cross(f, h)
    return [[sum(x * y for x, y in zip(normal, row)) for row in d] for normal in normals]


@pytest.mark.parametrize("size", [1.0, 1e-4, 1e4])
@pytest.mark.parametrize("turn", [1.0, 1e-3, 1e3])
def test_what_rounding_does_to_a_jacobian_is_some_roundings_of_the_lengths_in_it(size, turn):
    rng = np.random.default_rng(1)
    for _ in range(10):
        corners, vectors = size * rng.normal(size=(3, 3)), turn * rng.normal(size=(3, 3))
        found, error, double = (row[..., 0] for row in prisms([corners], [vectors]).jacobians())
        for values, truths, bound in zip(found, jacobian(corners, vectors), error):
            assert all(abs(Fraction(value) - truth) <= Fraction(bound) for value, truth in zip(values, truths))
        assert close(double, np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])), rel=1e-12)
    # a right triangle of sides 3 and 4 whose corners move by 12 i, 5 j and 12 i + 9 k
    corners = size * np.array([[0, 0, 0], [3, 0, 0], [0, 4, 0]])
    vectors = turn * np.array([[12, 0, 0], [0, 5, 0], [12, 0, 9]])
    error = prisms([corners], [vectors]).jacobians()[1][:, 0]
    sizes = np.array([4.0**2 * size**2, 2 * 4 * 13 * size * turn, 13.0**2 * turn**2]) * 15 * turn
    assert close(error, JACOBIAN_ROUNDINGS * U * sizes, rel=1e-12)


def steepest(corners, vectors, step, delta):
    """(3,) by how much the coefficients of the Jacobian at a corner change at most, to first order, where each corner
    moves by `step` and each direction by `delta`: the sum of the lengths of the gradients, by differences that are
    exact for what is of the third degree."""

    def coefficients(values):
        return np.array([[float(x) for x in row] for row in jacobian(values[:3], values[3:])])

    values, gradient = np.concatenate([corners, vectors]), np.zeros((6, 3, 3, 3))
    for row in range(6):
        for axis in range(3):
            ways = [values + way * np.eye(18)[3 * row + axis].reshape(6, 3) for way in (0.5, -0.5, 1.0, -1.0)]
            near, far, after, before = map(coefficients, ways)
            gradient[row, axis] = (4.0 * (near - far) - (after - before) / 2.0) / 3.0
    length = np.linalg.norm(gradient, axis=1)
    return (step * length[:3].sum(axis=0) + delta * length[3:].sum(axis=0)).max(axis=1)


def folded(length, far):
    """Triangles between sides that run against each other, whose directions do so too: here the bounds are reached."""
    e, x, z = (length * np.array([0.0, 1.0, 0.0]), far * np.array([1.0, 0.0, 0.0]), far * np.array([0.0, 0.0, 1.0]))
    low = np.array([0.0, 0.0, 1e-9 * length])
    yield np.array([0 * e, e, low - e]), np.array([-x, x, x])
    yield np.array([0 * e, e, low - e]), np.array([z, z, z])
    yield np.array([0 * e, e, low + x]), np.array([x, x + 0.1 * z, x - 0.1 * z])
    rng = np.random.default_rng(0)
    for _ in range(3):
        yield length * rng.uniform(-1, 1, (3, 3)), far * rng.uniform(-1, 1, (3, 3))


@pytest.mark.parametrize("length, far", [(8.0, 4.0), (0.25, 0.5)])
@pytest.mark.parametrize("step, delta", [(16.0, 0.0), (0.0, 2.0), (3.0, 5.0)])
def test_what_moves_points_and_directions_changes_a_jacobian_by_no_more_than_is_said(length, far, step, delta):
    reached = np.zeros(3)
    for corners, vectors in folded(length, far):
        body = prisms([corners], [vectors])
        sizes, rounded, moved = 2.0 * body.bounds(np.array([[delta], [delta]]), np.array([[delta], [delta]]), step)
        assert not sizes[3:].any()
        truth = np.abs(np.array([[float(x) for x in row] for row in jacobian(corners, vectors)])).max(axis=1)
        assert (truth <= sizes[:3] * (1.0 + 1e-12)).all()
        for found, way in ((rounded, 0.0), (moved, step)):
            change = steepest(corners, vectors, way, delta)
            assert (change <= found[:3] * (1.0 + 1e-9)).all()
            place = np.convolve(truth, (way, delta))
            assert (place <= found[3:] * (1.0 + 1e-9)).all()
        reached = np.maximum(reached, steepest(corners, vectors, step, delta) / np.where(moved[:3] > 0.0, moved[:3], 1))
    assert (reached > [0.99, 0.95, 0.95 if delta else -1.0]).all()  # bounds that say something


def test_along_its_normal_a_face_that_slides_changes_nothing():
    """Of a right triangle of sides 3 and 4, by what its corners' directions change along the normal."""
    corners, vectors = [[[0, 0, 0], [3, 0, 0], [0, 4, 0]]], [[[0, 0, 1]] * 3]
    body = prisms(corners, vectors)
    slide = np.zeros((2, 1))
    found = body.bounds(slide, np.array([[0.5], [0.25]]), 0.0)
    assert found[1].tolist() == [3.0, 0, 0, 0, 0, 0, 0] and found[2].tolist() == [1.5, 0, 0, 0, 0, 0, 0]
    assert found[0].tolist() == [8.0, 0, 0, 0, 0, 0, 0]
    many = prisms(corners * 5, vectors * 5)
    assert np.array_equal(many.bounds(np.zeros((2, 5)), np.full((2, 5), 0.5), 0.0)[1], 5.0 * found[1])


@pytest.mark.parametrize("size", [1.0, 2.0**-20, 2.0**20])
def test_what_a_right_triangle_sweeps_is_split_along_its_normal_and_across(size):
    """Sides p along x and q along y, and directions that turn by f and g: the normals in s are (0, 0, pq),
    (-q f_z, -p g_z, p g_y + q f_x) and f × g."""
    p, q = 3.0 * size, 4.0 * size
    f, g = np.array([1.0, 2.0, 5.0]), np.array([-2.0, 7.0, 3.0])
    first, second = np.array([-q * f[2], -p * g[2], p * g[1] + q * f[0]]), np.cross(f, g)
    vectors = [[0, 0, 1], f + [0, 0, 1], g + [0, 0, 1]]
    body = prisms([[[0, 0, 0], [p, 0, 0], [0, q, 0]]], [vectors])
    sizes = [p * q, np.linalg.norm(first), np.linalg.norm(second)]
    for tangential, normal, stored in ((0.5, 0.0, 0.0), (0.0, 0.25, 0.0), (0.0, 0.0, 0.125), (3.0, 5.0, 7.0)):
        truth = np.array(
            [
                2.0 * sizes[0] * stored,
                sizes[1] * stored + sizes[0] * normal,
                sizes[2] * stored + abs(first[2]) * normal + np.hypot(*first[:2]) * tangential,
                abs(second[2]) * normal + np.hypot(*second[:2]) * tangential,
            ]
        )
        found = body.swept(np.array([tangential]), np.array([normal]), stored)
        # where nothing moves along it, a rounding of the normal is across it still
        spare = 8.0 * U * tangential * np.array([0.0, sizes[0], sizes[1], sizes[2]]) / 2.0
        assert (np.abs(found - truth / 2.0 - spare) <= 1e-12 * truth + spare).all()


def test_what_a_face_sweeps_across_its_normal_is_in_the_bound_however_little_that_is():
    """Where the later normals are along the first one but for some roundings, their squares' difference is none."""
    rng, short = np.random.default_rng(2), 0
    for _ in range(200):
        corners = 1e6 * rng.normal(size=(3, 3))
        vectors = 1e6 * corners * (1.0 + 1e-16 * rng.normal(size=(3, 1))) + rng.normal(size=3)
        found = prisms([corners], [vectors]).swept(np.ones(1), np.zeros(1), 0.0)
        e, g = ([Fraction(float(x)) - Fraction(float(y)) for x, y in zip(corners[k], corners[0])] for k in (1, 2))
        f, h = ([Fraction(float(x)) - Fraction(float(y)) for x, y in zip(vectors[k], vectors[0])] for k in (1, 2))

        def cross(a, b):
            return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

        plain, first, second = cross(e, g), [x + y for x, y in zip(cross(e, h), cross(f, g))], cross(f, h)
        for normal, bound in ((first, found[2]), (second, found[3])):
            aside = cross(plain, normal)
            square = sum(x * x for x in aside) / sum(x * x for x in plain) / 4
            assert square <= Fraction(float(bound)) ** 2
            short += square > 0
    assert short


def test_a_face_without_area_sweeps_what_all_that_its_directions_change_sweeps():
    body = prisms([[[0, 0, 0], [1, 0, 0], [3, 0, 0]]], [[[0, 0, 0], [0, 0, 0], [0, 2, 0]]])
    assert close(body.swept(np.ones(1), np.ones(1), 0.0), np.array([0.0, 0.0, 1.0, 0.0]), rel=1e-12)


def test_what_strips_along_a_boundary_sweep_is_their_length_by_their_height():
    points, triangles = SQUARE[0] * [3.0, 5.0, 1.0], SQUARE[1]
    vectors = np.array([[0, 0, 2.0], [0, 0, 7.0], [0, 0, 4.0], [0, 0, 1.0]])
    long, turned = 3 * 7 + 5 * 7 + 3 * 4 + 5 * 2, 5 * 7 + 3 * 7 + 3 * 4 + 1 * 2
    for corner, (stored, slide) in enumerate(((2.0, 0.0), (0.0, 3.0), (8.0, 16.0))):
        found = walls._swept_by_strips(points, vectors, np.roll(triangles, corner, axis=1), stored, slide)
        assert close(found, np.array([0.0, long * stored, turned * stored + long * slide, turned * slide]), rel=1e-14)
    assert not walls._swept_by_strips(*(bodies.box()[0],) * 2, bodies.box()[1], 1.0, 1.0).any()


@pytest.mark.parametrize("stored", [0.0, 0.75])
def test_bounds_of_moments_are_those_of_jacobians_by_powers_of_how_far_points_are(stored):
    """As polynomials in s: the Jacobian's bound by (reach + s step)^α, and the move of each factor by the others."""
    rng = np.random.default_rng(4)
    bounds, reach = rng.uniform(1.0, 2.0, (3, 7)), (rng.uniform(1.0, 2.0, 3), rng.uniform(1.0, 2.0, 3))
    error, moved = walls._propagate_error(bounds, reach, 5, stored)
    bare = walls._propagate_error(bounds * [[0.0], [1.0], [1.0]], reach, 5, stored)[0]
    for s in (0.0, 0.5, 1.0, 3.0):
        far, powers = reach[0] + stored + s * reach[1], s ** np.arange(6)
        for i, exponents in enumerate(monomials(3)):
            whole = np.prod(far**exponents)
            less = sum(n * whole / far[axis] for axis, n in enumerate(exponents) if n)
            for found, row in ((bare, bounds[1]), (moved, bounds[2])):
                truth = whole * (row[:3] @ powers[:3]) + less * (row[3:] @ powers[:4])
                assert close(found[i] @ powers, truth, rel=1e-13)


def test_more_is_rounded_in_higher_moments_and_in_sums_of_more_blocks():
    bounds, reach = np.zeros((3, 7)), (np.ones(3), np.ones(3))
    bounds[0, :3] = 1.0, 2.0, 4.0

    def roundings(blocks):
        error, moved = walls._propagate_error(bounds, reach, blocks, 0.0)
        assert not moved.any()
        sizes = [np.polymul([4.0, 2.0, 1.0], np.poly([-1.0] * sum(n)))[::-1] for n in monomials(3).tolist()]
        shares = [row[: len(size)] / size / U for row, size in zip(error, sizes)]
        assert all(np.ptp(share) <= 1e-9 * share[0] for share in shares)
        assert all(not row[len(size) :].any() for row, size in zip(error, sizes))
        return np.array([share[0] for share in shares])

    degree, one, many = monomials(3).sum(axis=1), roundings(1), roundings(1001)
    # a Jacobian, the nodes' sums, and each factor: a difference, three products and sums of three, and the product
    assert (one >= JACOBIAN_ROUNDINGS + PAIRWISE_SUM_ROUNDINGS + 1.0 + 6.0 * degree).all()
    assert (one <= 200.0).all() and (many >= one + 1000.0 * (1.0 - 1e-9)).all()


def patched(monkeypatch, part, *, dtype=np.float64, **changes):
    """The wall of a surface whose directions are other ones."""
    found = offset_directions(part[0], part[1])
    monkeypatch.setattr(walls, "offset_directions", lambda *_: replace(found, **changes))
    return offset_solid(Surface(part[0].astype(dtype), part[1]))


@pytest.mark.parametrize("size", [1.0, 2.0**20, 2.0**-20])
def test_what_rounding_of_points_and_directions_sweeps_is_some_roundings_of_what_they_are(monkeypatch, size):
    """Of a cube that grows about its middle: with corners at ±size that go by ±3, a side is 4 (size + 3 s)²."""
    points, triangles = bodies.box((-1, -1, -1), (1, 1, 1))
    none = np.zeros((2, 8))
    given = {"vectors": 3.0 * points, "tangential_error": none, "normal_error": none}
    found = patched(monkeypatch, (size * points, triangles), **given)
    place, way = 3**0.5 * size * U, 3 * 3**0.5 * U
    normals = 4.0 * size**2, 24.0 * size, 36.0
    truth = np.array(
        [2 * normals[0] * place, normals[1] * place + normals[0] * way, normals[2] * place + normals[1] * way]
    )
    share = found.swept_rounding / (6.0 * np.array([*truth, normals[2] * way]))
    assert (share >= 2.0).all() and np.ptp(share) <= 1e-6 and (share <= 8.0).all()
    assert not found.swept_bound.any()


@pytest.mark.parametrize("size", [1.0, 2.0**20, 2.0**-20])
def test_what_rounding_sweeps_of_a_sheet_that_turns_is_across_its_faces_and_along_its_rim(monkeypatch, size):
    """A right triangle of sides 3 and 4, one corner of which rises three times as fast: later normals lie across."""
    points, triangles = size * np.array([[0, 0, 0], [3, 0, 0], [0, 4, 0]], float), np.array([[0, 1, 2]])
    vectors = np.array([[0, 0, 1], [0, 0, 3], [0, 0, 1]], float)
    none = np.zeros((2, 3))
    found = patched(
        monkeypatch, (points, triangles), vectors=vectors, tangential_error=none, normal_error=none
    ).swept_rounding
    normals, long, turned = (12.0 * size**2, 8.0 * size), (3 * 3 + 5 * 3 + 4 * 1) * size, 2 * 3 + 2 * 3
    place, way = found[0] / normals[0], found[3] / turned / 2.0
    truth = [
        normals[0] * place,
        (normals[1] * place + normals[0] * way) / 2.0 + long * place,
        normals[1] * way / 2.0 + turned * place + long * 2.0 * way,
        turned * 2.0 * way,
    ]
    assert close(found, truth, rel=1e-9)
    assert 2.0 * U <= place / (2.5 * size) <= 8.0 * U and 2.0 * U <= way / 3.0 <= 8.0 * U


@pytest.mark.parametrize("worst", [0, 3])
def test_what_storing_a_sheet_sweeps_is_that_of_its_faces_and_of_its_rim(monkeypatch, worst):
    """A unit square that goes straight up: with a needle of a face that was not asked, which may have stayed."""
    stored, ends = 1e-3, 1.0 + 2.0**-10
    points = np.concatenate([SQUARE[0], [[0.5, ends, 0.0]]])
    triangles = np.concatenate([SQUARE[1], [[3, 2, 4]]])
    tangential, normal = np.zeros((2, 5)), np.zeros((2, 5))
    tangential[:, worst], normal[:, worst] = (1e-3, 2e-3), (3e-3, 5e-3)
    surface = Surface(points, triangles, displacement=np.array([stored, 0.0, 0.0]))
    given = {
        "vectors": np.tile([0.0, 0.0, 1.0], (5, 1)),
        "tangential_error": tangential,
        "normal_error": normal,
        "has_normal": np.array([True, True, False]),
    }
    found_directions = replace(offset_directions(points, triangles), **given)
    monkeypatch.setattr(walls, "offset_directions", lambda *_: found_directions)
    found = offset_solid(surface)
    needle = 2.0**-10
    rim = 3.0 + 2.0 * np.hypot(0.5, needle)
    touched = [1.0, 1.0, 0.0] if worst == 0 else [0.0, 1.0, 1.0]
    lift = sum(d * (5e-3 * touch) for d, touch in zip((1.0, 1.0, needle), touched)) + 2.0 * needle
    truth = [2.0 * stored * (2.0 + needle) / 2.0, lift / 2.0 + rim * stored, rim * 7e-3, 0.0]
    assert close(found.swept_bound, np.array(truth), rel=1e-9)
    lift = sum(d * 3e-3 * touch for d, touch in zip((1.0, 1.0, needle), touched))
    assert close(found.swept_rounding[1:3], np.array([lift / 2.0, rim * 4e-3]), rel=1e-9)
    assert 0.0 < found.swept_rounding[0] < 1e-14 and found.degenerate_triangles == 1


def test_the_reach_of_a_wall_is_at_least_how_far_its_points_are():
    rng, less = np.random.default_rng(6), 0
    for _ in range(10):
        points = rng.normal(size=(4, 3)) * 10.0 ** rng.uniform(-4.0, 0.0, (4, 3))
        found = offset_solid(Surface(points, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])))
        for axis in range(3):
            far = max(abs(Fraction(float(p[axis])) - Fraction(float(found.about[axis]))) for p in points)
            assert far <= Fraction(float(found.reach[0, axis])) <= far * (1 + Fraction(2.0**-50))
            less += Fraction(float(np.abs(points - found.about).max(axis=0)[axis])) < far
            assert found.reach[1, axis] == np.abs(found.vectors[:, axis]).max()
    assert less  # a difference that was rounded down


@pytest.mark.parametrize("inward, outward", [(0.5, 0.0), (0.0, 0.25), (0.5, 2.0), (2.0, 0.5)])
def test_the_errors_of_a_wall_s_moments_follow_from_its_polynomials(inward, outward):
    solid = offset_solid(bodies.surface(SQUARE))
    rng = np.random.default_rng(8)
    reach, swept = np.array([[1.0, 2.0, 3.0], [0.5, 0.25, 0.125]]), np.array([1.0, 2.0, 3.0, 4.0])
    coefficients, error, moved = rng.uniform(1.0, 2.0, (3, 20, 6))
    given = replace(solid, coefficients=coefficients, reach=reach, swept_bound=swept, input_error=moved)
    exponents = monomials(3)
    size = sum(1 + 2 * s + 3 * s**2 + 4 * s**3 for s in (inward, outward))
    far = np.prod((reach[0] + max(inward, outward) * reach[1]) ** exponents, axis=1)

    def integral(rows, signs):
        return sum(
            sign * row * way ** (k + 1) / (k + 1)
            for way, sign in ((outward, 1), (-inward, signs))
            for k, row in enumerate(rows.T)
        )

    body = replace(given, rounding_error=np.zeros((20, 6))).moments(inward, outward)
    assert close(body.raw, integral(coefficients, -1), rel=1e-12)
    total = sum(row * (outward ** (k + 1) + inward ** (k + 1)) / (k + 1) for k, row in enumerate(coefficients.T))
    assert (body.rounding_error >= 4.0 * U * total).all() and (body.rounding_error <= 64.0 * U * total).all()
    both = [
        sum(row * (outward ** (k + 1) + inward ** (k + 1)) / (k + 1) for k, row in enumerate(rows.T))
        for rows in (error, moved)
    ]
    body = replace(given, rounding_error=error).moments(inward, outward)
    assert close(body.rounding_error, both[0], rel=1e-13)
    assert close(body.input_error, np.minimum(both[1], size * far), rel=1e-13)
    body = replace(given, rounding_error=error, input_error=1e9 * moved).moments(inward, outward)
    assert close(body.input_error, size * far, rel=1e-13)
