# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fourier transforms of surfaces at many places."""

import numpy as np
import pytest
from body_moments.core.fourier import BodyTransform, FrequencyGrid
from body_moments.core.fourier.transform import (
    run_to_completion,
    solid_transform,
    surface_transform,
)

from tests.close import close
from tests.core import bodies
from tests.core.findings import refused

Q = np.random.default_rng(3).normal(size=(40, 3)) * np.logspace(-9, 2, 40)[:, None]
PART = bodies.moved(bodies.sphere(2), np.diag([1, 0.5, 2]), (30, 1, -2))


def places(*maps):
    matrices = np.tile(np.eye(4), (len(maps), 1, 1))
    for matrix, (linear, offset) in zip(matrices, maps):
        matrix[:3, :3], matrix[:3, 3] = linear, offset
    return matrices


SHEARED = np.array([[1, 0.4, 0], [0, 0.7, 0], [0.1, 0, 1.5]])
MIRRORED = np.diag([1.0, -1.0, 2.0])
MAPS = places(
    (np.eye(3), (0, 0, 0)),
    (np.eye(3), (5, -3, 2)),
    (SHEARED, (1, 2, 3)),
    (MIRRORED, (-4, 0, 0)),
    (SHEARED, (0, 0, 70)),
    (bodies.rotation(2), (0, 0, 0)),
)


@pytest.mark.parametrize("of, alone", [("volume", solid_transform), ("area", surface_transform)])
@pytest.mark.parametrize("q", [Q, FrequencyGrid(5, 4.0)], ids=["list", "grid"])
def test_copies_under_any_map_are_the_mapped_bodies(of, alone, q):
    box = bodies.box((0, 0, 0), (1, 1.5, 0.7))
    transform = BodyTransform(
        [(bodies.surface(PART), MAPS), (bodies.surface(box), MAPS[2:4])], q, of, 1.0
    )
    found = run_to_completion(transform)
    true = 0.0
    for part, matrices in ((PART, MAPS), (box, MAPS[2:4])):
        for matrix in matrices:
            mirror = np.linalg.det(matrix[:3, :3]) < 0.0
            image = bodies.moved(
                bodies.inverted(part) if mirror else part, matrix[:3, :3], matrix[:3, 3]
            )
            true = true + alone(bodies.surface(image), q).values
    # rounding of mapped corners, 70 from the origin, times the surface's area
    assert np.abs(found.values - true).max() <= 150.0 * 4 * 2.0**-47
    assert len(transform.images) == 6 and found.method == "exact"


def test_a_map_of_the_body_is_a_map_of_the_frequencies():
    found = run_to_completion(
        BodyTransform([(bodies.surface(PART), MAPS[2:3])], Q, "volume", 1.0)
    ).values
    plain = solid_transform(bodies.surface(PART), Q @ SHEARED).values
    expected = np.linalg.det(SHEARED) * np.exp(-1j * (Q @ MAPS[2, :3, 3])) * plain
    assert np.abs(found - expected).max() <= 1e-12


def test_float32_storage_bound_counts_every_copy():
    stored = bodies.surface(PART, np.float32)
    one = run_to_completion(BodyTransform([(stored, MAPS[:1])], Q, "volume", 1.0))
    both = run_to_completion(BodyTransform([(stored, MAPS[:2])], Q, "volume", 1.0))
    assert close(both.input_error, 2 * one.input_error, rel=1e-6) and one.input_error > 0.0


def test_empty_instances_are_refused():
    empty = bodies.surface((PART[0], PART[1][:0]))
    with refused("no_faces"):
        BodyTransform([(empty, MAPS)], Q, "area", 1.0)


@pytest.mark.parametrize("place", [(2**19,) * 3, (2**19, 0, 0), (0, 0, -(2**19))])
def test_the_shape_of_a_far_body_loses_no_digits(place):
    """Half a million lengths away, only the place of the turned body is inexact."""
    turn, q = np.eye(4), np.random.default_rng(5).normal(size=(20, 3))
    turn[:3, :3] = bodies.rotation(7)
    near, far = (
        run_to_completion(
            BodyTransform([(bodies.surface(part), turn[None])], q, "volume", 1.0)
        ).values
        for part in (
            bodies.box((0, 0, 0), (1, 2, 4)),
            bodies.moved(bodies.box((0, 0, 0), (1, 2, 4)), None, place),
        )
    )
    assert np.abs(np.abs(far) - np.abs(near)).max() <= 1e-13
