# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare arrays are proved closed by pairing the sides of their faces, compared with a dictionary of
sides.
"""

from collections import defaultdict

import numpy as np
import pytest
from body_moments.core.mesh.edges import faces_across_sides

from tests.core import bodies

RNG = np.random.default_rng(7)


def bipyramid(sides):
    """Two vertices of so many faces that no hash has places for all their sides."""
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


def across_by_search(faces):
    """Return the faces across by a dictionary of sides, or None if an edge lacks two sides in
    opposite directions.
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
    return [
        [at[stop, start][0] for start, stop in zip(row, [*row[1:], row[0]])]
        for row in faces.tolist()
    ]


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
@pytest.mark.parametrize("name", PARTS)
def test_the_face_across_each_side_is_found(name, dtype):
    points, faces = shuffled(PARTS[name])
    for order in "CF":
        across = faces_across_sides(np.asarray(faces, dtype, order=order), len(points))
        assert across.tolist() == across_by_search(faces)


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
    assert across_by_search(faces) is None
    assert faces_across_sides(faces, len(points)) is None


def test_faces_at_random_are_judged_as_by_a_search():
    """Few vertices, so that sides meet by chance, in both directions, once and more often.

    A closed torus beside them makes the mesh large enough to be looked up in a table instead of
    being sorted.
    """
    beside = bodies.torus(40, 30)
    proved = 0
    for _ in range(80):
        count = int(RNG.integers(4, 7))
        points, faces = bodies.sphere(0) if RNG.random() < 0.5 else bodies.box()
        extra = RNG.integers(0, count, (2 * int(RNG.integers(0, 3)), 3))
        faces = RNG.permutation(np.concatenate([faces, extra])).astype(np.int32)
        joined = np.concatenate([faces, beside[1] + len(points)])
        for mesh, used in ((faces, len(points)), (joined, len(points) + len(beside[0]))):
            across, expected = faces_across_sides(mesh, used), across_by_search(mesh)
            assert (None if across is None else across.tolist()) == expected
        proved += expected is not None
    assert 10 < proved < 70
