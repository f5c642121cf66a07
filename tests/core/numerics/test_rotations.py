# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Quaternions and matrices are the same rotation, to double precision and at every angle."""

import numpy as np
import pytest
from body_moments.core.numerics.rotations import (
    along_x,
    polar_rotation,
    quaternion,
    rotation_matrix,
)
from hypothesis import given

from tests.core.strategies import holds, rotations, seeds


@holds(60)
@given(rotation=rotations())
def test_a_rotation_survives_as_a_quaternion(rotation):
    q = quaternion(rotation)
    assert q[0] >= 0.0 and abs(np.linalg.norm(q) - 1.0) <= 1e-14
    assert np.abs(rotation_matrix(q) - rotation).max() <= 1e-14


def test_a_quarter_turn_about_z_takes_x_to_y():
    assert (
        np.abs(rotation_matrix([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]) @ [1, 0, 0] - [0, 1, 0]).max()
        <= 1e-14
    )


def test_a_float32_quaternion_gives_an_orthonormal_matrix():
    rotation = rotation_matrix(np.array([0.5, 0.1, -0.3, 0.7], np.float32))
    assert np.abs(rotation.T @ rotation - np.eye(3)).max() <= 1e-14


@holds(40)
@given(rotation=rotations(), seed=seeds)
def test_own_axes_match_drawn_axes_or_nearest_under_shear(rotation, seed):
    rng = np.random.default_rng(seed)
    scale, sign = 10.0 ** rng.uniform(-6, 6, (3, 3)), rng.choice([-1.0, 1.0], 3)
    maps = np.full((3, 4, 4), np.nan)  # only the linear parts count
    maps[0, :3, :3] = rotation * sign * scale[0]
    maps[1, :3, :3] = sheared = rotation @ (np.eye(3) + rng.uniform(-0.3, 0.3, (3, 3))) * scale[1]
    maps[2, :3, :3] = rotation * scale[2] * (0.0, 1.0, 1.0)
    axes, shears = polar_rotation(maps)
    assert shears.tolist() == [False, True, False]
    assert np.abs(axes[0] - rotation * sign).max() <= 1e-14
    nearest = sheared / np.linalg.norm(sheared, axis=0)
    for _ in range(9):  # Newton's iteration to the polar factor
        nearest = (nearest + np.linalg.inv(nearest).T) / 2.0
    assert np.abs(axes[1] - nearest).max() <= 1e-14
    assert np.abs(axes[2].T @ axes[2] - np.eye(3)).max() <= 1e-14  # a flattening map has axes, too
    assert np.abs(axes[2] - rotation)[:, 1:].max() <= 1e-14


@pytest.mark.parametrize("pair", [(0, 1), (0, 2), (1, 2)])
@pytest.mark.parametrize(
    "cosine, shears", [(0.9e-5, False), (-0.9e-5, False), (1.1e-5, True), (-1.1e-5, True)]
)
def test_axes_from_float32_are_at_right_angles(pair, cosine, shears):
    matrix = np.eye(4)
    matrix[pair] = cosine
    assert polar_rotation(matrix[None])[1].tolist() == [shears]


@holds(30)
@given(rotation=rotations())
def test_rotation_onto_an_axis_is_exact(rotation):
    for axis in rotation:
        found = along_x(axis)
        assert np.array_equal(found[:, 0], axis) and np.linalg.det(found) > 0.0
        assert np.abs(found.T @ found - np.eye(3)).max() <= 1e-14


def test_half_and_third_turns_are_exact_without_negative_zeros():
    """About x, y, z and between them; of half a turn the largest component is positive."""
    s = np.sqrt(0.5)
    known = np.array(
        [
            [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
            [
                [0.5, 0.5, 0.5, 0.5],
                [0.5, -0.5, 0.5, 0.5],
                [0.5, 0.5, -0.5, 0.5],
                [0.5, 0.5, 0.5, -0.5],
            ],
            [[s, s, 0, 0], [s, -s, 0, 0], [s, 0, -s, 0], [s, 0, 0, s]],
            [[0, 0.8, -0.6, 0], [0, -0.6, 0.8, 0], [0, 0, -0.6, 0.8], [0, 0.8, 0, -0.6]],
        ]
    )
    matrices = rotation_matrix(known * 3.0)
    assert matrices.shape == (4, 4, 3, 3)
    w, v = known[..., 0, None, None], known[..., 1:]
    across = np.cross(v[..., None, :], np.eye(3)).swapaxes(-1, -2)  # the matrix of v ×
    rodrigues = (
        (2.0 * w * w - 1.0) * np.eye(3) + 2.0 * v[..., :, None] * v[..., None, :] + 2.0 * w * across
    )
    assert np.abs(matrices - rodrigues).max() <= 1e-14
    found = quaternion(matrices)
    assert found.shape == (4, 4, 4) and np.abs(found - known).max() <= 1e-14
    assert not np.signbit(quaternion(np.rint(matrices[:2]))[(known[:2] == 0.0)]).any()
    # 240° about x
    far = np.array([[1.0, 0.0, 0.0], [0.0, -0.5, 0.75**0.5], [0.0, -(0.75**0.5), -0.5]])
    for axis in range(3):
        found = quaternion(np.roll(far, (axis, axis), (0, 1)))
        across = [0, 1, 2, 3][1:][:axis] + [0, 1, 2, 3][axis + 2 :]
        assert np.abs(found[[0, axis + 1]] - (0.5, -(0.75**0.5))).max() <= 1e-14
        assert not found[across].any() and not np.signbit(found[across]).any()


@pytest.mark.parametrize("largest", range(4))
def test_quaternion_keeps_all_digits_for_any_largest_component(largest):
    rng = np.random.default_rng(largest)
    known = 1e-6 * rng.normal(size=(100, 4))
    known[:, largest] = 1.0
    known /= np.linalg.norm(known, axis=1, keepdims=True)
    known *= np.where(known[:, :1] >= 0.0, 1.0, -1.0)
    assert np.abs(quaternion(rotation_matrix(known)) - known).max() <= 3e-16
