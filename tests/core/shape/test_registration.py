# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which way a body is laid onto another one, with few points looked at where they tell enough."""

import numpy as np
import pytest
from body_moments.core.shape import registration as matching

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
