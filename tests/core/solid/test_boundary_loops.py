# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rims as loops: how they are joined, and what is known of their caps."""

import numpy as np
import pytest
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
def test_a_flat_loop_that_is_not_convex_has_its_true_area_and_no_height(seed):
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


def test_the_centroid_of_a_loop_in_a_plane_of_constant_z_lies_exactly_in_it():
    angle = np.linspace(0, 2 * np.pi, 17)[:-1]
    loops = polygon(np.stack([np.cos(angle), np.sin(angle), np.full(16, 0.1)], axis=1))
    assert loops.centroid[0, 2] == 0.1


def test_a_bent_loop_has_the_area_of_its_cone_and_a_height():
    loops = polygon([[0, 0, 0], [1, 0, 1], [1, 1, 0], [0, 1, 1]])
    np.testing.assert_allclose(loops.centroid[0], [0.5, 0.5, 0.5], rtol=1e-15)
    assert close(loops.planar_area[0], 1.0, rel=1e-15)
    assert close(loops.out_of_plane[0], 0.5, rel=1e-15)
    assert close(loops.cone_area[0], np.sqrt(2.0), rel=1e-14)  # four triangles of √2/4


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("width, tolerance, is_hole", [(3.9, 9, 0), (4.2, 9, 1), (0.199, 0.1, 0), (0.202, 0.1, 1)])
def test_what_is_narrower_than_a_thousandth_of_its_rim_or_than_the_tolerance_is_a_gap(width, tolerance, is_hole, scale):
    """A rectangle as wide as so many thousandths of its length, which is half its rim."""
    high = 1e-3 * width
    loops = polygon(scale * np.array([[0, 0, 0], [1, 0, 0], [1, high, 0], [0, high, 0]]))
    assert loops.has_area(1e-3 * tolerance * scale).tolist() == [bool(is_hole)]


@pytest.mark.parametrize("tolerance, is_flat, area", [(0.499, False, np.sqrt(2.0)), (0.501, True, 1.0)])
def test_a_cap_is_flat_where_its_rim_leaves_its_plane_by_no_more_than_the_tolerance(tolerance, is_flat, area):
    flat, curved, areas = polygon([[0, 0, 0], [1, 0, 1], [1, 1, 0], [0, 1, 1]]).caps(tolerance)
    assert (flat.tolist(), curved.tolist()) == ([is_flat], [not is_flat]) and close(areas[0], area, rel=1e-14)


def test_an_edge_and_the_shorter_ones_that_run_back_along_it_make_a_loop_without_area():
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
    # Where the shorter ones run the same way, the loops are the same, and the links say that the two sides disagree.
    flipped = [side if k % 4 == 0 else side[::-1] for k, side in enumerate(sides)]
    assert len(loops_of(points, flipped, directed=False).cone_area) == 4
    start, stop = np.array(flipped).T
    points = np.array(points)
    one, other, follows = join_sides(points[start], points[stop], start, stop, directed=False)
    mixed = (one % 4 == 0) != (other % 4 == 0)
    assert np.count_nonzero(mixed) == 8 and not follows[mixed].any() and follows[~mixed].all()


def test_two_holes_that_meet_in_a_vertex_lose_no_side():
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 0, 0], [-1, -1, 0], [0, -1, 0]]
    loops = loops_of(points, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 5), (5, 6), (6, 0)])
    assert loops.complete.all()
    assert close(loops.planar_area.sum(), 2.0, rel=1e-15)


def test_hundreds_of_sides_at_one_vertex_are_joined_in_pairs():
    n = 300
    angle = np.arange(2 * n) * np.pi / n
    points = np.concatenate([[[0, 0, 0]], np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)])
    sides = [side for k in range(n) for side in ((0, 2 * k + 1), (2 * k + 1, 2 * k + 2), (2 * k + 2, 0))]
    loops = loops_of(points, sides)
    assert loops.complete.all()
    assert close(loops.planar_area.sum(), n * np.sin(np.pi / n) / 2.0, rel=1e-12)


def greedy_links(points, sides, directed):
    """As `join_sides`, an end at a time."""
    count, ends = len(sides), {}
    for number, vertex in enumerate(np.array(sides).T.ravel().tolist()):
        ends.setdefault(vertex, []).append(number)
    places = points[np.array(sides)]
    ways = np.concatenate([places[:, 1] - places[:, 0], places[:, 0] - places[:, 1]])
    links = set()
    for meeting in ends.values():
        pairs = [(a, b) for a in meeting for b in meeting if a < b]
        fits = [(a, b) for a, b in pairs if len(meeting) == 2 or not directed or (a < count) != (b < count)]
        for a, b in sorted(fits, key=lambda pair: (-(ways[pair[0]] @ ways[pair[1]]), pair)):
            if a in meeting and b in meeting:
                meeting.remove(a), meeting.remove(b)
                links.add((*sorted((a % count, b % count)), (a < count) != (b < count)))
    return links


@holds(20)
@given(seed=seeds)
def test_at_each_vertex_the_sharpest_turns_are_joined_first_and_of_equal_ones_the_first(seed):
    rng = np.random.default_rng(seed)
    points = np.stack(np.meshgrid(*[np.arange(3.0)] * 3), axis=-1).reshape(-1, 3)
    pairs = np.argwhere(np.linalg.norm(points[:, None] - points, axis=2) == 1.0)
    sides = rng.permutation(pairs)[:70].tolist()
    start, stop = np.array(sides).T
    for directed in (True, False):
        one, other, follows = join_sides(points[start], points[stop], start, stop, directed)
        found = {(*sorted(pair), way) for *pair, way in zip(one.tolist(), other.tolist(), follows.tolist())}
        assert found == greedy_links(points, sides, directed)


def test_more_pairs_than_allowed_are_joined_in_order(monkeypatch):
    monkeypatch.setattr("body_moments.core.solid.boundary_loops.MAX_END_PAIRS", 1)
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0]]
    loops = loops_of(points, [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)])
    assert close(loops.planar_area.sum(), 1.0, rel=1e-15)


@pytest.mark.parametrize("scale", [1e-160, 1e-100, 1.0, 1e40])
def test_a_rim_without_an_area_has_no_plane_and_its_cap_is_curved(scale):
    """Two squares that run around oppositely, and so small ones that their area's square is no number."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    bow = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], float)
    with np.errstate(under="ignore"):
        loops = [polygon(scale * rim) for rim in (square, bow)]
    assert (loops[0].out_of_plane[0] == 0.0) == (scale > 1e-90)
    assert loops[1].out_of_plane[0] == np.inf and not loops[1].caps(scale)[0][0]


def test_a_chain_with_ends_is_not_complete():
    assert not loops_of([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [(0, 1), (1, 2)]).complete.any()
