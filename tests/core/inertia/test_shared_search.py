# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of a body share the search for its axes, and each has the axes that it has by itself."""

import numpy as np
import pytest
from body_moments.core.inertia import shared_search
from body_moments.core.inertia.canonical_frame import canonical_frames
from body_moments.core.inertia.shared_search import shared_frames
from body_moments.core.inertia.third_moment_frames import third_moment_frames
from body_moments.core.moments.moments import stack_moments

from tests.core import bodies, shapes
from tests.core.findings import refused
from tests.core.recursion import moments


def copies(part, count=12, turned=True, noise=0.0):
    """Placed anywhere, with noise in their coordinates as a share of their size."""
    rng = np.random.default_rng(7)
    made = []
    for seed in range(count):
        turn = bodies.rotation(seed) if turned else np.eye(3)
        points, triangles = bodies.moved(
            part, turn * 10.0 ** rng.uniform(-1, 1), rng.normal(size=3)
        )
        points = points + noise * np.ptp(points, axis=0).max() * rng.uniform(
            -1.0, 1.0, points.shape
        )
        made.append(moments((points, triangles), 6))
    return stack_moments(made)


def parts():
    found = {name: part for name, (part, _) in shapes.SYMMETRIC.items()}
    found["prism"] = bodies.box((-1, -1, -2), (1, 1, 2))
    found["plate"] = bodies.box((-2, -2, -0.1), (2, 2, 0.1))
    return found


def same_frames(found, expected):
    """Return True if the two sets of frames are equal up to their order."""
    gaps = np.abs(found[:, None] - expected[None]).max(axis=(2, 3))
    return (
        len(found) == len(expected)
        and gaps.min(axis=1).max() < 1e-9
        and gaps.min(axis=0).max() < 1e-9
    )


@pytest.mark.parametrize("name", parts())
@pytest.mark.parametrize("noise", [0.0, 1e-7])
def test_shared_frames_match_frames_of_single_bodies(name, noise):
    stack = copies(parts()[name], noise=noise)
    fixed = third_moment_frames(stack)
    which = np.flatnonzero(fixed.symmetry > 0)
    found = shared_frames(stack.at(which), fixed, which)
    for body, shared in zip(which.tolist(), found):
        alone = canonical_frames(stack.at(body), fixed.spread(body), fixed.frames(body))
        assert shared.revolution_axes == alone.revolution_axes
        if alone.revolution_axes != (0, 1, 2):
            assert same_frames(shared.frames, alone.frames), (name, body)


def test_frames_are_independent_of_earlier_measurements():
    stack = copies(shapes.SYMMETRIC["cube"][0], 6, noise=1e-7)
    fixed = third_moment_frames(stack)
    together = shared_frames(stack, fixed, np.arange(6))
    for i in range(6):
        shared_search._search.cache_clear()
        alone = shared_frames(stack.at([i]), fixed, np.array([i]))[0]
        assert np.abs(alone.frames - together[i].frames).max() < 1e-14


@pytest.mark.parametrize("scale", [1e-40, 1e60])
def test_a_body_beyond_the_range_of_numbers_is_refused(scale):
    points, triangles = bodies.box((-1, -1, -1), (1, 1, 1))
    stack = stack_moments([moments((points * size, triangles), 6) for size in (1.0, scale)])
    fixed = third_moment_frames(stack)
    with refused("moments_overflow", order=6):
        shared_frames(stack, fixed, np.array([0, 1]))


@pytest.mark.parametrize(("small", "far"), [(0.1, 5.0), (0.1, 20.0), (0.05, 30.0)])
def test_body_of_core_and_far_pieces_keeps_its_single_axes(small, far):
    """Moments of sixth order that are thousands of times what they are for a cube, and beyond 32
    bits on the grid.
    """
    points, triangles = bodies.box((-1, -1, -1), (1, 1, 1))
    centers = np.concatenate([np.zeros((1, 3)), far * np.eye(3), -far * np.eye(3)])
    sizes = [1.0, *[small] * 6]
    whole = np.concatenate(
        [center + size * np.asarray(points) for center, size in zip(centers, sizes)]
    )
    faces = np.concatenate([np.asarray(triangles) + i * len(points) for i in range(7)])
    stack = stack_moments([moments((whole @ bodies.rotation(3).T, faces), 6)])
    fixed = third_moment_frames(stack)
    shared = shared_frames(stack, fixed, np.array([0]))[0]
    alone = canonical_frames(stack.at(0), fixed.spread(0), fixed.frames(0))
    assert len(alone.frames) == 24 and same_frames(shared.frames, alone.frames)
