# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare arrays are proved closed by sorting the sides of their faces, compared with a dictionary of
sides.
"""

from collections import defaultdict

import numpy as np
import pytest
from body_moments.core.mesh.edges import faces_beside_edges

from tests.core import bodies

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
