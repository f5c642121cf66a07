# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments below planes against rational arithmetic of the clipped polyhedron."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.cuts import measure_below
from body_moments.core.mesh import convex_hull

from tests.core import exact
from tests.core.bodies import box, grid_torus, inverted, joined, split
from tests.core.strategies import SHAPES

EXPONENTS = exact.monomials(2)


def clipped(points, triangles, normal, offset):
    """Return the exact polyhedron below a plane, and the triangles of its cut face."""
    points = [tuple(map(Fraction, map(float, row))) for row in points]
    normal = [Fraction(float(value)) for value in normal]
    offset = Fraction(float(offset))
    heights = [sum(n * x for n, x in zip(normal, point)) - offset for point in points]
    foot = tuple(n * offset / sum(value * value for value in normal) for n in normal)
    soup, cap = [], []
    for triangle in np.asarray(triangles).tolist():
        # A face within the plane belongs to the cut, not to the part.
        if all(heights[i] == 0 for i in triangle):
            continue
        part, ends = [], []
        for i, j in zip(triangle, triangle[1:] + triangle[:1]):
            if heights[i] <= 0:
                part.append(points[i])
            if heights[i] == 0:
                ends.append((len(part) - 1, points[i]))
            if heights[i] * heights[j] < 0:
                t = heights[i] / (heights[i] - heights[j])
                part.append(tuple(a + t * (b - a) for a, b in zip(points[i], points[j])))
                ends.append((len(part) - 1, part[-1]))
        if len(part) < 3:
            continue
        soup += [(part[0], part[i], part[i + 1]) for i in range(1, len(part) - 1)]
        if len(ends) == 2:
            (i, first), (j, second) = ends
            first, second = (first, second) if (i + 1) % len(part) == j else (second, first)
            cap.append((foot, second, first))
    return soup + cap, cap


def face_moments(cap, normal):
    """Return exact moments about the origin of a face in a plane, up to its normal's length."""
    rows = [np.array(triangle) for triangle in cap]
    axis = int(np.argmax(np.abs(normal)))
    total = [Fraction(0)] * 10
    for corners in rows:
        area = np.cross(corners[1] - corners[0], corners[2] - corners[0])[axis]
        integers, scale = exact._integers(corners.tolist(), (0, 0, 0))
        for i, value in enumerate(exact._means(*integers, EXPONENTS)):
            n = sum(EXPONENTS[i])
            total[i] += area * Fraction(value, exact.factorial(n + 2) * scale**n)
    length = np.linalg.norm(normal) / abs(normal[axis])
    return np.array([float(value) for value in total]) * length * np.sign(normal[axis])


def assert_exact(points, triangles, normals, offsets):
    below = measure_below(points, triangles, normals, offsets)
    for i, (normal, offset) in enumerate(zip(normals, offsets)):
        soup, cap = clipped(points, triangles, normal, offset)
        corners = [corner for triangle in soup for corner in triangle]
        faces = np.arange(len(corners)).reshape(-1, 3)
        truth = exact.volume_moments(corners, faces, below.part.about[i], 2) if soup else [0] * 10
        for value, bound, right in zip(below.part.raw[i], below.part.rounding_error[i], truth):
            assert abs(Fraction(float(value)) - right) <= Fraction(float(bound))
        face = below.face.about_point(np.zeros(below.face.about.shape))
        error = np.abs(face.raw[i] - face_moments(cap, normal))
        assert (error <= face.rounding_error[i] + 1e-13 * np.abs(face.raw[i])).all()
    return below


def split_torus(n, m):
    points, quads = grid_torus(n, m)
    return points, split(quads)


def random_body(rng):
    """A hull, a torus, or one in another, of any proportion, place and hand."""
    proportions = list(SHAPES.values())[rng.integers(len(SHAPES))]
    kind = rng.integers(3)
    if kind == 0:
        points = rng.standard_normal((int(rng.integers(4, 14)), 3))
        hull = convex_hull(points)
        part = hull.points, hull.triangles
    elif kind == 1:
        part = split_torus(5, 4)
    else:
        part = joined(box((-2, -2, -2), (2, 2, 2)), inverted(box((-1, -1, -1), (1, 0.5, 1))))
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    if np.linalg.det(turn) < 0:
        part = inverted(part)
    points = part[0] * proportions @ turn.T + rng.choice([0.0, 1.0, 1e4]) * rng.standard_normal(3)
    return points, part[1]


@pytest.mark.parametrize("seed", range(200))
def test_random_body_below_planes_equals_clipped_polyhedron(seed):
    rng = np.random.default_rng(seed)
    points, triangles = random_body(rng)
    normals = np.repeat(rng.standard_normal((2, 3)) * [[1.0], [20.0]], 2, axis=0)
    through = points[rng.integers(len(points), size=4)]
    offsets = (normals * through).sum(axis=1)
    offsets[1::2] += 0.1 * np.ptp(points @ normals[0])
    assert_exact(points, triangles, normals, offsets)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1, -1])
def test_planes_through_vertices_edges_and_faces_of_a_box(axis, sign):
    body = box((1, 2, 3), (2, 4, 8))
    normal = sign * np.eye(3)[axis]
    heights = body[0] @ normal
    low, high = heights.min(), heights.max()
    offsets = np.array([high + 1, low, (low + high) / 2, high, low - 1])
    below = assert_exact(*body, np.tile(normal, (5, 1)), offsets)
    area = 10.0 / (high - low)
    assert below.volume.tolist() == [10, 0, 5, 10, 0]
    assert below.face_area.tolist() == [0, 0, area, area, 0]
    assert_exact(*body, np.array([[1, 1, 0.0]] * 3), [3.0, 4.0, 6.0])


def test_hundred_levels_equal_planes_measured_alone():
    body = split_torus(30, 20)
    normals = np.tile([0.3, -0.2, 1.0], (100, 1))
    offsets = np.linspace(-3, 3, 100)[::-1]
    together = measure_below(*body, normals, offsets)
    for i in range(0, 100, 7):
        alone = measure_below(*body, normals[i : i + 1], offsets[i : i + 1])
        np.testing.assert_allclose(together.second[i], alone.second[0], rtol=0, atol=1e-12)
    steps = np.diff(together.volume) / np.diff(offsets / np.linalg.norm(normals[0]))
    middle = (together.face_area[1:] + together.face_area[:-1]) / 2
    assert np.abs(steps - middle).max() < 0.05 * middle.max()


def test_open_surface_has_signed_prisms():
    points = np.array([[0, 0, 2], [1, 0, 2], [1, 1, 4], [0, 1, 4.0]])
    below = measure_below(points, [[0, 1, 2], [0, 2, 3]], [[0, 0, 1]] * 2, [3, 9], is_open=True)
    np.testing.assert_allclose(below.volume, [-0.25, -6.0])
    np.testing.assert_allclose(below.face_area, [-0.5, -1.0])


def test_zero_normals_and_numbers_without_end_are_refused():
    body = box()
    for normal, offset in (([0, 0, 0], 0.0), ([0, 0, np.nan], 0.0), ([0, 0, 1], np.inf)):
        with pytest.raises(ValueError, match=r"normals|finite"):
            measure_below(*body, [normal], [offset])


def paraboloid(n, m):
    """A polygonal paraboloid z = x² + y² below 1, as slices of n-gons, and the area of the unit
    polygon.
    """
    angle = np.arange(n) * (2 * np.pi / n)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    radii = np.sqrt(np.linspace(0, 1, m + 1))
    points = np.concatenate([r * ring + [0, 0, r * r] for r in radii] + [[[0, 0, 1.0]]])
    i, j = np.arange(n), (np.arange(n) + 1) % n
    quads = [np.stack([i, j, n + j, n + i], axis=1) + k * n for k in range(m)]
    lid = np.stack([m * n + i, m * n + j, np.full(n, len(points) - 1)], axis=1)
    return points, np.concatenate([split(np.concatenate(quads)), lid]), n / 2 * np.sin(angle[1])


@pytest.mark.parametrize("place", [0.0, 1e6])
def test_paraboloid_below_its_rings_is_its_frustums(place):
    points, triangles, unit = paraboloid(40, 8)
    levels = np.linspace(0, 1, 9)[1:]
    shifted = points + [place, -place, place]
    below = measure_below(shifted, triangles, np.tile([0, 0, 1.0], (8, 1)), levels + place)
    squares = np.linspace(0, 1, 9)
    frustums = unit / 24 * (squares[1:] + squares[:-1] + np.sqrt(squares[1:] * squares[:-1]))
    accuracy = 1e-12 + 1e-15 * place
    assert np.abs(below.volume - np.cumsum(frustums)).max() < accuracy
    assert np.abs(below.face_area - unit * levels).max() < 20 * accuracy
    assert (np.abs(below.part.rounding_error[:, 0]) < 1e2 * accuracy).all()
