# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells that go through themselves are found and weighed; bodies that do not are proved, or raise
no alarm.
"""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.mesh import Crossings, LineGrids, Surface
from body_moments.core.solid import measure_solid, self_intersection
from body_moments.core.solid.self_intersection import measure_excess
from body_moments.core.verdict import Intersection
from hypothesis import given
from hypothesis import strategies as st

from tests.close import close
from tests.core.bodies import (
    CORNERS,
    bar,
    box,
    grid,
    inverted,
    joined,
    moebius,
    moved,
    rotation,
    sphere,
    split,
    surface,
    torus,
    welded,
    without,
)
from tests.core.findings import codes, only
from tests.core.shapes import L_PRISM, STEPPED
from tests.core.strategies import holds, seeds


def pushed(far, level=2):
    """A ball with one vertex pushed through the other side."""
    points, triangles = sphere(level)
    points[0] *= -far
    return points, triangles


def twice_around(count=24, rings=12):
    """A closed surface that goes around its center twice, all its faces outward: two balls,
    branched at the poles.
    """
    longitude = np.arange(2 * count) * 2.0 * np.pi / count
    latitude = np.linspace(-np.pi / 2.0, np.pi / 2.0, rings + 1)[1:-1]
    points = [
        [np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)]
        for b in latitude
        for a in longitude
    ]
    width, south, north = 2 * count, len(points), len(points) + 1
    i, j = (k.ravel() for k in np.meshgrid(np.arange(rings - 2), np.arange(width), indexing="ij"))
    after = (j + 1) % width
    belt = np.stack(
        [i * width + j, i * width + after, (i + 1) * width + after, (i + 1) * width + j], axis=1
    )
    top = (rings - 2) * width
    caps = [(south, (k + 1) % width, k) for k in range(width)]
    caps += [(north, top + k, top + (k + 1) % width) for k in range(width)]
    return np.array([*points, [0, 0, -1], [0, 0, 1]]), np.concatenate([split(belt), caps])


def hull(seed, count=30):
    """A random convex body: the faces that all points are on one side of."""
    points = np.random.default_rng(seed).normal(size=(count, 3)) ** 3
    triple = np.array([(i, j, k) for i in range(count) for j in range(i) for k in range(j)])
    a, b, c = (points[triple[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    height = np.einsum("tj,nj->tn", normal, points) - np.einsum("tj,tj->t", normal, a)[:, None]
    height[np.arange(len(triple))[:, None], triple] = 0.0
    below, above = (height <= 0.0).all(axis=1), (height >= 0.0).all(axis=1)
    return points, np.concatenate([triple[below], triple[above][:, ::-1]])


# the middle of whose box is outside
CORNER = (
    np.eye(4, 3, -1),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


@pytest.mark.parametrize(
    "part",
    [box(), sphere(3), CORNER, moved(box(), [[1, 5, 0], [0, 1, 7], [0, 0, 1]])],
)
@pytest.mark.parametrize("scale", [1e-8, 1e8])
@pytest.mark.parametrize("turned", [False, True])
def test_convex_bodies_are_proved(part, scale, turned):
    assert_convex_is_proved(part, scale, turned)


@pytest.mark.parametrize(
    "tip, height, agree",
    [((1.0, 1.0, 1.0), 0.0, True), ((-0.2, -0.2, 2.0), 0.0, False), ((-0.2, -0.2, 2.0), 1.0, True)],
    ids=["upright", "leaning over a slope", "folded the other way"],
)
@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("turn, others", [(0, 0), (0, 2), (2, 0), (2, 2)])
def test_one_reversed_triangle_leaves_a_body_unproved(tip, height, agree, first, turn, others):
    """A cube with a corner that leans over a side next to it, for each face and each half of a
    quad.
    """
    points = 2.0 * CORNERS - 1.0
    points[4, 2], points[7] = height, tip
    quads = np.array(
        [[5, 7, 6, 4], [0, 2, 3, 1], [0, 1, 5, 4], [6, 7, 3, 2], [0, 4, 6, 2], [3, 7, 5, 1]]
    )
    quads = np.concatenate([np.roll(quads[:1], turn, axis=1), np.roll(quads[1:], others, axis=1)])
    cut = Surface(points, quads=quads if first else quads[::-1])
    triangles = cut.all_triangles()[0]
    leaning = int(np.isin(triangles, [5, 6, 7]).all(axis=1).argmax())
    for body in (cut, Surface(points, np.roll(triangles, -leaning - (not first), axis=0))):
        for size in (1.0, 2.0**-15, 2.0**15):
            scaled = replace(body, points=size * body.points)
            assert self_intersection.is_star(scaled, np.zeros(3)) is agree
    state = measure_solid(cut).health.self_intersection
    assert state is (Intersection.EXCLUDED if agree else Intersection.NOT_FOUND)


@holds(20)
@given(seed=seeds, scale=st.sampled_from([1e-8, 1.0, 1e8]), turned=st.booleans())
def test_random_convex_bodies_are_proved(seed, scale, turned):
    assert_convex_is_proved(hull(seed), scale, turned)


def assert_convex_is_proved(part, scale, turned):
    part = moved(
        inverted(part) if turned else part, scale * rotation(7), (3 * scale, -5 * scale, scale)
    )
    result = measure_solid(surface(part))
    assert result.health.self_intersection is Intersection.EXCLUDED
    assert codes(result) == (["inverted_components"] if turned else [])


def test_surface_around_its_center_twice_is_found():
    result = measure_solid(surface(twice_around()))
    assert result.health.self_intersection is Intersection.FOUND
    assert only(result).code == "self_intersection" and close(
        only(result).values["share"], 0.5, rel=0.02
    )


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(
    "turn, share", [(1.1, 0.1 / 1.1), (1.5, 0.5 / 1.5), (2.5, 1.5 / 2.5), (0.97, 0.0), (1.0, 0.0)]
)
def test_bar_bent_past_a_full_ring_counts_its_overlap_twice(turn, share, dtype, scale):
    for seed in range(3):
        part = moved(bar(turn), scale * rotation(seed), (2 * scale, scale, -3 * scale))
        result = measure_solid(surface(part, dtype))
        assert result.method == "exact"
        if share:
            assert (
                result.health.self_intersection is Intersection.FOUND
                and codes(result)[0] == "self_intersection"
            )
            assert close(result.findings[0].values["share"], share, rel=0.15)
        else:
            assert result.health.self_intersection is Intersection.NOT_FOUND and not result.findings


@pytest.mark.parametrize("far, share", [(1.5, 6.3e-4), (2.0, 3.4e-3), (3.0, 1.5e-2)])
def test_a_vertex_pushed_through_the_other_side_is_found(far, share):
    """Shares: of 200,000 lines."""
    for seed in range(8):
        result = measure_solid(surface(moved(pushed(far), rotation(seed))))
        assert result.method == "exact" and result.health.self_intersection is Intersection.FOUND
        assert only(result).code == "self_intersection" and close(
            only(result).values["share"], share, rel=0.5
        )


def test_negligible_region_is_a_note():
    """Two ends of a long bar that just meet."""
    part = bar(1.0 + 2e-6, 400)
    result = measure_solid(surface(moved(part, rotation(1))))
    assert codes(result) in ([], ["self_intersection"])
    part = bar(1.0 + 5e-5, 400)
    for size in (1.0, 16.0):
        result = measure_solid(surface(moved(part, size * rotation(1))))
        assert only(result).values["slight"] and 1e-5 < only(result).values["share"] < 1e-4


@pytest.mark.parametrize(
    "part",
    [
        torus(),
        torus(48, 32),
        L_PRISM,
        STEPPED,
        box((0, 0, 0), (1, 1, 1e-5)),
        box((0, 0, 0), (1, 1e-4, 1e-4)),
        welded(joined(box(), box((1, 0, 0), (2, 1, 1)))),  # a face in common
        joined(box(), box((1, 0, 0), (2, 1, 1))),
        joined(box((-2, -2, -2), (2, 2, 2)), inverted(sphere(2))),
        without(torus(), 5),
        joined(torus(), moved(torus(), [[1, 0, 0], [0, 0, -1], [0, 1, 0]], (1, 0, 0))),  # linked
    ],
)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_ordinary_bodies_raise_no_alarm(part, dtype):
    for seed in (None, 1, 2):
        turned = part if seed is None else moved(part, rotation(seed), (4, 5, 6))
        result = measure_solid(surface(turned, dtype))
        assert result.health.self_intersection in (Intersection.NOT_FOUND, Intersection.EXCLUDED)
        assert not [code for code in codes(result) if code.startswith("self_")]


def test_each_component_is_looked_at_by_itself():
    """Overlaps of two components are reported as such, and none of them goes through itself."""
    result = measure_solid(surface(joined(torus(), moved(torus(), offset=(0.4, 0, 0)))))
    assert (
        codes(result) == ["components_overlap"]
        and result.health.self_intersection is Intersection.NOT_FOUND
    )
    result = measure_solid(
        surface(
            joined(
                bar(1.2),
                moved(box(), offset=(5, 0, 0)),
                inverted(moved(bar(1.2), offset=(0, 5, 0))),
            )
        )
    )
    assert codes(result) == ["inverted_components", "self_intersection"]
    (found,) = [item for item in result.findings if item.code == "self_intersection"]
    each = measure_solid(surface(bar(1.2))).volume.total
    assert close(found.values["share"], 2.0 * each * 0.2 / 1.2 / (2.0 * each + 1.0), rel=0.2)


def test_the_order_of_faces_and_points_changes_nothing():
    points, triangles = moved(bar(1.1), rotation(5))
    rng = np.random.default_rng(0)
    order = rng.permutation(len(points))
    number = np.argsort(order)
    shuffled = Surface.from_triangles(
        points[order], number[triangles][rng.permutation(len(triangles))]
    )
    first, second = (
        only(measure_solid(body)).values["share"]
        for body in (surface((points, triangles)), shuffled)
    )
    assert close(first, second, rel=1e-12)


@pytest.mark.parametrize(
    "part", [grid(3), joined(moebius(), moved(box(), offset=(5, 5, 5)))], ids=["flat", "open"]
)
def test_flat_or_open_part_is_not_examined(part):
    assert measure_solid(surface(part)).health.self_intersection is Intersection.NOT_CHECKED


# row and column of each line, and its entries (1) and exits (-1)
LINES = {
    (0, 0): [(-1.0, 1)],  # a hole
    (0, 1): [(-2.0, 1), (-1.0, 1), (1.5, -1), (2.0, -1)],  # twice for 2.5
    (1, 0): [(-1.0, 1), (1.0, -1)],
    (1, 1): [(-1.0, -1), (0.5, 1)],  # inside out for 1.5
    (2, 1): [
        (-1.0, 1),
        (0.0, 1),
        (0.0625, -1),
        (1.0, -1),
    ],  # twice for as little as counts for nothing
    (2, 2): [(-3.0, 1), (-2.0, 1), (-1.0, 1), (1.0, -1), (2.0, -1), (3.0, -1)],  # up to three times
}


def crossings(parts=1, turned=1, order=None, apart=1):
    rows = [
        (row, column, part, along, turned * sign)
        for (row, column), ends in LINES.items()
        for part in range(parts)
        for along, sign in ends
    ]
    rows = [rows[k] for k in (range(len(rows)) if order is None else order)]
    row, column, triangle, along, sign = (np.array(values) for values in zip(*rows))
    return Crossings(
        np.zeros(len(rows), np.intp), row, column, triangle, along, sign, np.array([apart])
    )


@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("parts, apart", [(1, 1), (2, 1), (1, 3)])
@pytest.mark.parametrize("seed", [None, 0, 1])
def test_repeated_body_is_measured_part_by_part(turned, parts, apart, seed):
    grids = LineGrids.over_boxes(
        np.array([[-4.0, -2.0, -3.0]]), np.array([[4.0, 2.0, 3.0]]), np.array([64])
    )
    count = parts * sum(map(len, LINES.values()))
    order = None if seed is None else np.random.default_rng(seed).permutation(count)
    part = np.arange(parts) if parts > 1 else None
    found = measure_excess(crossings(parts, turned, order, apart), grids, np.array([0.0625]), part)
    area = float(np.prod(grids.cell[0])) * apart * parts
    assert close(found.volume[0], (2.5 + 1.5 + 1.0 + 2.0 * 2.0 + 1.0) * area, rel=1e-12)
    assert close(found.unsure[0], 1.0 / 6.0, rel=1e-12)
    second = 0.0
    for row, column, low, high, times in (
        (0, 1, -1.0, 1.5, 1),
        (1, 1, -1.0, 0.5, 1),
        (2, 2, -2.0, -1.0, 1),
        (2, 2, -1.0, 1.0, 2),
        (2, 2, 1.0, 2.0, 1),
    ):
        at = (
            np.zeros(1, np.intp),
            np.array([row]),
            np.array([column]),
            np.array([(low + high) / 2.0]),
        )
        second += times * (high - low) * area * grids.squared_distances(*at)[0]
    assert close(found.second_moment[0], second, rel=1e-12)


def test_lines_meeting_nothing_are_ignored():
    grids = LineGrids.over_boxes(np.zeros((2, 3)), np.ones((2, 3)), np.array([64, 64]))
    none = np.empty(0, np.intp)
    found = measure_excess(
        Crossings(none, none, none, none, np.empty(0), none, np.ones(2, np.intp)),
        grids,
        np.zeros(2),
    )
    assert (found.volume.tolist(), found.unsure.tolist()) == ([0.0, 0.0], [1.0, 1.0])
    assert found.second_moment.tolist() == [0.0, 0.0]
