# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loops of rim edges and the geometry of their caps."""

import numpy as np
import pytest
from body_moments.core.solid import boundary_loops
from body_moments.core.solid.boundary_loops import find_loops, join_sides
from hypothesis import given

from tests.close import close
from tests.core.bodies import rotation
from tests.core.strategies import holds, seeds


def loops_of(points, sides, directed=True):
    points, (start, stop) = np.asarray(points, float), np.array(sides).T
    begin, end = points[start], points[stop]
    return find_loops(begin, end, join_sides(begin, end, start, stop, directed))


def polygon(points):
    n = len(points)
    return loops_of(points, [(i, (i + 1) % n) for i in range(n)])


@holds(5)
@given(seed=seeds)
def test_concave_flat_loop_has_its_true_area_and_no_height(seed):
    comb = np.array(
        [
            [0, 0, 0],
            [5, 0, 0],
            [5, 3, 0],
            [4, 3, 0],
            [4, 1, 0],
            [3, 1, 0],
            [3, 3, 0],
            [2, 3, 0],
            [2, 1, 0],
            [1, 1, 0],
            [1, 3, 0],
            [0, 3, 0],
        ],
        float,
    )
    loops = polygon(comb @ rotation(seed).T + [3, 4, 5])
    assert len(loops.planar_area) == 1 and loops.complete[0]
    assert close(loops.planar_area[0], 11.0, rel=1e-14)
    assert loops.cone_area[0] > 12.0  # the cone folds over
    assert close(loops.perimeter[0], 24.0, rel=1e-14)
    assert loops.out_of_plane[0] < 1e-14


def test_centroid_of_a_loop_at_constant_z_lies_in_its_plane():
    angle = np.linspace(0, 2 * np.pi, 17)[:-1]
    loops = polygon(np.stack([np.cos(angle), np.sin(angle), np.full(16, 0.1)], axis=1))
    assert loops.centroid[0, 2] == 0.1


def test_a_bent_loop_has_the_area_of_its_cone_and_a_height():
    loops = polygon([[0, 0, 0], [1, 0, 1], [1, 1, 0], [0, 1, 1]])
    np.testing.assert_allclose(loops.centroid[0], [0.5, 0.5, 0.5], rtol=1e-14)
    assert close(loops.planar_area[0], 1.0, rel=1e-14)
    assert close(loops.out_of_plane[0], 0.5, rel=1e-14)
    assert close(loops.cone_area[0], np.sqrt(2.0), rel=1e-14)  # four triangles of √2/4


def test_edges_running_back_along_an_edge_enclose_no_area():
    # Four edges of a square, and the same edges the other way, each cut in three.
    corner = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float) @ rotation(1).T
    points, sides = [*corner], []
    for k in range(4):
        a, b = k, (k + 1) % 4
        sides.append((a, b))
        points += [corner[a] + (corner[b] - corner[a]) * t for t in (1 / 3, 2 / 3)]
        n = len(points)
        sides += [(b, n - 1), (n - 1, n - 2), (n - 2, a)]
    for directed in (True, False):
        loops = loops_of(points, sides, directed)
        assert len(loops.cone_area) == 4 and loops.complete.all()
        assert np.all(loops.cone_area < 1e-15)
    # If the shorter ones run the same way, the loops are the same, and the links say that the two
    # sides disagree.
    flipped = [side if k % 4 == 0 else side[::-1] for k, side in enumerate(sides)]
    assert len(loops_of(points, flipped, directed=False).cone_area) == 4
    start, stop = np.array(flipped).T
    points = np.array(points)
    one, other, follows = join_sides(points[start], points[stop], start, stop, directed=False)
    mixed = (one % 4 == 0) != (other % 4 == 0)
    assert np.count_nonzero(mixed) == 8 and not follows[mixed].any() and follows[~mixed].all()


def test_holes_meeting_in_a_vertex_lose_no_side():
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 0, 0], [-1, -1, 0], [0, -1, 0]]
    loops = loops_of(points, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 5), (5, 6), (6, 0)])
    assert loops.complete.all()
    assert close(loops.planar_area.sum(), 2.0, rel=1e-14)


def test_hundreds_of_sides_at_one_vertex_are_joined_in_pairs():
    n = 300
    angle = np.arange(2 * n) * np.pi / n
    points = np.concatenate(
        [[[0, 0, 0]], np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)]
    )
    sides = [
        side for k in range(n) for side in ((0, 2 * k + 1), (2 * k + 1, 2 * k + 2), (2 * k + 2, 0))
    ]
    loops = loops_of(points, sides)
    assert loops.complete.all()
    assert close(loops.planar_area.sum(), n * np.sin(np.pi / n) / 2.0, rel=1e-12)


@pytest.mark.parametrize("scale", [1e-160, 1e-100, 1.0, 1e40])
def test_rim_without_area_has_no_plane_and_a_curved_cap(scale):
    """Two squares that run around oppositely, and so small ones that their area's square is no
    number.
    """
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    bow = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], float)
    with np.errstate(under="ignore"):
        loops = [polygon(scale * rim) for rim in (square, bow)]
    assert (loops[0].out_of_plane[0] == 0.0) == (scale > 1e-90)
    assert loops[1].out_of_plane[0] == np.inf


def test_too_many_ends_are_joined_at_equal_vertices_only(monkeypatch):
    monkeypatch.setattr(boundary_loops, "MAX_END_PAIRS", 0)
    sides = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)])  # two loops meet at 0
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0]], float)
    start, stop = sides.T
    left, right, _ = join_sides(points[start], points[stop], start, stop, directed=True)
    assert len(left) > 0
    assert all(set(sides[a]) & set(sides[b]) for a, b in zip(left, right))
