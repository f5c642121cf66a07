# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of a body share the search for its axes, and each has the axes that it has by itself."""

import numpy as np
import pytest
from body_moments.core.inertia import canonical_frame, shared_search
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
        points, triangles = bodies.moved(part, turn * 10.0 ** rng.uniform(-1, 1), rng.normal(size=3))
        points = points + noise * np.ptp(points, axis=0).max() * rng.uniform(-1.0, 1.0, points.shape)
        made.append(moments((points, triangles), 6))
    return stack_moments(made)


def parts():
    found = {name: part for name, (part, _) in shapes.SYMMETRIC.items()}
    found["prism"] = bodies.box((-1, -1, -2), (1, 1, 2))
    found["plate"] = bodies.box((-2, -2, -0.1), (2, 2, 0.1))
    return found


def same_frames(found, expected):
    """Whether each of some frames is one of the others."""
    gaps = np.abs(found[:, None] - expected[None]).max(axis=(2, 3))
    return len(found) == len(expected) and gaps.min(axis=1).max() < 1e-9 and gaps.min(axis=0).max() < 1e-9


@pytest.mark.parametrize("name", parts())
@pytest.mark.parametrize("noise", [0.0, 1e-7])
def test_shared_frames_are_those_of_each_body_by_itself(name, noise):
    stack = copies(parts()[name], noise=noise)
    fixed = third_moment_frames(stack)
    which = np.flatnonzero(fixed.symmetry > 0)
    found = shared_frames(stack.at(which), fixed, which)
    for body, shared in zip(which.tolist(), found):
        alone = canonical_frames(stack.at(body), fixed.spread(body), fixed.frames(body))
        assert shared.revolution_axes == alone.revolution_axes
        if alone.revolution_axes != (0, 1, 2):
            assert same_frames(shared.frames, alone.frames), (name, body)


@pytest.mark.parametrize(("turn", "most"), [(np.eye(3), 2), (bodies.rotation(3), 25)], ids=["along the axes", "turned"])
def test_copies_that_lie_alike_are_hardly_searched_again_and_each_has_its_own_axes(monkeypatch, turn, most):
    shared_search._search.cache_clear()
    searches = []
    searched = shared_search.canonical_frames
    monkeypatch.setattr(shared_search, "canonical_frames", lambda *args: searches.append(args) or searched(*args))
    stack = copies(bodies.moved(bodies.box((-1, -1, -1), (1, 1, 1)), turn), 40, turned=False, noise=3e-8)
    fixed = third_moment_frames(stack)
    found = shared_frames(stack, fixed, np.arange(40))
    assert 1 <= len(searches) <= most
    for frames in found:
        cosines = np.sort(np.abs(turn.T @ frames.frames), axis=1)
        assert len(frames.frames) == 24 and np.abs(cosines - [[0], [0], [1]]).max() < 1e-6
    assert max(np.abs(frames.frames - found[0].frames).max() for frames in found) > 1e-10  # each has its own


def test_what_was_measured_before_changes_nothing():
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


def test_the_grid_is_a_tenth_of_noise():
    assert 5.0 < canonical_frame.NOISE_LEVEL / shared_search.GRID < 20.0


@pytest.mark.parametrize(("small", "far"), [(0.1, 5.0), (0.1, 20.0), (0.05, 30.0)])
def test_a_body_of_a_core_and_far_pieces_has_the_axes_that_it_has_by_itself(small, far):
    """Moments of sixth order that are thousands of times what they are for a cube, and beyond 32 bits on the grid."""
    points, triangles = bodies.box((-1, -1, -1), (1, 1, 1))
    centers = np.concatenate([np.zeros((1, 3)), far * np.eye(3), -far * np.eye(3)])
    sizes = [1.0, *[small] * 6]
    whole = np.concatenate([center + size * np.asarray(points) for center, size in zip(centers, sizes)])
    faces = np.concatenate([np.asarray(triangles) + i * len(points) for i in range(7)])
    stack = stack_moments([moments((whole @ bodies.rotation(3).T, faces), 6)])
    fixed = third_moment_frames(stack)
    shared = shared_frames(stack, fixed, np.array([0]))[0]
    alone = canonical_frames(stack.at(0), fixed.spread(0), fixed.frames(0))
    assert len(alone.frames) == 24 and same_frames(shared.frames, alone.frames)
