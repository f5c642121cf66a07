# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Winding numbers of a box by rays, the depth of piercing triangles, and overlapping boxes."""

import numpy as np
import pytest
from body_moments.core.mesh import (
    Bvh,
    boxes_overlap,
    intersecting_pairs,
    overlapping_box_pairs,
    sort_components,
)
from body_moments.core.mesh.bvh import RAY_SLOPES
from hypothesis import given

from tests.close import close
from tests.core import bodies, shapes
from tests.core.strategies import holds, seeds

RAY = np.array([*RAY_SLOPES, 1.0])
TOLERANCE = 1e-6


def tree_of(points, triangles):
    components = sort_components(points, triangles, np.zeros(len(triangles), np.intp), 1)
    return Bvh(points, components, np.ones(1, bool))


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("share", [2.0, 1.1, 0.9, 0.1, -0.1, -0.9, -1.1, -2.0])
def test_place_is_sure_if_the_surface_is_beyond_the_tolerance(share, flip):
    """Places beside faces above and below; other places are sure in any case."""
    points, triangles = bodies.box((1.0, 2.0, 3.0), (2.0, 4.0, 6.0))
    tree = tree_of(points, triangles[:, ::-1] if flip else triangles)
    faces = np.array([[1.3, 2.9, 6.0], [1.8, 3.4, 3.0], [1.3, 3.1, 6.0]])
    far = np.array([[1.5, 3.0, 4.5], [0.5, 3.0, 4.5], [1.5, 3.0, 6.5], [1.5, 3.0, 2.0]])
    places = np.concatenate([faces - share * TOLERANCE * RAY, far])
    winding, sure = tree.winding_numbers(places - tree.origin, np.zeros(7, np.intp), TOLERANCE)
    assert sure.tolist() == [abs(share) > 1.0] * 3 + [True] * 4
    inside = [share > 0.0, share < 0.0, share > 0.0, True, False, False, False]
    expected = np.where(inside, -1 if flip else 1, 0)
    assert (winding[sure] == expected[sure]).all()


def test_a_place_on_the_surface_is_not_sure_without_a_tolerance():
    tree = tree_of(*bodies.box((0.0, 0.0, 0.0), (1.0, 2.0, 4.0)))
    places = np.array([[0.5, 0.75, 4.0], [0.5, 0.75, 0.0], [0.5, 0.75, 1.0]]) - tree.origin
    assert tree.winding_numbers(places, np.zeros(3, np.intp), 0.0)[1].tolist() == [
        False,
        False,
        True,
    ]


@pytest.mark.parametrize("turn", range(3))
def test_distances_from_a_box_match_their_closed_form(turn):
    low, high = np.roll([1.0, 2.0, 3.0], turn), np.roll([2.0, 4.0, 7.0], turn)
    tree = tree_of(*shapes.refined(shapes.refined(bodies.box(low, high), 0), 1))
    places = np.random.default_rng(turn).uniform(2.0 * low - high, 2.0 * high - low, (300, 3))
    outside = np.linalg.norm(np.maximum(np.maximum(low - places, places - high), 0.0), axis=1)
    inside = np.minimum(places - low, high - places).min(axis=1)
    assert 5 < np.count_nonzero(inside > 0.0) < 295
    found = tree.distances(places - tree.origin, np.zeros(300, np.intp))
    assert close(found, np.where(inside > 0.0, inside, outside), rel=1e-12)


@pytest.mark.parametrize("order, size", [([0, 1, 2], 7.0), ([2, 0, 1], 2e-4), ([0, 2, 1], 0.125)])
@pytest.mark.parametrize(
    "start, end, depth",
    [
        ((1.5, 0.5, -2.0), (1.5, 0.5, 1.0), 0.5),  # from the side along x
        ((0.25, 1.0, -1.0), (0.25, 1.0, 3.0), 0.25),  # from that along y
        ((2.0, 1.0, -1.0), (2.0, 1.0, 1.0), 0.4),  # from the slanted one
        ((1.0, 1.25, -3.0), (1.0, 0.05, 1.0), 0.35),  # it crosses at three quarters of its way
        ((1.0, 1.0, -0.3), (1.0, 1.0, 2.0), 0.3),  # in which it begins just below
        ((1.0, 1.0, -2.0), (1.0, 1.0, 0.3), 0.3),  # ends just above
        ((1.0, 2.0, -0.15), (1.0, -1.0, 0.15), 0.05),  # leaves just above
        ((1.0, -1.0, -0.15), (1.0, 2.0, 0.15), 0.05),  # and comes just below
    ],
)
def test_needle_depth_is_limited_by_triangle_and_needle(start, end, depth, order, size):
    """A triangle with sides of 3, 4 and 5 in the plane z = 0; beyond its sides the needle may be as
    low as it is.
    """
    flat = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]])[order]
    for needle in ([start, end, end], [end, start, start]):
        needle = np.array(needle) + [[0.0] * 3, [0.0] * 3, [1e-7, -1e-7, 0.0]]
        points = size * np.concatenate([flat, needle]) @ bodies.rotation(4).T + [5.0, -8.0, 2.0]
        components = sort_components(points, np.arange(6).reshape(2, 3), np.arange(2), 2)
        tree = Bvh(points, components, np.ones(2, bool))
        for share in (0.999, 1.001):
            for pair in ([0, 1], [1, 0]):
                found = intersecting_pairs(tree, *np.array(pair)[:, None], size * share * depth)
                assert [array.tolist() for array in found] == [[share < 1.0], [False]]


def test_triangles_without_an_area_are_gone_through_by_nothing():
    """A needle through the middle of one with corners in a row, and through a point."""
    flat = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    needle = np.array([[0.0, 0.0, -1.0], [0.1, 0.0, 1.0], [0.0, 0.1, 1.0]])
    triangles = np.array([[0, 1, 2], [3, 3, 3], [4, 5, 6], [4, 5, 6]])
    components = sort_components(
        np.concatenate([flat, needle]), triangles, np.array([0, 0, 1, 2]), 3
    )
    tree = Bvh(np.concatenate([flat, needle]), components, np.ones(3, bool))
    found, unfinished = intersecting_pairs(tree, np.array([0, 1, 1]), np.array([1, 0, 2]), 1e-9)
    assert not found.any() and not unfinished.any()


def test_distant_volumes_are_as_exact_as_near_ones():
    parts = [
        bodies.moved(bodies.sphere(1), size * bodies.rotation(size), (1e9, -2e9, 3e9))
        for size in (2, 5)
    ]
    points, triangles = bodies.joined(*parts)
    order = np.random.default_rng(0).permutation(len(triangles))
    owner = np.repeat([0, 1], len(parts[0][1]))
    components = sort_components(points, triangles[order], owner[order], 2)
    assert close(components.volume, [bodies.volume(part) for part in parts], rel=1e-12)


@holds(60)
@given(seed=seeds)
def test_box_overlaps_match_a_comparison_of_all_pairs(seed):
    rng = np.random.default_rng(seed)
    count = rng.integers(1, 25)
    centers, extents = rng.uniform(0.0, 10.0, (count, 3)), rng.uniform(0.0, 1.2, (count, 3))
    centers[::2] = np.round(centers[::2])
    extents[1::3] = 0.5  # neighbors that touch
    extents[::4, rng.integers(3)] = 0.0  # flat ones
    shrunk = extents * (1.0 - 1e-6)
    low, high = centers - shrunk, centers + shrunk
    truth = any(
        (low[i] < high[j]).all() and (low[j] < high[i]).all()
        for i in range(count)
        for j in range(i + 1, count)
    )
    assert boxes_overlap(centers, extents) == truth


def test_boxes_sharing_a_side_do_not_meet():
    grid = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    half = np.full((64, 3), 0.5)
    for unit in (1.0, 0.1, 0.7):  # rounded, some would overlap
        assert not boxes_overlap(unit * grid, unit * half)
        assert boxes_overlap(unit * grid, 1.001 * unit * half)
    assert boxes_overlap(
        np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.1]]), np.array([[1.0, 1.0, 1.0], [2.0, 2.0, 0.0]])
    )


@pytest.mark.parametrize("margin", [0.0, 0.25, 0.5])
@pytest.mark.parametrize("turn", range(3))
def test_pairs_overlap_by_more_than_the_margin_along_every_axis(margin, turn):
    """On a lattice of quarters many boxes overlap by exactly the margin."""
    rng = np.random.default_rng(turn)
    low = np.roll(rng.integers(0, 16, (60, 3)) * (0.25, 0.25, 0.5), turn, axis=1)
    high = low + 0.25 * rng.integers(1, 9, (60, 3))
    one, other, left_out = overlapping_box_pairs(low, high, margin, 10_000)
    common = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    truth = {(i, j) for i in range(60) for j in range(i) if common[i, j].min() > margin}
    assert sorted((max(pair), min(pair)) for pair in zip(one, other)) == sorted(truth)
    assert left_out == 0 and len(truth) > 5
