# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare arrays are proved closed by pairing the sides of their faces: what is not closed and consistent never is."""

from collections import defaultdict

import numpy as np
import pytest
from body_moments.core.mesh import side_pairs
from body_moments.core.mesh.side_pairs import faces_across_sides
from body_moments.core.mesh.surface import Surface
from body_moments.core.numerics.graph import connected_components, connected_neighbors
from body_moments.core.solid.measure import measure_solid
from body_moments.core.verdict.method import Verdict

from tests.core import bodies

RNG = np.random.default_rng(7)


def bipyramid(sides):
    """Two vertices of so many faces that no hash has places for all their sides."""
    ring = np.arange(sides)
    angle = 2.0 * np.pi * ring / sides
    points = np.concatenate([np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], 1), [[0, 0, 1], [0, 0, -1]]])
    following = (ring + 1) % sides
    top, bottom = np.full((2, sides), [[sides], [sides + 1]])
    return points, np.concatenate([np.stack([ring, following, top], 1), np.stack([following, ring, bottom], 1)])


PARTS = {
    "box": bodies.box(),
    "sphere": bodies.sphere(2),
    "torus": bodies.torus(),
    "two boxes": bodies.joined(bodies.box(), bodies.box((3, 0, 0), (4, 1, 1))),
    "bipyramid": bipyramid(700),
}


@pytest.fixture(params=["sorted", "in tables"], autouse=True)
def way(request, monkeypatch):
    """Small meshes are sorted; here they are also looked up, in blocks of a few faces."""
    if request.param == "in tables":
        monkeypatch.setattr(side_pairs, "MAX_SORTED_SIDES", 0)
        monkeypatch.setattr(side_pairs, "FACES_PER_BLOCK", 7)


def shuffled(part):
    points, faces = part
    order = RNG.permutation(len(points))
    return points[order], RNG.permutation(np.argsort(order)[faces])


def across_by_search(faces):
    """The faces across, by a dictionary of sides; None where an edge has not two sides in opposite directions."""
    at = defaultdict(list)
    for face, corners in enumerate(faces.tolist()):
        for start, stop in zip(corners, [*corners[1:], corners[0]]):
            at[start, stop].append(face)
    if any(len(found) > 1 or start == stop or (stop, start) not in at for (start, stop), found in at.items()):
        return None
    return [[at[stop, start][0] for start, stop in zip(row, [*row[1:], row[0]])] for row in faces.tolist()]


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
@pytest.mark.parametrize("name", PARTS)
def test_the_face_across_each_side_is_found(name, dtype):
    points, faces = shuffled(PARTS[name])
    for order in "CF":
        across = faces_across_sides(np.asarray(faces, dtype, order=order), len(points))
        assert across.tolist() == across_by_search(faces)


def test_quads_have_four_sides():
    assert faces_across_sides(bodies.SIDES, 8).tolist() == across_by_search(bodies.SIDES)


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
def test_what_is_not_closed_once_and_consistently_is_not_proved(name, damage):
    points, faces = damage(PARTS[name])
    assert across_by_search(faces) is None
    assert faces_across_sides(faces, len(points)) is None


def test_faces_at_random_are_judged_as_by_a_search():
    """Few vertices, so that sides meet by chance, in both directions, once and more often."""
    proved = 0
    for _ in range(300):
        count = int(RNG.integers(4, 7))
        points, faces = bodies.sphere(0) if RNG.random() < 0.5 else bodies.box()
        extra = RNG.integers(0, count, (2 * int(RNG.integers(0, 3)), 3))
        faces = RNG.permutation(np.concatenate([faces, extra])).astype(np.int32)
        across, expected = faces_across_sides(faces, len(points)), across_by_search(faces)
        assert (None if across is None else across.tolist()) == expected
        proved += expected is not None
    assert 50 < proved < 250


def test_components_are_those_of_the_links():
    for parts in ([bodies.torus()], [bodies.torus(), bodies.sphere(2), bodies.box()]):
        points, faces = shuffled(bodies.joined(*parts))
        across = faces_across_sides(faces, len(points))
        component, count = connected_neighbors(across)
        rows = np.repeat(np.arange(len(faces)), 3)
        expected, number = connected_components(len(faces), rows, across.ravel())
        assert count == number == len(parts)
        assert component.tolist() == expected.tolist()


def test_bare_arrays_are_judged_as_meshes_are():
    for part in (bodies.sphere(2), bodies.joined(bodies.box(), bodies.box((0.2, 0.2, 0.2), (0.8, 0.8, 0.8)))):
        solid = measure_solid(Surface(*shuffled(part)))
        assert solid.method is Verdict.EXACT and solid.health.closed and not solid.health.welded
    solid = measure_solid(Surface(*shuffled(bodies.inverted(bodies.torus()))))
    assert solid.method is Verdict.REORIENTED and solid.health.inverted_components == 1


def test_triangles_and_quads_without_numbers_are_not_proved_by_one_kind_of_them():
    """Else a finely cut ball would do for the box of quads beside it."""
    ball, quads = bodies.sphere(2), bodies.SIDES + len(bodies.sphere(2)[0])
    solid = measure_solid(Surface(np.concatenate([ball[0], bodies.CORNERS + 5.0]), ball[1], quads))
    alone = measure_solid(Surface(*ball))
    assert solid.health.components == 2 and solid.method is Verdict.EXACT
    assert abs(solid.volume.total - alone.volume.total - 1.0) < 1e-12
