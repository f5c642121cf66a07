# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Quaternions and matrices are the same rotation, to double precision and at every angle."""

import numpy as np
from body_moments.core.numerics.rotations import quaternion, rotation_matrix
from hypothesis import given

from tests.core.strategies import holds, rotations


@holds(60)
@given(rotation=rotations())
def test_a_rotation_survives_as_a_quaternion(rotation):
    q = quaternion(rotation)
    assert q[0] >= 0.0 and abs(np.linalg.norm(q) - 1.0) <= 1e-15
    assert np.abs(rotation_matrix(q) - rotation).max() <= 1e-14


def test_a_quarter_turn_about_z_takes_x_to_y():
    assert np.abs(rotation_matrix([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]) @ [1, 0, 0] - [0, 1, 0]).max() <= 1e-15


def test_a_float32_quaternion_gives_an_orthonormal_matrix():
    rotation = rotation_matrix(np.array([0.5, 0.1, -0.3, 0.7], np.float32))
    assert np.abs(rotation.T @ rotation - np.eye(3)).max() <= 1e-15
