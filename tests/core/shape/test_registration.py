# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which way a body is laid onto another one, with few points looked at where they tell enough."""

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, region_moments
from body_moments.core.shape import registration as matching
from body_moments.core.shape.disc_zernike import disc_zernike
from body_moments.core.shape.flat_pose import match_flat, turns_about_normal

from tests.core import bodies, shapes
from tests.core.recursion import moments


def laid(source, target, calls):
    here, there = moments(source, 6).about_center(), moments(target, 6).about_center()

    def distances(way, one, other, step):
        images = (one[0][::step] - moments(one, 1).center) @ way.T + moments(other, 1).center
        return shapes.distance(other, images)

    def residual(way, few):
        calls.append(few)
        step = max(1, len(source[0]) // few) if few else 1
        return np.concatenate([distances(way, source, target, step), distances(way.T, target, source, step)])

    return matching.match(here, there, residual, 1.0)


@pytest.mark.parametrize("name", ["cube", "L prism", "box", "tetrahedron"])
def test_the_way_is_the_one_that_all_points_tell_and_few_ways_need_them(name, monkeypatch):
    target = shapes.refined(shapes.SYMMETRIC[name][0], 1)
    noise = np.random.default_rng(2).normal(size=target[0].shape) * 1e-3  # so that one way is the best
    target = target[0] + noise, target[1]
    source = bodies.moved(target, bodies.rotation(3), (1, 2, 3))
    calls = []
    found = laid(source, target, calls)
    monkeypatch.setattr(matching, "FIRST_SAMPLES", 10**9)  # all points of every way
    complete = laid(source, target, [])
    assert (found.rotation == complete.rotation).all() and not found.is_mirror_image
    assert (found.max_distance, found.mean_distance) == (
        complete.max_distance,
        complete.mean_distance,
    ) and found.max_distance < 1e-4
    assert np.abs(found.rotation - bodies.rotation(3).T).max() < 1e-6
    ways = sum(few is not None for few in calls)
    assert 1 <= len(calls) - ways <= max(1, ways // 2)


@pytest.mark.parametrize("size", [0.5, 7.0])
@pytest.mark.parametrize("share, smallest, looked_at", [(0.9, True, 2), (1.1, False, 1)])
def test_of_ways_that_leave_as_much_to_a_ten_thousandth_of_the_size_the_smallest_turn_is_taken(
    size, share, smallest, looked_at
):
    left, calls = {2.0: 1.0, 0.5: 1.0 + share * 1e-4 * size, 1.0: 2.0}, []

    def residual(way, few):
        calls.append(few)
        return np.array([left[round(float(np.arctan2(way[1, 0], way[0, 0])), 9)], 0.25])

    ways = turns_about_normal(np.array([2.0, 0.5, 1.0]))
    rotation, distances = matching.best_rotation(ways, residual, size)
    assert np.array_equal(rotation, ways[1 if smallest else 0])
    assert distances.tolist() == [left[0.5 if smallest else 2.0], 0.25] and calls.count(None) == looked_at


@pytest.mark.parametrize("is_flat", [False, True])
@pytest.mark.parametrize("size", [0.5, 7.0])
@pytest.mark.parametrize(
    "left, share, is_mirror_image", [(1.01, 0.19, True), (1.01, 0.21, False), (0.99, 0.19, False), (1.5, 0.0, True)]
)
def test_what_no_rotation_lays_on_the_other_to_a_thousandth_is_a_mirror_image_where_a_reflection_leaves_a_fifth(
    is_flat, size, left, share, is_mirror_image
):
    left = left * 1e-3 * size

    def residual(way, few):
        return np.array([left if np.linalg.det(way) > 0.0 else share * left, 0.0])

    if is_flat:
        points = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 1.0]])
        zernike = disc_zernike(region_moments(points, directed_edges([range(3)]), 8), 3.0)
        found = match_flat(zernike, zernike, (np.eye(3), np.eye(3)), residual, size)
    else:
        body = moments(shapes.WEDGE, 6).about_center()
        found = matching.match(body, body, residual, size)
    assert found.is_mirror_image is is_mirror_image
    assert (found.max_distance, found.mean_distance) == (left, left / 2.0)


@pytest.mark.parametrize("way", [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
def test_half_turns_about_the_axes_are_tried_for_noise_may_decide_a_sign(way):
    """The body tells one way alone; here what is left is least after a half turn more."""
    body = moments(shapes.WEDGE, 6).about_center()
    axes = np.linalg.eigh(body.second())[1]
    wanted = axes @ np.diag(way).astype(float) @ axes.T
    found = matching.match(body, body, lambda turn, _: np.abs(turn - wanted).max(axis=1), 1.0)
    assert np.abs(found.rotation - wanted).max() < 1e-9
