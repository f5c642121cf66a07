# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Functionals of polynomials follow maps of the coordinates."""

import numpy as np
import pytest
from body_moments.core.moments.affine_maps import (
    absolute_moments,
    apply_translation,
    are_similarities,
    are_singular,
    distinct_linear_parts,
    rotate_moments,
    translation_matrices,
)
from body_moments.core.moments.exponents import monomial_count, monomials, tensor_index
from body_moments.core.moments.symmetric_tensors import _tensor_positions, distinct_arrays

from tests.core import bodies


@pytest.mark.parametrize("order", [3, 6, 9])
def test_a_point_mass_is_moved_by_the_binomial_theorem(order):
    rng = np.random.default_rng(order)
    place, offset = rng.uniform(0.5, 2, (5, 3)), rng.uniform(0.5, 2, (5, 3))
    offset[1] = 0.0
    powers = monomials(order)
    values, moved = (np.prod(where[:, None] ** powers, axis=2) for where in (place, place + offset))
    found = apply_translation(values, order, offset)
    assert values.shape == (5, monomial_count(order)) and np.array_equal(found[1], values[1])
    assert (np.abs(found - moved) <= 1e-14 * order * moved).all()
    for i in range(5):
        assert np.array_equal(found[i], apply_translation(values[i], order, offset[i]))


def test_moments_turn_with_the_body_one_or_many_at_a_time():
    rng = np.random.default_rng(2)
    place, turns = rng.normal(size=(4, 3)), np.array([bodies.rotation(seed) for seed in range(4)])
    powers = monomials(7)
    raw, turned = (np.prod(where[:, None] ** powers, axis=2) for where in (place, (turns @ place[..., None])[..., 0]))
    for found, truth in ((rotate_moments(raw, 7, turns), turned), (rotate_moments(raw[1], 7, turns[1]), turned[1])):
        assert np.abs(found - truth).max() <= 1e-13 * np.abs(turned).max()
    one_by_all = rotate_moments(raw[0], 7, turns)
    assert np.abs(one_by_all[2] - rotate_moments(raw[0], 7, turns[2])).max() <= 1e-13 * np.abs(raw).max()


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_what_flattens_as_far_as_float32_shows_is_singular(scale):
    turn = bodies.rotation(3)
    for angle, is_singular in ((4.7e-7, True), (4.8e-7, False), (-4.7e-7, True), (-4.8e-7, False)):
        flat = np.array([[1.0, 1.0, 0.0], [0.0, angle, 0.0], [0.0, 0.0, 1e-9]])
        stack = scale * np.array([turn @ flat, turn @ flat[:, [2, 0, 1]], flat[[1, 2, 0]] * (1.0, 1e3, 1e-3)])
        assert are_singular(stack).tolist() == [is_singular] * 3
    assert are_singular(scale * np.array([np.diag([1.0, 1.0, 0.0]), np.zeros((3, 3))])).all()


@pytest.mark.parametrize("scale", [1e-100, 1.0, 1e100])
def test_what_stretches_as_little_as_float32_rotations_do_is_a_similarity(scale):
    turn = scale * bodies.rotation(4)
    for share, is_similar in ((0.99, True), (1.01, False)):
        for sign in (1.0, -1.0):
            stretch = np.sqrt(1.0 + sign * share * 1.5e-5)
            maps = [np.diag(np.roll([stretch, 1.0, 1.0], axis)) for axis in range(3)]
            for i, j in ((0, 1), (0, 2), (1, 2)):
                maps.append(np.eye(3))
                maps[-1][i, j] = sign * share * 1e-5
            assert are_similarities(turn @ np.array(maps)).tolist() == [is_similar] * 6
    assert are_similarities(np.array([turn, -turn, turn * (1.0, 1.0, -1.0), turn * 0.0])).tolist() == [True] * 3 + [
        False
    ]


def test_maps_are_told_apart_by_their_linear_parts_and_made_of_offsets():
    offsets = np.random.default_rng(1).normal(size=(6, 3))
    maps = translation_matrices(offsets)
    assert np.array_equal(maps @ (1, 2, 3, 1), np.column_stack([offsets + (1, 2, 3), np.ones(6)]))
    linear = [np.eye(3), bodies.rotation(1), np.diag([1.0, 1.0, -1.0])]
    which = [1, 0, 2, 1, 1, 0]
    maps[:, :3, :3] = [linear[i] for i in which]
    found = [(part.tolist(), members.tolist()) for part, members in distinct_linear_parts(maps)]
    expected = [(part.tolist(), [k for k, i in enumerate(which) if i == n]) for n, part in enumerate(linear)]
    assert sorted(found) == sorted(expected)


@pytest.mark.parametrize("degree", range(1, 6))
def test_a_symmetric_tensor_holds_each_moment_of_its_degree(degree):
    place = np.array([0.5, -1.25, 2.0])
    tensor = 1.0
    for _ in range(degree):
        tensor = np.multiply.outer(tensor, place)
    raw = np.prod(place ** monomials(degree), axis=1)
    assert np.array_equal(raw[tensor_index(degree)], tensor)
    assert np.array_equal(tensor.ravel()[_tensor_positions(degree)], raw[monomials(degree).sum(axis=1) == degree])


def test_of_arrays_that_are_near_the_first_is_kept():
    rows = np.array([[0.0, 0.0], [1.0, 0.0], [0.09, -0.09], [1.0, 0.11], [0.05, 0.0]])
    assert distinct_arrays(rows, 0.1).tolist() == rows[[0, 1, 3]].tolist()
    assert distinct_arrays(rows.reshape(5, 2, 1), 0.1)[:, :, 0].tolist() == rows[[0, 1, 3]].tolist()


@pytest.mark.parametrize("offset, size", [(1e60, 1e200), (-1e60, 1e200), (1e200, 1.0)])
def test_what_is_moved_beyond_the_range_of_numbers_says_nothing(offset, size):
    """Who measures looks for that; numpy would warn on the console."""
    values = np.append(size, np.full(monomial_count(4) - 1, -size))
    with np.errstate(all="raise"):
        assert not np.isfinite(apply_translation(values, 4, np.full(3, offset))).all()


@pytest.mark.parametrize("order", range(8))
def test_nothing_has_no_absolute_moments(order):
    with np.errstate(all="raise"):
        assert not absolute_moments(np.zeros((2, monomial_count(order))), order).any()
