# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments in n dimensions against closed forms and rational integration, and their bounds against
the truth.
"""

import math
from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import (
    closes,
    enclosed_moments,
    facet_moments,
    facets_of,
    multi_indices,
    outer_facets,
    polyhedron_moments,
)

from tests.close import close
from tests.core import bodies, rational
from tests.core.findings import refused

U = 2.0**-53


def unit_simplex(n):
    """The corners of the simplex 0, e_1 … e_n and its outward facets; on a line the facets'
    signs.
    """
    points = np.vstack([np.zeros(n), np.eye(n)])
    facets, signs = [], []
    for left_out in range(n + 1):
        corners = [i for i in range(n + 1) if i != left_out]
        frame = [points[i] - points[left_out] for i in corners]
        sign = round(np.linalg.det(np.array(frame)))
        facets.append(corners if sign > 0 or n == 1 else [corners[1], corners[0], *corners[2:]])
        signs.append(sign)
    return points, np.array(facets), (np.array(signs) if n == 1 else None)


def cube(n):
    """The unit cube in n dimensions with Kuhn's simplices on each side, outward."""
    points = np.array(np.meshgrid(*[[0.0, 1.0]] * n, indexing="ij")).reshape(n, -1).T
    weights = 2 ** np.arange(n)[::-1]
    facets, signs = [], []
    for axis in range(n):
        for side in (0, 1):
            for order in permutations([k for k in range(n) if k != axis]):
                corner = np.zeros(n, int)
                corner[axis] = side
                path = [corner]
                for k in order:
                    corner = corner.copy()
                    corner[k] = 1
                    path.append(corner)
                inside = np.full(n, 0.5)
                sign = np.sign(np.linalg.det(np.array(path) - inside))
                row = [int(weights @ c) for c in path]
                if sign < 0 and n > 1:
                    row[0], row[1] = row[1], row[0]
                facets.append(row)
                signs.append(sign)
    return points, np.array(facets), (np.array(signs) if n == 1 else None)


def affine(n, seed):
    rng = np.random.default_rng(seed)
    return np.round(rng.normal(size=(n, n)) * 64) / 64 + np.eye(n), np.round(
        rng.normal(size=n) * 64
    ) / 64


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_unit_simplices_have_dirichlets_moments_to_twelfth_order(n):
    points, facets, signs = unit_simplex(n)
    found = enclosed_moments(points, facets, 12, about=np.zeros(n), signs=signs)
    truth = np.array(
        [
            float(Fraction(math.prod(math.factorial(k) for k in row), math.factorial(sum(row) + n)))
            for row in multi_indices(n, 12).tolist()
        ]
    )
    assert np.abs(found.raw / truth - 1.0).max() < 1e-14
    assert (np.abs(found.raw - truth) <= found.rounding_error).all()
    assert (found.rounding_error <= 1000 * U * truth).all()  # and the bound means something


def test_bounds_hold_for_vanishing_coordinate_products():
    """A needle of 1e-50 by 1e60 by 1e60: of its own size x³ is 1e-330."""
    sides = np.array([1e-50, 1e60, 1e60])
    points, facets, _ = unit_simplex(3)
    found = enclosed_moments(points * sides, facets, 2, about=np.zeros(3))
    for row, value, bound in zip(multi_indices(3, 2).tolist(), found.raw, found.rounding_error):
        truth = Fraction(math.prod(map(math.factorial, row)), math.factorial(sum(row) + 3))
        for side, power in zip(sides, row):
            truth *= Fraction(side) ** (power + 1)
        assert abs(Fraction(value) - truth) <= Fraction(bound)
    assert found[2, 0, 0] == 0.0 < found.bound((2, 0, 0)) < 1.0


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_facets_of_unit_simplices_match_dirichlet(n):
    points, facets, _ = unit_simplex(n)
    found = facet_moments(points, facets, 12, about=np.zeros(n))
    truth = []
    for row in multi_indices(n, 12).tolist():
        value = math.prod(map(math.factorial, row)) / math.factorial(sum(row) + n - 1)
        # The slanted facet, √n larger than those in the coordinate planes, of which x^α sees those
        # with α_i = 0.
        truth.append(value * (math.sqrt(n) + row.count(0)))
    assert np.abs(found.raw / truth - 1.0).max() < 1e-14
    assert (np.abs(found.raw - truth) <= found.rounding_error + 8 * U * np.array(truth)).all()


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_cubes_have_the_moments_of_products(n):
    points, facets, signs = cube(n)
    size, offset = (
        np.array([1.0, 2.0, 0.5, 3.0, 1.5])[:n],
        np.array([-1.0, 0.25, 2.0, -3.0, 0.5])[:n],
    )
    order = 12 if n < 5 else 6
    found = enclosed_moments(points * size + offset, facets, order, about=np.zeros(n), signs=signs)
    low, high = [Fraction(x) for x in offset], [Fraction(x) for x in size + offset]
    truth = np.array(
        [
            float(
                math.prod(
                    (high[i] ** (k + 1) - low[i] ** (k + 1)) / (k + 1) for i, k in enumerate(row)
                )
            )
            for row in multi_indices(n, order).tolist()
        ]
    )
    assert (np.abs(found.raw - truth) <= found.rounding_error).all()
    area = facet_moments(points * size + offset, facets, 0).raw[0]
    assert close(area, 2 * sum(np.prod(size) / s for s in size), rel=1e-14)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", [0, 1])
def test_affine_images_match_rational_integration_within_bounds(n, seed):
    points, facets, signs = unit_simplex(n)
    linear, offset = affine(n, seed)
    points = points @ linear.T + offset  # exact: few digits
    if np.linalg.det(linear) < 0 and n > 1:
        facets = facets[:, [1, 0, *range(2, n)]]
    elif np.linalg.det(linear) < 0:
        signs = -signs
    exactly = rational.fractions(points)
    found = enclosed_moments(points, facets, 6, signs=signs)
    about = tuple(Fraction(x) for x in found.about)
    rows = multi_indices(n, 6).tolist()
    chosen = range(len(rows)) if n < 4 else range(0, len(rows), 9)
    for i in chosen:
        truth = rational.enclosed(
            exactly, facets.tolist(), rows[i], about, None if signs is None else signs.tolist()
        )
        assert abs(Fraction(found.raw[i]) - truth) <= Fraction(found.rounding_error[i])
    assert found.raw[0] > 0
    assert found.rounding_error[0] < 1e-13 * found.raw[0] * np.linalg.cond(linear)


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e7])
def test_a_body_far_away_is_as_exact_about_its_own_center(offset):
    points, facets, _ = cube(3)
    points = points + np.array([offset, -2 * offset, 3 * offset])
    found = enclosed_moments(points, facets, 4)
    exactly = rational.fractions(points)
    for i, row in enumerate(multi_indices(3, 4).tolist()):
        truth = rational.enclosed(
            exactly, facets.tolist(), row, tuple(Fraction(x) for x in found.about)
        )
        assert abs(Fraction(found.raw[i]) - truth) <= Fraction(found.rounding_error[i])
        assert abs(float(truth) - found.raw[i]) < 1e-14


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_open_boundaries_are_refused_unless_allowed(n):
    points, facets, signs = cube(n)
    signs = np.ones(len(facets)) if signs is None else signs
    with refused("boundary_open"):
        enclosed_moments(points, facets[1:], 1, signs=signs[1:])
    with refused("boundary_open"):
        enclosed_moments(points, facets, 1, signs=np.r_[-signs[:1], signs[1:]])
    cone = enclosed_moments(
        points, facets[1:], 0, about=np.full(n, 0.5), signs=signs[1:], allow_open=True
    )
    assert close(cone.raw[0], 1.0 - 0.5 / math.factorial(n), rel=1e-13)


@pytest.mark.parametrize(("n", "size"), [(2, 1e-160), (3, 1e-108), (3, 1e-200), (6, 1e-60)])
def test_vanishing_bodies_are_refused(n, size):
    points, facets, signs = unit_simplex(n)
    with refused("object_size"):
        enclosed_moments(points * size, facets, 0, signs=signs)
    assert enclosed_moments(points * size ** (1 / 3), facets, 0, signs=signs).raw[0] > 0.0


@pytest.mark.parametrize("exponents", [(-1, 0), (0, 3), (2, 1), 1, (1, 0, 0), (0.5, 0)])
def test_exponents_without_moment_are_refused_in_any_dimension(exponents):
    points, facets, _ = cube(2)
    moments = enclosed_moments(points, facets, 2)
    for of in (moments.__getitem__, moments.bound):
        with pytest.raises((IndexError, TypeError), match="to order 2|2 integer exponents"):
            of(exponents)


@pytest.mark.parametrize("size", [1e-100, 1e-30, 1e-9, 1e12])
def test_size_costs_no_digits(size):
    points, facets, _ = cube(2)
    order = 1 if size < 1e-90 else 6
    found = enclosed_moments(points * size, facets, order, about=np.zeros(2))
    for row, value in zip(multi_indices(2, order).tolist(), found.raw):
        truth = Fraction(size) ** (sum(row) + 2) / ((row[0] + 1) * (row[1] + 1))
        assert abs(float(Fraction(value) / truth) - 1.0) < 1e-14


def test_overflowing_order_is_refused():
    points, facets, _ = cube(2)
    with refused("moments_overflow", order=6):
        enclosed_moments(points * 1e60, facets, 6)


def test_a_reversed_boundary_encloses_the_negative():
    points, facets, _ = cube(3)
    there, back = (
        enclosed_moments(points, f, 5, about=np.zeros(3)) for f in (facets, facets[:, ::-1])
    )
    assert np.abs(there.raw + back.raw).max() <= (there.rounding_error + back.rounding_error).max()


def test_triangle_meshes_match_the_third_order_kernel():
    points, triangles = bodies.moved(bodies.torus(12, 9), bodies.rotation(3), (4, -2, 9))
    surface = Surface.from_triangles(points, triangles)
    volume, area = polyhedron_moments(surface, area_order=3)
    mine = enclosed_moments(points, triangles, 3, about=volume.about)
    assert (np.abs(mine.raw - volume.raw) <= mine.rounding_error + volume.rounding_error).all()
    mine = facet_moments(points, triangles, 3, about=area.about)
    assert (np.abs(mine.raw - area.raw) <= mine.rounding_error + area.rounding_error).all()
    assert abs(mine.raw[0] / area.raw[0] - 1.0) < 1e-14


@pytest.mark.parametrize(
    "points, simplices, words",
    [
        ([[0.0, 0.0], [1.0, np.nan]], [[0, 1]], "coordinates must be finite"),
        ([[0.0, 0.0], [1.0, 0.0]], [[0, 2]], "no such point"),
        ([[0.0, 0.0], [1.0, 0.0]], [[0, -1]], "no such point"),
        ([[0.0, 0.0], [1.0, 0.0]], [[0, 1, 1]], "simplices"),
        ([[0.0, 0.0], [1.0, 0.0]], [0, 1], "simplices"),
        ([0.0, 1.0], [[0]], "points"),
        ([[], []], [[]], "points"),
        ([[0.0, 1j], [1.0, 0.0]], [[0, 1]], "real"),
        ([[0.0, 0.0], [1.0, 0.0]], [[0.0, 1.0]], "integers"),
        ([[0.0, 0.0], [1.0, 0.0]], [[False, True]], "integers"),
    ],
)
def test_bad_input_is_refused(points, simplices, words):
    with pytest.raises(ValueError, match=words):
        enclosed_moments(points, simplices, 2)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"order": -1}, "order"),
        ({"order": 2.5}, "order"),
        ({"about": (0.0, 0.0)}, "about"),
        ({"about": (0.0, np.nan, 0.0)}, "about must be finite"),
        *(({"signs": signs}, "signs") for signs in (np.ones(35), np.ones((1, 36)), 1.0)),
    ],
)
def test_arguments_are_checked(arguments, words):
    points, facets, _ = cube(3)
    with pytest.raises(ValueError, match=words):
        enclosed_moments(points, facets, **{"order": 2} | arguments)


def test_empty_boundary_encloses_nothing():
    for simplices in (np.zeros((0, 3), int), np.zeros((0, 3))):
        found = enclosed_moments(np.zeros((0, 3)), simplices, 2)
        assert (
            not found.raw.any()
            and (found.rounding_error > 0.0).all()
            and found.rounding_error.max() < 1e-300
        )


def test_a_body_far_away_is_bounded_as_at_home():
    """The farther it is, the more its size to the 28th would leave the range of numbers beside
    that.
    """
    points, facets, _ = cube(2)
    here, there = (enclosed_moments(points + far, facets, 26) for far in (0.0, 2.0**40))
    assert np.array_equal(here.raw, there.raw) and np.array_equal(
        here.rounding_error, there.rounding_error
    )


def test_unused_points_may_be_nonfinite():
    points, facets, _ = cube(3)
    more = np.concatenate([points, np.full((1, 3), np.nan)])
    assert np.array_equal(
        enclosed_moments(more, facets, 3).raw, enclosed_moments(points, facets, 3).raw
    )


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_facets_of_simplices_enclose_their_volumes(n):
    """However their corners are turned."""
    rng = np.random.default_rng(n)
    points = rng.normal(size=(12, n))
    simplices = np.array([rng.permutation(12)[: n + 1] for _ in range(6)])
    corners = points[simplices]
    truth = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / math.factorial(n)
    facets, signs = facets_of(points, simplices)
    assert close(enclosed_moments(points, facets, 0, signs=signs).raw[0], truth, rel=1e-13)
    assert closes(points, facets, signs) and not closes(points, facets[1:], signs[1:])


def test_facets_of_simplices_close_with_or_without_signs():
    square, halves = [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]]
    facets, signs = facets_of(square, halves)
    outer = outer_facets(square, facets, signs)
    assert sorted(sorted(pair) for pair in outer.tolist()) == [[0, 1], [0, 3], [1, 2], [2, 3]]
    assert closes(square, facets, signs) and not closes(square, facets)
    ring = [[0, 1], [1, 2], [2, 3], [3, 0]]
    assert closes(square, ring) and not closes(square, ring[1:])
    assert sorted(outer_facets(square, [*ring, [0, 2], [2, 0]]).tolist()) == sorted(ring)
    assert sorted(outer_facets(square, [*ring, [0, 2], [0, 2]]).tolist()) == sorted(
        [*ring, [0, 2], [0, 2]]
    )
    again = [*square, [0, 0]]  # from a point to itself is no side
    assert sorted(outer_facets(again, [[0, 4], *ring]).tolist()) == sorted(ring) and closes(
        again, [[0, 4], *ring]
    )
