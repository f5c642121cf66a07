# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Quaternions and matrices are the same rotation, to double precision and at every angle."""

import numpy as np
import pytest
from body_moments.core.numerics.rotations import quaternion, rotation_matrix

HALF_TURNS = [np.diag(signs) for signs in ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))]


def random_rotations(count):
    rng = np.random.default_rng(1)
    for _ in range(count):
        rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        yield rotation * np.sign(np.linalg.det(rotation))


@pytest.mark.parametrize("rotation", [*HALF_TURNS, *random_rotations(50)])
def test_a_rotation_survives_as_a_quaternion(rotation):
    q = quaternion(rotation)
    assert q[0] >= 0.0 and np.linalg.norm(q) == pytest.approx(1.0, abs=1e-15)
    assert np.allclose(rotation_matrix(q), rotation, atol=1e-14)


def test_a_quarter_turn_about_z_takes_x_to_y():
    assert np.abs(rotation_matrix([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]) @ [1, 0, 0] - [0, 1, 0]).max() <= 1e-15


def test_a_float32_quaternion_gives_an_orthonormal_matrix():
    rotation = rotation_matrix(np.array([0.5, 0.1, -0.3, 0.7], np.float32))
    assert np.allclose(rotation.T @ rotation, np.eye(3), atol=1e-15)
