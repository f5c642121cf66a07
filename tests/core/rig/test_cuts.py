# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones' pieces are closed and add up to the whole; boxes give boxes, a chain of cylinders
cylinders.
"""

from collections import Counter

import numpy as np
import pytest
from body_moments.core.inertia import MassProperties
from body_moments.core.mesh import Surface
from body_moments.core.moments import monomials, sum_moments
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.rig.cuts import bone_pieces, dominant_bones

from tests.close import close
from tests.core import characters as made

CHARACTERS = made.characters()


def cut(character):
    faces, corners = character.corners
    bone, _ = dominant_bones(faces, corners, character.points, character.weights, character.bones)
    return bone_pieces(character.points, character.triangles, np.repeat(bone, 2))


def is_closed(surface):
    sides = Counter()
    for triangle in surface.triangles.tolist():
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            sides[min(a, b), max(a, b)] += 1 if a < b else -1
    return not any(sides.values())


def test_empty_mesh_has_no_pieces():
    assert bone_pieces(np.eye(3), np.zeros((0, 3), int), np.zeros(0, int)) == []


@pytest.mark.parametrize("name", CHARACTERS)
def test_pieces_are_closed_and_their_moments_add_up_to_the_whole(name):
    character = CHARACTERS[name]
    pieces = cut(character)
    assert len(pieces) == len(character.bones) and all(is_closed(piece.surface) for piece in pieces)
    assert sum(piece.face_count for piece in pieces) == len(character.triangles)
    whole, _ = polyhedron_moments(
        Surface.from_triangles(character.points, character.triangles), exact=True
    )
    total = sum_moments([piece.moments() for piece in pieces]).about_point(whole.about)
    degree = monomials(3).sum(axis=1)
    for n in range(4):
        largest = np.abs(whole.raw[degree == n]).max()
        assert np.abs(total.raw - whole.raw)[degree == n].max() <= 1e-12 * max(
            largest, whole.raw[0] * np.ptp(character.points) ** n
        )
    assert all(piece.moments().total > 0.0 for piece in pieces)


@pytest.mark.parametrize("name", CHARACTERS)
def test_faces_come_first_in_their_order(name):
    character = CHARACTERS[name]
    bone = np.random.default_rng(1).integers(0, 3, len(character.triangles))
    pieces = bone_pieces(character.points, character.triangles, bone)
    assert [piece.bone for piece in pieces] == [0, 1, 2]
    for piece in pieces:
        faces = piece.surface.points[piece.surface.triangles[: piece.face_count]]
        assert np.array_equal(faces, character.points[character.triangles[bone == piece.bone]])


@pytest.mark.parametrize("cells", [1, 3])
def test_a_skeleton_of_boxes_gives_each_bone_its_box(cells):
    pieces = cut(made.box_skeleton(cells))
    for piece, (low, high) in zip(pieces, made.BOXES):
        size, center = np.subtract(high, low).astype(float), np.add(high, low) / 2.0
        body = MassProperties.from_moments(piece.moments())
        volume = size.prod()
        assert close(body.mass, volume, 1e-12)
        assert np.abs(body.center - center).max() <= 1e-12 * size.max()
        tensor = np.diag((size @ size - size * size) * volume / 12.0)
        assert np.abs(body.inertia - tensor).max() <= 1e-12 * tensor.max()


@pytest.mark.parametrize(
    "turn", [np.eye(3), np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]]), np.diag([-1.0, 1, 1])]
)
def test_a_chain_of_cylinders_gives_each_bone_its_cylinder(turn):
    lengths, radius, sides = (1.0, 2.5, 0.75), 0.5, 24
    character = made.cylinder_chain(lengths, radius, sides).moved(turn, (10.0, 20.0, -5.0))
    angle = 2.0 * np.pi / sides
    area = sides / 2.0 * radius**2 * np.sin(angle)
    # the second moment of a regular polygon about its center
    polar = area * radius**2 * (2.0 + np.cos(angle)) / 6.0
    start = 0.0
    for piece, length in zip(cut(character), lengths, strict=True):
        assert is_closed(piece.surface)
        body = MassProperties.from_moments(piece.moments())
        center = turn @ [start + length / 2.0, 0.0, 0.0] + (10.0, 20.0, -5.0)
        assert (
            close(body.mass, area * length, 1e-12)
            and np.abs(body.center - center).max() <= 1e-12 * 20.0
        )
        across = polar * length / 2.0 + area * length * length**2 / 12.0
        tensor = turn @ np.diag([polar * length, across, across]) @ turn.T
        assert np.abs(body.inertia - tensor).max() <= 1e-12 * np.abs(tensor).max()
        start += length


def test_faces_without_weights_go_with_the_nearest_bone():
    character = made.humanoid(unweighted=range(10_000))
    faces, corners = character.corners
    assert len(character.weights.unweighted(len(character.points))) == len(character.points)
    bone, by_distance = dominant_bones(
        faces, corners, character.points, character.weights, character.bones
    )
    assert len(by_distance) == len(character.quads)
    centers = character.points[character.quads].mean(axis=1)
    hand = centers[:, 0] > 5.5
    assert hand.any() and (bone[hand] == made.NAMES.index("arm.L")).all()


def test_cut_is_closed_to_its_centroid_at_any_place():
    """Two cones that meet in a ring of many edges, far from the origin compared with their size."""
    count, shift = 1 << 14, np.array([2.0**30, -(2.0**31), 2.0**29])
    angle = 2.0 * np.pi / count * np.arange(count)
    ring = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    points = (
        np.round(np.concatenate([ring, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]]) * 2**20) / 2**20
        + shift
    )
    here = np.arange(count)
    after = (here + 1) % count
    upper, lower = (
        np.stack([here, after, 0 * here + count], axis=1),
        np.stack([after, here, 0 * here + count + 1], axis=1),
    )
    for piece in bone_pieces(points, np.concatenate([upper, lower]), np.repeat([0, 1], count)):
        assert (np.abs(piece.surface.points[-1] - shift) <= 4.0 * np.spacing(np.abs(shift))).all()


def test_piece_bounds_include_the_storage_of_points():
    points, triangles = made.box_skeleton().points, made.box_skeleton().triangles
    bone = np.arange(len(triangles)) % 2
    moved = np.array([1e-3, 2e-3, 5e-4])
    for exact, stored in zip(
        bone_pieces(points, triangles, bone),
        bone_pieces(points, triangles, bone, displacement=moved),
        strict=True,
    ):
        assert not exact.moments().input_error.any()
        same = Surface(exact.surface.points, exact.surface.triangles, displacement=moved)
        wanted = polyhedron_moments(same, exact=True)[0].input_error
        assert (wanted > 0.0).all() and close(stored.moments().input_error, wanted, 1e-9)


def test_a_cut_far_from_the_origin_is_as_exact_as_near():
    character = made.humanoid()
    faces, corners = character.corners
    bone, _ = dominant_bones(faces, corners, character.points, character.weights, character.bones)
    near = np.round(character.points * 2**20) / 2**20  # so that the shift is exact
    pieces = [
        bone_pieces(points, character.triangles, np.repeat(bone, 2))
        for points in (near, near + (4096, -8192, 2048))
    ]
    for first, second in zip(*pieces):
        a, b = (MassProperties.from_moments(piece.moments()) for piece in (first, second))
        assert (
            close(a.mass, b.mass, 1e-11)
            and np.abs(a.inertia - b.inertia).max() <= 1e-11 * np.abs(a.inertia).max()
        )
