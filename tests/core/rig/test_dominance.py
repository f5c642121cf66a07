# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces go with the bone that a loop in rational numbers finds for them."""

from collections import defaultdict
from fractions import Fraction

import numpy as np
from body_moments.core.rig.cuts import VertexWeights, bones_of_caps, dominant_bones
from hypothesis import given, strategies

from tests.close import close

SMALL = strategies.integers(-3, 3)
POINT = strategies.tuples(SMALL, SMALL, SMALL)


@strategies.composite
def skins(draw):
    points = draw(strategies.lists(POINT, min_size=4, max_size=9))
    bones = draw(strategies.lists(strategies.tuples(POINT, POINT), min_size=1, max_size=4))
    vertex = strategies.integers(0, len(points) - 1)
    faces = draw(strategies.lists(strategies.lists(vertex, max_size=5), min_size=1, max_size=6))
    pairs = strategies.tuples(vertex, strategies.integers(0, len(bones) - 1))
    weights = draw(
        strategies.dictionaries(
            pairs, strategies.sampled_from([0.0, 0.25, 0.5, 1.0, 3.0]), max_size=24
        )
    )
    return points, bones, faces, weights


def distance(point, bone):
    start, stop = np.array(bone, float)
    way = stop - start
    share = np.clip((point - start) @ way / (way @ way), 0.0, 1.0) if way.any() else 0.0
    return np.linalg.norm(point - start - share * way)


def nearest(face, points, bones, chosen):
    center = np.mean([points[vertex] for vertex in face], axis=0)
    away = [distance(center, bones[bone]) for bone in chosen]
    return next(bone for bone, one in zip(chosen, away) if one <= min(away) * (1.0 + 1e-9) + 1e-12)


def truth(points, bones, faces, weights):
    of_vertex = defaultdict(dict)
    for (vertex, bone), weight in weights.items():
        of_vertex[vertex][bone] = Fraction(weight)
    found, by_distance = [], []
    for number, face in enumerate(faces):
        score = defaultdict(Fraction)
        for vertex in face:
            total = sum(of_vertex[vertex].values())
            for bone, weight in of_vertex[vertex].items():
                score[bone] += weight / total if total else 0
        best = max(score.values(), default=0)
        leading = (
            sorted(bone for bone, one in score.items() if one == best)
            if best
            else range(len(bones))
        )
        found.append(nearest(face, points, bones, leading) if face else -1)
        by_distance += [number] if face and not best else []
    while found and not faces[len(found) - 1]:  # the arrays end with the last face that has corners
        found.pop()
    return found, by_distance


def found(points, bones, faces, weights):
    face = np.array([number for number, corners in enumerate(faces) for _ in corners], int)
    corner = np.array([vertex for corners in faces for vertex in corners], int)
    rows = sorted((*pair, weight) for pair, weight in weights.items())
    vertex, bone, weight = np.array(rows, float).reshape(-1, 3).T
    given = VertexWeights(vertex.astype(int), bone.astype(int), weight)
    bone, by_distance = dominant_bones(
        face, corner, np.array(points, float), given, np.array(bones, float)
    )
    return bone.tolist(), by_distance.tolist()


@given(skins())
def test_face_goes_to_the_heaviest_bone_or_else_the_nearest(skin):
    assert found(*skin) == truth(*skin)


def test_weights_tie_within_float32_precision():
    points, bones = (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
        [((0, 0, 9), (0, 0, 8)), ((0, 0, 1), (0, 0, 2))],
    )
    for more, bone in ((2e-6, 1), (5e-5, 0)):  # the first bone has more weight, the second is near
        weights = {(vertex, 0): 1.0 + more for vertex in range(3)} | {
            (vertex, 1): 1.0 for vertex in range(3)
        }
        assert found(points, bones, [[0, 1, 2]], weights) == ([bone], [])
        turned = {(vertex, 1 - one): weight for (vertex, one), weight in weights.items()}
        assert found(points, bones[::-1], [[0, 1, 2]], turned) == ([1 - bone], [])
    for off, bone in ((2e-6, 0), (5e-5, 1)):  # the second bone is nearer
        ends = [((0, 0, 1.0 + off), (0, 0, 3)), ((0, 0, -1), (0, 0, -2))]
        center = [(0, 0, 0)]
        assert found(center, ends, [[0]], {}) == ([bone], [0])


def test_weights_are_normalized_on_each_vertex():
    weights = VertexWeights(
        np.array([0, 0, 2, 3]), np.array([0, 1, 1, 0]), np.array([3.0, 1.0, 0.0, 0.1])
    )
    assert close(weights.normalized(), [0.75, 0.25, 0.0, 1.0], 1e-14)
    assert weights.unweighted(6).tolist() == [1, 2, 4, 5] and weights.unweighted(2).tolist() == [1]
    assert not len(VertexWeights(*np.zeros((2, 0), int), np.zeros(0)).normalized())


def test_caps_follow_adjacent_faces_or_else_the_heaviest_bone():
    strip = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [10, 11, 12], [13, 14, 15], [16, 17, 18]])
    caps = np.array([False, True, True, True, False, False])
    assert bones_of_caps(strip, caps, np.array([7, -1, -1, -1, 3, 3])).tolist() == [
        7,
        7,
        7,
        3,
        3,
        3,
    ]
    assert bones_of_caps(strip, np.ones(6, bool), np.full(6, 9)).tolist() == [0] * 6
    assert not len(bones_of_caps(np.zeros((0, 3), int), np.zeros(0, bool), np.zeros(0, int)))
