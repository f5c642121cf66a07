# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay draws, as arrays: where it is, how large, in which form. tests/window looks at
its pixels.
"""

import numpy as np
import pytest
from body_moments.panels.overlay import bodies, discs
from body_moments.panels.overlay.discs import View

from tests.close import close


@pytest.fixture
def view(registered):
    """A perspective of 60° from (3, -4, 5) at an odd size, rolled."""
    rotation = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, -rotation @ (3.0, -4.0, 5.0)
    near, far, width, height = 0.1, 100.0, 641.0, 357.0
    slope = np.tan(np.radians(30.0))
    projection = np.diag([1.0 / slope, width / height / slope, -(far + near) / (far - near), 0.0])
    projection[2, 3], projection[3, 2] = -2.0 * far * near / (far - near), -1.0
    return View(matrix, projection, np.array([width, height]))


def in_front(view, count=5):
    """(count, 3) points that the view shows."""
    random = np.random.default_rng(5)
    seen = np.stack(
        [*(random.uniform(-0.4, 0.4, (2, count)) * 8.0), -random.uniform(6.0, 12.0, count)], axis=1
    )
    return (seen - view.view[:3, 3]) @ view.view[:3, :3]


def test_shapes_have_their_size_in_pixels_wherever_they_are(view):
    anchors = in_front(view)
    offsets = np.random.default_rng(7).uniform(-20.0, 20.0, (len(anchors), 6, 2))
    placed = view.place(anchors, offsets)
    on_screen = view.pixels(placed.reshape(-1, 3)).reshape(offsets.shape)
    assert close(on_screen - view.pixels(anchors)[:, None], offsets, 1e-9)
    assert close(
        view.depths(placed.reshape(-1, 3)).reshape(-1, 6),
        view.depths(anchors)[:, None].repeat(6, axis=1),
        1e-12,
    )


def test_an_equal_box_has_the_inertia_of_the_body(registered):
    sides = np.array([1.0, 2.0, 5.0])
    inertia = (sides @ sides - sides**2) / 12.0  # of a box of mass 1
    centers, axes = np.array([[10.0, 20.0, 30.0]]), np.eye(3)[None]
    corners = bodies.box_lines(centers, axes, np.sqrt(inertia)[None]).reshape(-1, 3)
    assert close(np.ptp(corners, axis=0), sides, 1e-12)
    assert close(corners.mean(axis=0), centers[0], 1e-12)


def test_an_equal_ellipsoid_has_the_inertia_of_the_body(registered):
    half = np.array([1.0, 2.0, 5.0])
    inertia = (half @ half - half**2) / 5.0
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    points = bodies.ellipsoid_lines(np.zeros((1, 3)), turn[None], np.sqrt(inertia)[None]).reshape(
        -1, 3
    )
    assert close(((points @ turn / half) ** 2).sum(axis=1), 1.0, 1e-12)
    assert close(np.abs(points @ turn).max(axis=0), half, 1e-12)


def test_axes_are_as_long_as_the_largest_gyration(registered):
    gyration = np.array([[1.0, 2.0, 3.0]])
    turn = np.linalg.qr(np.random.default_rng(2).standard_normal((3, 3)))[0]
    segments = bodies.axis_lines(np.ones((1, 3)), turn[None], gyration)[0]
    assert close(segments.mean(axis=1), 1.0, 1e-12)
    assert close(segments[:, 1] - segments[:, 0], 2.0 * 3.0 * turn.T, 1e-12)


@pytest.mark.parametrize("size", [1e-4, 0.01, 0.3, 3.0])
def test_disc_is_never_larger_than_its_ball(view, size):
    centers = in_front(view)
    count = len(centers)
    gyration = np.full((count, 3), size * np.sqrt(0.4))
    for verdict in range(5):
        drawn = bodies.Bodies(
            centers,
            np.tile(np.eye(3), (count, 1, 1)),
            gyration,
            np.full(count, verdict),
            *np.ones((2, count), bool),
        )
        points, _, _ = discs.disc_triangles(drawn, view, 1.0)
        order = np.argsort(-view.depths(centers), kind="stable")
        pixels = (
            view.pixels(points.astype(float)).reshape(count, -1, 2)
            - view.pixels(centers)[order][:, None]
        )
        ball = size / view.pixel_sizes(centers)[order].max(axis=1)
        radii = np.linalg.norm(pixels, axis=2).max(axis=1)
        assert (radii <= np.minimum(ball, 30.0) + 1e-3).all() and (
            radii > 0.5 * np.minimum(ball, 12.0)
        ).all()
