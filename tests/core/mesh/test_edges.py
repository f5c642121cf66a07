# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges, the proof of closedness, connected parts and orientation, against plain Python."""

from collections import defaultdict

import numpy as np
import pytest
from body_moments.core.mesh import (
    BoundarySum,
    Surface,
    closed_side_faces,
    consistent_orientation,
    faces_beside_edges,
    find_edges,
    first_at_equal_position,
    first_at_near_position,
    group_components,
    same_vertices_groups,
    vertex_tolerance,
)
from body_moments.core.numerics import connected_components, first_occurrence
from body_moments.core.solid.measure import measure_solid
from hypothesis import given

from tests.close import close
from tests.core import bodies
from tests.core.bodies import (
    CORNERS,
    SIDES,
    box,
    grid,
    inverted,
    joined,
    mesh,
    moebius,
    ring,
    rotation,
    soup,
    sphere,
    torus,
    welded,
    with_flipped,
    without,
)
from tests.core.strategies import holds, seeds


def star(center, leaves):
    return np.full(len(leaves), center), leaves


def test_hub_after_its_leaves_costs_no_more_time():
    """If each round joined one more leaf, this would take hours."""
    leaves = np.arange(1_000_000)
    label, number = connected_components(len(leaves) + 1, *star(len(leaves), leaves))
    assert number == 1 and not label.any()


@pytest.mark.parametrize("copies", [2, 1100, 20_000])
def test_copies_of_one_face_are_one_component(copies):
    found = measure_solid(Surface(CORNERS, quads=np.repeat(SIDES[:1], copies, axis=0)), shell=True)
    assert found.health.components == 1


def test_first_occurrence_of_rows_matches_a_dictionary():
    rng = np.random.default_rng(2)
    for high in (1, 3, 1000):
        rows = rng.integers(0, high, size=(2, 2000))
        seen, expected = {}, []
        for k, row in enumerate(rows.T):
            expected.append(seen.setdefault(tuple(row), k))
        np.testing.assert_array_equal(first_occurrence(*rows), expected)
    assert len(first_occurrence(rows[0, :0])) == 0


def test_edges_match_a_dictionary():
    triangles = joined(sphere(2), box())[1]
    edges = find_edges(triangles)
    found = {}
    for t, triangle in enumerate(triangles):
        for i in range(3):
            a, b = triangle[i], triangle[(i + 1) % 3]
            found.setdefault((min(a, b), max(a, b)), []).append(3 * t + i)
    assert len(edges.count) == len(found)
    for sides in found.values():
        edge = edges.of_side[sides[0]]
        assert edges.first[edge] == sides[0] and edges.count[edge] == len(sides)
        assert all(edges.of_side[side] == edge for side in sides)
    assert not edges.signed_use_count(np.zeros(len(triangles), bool)).any()
    one, other = edges.manifold_side_pairs()
    assert sorted(map(tuple, np.stack([one, other], axis=1))) == sorted(map(tuple, found.values()))


def mixed_mesh():
    """A cube: its top a fan of four triangles, its bottom and front pentagons with a common bent
    edge.
    """
    points = np.concatenate([CORNERS, [[0.5, 0.5, 1.0], [0.5, 0.0, 0.0]]])
    faces = [
        [0, 2, 3, 1, 9],
        [2, 6, 7, 3],
        [0, 9, 1, 5, 4],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [4, 5, 8],
        [5, 7, 8],
        [7, 6, 8],
        [6, 4, 8],
    ]
    return points, faces


def pyramid(sides):
    """Over a polygon, and the triangles around it."""
    angle = 2.0 * np.pi / sides * np.arange(sides)
    rim = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    around = [[k, (k + 1) % sides, sides] for k in range(sides)]
    return np.concatenate([rim, [[0.0, 0.0, 1.0]]]), [
        *around[:2],
        list(range(sides))[::-1],
        *around[2:],
    ]


@pytest.mark.parametrize(
    "points, faces",
    [
        (CORNERS, SIDES.tolist()),
        mixed_mesh(),
        pyramid(5),
        pyramid(7),
        (ring(20, 10)[0], ring(20, 10)[1].tolist()),
        (sphere(2)[0], sphere(2)[1].tolist()),
    ],
)
def test_a_closed_mesh_is_proven_closed_by_its_own_corners(points, faces):
    surface = mesh(points, faces)
    sides = closed_side_faces(surface)
    edges = dict.fromkeys(
        tuple(sorted((face[i - 1], face[i]))) for face in faces for i in (*range(1, len(face)), 0)
    )
    # in the order in which the faces come to them, as in the mesh
    assert sides.shape == (
        2,
        len(edges),
    )
    for edge, pair in zip(edges, sides.T):
        expected = {
            k
            for k, face in enumerate(faces)
            for i in range(len(face))
            if {face[i], face[i - 1]} == set(edge)
        }
        assert set(pair) == expected


def test_hole_or_flipped_face_or_copy_spoils_the_proof():
    points, faces = mixed_mesh()
    for k in range(len(faces)):
        assert closed_side_faces(mesh(points, faces[:k] + faces[k + 1 :])) is None
        assert (
            closed_side_faces(mesh(points, faces[:k] + [faces[k][::-1]] + faces[k + 1 :])) is None
        )
        assert closed_side_faces(mesh(points, faces + [faces[k]])) is None


@holds(10)
@given(seed=seeds)
def test_orientation_turns_flipped_faces(seed):
    rng = np.random.default_rng(seed)
    triangles = sphere(3)[1]
    flipped = rng.random(len(triangles)) < rng.uniform(0.0, 0.45)
    triangles = np.where(flipped[:, None], triangles[:, ::-1], triangles)
    edges = find_edges(triangles)
    one, other = edges.manifold_side_pairs()
    against = edges.upward[one] == edges.upward[other]
    turned, twisted = consistent_orientation(
        len(triangles), one // 3, other // 3, against, np.ones(len(triangles))
    )
    np.testing.assert_array_equal(turned, flipped)
    assert not twisted.any()


def test_moebius_strip_and_klein_bottle_have_no_orientation():
    points, quads = ring(30, 12, twist=True)
    klein = points, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    tube = ring(20, 10)[0], ring(20, 10)[1][:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    for strip in (moebius(), klein):
        triangles = joined(strip, tube)[1]
        edges = find_edges(triangles)
        one, other = edges.manifold_side_pairs()
        against = edges.upward[one] == edges.upward[other]
        assert against.any()
        turned, twisted = consistent_orientation(
            len(triangles), one // 3, other // 3, against, np.ones(len(triangles))
        )
        assert twisted[: len(strip[1])].all() and not twisted[len(strip[1]) :].any()
        assert not turned.any()


def parts_of(triangles):
    edges = find_edges(triangles)
    one, other = edges.manifold_side_pairs()
    return edges, *connected_components(len(triangles), one // 3, other // 3)


def test_boxes_sharing_an_edge_are_two_shells():
    edge = welded(joined(box(), box((1, 1, 0), (2, 2, 1))))[1]
    edges, part, number = parts_of(edge)
    shell, shell_number = group_components(edges, part, number, np.zeros(len(edges.count), bool))
    assert shell_number == 2
    wall = welded(joined(box(), box((1, 0, 0), (2, 1, 1))))[1]
    wall = wall[np.unique(np.sort(wall, axis=1), axis=0, return_index=True)[1]]
    edges, part, number = parts_of(wall)
    assert number == 3
    shell, shell_number = group_components(edges, part, number, np.zeros(len(edges.count), bool))
    assert shell_number == 1


@pytest.mark.parametrize("first", range(3))
def test_closed_box_is_a_shell_of_its_own_beside_joined_ones(first):
    """It shares an edge with one of them, and so do the wall and what is around it."""
    three = [box(), box((1, 0, 0), (2, 1, 1)), box((-1, -1, 0), (0, 0, 1))]
    corners, triangles = welded(joined(*three[first:], *three[:first]))
    triangles = triangles[
        np.sort(np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1])
    ]
    edges, part, number = parts_of(triangles)
    shell, count = group_components(edges, part, number, np.zeros(len(edges.count), bool))
    alone = (corners[triangles].mean(axis=1) < 0.0).any(axis=1)
    assert (number, count, alone.sum()) == (4, 2, 12)
    assert len(set(shell[alone])) == len(set(shell[~alone])) == 1


@pytest.mark.parametrize("sides", range(1, 8))
def test_parts_meeting_in_an_edge_are_joined_by_odd_sides(sides):
    """Pages around a spine, closed by something else everywhere but there."""
    triangles = np.array([[0, 1, 2 + k] for k in range(1 + sides + 2)])
    part = np.repeat([0, 1, 2], [1, sides, 2])
    edges = find_edges(triangles)
    shell, number = group_components(edges, part, 3, edges.count == 1)
    assert (number, len(set(shell[: 1 + sides])), len(set(shell[-3 + 1 :]))) == (
        (2, 1, 1) if sides % 2 else (3, 2, 1)
    )


def test_equal_positions_are_welded_and_minus_zero_is_zero():
    points = soup(sphere(2))[0]
    points[points == 0.0] *= np.where(np.arange(np.count_nonzero(points == 0.0)) % 2, 1.0, -1.0)
    first = first_at_equal_position(points)
    assert len(np.unique(first)) == 66
    np.testing.assert_array_equal(points[first], points)
    assert np.all(first <= np.arange(len(points)))


def test_positions_within_the_tolerance_are_welded_at_any_place():
    rng = np.random.default_rng(3)
    base = rng.uniform(-1, 1, size=(400, 3))
    step = rng.normal(size=base.shape)
    step *= 0.99e-6 / np.linalg.norm(step, axis=1)[:, None]
    points = np.concatenate([base, base + step])
    first = first_at_near_position(points, np.full(800, 1e-6))
    np.testing.assert_array_equal(first, np.tile(np.arange(400), 2))
    apart = np.concatenate([base, base + 10 * step])
    np.testing.assert_array_equal(first_at_near_position(apart, np.full(800, 1e-6)), np.arange(800))


def test_faces_on_the_same_vertices_share_a_group():
    triangles = np.array(
        [
            [0, 1, 2],
            [0, 2, 3],  # face 0, a quad
            [3, 1, 0],
            [3, 2, 1],  # face 1, the same reversed and cut the other way
            [0, 1, 2],
            [2, 0, 1],
            [2, 3, 4],
        ]
    )
    faces = np.array([0, 0, 1, 1, 2, 3, 4])
    np.testing.assert_array_equal(same_vertices_groups(triangles, faces), [0, 0, 0, 0, 2, 2, 4])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_move_a_thousandth_of_a_triangle_at_most(dtype):
    """Each triangle is as large as its longest side: 5, 13.3 and 0.5."""
    points = np.array(
        [[0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 5, 12], [0, 4, 0.5], [0.25, 4, 0.25], [9, 9, 9]],
        dtype,
    )
    triangles = np.array([[0, 1, 2], [0, 3, 1], [2, 5, 4]])
    found = vertex_tolerance(points, triangles, np.array([6, 3, 0, 4, 2, 1]), 0.01)
    sides = [np.sqrt(178.0), 5.0, 0.5, 0.5, 5.0]
    assert close(found, [0.01, *np.minimum(0.01, 1e-3 * np.array(sides))], 1e-7)
    assert close(
        vertex_tolerance(points, triangles, np.array([3, 1]), 1.0), [1e-3 * 178.0**0.5, 5e-3], 1e-7
    )


RNG = np.random.default_rng(7)


def bipyramid(sides):
    """Two vertices of many faces."""
    ring = np.arange(sides)
    angle = 2.0 * np.pi * ring / sides
    points = np.concatenate(
        [np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], 1), [[0, 0, 1], [0, 0, -1]]]
    )
    following = (ring + 1) % sides
    top, bottom = np.full((2, sides), [[sides], [sides + 1]])
    return points, np.concatenate(
        [np.stack([ring, following, top], 1), np.stack([following, ring, bottom], 1)]
    )


PARTS = {
    "box": bodies.box(),
    "sphere": bodies.sphere(2),
    "torus": bodies.torus(),
    "large torus": bodies.torus(130, 70),
    "two boxes": bodies.joined(bodies.box(), bodies.box((3, 0, 0), (4, 1, 1))),
    "bipyramid": bipyramid(700),
}


def shuffled(part):
    points, faces = part
    order = RNG.permutation(len(points))
    return points[order], RNG.permutation(np.argsort(order)[faces])


def pairs_by_search(faces):
    """Return the pairs of faces beside the edges by a dictionary of sides, or None if an edge lacks
    two sides in opposite directions.
    """
    at = defaultdict(list)
    for face, corners in enumerate(faces.tolist()):
        for start, stop in zip(corners, [*corners[1:], corners[0]]):
            at[start, stop].append(face)
    if any(
        len(found) > 1 or start == stop or (stop, start) not in at
        for (start, stop), found in at.items()
    ):
        return None
    return sorted(
        sorted((face, *at[stop, start])) for (start, stop), (face,) in at.items() if start < stop
    )


def found_pairs(faces, count):
    beside = faces_beside_edges(faces, count)
    return None if beside is None else sorted(map(sorted, beside.T.tolist()))


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
@pytest.mark.parametrize("name", PARTS)
def test_faces_beside_each_edge_are_found(name, dtype):
    points, faces = shuffled(PARTS[name])
    for order in "CF":
        given = np.asarray(faces, dtype, order=order)
        assert found_pairs(given, len(points)) == pairs_by_search(faces)


def test_faces_beside_edges_of_millions_of_sides_are_found():
    """Keys of two ends have no room for the number of a side."""
    count = 1025
    i, j = np.divmod(np.arange(count * count, dtype=np.int32), count)
    after = (i + 1) % count * count, (j + 1) % count
    faces = np.stack([i * count + j, after[0] + j, sum(after), i * count + after[1]], axis=1)
    beside = faces_beside_edges(faces, len(faces))
    steps = np.abs(beside[0] - beside[1])
    assert np.isin(steps, [1, count - 1, count, count * (count - 1)]).all()
    assert (np.bincount(beside.ravel()) == 4).all()


@pytest.mark.parametrize(
    "damage",
    [
        lambda part: bodies.without(part, 3),
        lambda part: bodies.without(part, 3, 8),
        lambda part: bodies.with_flipped(part, 3),
        lambda part: bodies.soup(part),
        lambda part: (part[0], np.concatenate([part[1], part[1][:2], part[1][:2, ::-1]])),
        lambda part: (part[0], np.concatenate([part[1], part[1]])),
        lambda part: (part[0], np.concatenate([part[1], [[0, 0, 1], [0, 1, 1]]])),
        lambda part: (part[0], np.concatenate([part[1], [[0, 0, 0], [1, 1, 1]]])),
    ],
)
@pytest.mark.parametrize("name", PARTS)
def test_open_or_inconsistent_mesh_is_not_proved_closed(name, damage):
    points, faces = damage(PARTS[name])
    assert pairs_by_search(faces) is None
    assert faces_beside_edges(faces, len(points)) is None


def test_faces_at_random_are_judged_as_by_a_search():
    """Few vertices, so that sides meet by chance, in both directions, once and more often."""
    proved = 0
    for _ in range(80):
        count = int(RNG.integers(4, 7))
        points, faces = bodies.sphere(0) if RNG.random() < 0.5 else bodies.box()
        extra = RNG.integers(0, count, (2 * int(RNG.integers(0, 3)), 3))
        faces = RNG.permutation(np.concatenate([faces, extra])).astype(np.int32)
        expected = pairs_by_search(faces)
        assert found_pairs(faces, len(points)) == expected
        proved += expected is not None
    assert 10 < proved < 70


def closes(*surfaces):
    total = BoundarySum()
    for surface in surfaces:
        total.add(surface)
    return total.is_zero


CLOSED_PARTS = [
    (box(), True),
    (sphere(3), True),
    (torus(), True),
    (inverted(torus()), True),
    (joined(box(), box((1, 0, 0), (2, 1, 1))), True),
    (welded(joined(box(), box((1, 1, 0), (2, 2, 1)))), True),
    (without(box(), 0), False),
    (without(box(), 0, 1, 2, 3), False),  # two holes whose sides would cancel as vectors
    (with_flipped(box(), 4), False),
    (grid(5), False),
    (moebius(), False),
    ((box()[0], np.concatenate([box()[1], box()[1][:1]])), False),
]


@pytest.mark.parametrize("part, closed", CLOSED_PARTS)
@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_closedness_needs_each_edge_equally_often_both_ways(part, closed, scale):
    points, triangles = part
    assert closed == (
        not find_edges(welded(part)[1]).signed_use_count(np.zeros(len(triangles), bool)).any()
    )
    points = (points @ rotation(1).T + 0.1) * scale
    assert closes(Surface(points, triangles)) == closed
    apart = Surface(*soup((points, triangles)))
    assert closes(apart) == closed  # corners at the same place are one
    halves = [Surface(points, triangles[k::2]) for k in range(2)]
    assert closes(*halves) == closed
    rolled = Surface(points, np.roll(triangles[::-1], 1, axis=1))
    assert closes(rolled) == closed


def test_quads_close_with_triangles_and_without():
    points, quads = ring(12, 8)
    assert closes(Surface(points, quads=quads)) and not closes(Surface(points, quads=quads[1:]))
    assert closes(Surface(points, quads[:1, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), quads[1:]))


def test_minus_zero_closes_and_float32_keeps_its_value():
    points, triangles = box((-1, 0, 0), (0, 1, 1))
    apart = soup((points, triangles))
    apart[0][::2] = np.where(apart[0][::2] == 0.0, -0.0, apart[0][::2])
    assert closes(Surface(*apart))
    rounded = (points + 0.1).astype(np.float32)
    mixed = Surface(rounded, triangles[:5]), Surface(rounded.astype(float), triangles[5:])
    assert closes(*mixed)
    assert not closes(mixed[0], Surface(points + 0.1, triangles[5:]))
