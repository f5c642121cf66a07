# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Of the frames in which a body is the same: those along fixed axes, turned about free ones, and nearest to others."""

from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.inertia.frame_choice import align_frames, complete_free_axes, nearest_frames
from body_moments.core.inertia.third_moment_frames import HALF_TURN_SIGNS, SYMMETRIES

from tests.close import close
from tests.core.bodies import rotation


def turn(angle, axis):
    """About one of the coordinate axes."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[second, first], matrix[first, second] = np.sin(angle), -np.sin(angle)
    return matrix


@pytest.mark.parametrize("cosine, is_aligned", [(0.9991, True), (0.9989, False)])
@pytest.mark.parametrize("axis", range(3))
def test_frames_near_the_fixed_axes_of_a_body_are_put_along_them(cosine, is_aligned, axis):
    axes = np.array([rotation(1), rotation(2)])
    fixed = SimpleNamespace(axes=axes, symmetry=np.array([0, 0]))
    off = turn(np.arccos(cosine), axis)
    frames = (axes[[1]] * HALF_TURN_SIGNS[:, None]) @ off
    found = align_frames(frames[None], fixed, np.array([1]))[0]
    assert np.abs(found - (axes[1] * HALF_TURN_SIGNS[:, None] if is_aligned else frames)).max() <= 1e-15


@pytest.mark.parametrize("cosine, is_aligned", [(0.9991, True), (0.9989, False)])
@pytest.mark.parametrize("name, pole", [("prolate", 0), ("oblate", 2)])
def test_of_frames_about_a_fixed_axis_that_axis_is_put_along_it(cosine, is_aligned, name, pole):
    """And the others as little aside as that asks for; those of another body in the stack are left as they are."""
    axes = np.array([rotation(1), rotation(2)])
    fixed = SimpleNamespace(axes=axes, symmetry=np.array([3, SYMMETRIES.index(name)]))
    across = (pole + 1) % 3
    off = turn(0.7, pole) @ turn(np.arccos(cosine), across)
    frames = np.array([axes * HALF_TURN_SIGNS[1] @ off, axes * HALF_TURN_SIGNS[2] @ off]).swapaxes(0, 1)
    found = align_frames(frames, fixed, np.array([0, 1]))
    assert (found[0] == frames[0]).all()
    if not is_aligned:
        assert (found[1] == frames[1]).all()
        return
    for frame, before, signs in zip(found[1], frames[1], HALF_TURN_SIGNS[[1, 2]]):
        assert np.abs(frame[:, pole] - axes[1][:, pole] * signs[pole]).max() <= 1e-15
        assert np.abs(frame.T @ frame - np.eye(3)).max() <= 1e-14 and np.linalg.det(frame) > 0.0
        assert abs(np.cross(frame[:, pole], before[:, across]) @ frame[:, across]) <= 1e-14
        assert frame[:, across] @ before[:, across] > 0.99


@pytest.mark.parametrize("free, fixed", [((1, 2), 0), ((0, 1), 2)])
@pytest.mark.parametrize("seed", range(5))
def test_free_axes_are_turned_as_near_to_the_preferred_ones_as_any_turn_can_bring_them(free, fixed, seed):
    frames, preferred = np.array([rotation(seed), rotation(seed + 10)]), rotation(seed + 20)
    found = complete_free_axes(frames, free, preferred)
    assert (found[:, :, fixed] == frames[:, :, fixed]).all() and close(np.linalg.det(found), 1.0, 1e-14)
    for frame in found:
        nearness = [np.trace((frame @ turn(angle, fixed)).T @ preferred) for angle in np.linspace(-3.0, 3.0, 601)]
        assert np.argmax(nearness) == 300


@pytest.mark.parametrize("free, fixed", [((1, 2), 0), ((0, 1), 2)])
@pytest.mark.parametrize("angle, is_opposite", [(np.pi - 0.3e-6, True), (np.pi - 1e-5, False), (np.pi, True)])
def test_half_a_turn_away_the_preferred_axis_most_across_is_taken(free, fixed, angle, is_opposite):
    """About an axis across the fixed one, which then points the other way: of the others any turn is as near."""
    preferred = rotation(4)
    frame = preferred @ turn(angle, free[0]) @ turn(0.4, fixed)
    (found,) = complete_free_axes(frame[None], free, preferred)
    along = [abs(found[:, free[0]] @ preferred[:, axis]) for axis in range(3)]
    cosines = np.abs(frame[:, fixed] @ preferred)
    assert not is_opposite or along[int(cosines.argmin())] > 1.0 - 1e-9
    assert np.abs(found.T @ found - np.eye(3)).max() <= 1e-12


def test_no_axis_or_all_of_them_are_free():
    frames, preferred = np.array([rotation(1), rotation(2)]), rotation(3)
    assert complete_free_axes(frames, (), preferred) is frames
    assert (complete_free_axes(frames, (0, 1, 2), preferred) == [preferred, preferred]).all()


@pytest.mark.parametrize("seed", range(10))
def test_the_frame_with_the_smallest_turn_is_taken_of_each_body(seed):
    frames = np.array([[rotation(100 * seed + 10 * body + k) for k in range(4)] for body in range(3)])
    preferred = np.array([rotation(7000 + seed + body) for body in range(3)])
    found = nearest_frames(frames, preferred, [0.0, 1e-9, 0.0])
    for one, own, wanted in zip(found, frames, preferred):
        assert (one == max(own, key=lambda frame: np.trace(wanted.T @ frame))).all()
    assert (nearest_frames(frames[:, :1], preferred, 0.0) == frames[:, 0]).all()


@pytest.mark.parametrize("noise", [0.0, 1e-8, -1e-8])
@pytest.mark.parametrize("tilt", [0.0, 1e-6])
def test_noise_does_not_choose_between_frames_that_are_as_near(noise, tilt):
    """Of two frames a quarter turn to either side the one whose axes in order point along the preferred ones."""
    small = 0.0 if tilt == 0.0 else 0.5 * tilt
    sides = [turn(np.pi / 2.0 + noise, 2), turn(-np.pi / 2.0 - noise + small, 2)]
    for frames in (sides, sides[::-1]):
        (found,) = nearest_frames(np.array(frames)[None], np.eye(3)[None], tilt)
        assert np.abs(found - sides[0]).max() <= 1e-12


@pytest.mark.parametrize("share, is_nearer", [(0.98, False), (1.02, True)])
@pytest.mark.parametrize("tilt, allowed", [(0.0, 1e-6), (1e-3, 4e-3 + 1e-6), (0.02, 0.08 + 1e-6), (3.0, 0.1 + 1e-6)])
def test_frames_are_as_near_where_traces_differ_by_up_to_four_tilts_but_never_by_a_tenth(
    share, is_nearer, tilt, allowed
):
    nearer = turn(np.arcsin(share * allowed / 2.0) - np.pi / 2.0, 2)
    frames = np.array([[turn(np.pi / 2.0, 2), nearer]])
    (found,) = nearest_frames(frames, np.eye(3)[None], [tilt])
    assert (found == (nearer if is_nearer else frames[0, 0]) + 0.0).all()
