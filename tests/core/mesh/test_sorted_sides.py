# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare arrays are proved closed by sorting their edges: what is not closed and consistent never is."""

import numpy as np
import pytest
from body_moments.core.mesh.edges import sorted_side_faces
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid.measure_solid import measure_solid
from body_moments.core.verdict.method import Verdict

from tests.core import bodies

RNG = np.random.default_rng(7)
PARTS = bodies.box(), bodies.sphere(2), bodies.torus(), bodies.joined(bodies.box(), bodies.box((3, 0, 0), (4, 1, 1)))


def shuffled(part):
    points, faces = part
    order = RNG.permutation(len(points))
    return points[order], RNG.permutation(np.argsort(order)[faces])


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
@pytest.mark.parametrize(
    "part",
    [bodies.box(), bodies.sphere(2), bodies.torus(), bodies.joined(bodies.box(), bodies.box((3, 0, 0), (4, 1, 1)))],
)
def test_the_two_sides_of_each_edge_are_found(part, dtype):
    points, faces = shuffled(part)
    sides = sorted_side_faces(Surface(points, faces.astype(dtype)))
    assert sides.shape == (2, len(faces) * 3 // 2)
    for one, other in sides.T:
        assert len(set(faces[one]) & set(faces[other])) == 2
    assert (np.bincount(sides.ravel()) == 3).all()


def test_quads_have_four_sides():
    sides = sorted_side_faces(Surface(bodies.CORNERS, quads=bodies.SIDES))
    assert (np.bincount(sides.ravel()) == 4).all()


@pytest.mark.parametrize(
    "damage",
    [
        lambda part: bodies.without(part, 3),
        lambda part: bodies.without(part, 3, 8),
        lambda part: bodies.with_flipped(part, 3),
        lambda part: bodies.soup(part),
        lambda part: (part[0], np.concatenate([part[1], part[1][:2], part[1][:2, ::-1]])),
        lambda part: (part[0], np.concatenate([part[1], [[0, 0, 1], [0, 1, 1]]])),
    ],
)
def test_what_is_not_closed_once_and_consistently_is_not_proved(damage):
    points, faces = damage(bodies.sphere(1))
    assert sorted_side_faces(Surface(points, faces)) is None


def test_bare_arrays_are_judged_as_meshes_are():
    for part in (bodies.sphere(2), bodies.joined(bodies.box(), bodies.box((0.2, 0.2, 0.2), (0.8, 0.8, 0.8)))):
        solid = measure_solid(Surface(*shuffled(part)))
        assert solid.method is Verdict.EXACT and solid.health.closed and not solid.health.welded
    solid = measure_solid(Surface(*shuffled(bodies.inverted(bodies.torus()))))
    assert solid.method is Verdict.REORIENTED and solid.health.inverted_components == 1
