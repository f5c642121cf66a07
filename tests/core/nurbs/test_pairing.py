# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sides of patches are joined where more than two meet: patches around one edge, joined elsewhere or not."""

from itertools import combinations

import numpy as np
import pytest
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs.creases import sharpest_crease
from body_moments.core.nurbs.patch import Patch
from body_moments.core.nurbs.patch_topology import (
    _close_pairs,
    _find_loops,
    _orient_patches,
    _pair_sides,
    find_topology,
)

from tests.close import close
from tests.core.nurbs.test_solid import flat

EDGE = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]])


def joined(around, joints=(), alike=(), apart=()):
    """Which patches are joined at the edge, and how many sides coincide with more than one.

    around: of each patch in which direction it lies (degrees) and whether it runs along the edge forward. joints: pairs
    of patches that another side of each joins, and whether one must turn for that. alike: pairs whose curves run the
    same way at the edge; others run against each other, which fits where both run forward. apart: pairs that do not
    coincide there, as each of them is but near to a third one.
    """
    count = len(around)
    points = np.zeros((4 * count, len(EDGE), 3))
    forward = np.ones(4 * count, bool)
    for k, (degrees, ahead) in enumerate(around):
        out = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])
        points[4 * k] = EDGE
        points[4 * k + 1 : 4 * k + 4] = EDGE + 4.0 * out
        forward[4 * k] = ahead
    pairs = [(0.0, 4 * i, 4 * j, (i, j) in alike) for i, j in combinations(range(count), 2) if (i, j) not in apart]
    free = [[4 * k + 1, 4 * k + 2, 4 * k + 3] for k in range(count)]
    others = [(0.25, *sorted((free[i].pop(), free[j].pop())), turns) for i, j, turns in joints]
    left, right, same, gap, crowded = _pair_sides(sorted(pairs + others), points, np.arange(4 * count) // 4, forward)
    assert (gap == np.where((left % 4 == 0) & (right % 4 == 0), 0.0, 0.25)).all() and len(left) == len(same)
    found = [(int(i) // 4, int(j) // 4) for i, j in zip(left, right) if i % 4 == j % 4 == 0]
    assert len(found) + len(joints) == len(left)
    return sorted(found), crowded


CHAIN = [(0, 1, False), (1, 2, False), (2, 3, False)]
F, B = True, False  # which run forward; those that run alike fit here, as their curves run against each other


@pytest.mark.parametrize(
    "around, joints, expected",
    [
        # of one body those that fit, though others are as near or nearer
        ([(0, F), (10, B), (20, F), (30, B)], CHAIN, [(0, 2), (1, 3)]),
        ([(0, F), (10, F), (20, B), (30, B)], CHAIN, [(0, 1), (2, 3)]),
        ([(0, F), (40, F), (20, B), (30, F)], CHAIN, [(0, 2), (1, 3)]),
        # those that are turned by what joins them fit as if they faced the other way
        ([(0, F), (10, F), (20, F), (30, F)], [(0, 1, True), (1, 2, True), (2, 3, True)], [(0, 2), (1, 3)]),
        ([(0, F), (10, F), (20, F), (30, F)], [(0, 1, False), (1, 2, True), (2, 3, False)], [(0, 1), (2, 3)]),
        # what fits within a body comes before a patch by itself, and that before another body, sharper as they may be
        ([(0, F), (60, F), (10, F)], [(0, 1, False)], [(0, 1)]),
        ([(10, F), (0, F), (60, F)], [(1, 2, False)], [(1, 2)]),
        ([(0, F), (10, F), (60, F), (120, B), (180, B)], [(0, 3, False), (1, 4, False)], [(1, 2), (3, 4)]),
        ([(60, F), (10, F), (0, F), (120, B), (180, B)], [(1, 3, False), (2, 4, False)], [(0, 1), (3, 4)]),
        # patches by themselves are no sharper than other bodies
        ([(0, F), (50, F), (60, F), (90, B)], [(2, 3, False)], [(0, 3), (1, 2)]),
        ([(0, F), (10, F), (60, F), (90, B)], [(2, 3, False)], [(0, 3), (1, 2)]),
        # and a body of three is none by itself
        (
            [(300, F), (0, B), (310, F), (280, F), (10, B), (180, B)],
            [*CHAIN[:2], (3, 4, False)],
            [(0, 2), (1, 3), (4, 5)],
        ),
        # what fits comes before what must turn, and that before what would make a body of one side only
        ([(0, F), (10, B), (60, F)], [], [(0, 2)]),
        ([(0, F), (10, B), (60, B)], [(0, 1, False)], [(1, 2)]),
        ([(0, F), (10, B), (60, F), (130, B)], [(0, 1, False), (2, 3, False)], [(0, 2), (1, 3)]),
        ([(0, F), (10, B), (170, B)], [(0, 1, False), (1, 2, True)], [(0, 2)]),
        ([(0, F), (10, F), (60, B)], [(0, 1, True)], [(1, 2)]),
        # even that is joined where nothing else is left
        ([(0, F), (10, B), (20, B), (40, B)], CHAIN, [(0, 3), (1, 2)]),
        # patches that lie on each other come after those that fit
        ([(0, F), (0.05, F), (60, F), (300, F)], CHAIN, [(0, 3), (1, 2)]),
        ([(0, F), (0.06, F), (60, F), (300, F)], CHAIN, [(0, 1), (2, 3)]),
        ([(0, F), (0.05, F), (60, B)], [], [(0, 1)]),
        ([(0, F), (0.05, F), (60, B)], CHAIN[:2], [(0, 1)]),
    ],
)
def test_of_sides_that_meet_those_are_joined_that_turn_the_fewest_and_of_these_the_sharpest(around, joints, expected):
    found, crowded = joined(around, joints)
    assert (found, crowded) == (expected, len(around))


def test_sides_that_meet_no_others_are_joined_whatever_they_are():
    for around in ([(0, F), (90, F)], [(0, F), (90, B)], [(0, F), (0, F)]):
        assert joined(around) == ([(0, 1)], 0)
    assert joined([(0, F)]) == ([], 0)


@pytest.mark.parametrize(
    "around, apart, expected",
    [
        ([(0, F), (90, F), (40, F)], (1, 2), (0, 2)),
        ([(90, F), (40, F), (0, F)], (0, 1), (1, 2)),
        # angles that are the same but for rounding are one, and the first pair comes first
        ([(0, F), (-10.01, F), (10, F)], (1, 2), (0, 1)),
        ([(0, F), (-10.1, F), (10, F)], (1, 2), (0, 2)),
    ],
)
def test_a_side_that_two_others_are_near_to_is_joined_to_the_sharpest(around, apart, expected):
    assert joined(around, apart=[apart]) == ([expected], 1)


def arc(start, length, inner):
    """A band around z, from a circle of radius 1 to another one, in chords; along its other sides it is open."""
    angles = start + length * np.linspace(0.0, 1.0, 41)
    circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(41)], axis=1)
    space = SplineSpace((0.0, *map(float, range(41)), 40.0), 2, 41)
    return Patch((space, clamped_space(2)), np.stack([circle, circle * inner[0] + [0.0, 0.0, inner[1]]], axis=1))


@pytest.mark.parametrize("gap, is_joined", [(1.9, True), (2.1, False), (3.0, False)])
def test_a_side_has_no_ends_where_they_are_within_twice_the_tolerance(gap, is_joined):
    """Else it coincides with no side that begins elsewhere."""
    tolerance = 0.01
    length = 2.0 * np.arcsin(gap * tolerance / 2.0)
    bands = [
        arc(0.0, 2.0 * np.pi - length, (1.0, 1.0)),
        arc(np.pi / 80.0 + 1.0, 2.0 * np.pi - length, (0.5, 0.0)),
    ]
    found = find_topology(bands, tolerance)
    assert found.number == (1 if is_joined else 2)


@pytest.mark.parametrize("off, is_joined", [(0.9, True), (1.1, False)])
@pytest.mark.parametrize("place", [0, 1, 2, 4])
@pytest.mark.parametrize("turned", [False, True])
def test_sides_coincide_within_the_tolerance_all_along(off, is_joined, place, turned):
    """Two sheets side by side, of which the second's side is off somewhere."""
    along = np.stack([np.zeros(5), np.arange(5.0), np.zeros(5)], axis=1)
    space = SplineSpace((0.0, *map(float, range(5)), 4.0), 2, 5)
    first = Patch((space, clamped_space(2)), np.stack([along, along - [1.0, 0.0, 0.0]], axis=1))
    side = along + (np.arange(5)[:, None] == place) * np.array([0.0, 0.0, off * 0.01])
    points = np.stack([side, along + [1.0, 0.0, 0.0]], axis=1)
    second = Patch((space, clamped_space(2)), points[::-1] if turned else points)
    found = find_topology([first, second], 0.01)
    assert found.number == (1 if is_joined else 2)
    assert found.misoriented_sides == (is_joined and not turned)
    if is_joined:
        assert close(found.seam_gap, off * 0.01 * 4.0, 1e-3)


@pytest.mark.parametrize("gap, count", [(1.9, 1), (2.1, 0), (3.9, 0)])
def test_open_sides_follow_each_other_within_twice_the_tolerance(gap, count):
    """A square, of which one side begins so far from the end of the one before: else it is no loop."""
    corners = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
    points = np.stack([np.stack([corners[k], corners[(k + 1) % 4]]) for k in range(4)])[:, None]
    points = np.concatenate(
        [points[..., :1, :] * (1 - t) + points[..., 1:, :] * t for t in np.linspace(0, 1, 5)], axis=2
    )
    points = points[:, 0]
    points[2, :, 2] += gap * 0.01 * np.linspace(1.0, 0.0, 5)
    loops = _find_loops(points, np.arange(4), np.ones(4, bool), 0.01)
    assert sum(complete for _, complete in loops) == count


@pytest.mark.parametrize("far", [0, 2**50, -(2**52)])
@pytest.mark.parametrize("limit", [0, 1, 3])
def test_keys_are_close_that_differ_by_no_more_than_the_limit_wherever_they_are(limit, far):
    """In units of which those far away have none smaller."""
    rng = np.random.default_rng(0)
    for width in (1, 3, 6):
        keys = far + rng.integers(-4, 5, (60, width))
        found = set(zip(*(side.tolist() for side in _close_pairs(keys.astype(float), float(limit)))))
        apart = np.abs(keys[:, None] - keys).max(axis=2)
        assert found == set(map(tuple, np.argwhere(np.triu(apart <= limit, 1)).tolist()))
    alike = _close_pairs(np.full((4, 2), float(far)), 0.0)
    assert sorted(zip(*(side.tolist() for side in alike))) == [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]


def test_patches_turn_to_face_as_the_first_of_theirs_and_those_that_cannot_are_told():
    draw = np.random.default_rng(3)
    for _ in range(40):
        count = int(draw.integers(1, 7))
        left, right = draw.integers(0, count, (2, int(draw.integers(0, 9))))
        faces = draw.random(count) < 0.5
        wrong = draw.random(len(left)) < 0.2 * (draw.random() < 0.5)
        flipped, conflict = _orient_patches(count, left, right, faces[left] ^ faces[right] ^ wrong)
        off = flipped[left] ^ flipped[right] != faces[left] ^ faces[right] ^ wrong
        assert set(conflict.tolist()) == {*left[off].tolist(), *right[off].tolist()}
        links = [set(pair) for pair in zip(left.tolist(), right.tolist())]
        for first in range(count):
            reached = {first}
            while more := set().union(*(link for link in links if link & reached)) - reached:
                reached |= more
            assert not flipped[min(reached)]
            if not any(wrong[k] for k, link in enumerate(links) if link <= reached):
                assert flipped[first] == faces[first] ^ faces[min(reached)] and first not in conflict


def twisted(way, turned):
    """Over the y axis to one side of it, and as steep at y as y is large; along y or against it."""
    corners = [(0.0, 0.0, 0.0), (way, 0.0, 0.0), (way, 1.0, way), (0.0, 1.0, 0.0)]
    patch = flat(corners)
    return Patch(patch.spaces, patch.points[:, ::-1]) if turned else patch


@pytest.mark.parametrize("turns", [(False, False), (True, False), (False, True), (True, True)])
@pytest.mark.parametrize("axes", [(0, 0), (1, 0), (0, 1), (1, 1)])
def test_normals_are_compared_where_sides_meet_however_they_run(turns, axes):
    """Of one smooth sheet, whose normal turns along the seam."""
    patches = [
        patch.reverse_orientation() if axis else patch
        for patch, axis in zip((twisted(1.0, turns[0]), twisted(-1.0, turns[1])), axes)
    ]
    topology = find_topology(patches, 1e-9)
    assert len(topology.seams) == 1 and sharpest_crease(patches, topology) < 1e-7
    bent = [patches[0], patches[1].transform(np.diag([1.0, 1.0, -1.0, 1.0]))]
    assert close(sharpest_crease(bent, find_topology(bent, 1e-9)), np.pi / 2.0, 1e-9)


@pytest.mark.parametrize("inner", [((0.5,), ()), ((), (0.5,))])
def test_a_patch_that_is_a_line_has_no_crease_at_its_knots(inner):
    line = flat([(0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 0, 0)], inner=inner)
    assert sharpest_crease([line], find_topology([line], 1e-9)) == 0.0


@pytest.mark.parametrize("order", [1, -1])
def test_where_a_patch_has_no_normal_there_is_no_crease(order):
    """A triangle beside a square, and its corner on their seam a side that is a point."""
    triangle = flat([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 1, 0)])
    square = flat([(-1, 0, 0), (0, 0, 0), (0, 1, 0), (-1, 1, 0)])
    patches = [triangle, square][::order]
    topology = find_topology(patches, 1e-9)
    assert len(topology.seams) == 1 and sharpest_crease(patches, topology) < 1e-7
