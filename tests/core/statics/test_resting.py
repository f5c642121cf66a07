# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Resting poses against known answers: dice, boxes, cylinders, cones, L prisms; wherever and
however large they are.
"""

from itertools import product
from math import acos, atan, cos, hypot, pi, sin, sqrt, tan

import numpy as np
import pytest
from body_moments.core.mesh import convex_hull
from body_moments.core.statics import resting_poses
from body_moments.core.verdict import MeasureError

from tests.close import close
from tests.core.findings import refused

EXACT = 1e-12
PLACES = [
    (np.eye(3), np.zeros(3)),
    (np.diag([1e-9, 1e-9, 1e-9]), np.zeros(3)),
    (1e6 * np.linalg.qr(np.random.default_rng(5).standard_normal((3, 3)))[0], np.zeros(3)),
    (np.diag([-1.0, 1.0, 1.0]), np.array([4.0, 7.0, -2.0])),
]


def box(a, b, c):
    return np.array(list(product((0.0, a), (0.0, b), (0.0, c))))


def prism(outline, height):
    outline = np.asarray(outline, float)
    return np.concatenate(
        [np.column_stack([outline, np.full(len(outline), z)]) for z in (0.0, height)]
    )


def ring(count, radius):
    angles = 2.0 * pi / count * np.arange(count)
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


UPRIGHT, ORIGIN = np.eye(3), np.zeros(3)


def poses_of(points, center, matrix=UPRIGHT, offset=ORIGIN):
    """Poses in the body's own unit and axes, at any place."""
    size = abs(np.linalg.det(matrix)) ** (1.0 / 3.0)
    poses = resting_poses(convex_hull(points @ matrix.T + offset), matrix @ center + offset)
    return poses.normals @ matrix / size, poses.shares, poses.margins / size, poses.heights / size


def facing(normals, direction):
    """Return the pose that rests on the face to this direction."""
    along = normals @ (np.asarray(direction, float) / np.linalg.norm(direction))
    place = int(along.argmax())
    assert abs(along[place] - 1.0) < 1e-9
    return place


def rectangle_share(corners):
    """The share of the sphere that a polygon covers, by the sum of its angles (Girard)."""
    corners = np.asarray(corners, float)
    planes = np.cross(corners, np.roll(corners, -1, axis=0))
    planes /= np.linalg.norm(planes, axis=1, keepdims=True)
    angles = [
        pi - acos(np.clip(before @ after, -1.0, 1.0))
        for before, after in zip(np.roll(planes, 1, axis=0), planes)
    ]
    return (sum(angles) - (len(corners) - 2) * pi) / (4.0 * pi)


def test_a_die_tips_at_45_degrees():
    poses = resting_poses(convex_hull(box(2, 2, 2)), np.ones(3))
    assert close(poses.tipping_angles, pi / 4.0, EXACT)


@pytest.mark.parametrize("matrix, offset", PLACES)
def test_a_box_rests_on_each_face_by_its_solid_angle(matrix, offset):
    a, b, c = 1.0, 2.0, 5.0
    normals, shares, margins, _ = poses_of(box(a, b, c), np.array([a, b, c]) / 2.0, matrix, offset)
    for axis, (height, u, v) in enumerate(((a, b, c), (b, c, a), (c, a, b))):
        truth = atan(u * v / (height * sqrt(a * a + b * b + c * c))) / pi
        for sign in (1.0, -1.0):
            place = facing(normals, sign * np.eye(3)[axis])
            assert close(shares[place], truth, 1e-11)
            assert close(margins[place], min(u, v) / 2.0, 1e-11)
    assert close(shares.sum(), 1.0, EXACT)


@pytest.mark.parametrize("count", [3, 6, 64])
def test_a_cylinder_rests_on_its_ends_and_its_sides(count):
    radius, height = 1.0, 1.5
    normals, shares, margins, _ = poses_of(
        prism(ring(count, radius), height), np.array([0.0, 0.0, height / 2.0])
    )
    end = (
        2.0 * pi - 2.0 * count * atan(tan(pi / count) / sqrt(1.0 + (2.0 * radius / height) ** 2))
    ) / (4.0 * pi)
    assert len(shares) == count + 2
    for sign in (1.0, -1.0):
        place = facing(normals, (0.0, 0.0, sign))
        assert close(shares[place], end, 1e-11)
        assert close(margins[place], radius * cos(pi / count), EXACT)
    sides = np.abs(normals[:, 2]) < 0.5
    assert close(shares[sides], (1.0 - 2.0 * end) / count, 1e-10)
    assert close(margins[sides], min(radius * sin(pi / count), height / 2.0), 1e-11)


def test_a_cone_rests_on_its_base_and_its_sides():
    count, radius, height = 32, 1.0, 2.0
    points = np.concatenate(
        [np.column_stack([ring(count, radius), np.zeros(count)]), [[0.0, 0.0, height]]]
    )
    normals, shares, margins, heights = poses_of(points, np.array([0.0, 0.0, height / 4.0]))
    base = (
        2.0 * pi - 2.0 * count * atan(tan(pi / count) / sqrt(1.0 + (4.0 * radius / height) ** 2))
    ) / (4.0 * pi)
    place = facing(normals, (0.0, 0.0, -1.0))
    assert close(shares[place], base, 1e-11)
    assert close(margins[place], radius * cos(pi / count), EXACT)
    inner, half = radius * cos(pi / count), radius * sin(pi / count)
    slope = hypot(inner, height)
    above_base = (inner**2 + height**2 / 4.0) / slope
    beside = half * (1.0 - above_base / slope) * slope / hypot(half, slope)
    sides = np.arange(len(shares)) != place
    assert np.count_nonzero(sides) == count
    assert close(shares[sides], (1.0 - base) / count, 1e-10)
    assert close(margins[sides], min(above_base, beside), 1e-10)
    assert close(heights[sides], 0.75 * height * inner / slope, EXACT)


@pytest.mark.parametrize("matrix, offset", PLACES)
def test_l_prism_tips_from_its_leg_ends_onto_the_slope(matrix, offset):
    outline = [(0, 0), (6, 0), (6, 0.5), (0.5, 0.5), (0.5, 4), (0, 4)]
    area, width = 3.0 + 1.75, 2.0
    x, y = (3.0 * 3.0 + 1.75 * 0.25) / area, (3.0 * 0.25 + 1.75 * 2.25) / area
    normals, shares, margins, _ = poses_of(
        prism(outline, width), np.array([x, y, width / 2.0]), matrix, offset
    )

    def side(first, last):
        (x0, y0), (x1, y1) = first, last
        corners = [(x0, y0, 0.0), (x1, y1, 0.0), (x1, y1, width), (x0, y0, width)]
        return rectangle_share(np.array(corners) - (x, y, width / 2.0))

    assert len(shares) == 5
    slope = np.array([-5.5, 3.5])
    truth = {
        (0, -1, 0): (side((0, 0), (6, 0)), min(x, width / 2.0)),
        (-1, 0, 0): (side((0, 4), (0, 0)), min(y, width / 2.0)),
        (3.5, 5.5, 0): (
            side((6, 0), (6, 0.5)) + side((6, 0.5), (0.5, 4)) + side((0.5, 4), (0, 4)),
            min(
                abs((np.array([x, y]) - end) @ slope) / hypot(*slope)
                for end in ((6, 0.5), (0.5, 4))
            ),
        ),
    }
    for direction, (share, margin) in truth.items():
        place = facing(normals, direction)
        assert close(shares[place], share, 1e-9)
        assert close(margins[place], min(margin, width / 2.0), 1e-9 if offset.any() else 1e-11)
    assert close(shares.sum(), 1.0, EXACT)


def test_a_plate_without_thickness_rests_on_both_sides():
    normals, shares, margins, heights = poses_of(
        np.column_stack([ring(7, 2.0), np.zeros(7)]), np.array([0.1, 0.0, 0.0])
    )
    assert close(np.abs(normals[:, 2]), 1.0, EXACT)
    assert shares.tolist() == [0.5, 0.5]
    assert np.abs(heights).max() < 1e-14
    assert 1.6 < margins.min() < 2.0 * cos(pi / 7.0)


def test_flat_faces_of_many_triangles_are_one():
    grid = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, 12)] * 3), axis=-1).reshape(-1, 3)
    turn = np.linalg.qr(np.random.default_rng(9).standard_normal((3, 3)))[0]
    for points, exact in (
        (grid, EXACT),
        (grid @ turn.T, 1e-8),
        ((grid @ turn.T).astype(np.float32), 1e-5),
    ):
        hull = convex_hull(points, tolerance=1e-6 if points.dtype == np.float32 else 1e-8)
        poses = resting_poses(hull, points.astype(float).mean(axis=0))
        assert len(poses.shares) == 6
        assert close(poses.shares, 1.0 / 6.0, exact)
        assert close(poses.margins, 0.5, exact)


def test_a_center_outside_the_hull_is_refused():
    with pytest.raises(MeasureError) as refusal:
        resting_poses(convex_hull(box(1, 1, 1)), [2.0, 0.5, 0.5])
    assert refusal.value.finding.code == "center_outside_hull"


def test_a_square_plate_rests_on_both_sides_equally():
    """Its center is on a diagonal, so that triangles have no certain solid angle."""
    plate = np.array([(x, y, 0.0) for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    poses = resting_poses(convex_hull(plate), np.zeros(3))
    assert poses.shares.tolist() == [0.5, 0.5] and poses.margins.tolist() == [1.0, 1.0]
    with pytest.raises(MeasureError) as refusal:
        resting_poses(convex_hull(plate), [1.5, 0.0, 0.0])
    assert refusal.value.finding.code == "center_outside_hull"


def test_a_center_above_an_edge_is_not_stable():
    """A cube with its center of mass in its top face: from the sides it tips onto that."""
    normals, shares, margins, _ = poses_of(box(1, 1, 1), np.array([0.5, 0.5, 1.0]))
    assert len(shares) == 2
    bottom = atan(1.0 / (2.0 * sqrt(1.0 + 1.0 + 4.0))) / pi
    place = facing(normals, (0, 0, -1))
    assert close(shares[place], bottom, 1e-11) and close(shares[1 - place], 1.0 - bottom, 1e-11)


def test_a_round_side_is_no_face():
    """A dome on a base: its facets are smaller than the tolerance, and together they are not
    flat.
    """
    angles, heights = np.meshgrid(2.0 * pi / 160 * np.arange(160), np.linspace(0.0, 1.0, 60)[:-1])
    radius = np.sqrt(1.0 - heights**2)
    dome = np.stack([radius * np.cos(angles), radius * np.sin(angles), heights], axis=-1).reshape(
        -1, 3
    )
    poses = resting_poses(
        convex_hull(np.concatenate([dome, [[0.0, 0.0, 1.0]]])), [0.0, 0.0, 0.375], tolerance=0.02
    )
    assert facing(poses.normals, (0, 0, -1)) == 0
    assert len(poses.shares) == 1


def test_noise_on_edges_changes_no_face():
    """Corners of a cube doubled by points that stand out by half of the tolerance."""
    corners = box(2, 2, 2) - 1.0
    noise = corners * (1.0 - 1e-5, 1.0 + 5e-7, 1.0)
    poses = resting_poses(
        convex_hull(np.concatenate([corners, noise]), tolerance=1e-6), np.zeros(3)
    )
    assert len(poses.shares) == 6
    assert close(poses.shares, 1.0 / 6.0, 1e-5) and close(poses.margins, 1.0, 1e-5)


@pytest.mark.parametrize("axis", range(3))
def test_flattened_body_has_no_stable_pose(axis):
    cube = convex_hull(list(product((-1.0, 1.0), repeat=3)))
    with refused("no_stable_pose"):
        resting_poses(cube.transform(np.diag(np.arange(3) != axis).astype(float)), [0.0, 0.0, 0.0])
