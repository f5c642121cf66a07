# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls: closed, convex, around all points; of degenerate, tiny, far and large clouds."""

import numpy as np
import pytest
from body_moments.core.mesh import convex_hull, convex_polygon
from body_moments.core.verdict import MeasureError

from tests.close import close


def turned(points, seed=11):
    """Points turned at random, and put off the origin."""
    turn = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))[0]
    return np.asarray(points) @ turn.T + (3.0, -5.0, 2.0)


def on_sphere(count, seed=2):
    points = np.random.default_rng(seed).standard_normal((count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def lattice(count):
    return np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, count)] * 3), axis=-1).reshape(-1, 3)


def volume(hull):
    a, b, c = (hull.points[hull.triangles[:, k]] - hull.points[0] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


def require_closed(hull):
    """Each side belongs to two triangles, in opposite directions, which know each other; and there
    is one surface.
    """
    triangles, neighbors = hull.triangles, hull.neighbors
    for side in range(3):
        beyond = neighbors[:, side]
        ends = triangles[:, (side + 1) % 3], triangles[:, side]
        matches = [
            (triangles[beyond, back] == ends[0])
            & (triangles[beyond, (back + 1) % 3] == ends[1])
            & (neighbors[beyond, back] == np.arange(len(triangles)))
            for back in range(3)
        ]
        assert np.sum(matches, axis=0).tolist() == [1] * len(triangles)
    assert len(hull.points) - len(triangles) // 2 == 2


def highest_outside(hull, points):
    """Return the largest distance of a point outside the hull as a share of the extent, without
    slivers.
    """
    a, b, c = (hull.points[hull.triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    extent = np.ptp(points, axis=0).max()
    kept = length > 1e-4 * extent**2
    normal = normal[kept] / length[kept, None]
    return ((points @ normal.T) - (normal * a[kept]).sum(axis=1)).max() / extent


@pytest.mark.parametrize("size", [1e-12, 1.0, 1e15])
@pytest.mark.parametrize(
    "points",
    [
        np.random.default_rng(1).standard_normal((2000, 3)),
        on_sphere(1500),
        lattice(9),
        np.concatenate([lattice(6), lattice(6)]),
        np.random.default_rng(3).integers(0, 3, (400, 3)).astype(float),
        np.random.default_rng(4).standard_normal((500, 3)) * (1.0, 1e-3, 1e-5),
    ],
    ids=["cloud", "sphere", "lattice", "duplicates", "coplanar", "thin"],
)
def test_a_hull_is_closed_and_around_all_points(points, size):
    points = size * turned(points)
    hull = convex_hull(points)
    require_closed(hull)
    assert highest_outside(hull, points) <= 3e-8
    assert volume(hull) > 0.0
    assert np.array_equal(hull.points, points[hull.indices])


def test_faces_full_of_points_have_their_corners_only():
    assert len(convex_hull(lattice(9)).points) == 8
    assert len(convex_hull(turned(lattice(9)).astype(np.float32), tolerance=1e-6).points) == 8


def test_all_points_of_a_sphere_are_corners():
    assert len(convex_hull(on_sphere(3000)).points) == 3000


def test_limited_hull_keeps_farthest_points_and_states_its_gap():
    points = on_sphere(20000)
    hull = convex_hull(points, max_corners=500)
    require_closed(hull)
    assert 500 <= len(hull.points) < 1500
    a, b, c = (hull.points[hull.triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    outside = (points @ normal.T - (normal * a).sum(axis=1)).max()
    assert 0.9 * outside <= hull.gap <= 1.5 * outside


def test_points_in_a_plane_have_both_sides_of_their_polygon():
    square = np.random.default_rng(8).uniform(0.0, 1.0, (300, 2))
    square = np.concatenate([square, [[0, 0], [1, 0], [1, 1], [0, 1]]])
    points = turned(np.column_stack([square, np.zeros(len(square))]))
    hull = convex_hull(points)
    require_closed(hull)
    assert hull.is_flat and sorted(hull.indices) == [300, 301, 302, 303]


@pytest.mark.parametrize(
    "points", [[], [[1, 2, 3]], [[1, 2, 3]] * 5, [[0, 0, 0], [1, 1, 1], [3, 3, 3]]]
)
def test_points_on_a_line_have_no_hull(points):
    with pytest.raises(MeasureError) as refusal:
        convex_hull(np.array(points, float).reshape(-1, 3))
    assert refusal.value.finding.code == "hull_without_extent"


def test_hull_polygon_is_convex_counterclockwise_and_complete():
    random = np.random.default_rng(6)
    for points in (
        random.standard_normal((500, 2)),
        random.integers(0, 4, (60, 2)).astype(float),
        1e-9 * random.standard_normal((50, 2)) + 5.0,
    ):
        corners = points[convex_polygon(points)]
        along = np.roll(corners, -1, axis=0) - corners
        following = np.roll(along, -1, axis=0)
        assert (along[:, 0] * following[:, 1] - along[:, 1] * following[:, 0] > 0.0).all()
        inward = (
            np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
        )
        inside = points @ inward.T - (corners * inward).sum(axis=1)
        assert inside.min() >= -1e-14 * np.abs(points).max()


def test_polygons_of_lines_and_points():
    line = np.outer(np.linspace(0.0, 1.0, 9), (3.0, 1.0)) + 2.0
    assert convex_polygon(line).tolist() == [0, 8]
    assert len(convex_polygon(np.full((4, 2), 3.0))) == 1


def test_neighbors_of_a_tetrahedron_are_across_its_sides():
    hull = convex_hull(np.eye(4, 3, -1))
    require_closed(hull)
    assert close(volume(hull), 1.0 / 6.0, 1e-12)


@pytest.mark.parametrize(
    "linear", [np.diag([2.0, 3.0, -1.0]), [[1.0, 0.5, 0.0], [0.0, 2.0, 0.0], [0.3, 0.0, 1.0]]]
)
def test_an_affine_image_is_the_hull_of_the_images(linear):
    points = turned(np.random.default_rng(1).standard_normal((300, 3)))
    hull = convex_hull(points).transform(linear)
    require_closed(hull)
    assert volume(hull) > 0.0
    assert highest_outside(hull, points @ np.asarray(linear).T) <= 3e-8


def test_small_clouds_in_degenerate_places_have_closed_hulls():
    random = np.random.default_rng(12)
    for count in random.integers(5, 60, 300):
        points = random.integers(0, 5, (count, 3)) + 0.3 * random.integers(
            0, 2, (count, 3)
        ) * random.random((count, 3))
        hull = convex_hull(points)
        require_closed(hull)
        assert highest_outside(hull, points) <= 3e-8


@pytest.mark.parametrize("height, corners", [(0.6e-3, 8), (1.6e-3, 9)])
def test_the_tolerance_is_of_the_extent(height, corners):
    points = 7.0 * np.concatenate([lattice(2), [[0.4, 0.6, 1.0 + height]]])
    assert len(convex_hull(points, tolerance=1e-3).points) == corners


def test_hull_is_independent_of_the_order_of_equal_keys(monkeypatch):
    points, sort = lattice(4), np.argsort

    def argsort(values, kind=None):
        return (
            sort(values, kind="stable")
            if kind
            else len(values) - 1 - sort(values[::-1], kind="stable")
        )

    wanted = convex_hull(points).triangles
    monkeypatch.setattr(np, "argsort", argsort)
    np.testing.assert_array_equal(convex_hull(points).triangles, wanted)


@pytest.mark.parametrize("normal", [(1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1), (3, 1, 2)])
def test_slanted_faces_full_of_points_have_their_corners_only(normal):
    """Triangles above and below a hexagon: no point within them is a corner, though all are as far
    from it.
    """
    normal = np.array(normal) / np.linalg.norm(normal)
    first = np.cross(normal, (0.3, 0.7, -0.6))
    first /= np.linalg.norm(first)
    across = np.stack([first, np.cross(normal, first)])
    around = np.exp(2j * np.pi * np.arange(6) / 6.0)
    hexagon = np.stack([around.real, around.imag], axis=1) @ across
    shares = np.array([(i, j, 16 - i - j) for i in range(17) for j in range(17 - i)]) / 16.0
    triangle = shares @ (0.4 * hexagon[[0, 2, 4]])
    points = np.concatenate([hexagon, triangle + 0.2 * normal, triangle[::-1] - 0.15 * normal])
    for order in (np.arange(len(points)), np.random.default_rng(3).permutation(len(points))):
        hull = convex_hull(points[order] + (3.0, -5.0, 2.0))
        require_closed(hull)
        assert len(hull.points) == 6 + 3 + 3


def test_flat_hull_may_omit_its_tolerance_along_an_axis():
    square = np.array([[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 3.0, 5.0], [0.0, 3.0, 5.0]])
    for axis in range(3):
        hull = convex_hull(np.roll(square, axis, axis=1), tolerance=1e-4)
        assert hull.is_flat and close(hull.gap, 4e-4, 1e-12)
        assert close(hull.transform(np.diag([2.0, 5.0, 3.0])).gap, 20e-4, 1e-12)


@pytest.mark.parametrize("steps, corners", [(0.4, 8), (0.6, 9)])
def test_points_are_rounded_to_2_to_the_29_steps_of_the_extent(steps, corners):
    cube = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 0.5)])
    hull = convex_hull([*cube, [0.5, 0.5, 0.5 + steps * 2.0**-29]], 0.0)
    assert len(hull.points) == corners


@pytest.mark.parametrize("offset", [(0.0, 0.0), (0.0, 1e6), (-1e6, 0.0), (1e6, -1e6)])
@pytest.mark.parametrize("height, corners", [(0.09, [0, 2, 3, 4]), (0.11, [0, 1, 2, 3, 4])])
def test_distance_outside_a_polygon_is_relative_to_its_extent(offset, height, corners):
    """A rectangle of 10 by 4 with a point below one side by more or less than a hundredth of
    ten.
    """
    points = np.array([[0, 0], [5, -height], [10, 0], [10, 4], [0, 4]]) + offset
    assert convex_polygon(points, 0.01).tolist() == corners
