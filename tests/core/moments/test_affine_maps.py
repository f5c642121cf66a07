# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Functionals of polynomials follow maps of the coordinates."""

import numpy as np
import pytest
from body_moments.core.moments.affine_maps import (
    apply_translation,
    rotate_moments,
)
from body_moments.core.moments.exponents import monomial_count, monomials, tensor_index
from body_moments.core.shape.canonical_frame import _tensor_positions

from tests.close import close
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
        assert close(apply_translation(values[i], order, offset[i]), found[i], 1e-14 * order)


def test_moments_turn_with_the_body_one_or_many_at_a_time():
    rng = np.random.default_rng(2)
    place, turns = rng.normal(size=(4, 3)), np.array([bodies.rotation(seed) for seed in range(4)])
    powers = monomials(7)
    raw, turned = (
        np.prod(where[:, None] ** powers, axis=2)
        for where in (place, (turns @ place[..., None])[..., 0])
    )
    for found, truth in (
        (rotate_moments(raw, 7, turns), turned),
        (rotate_moments(raw[1], 7, turns[1]), turned[1]),
    ):
        assert np.abs(found - truth).max() <= 1e-13 * np.abs(turned).max()
    one_by_all = rotate_moments(raw[0], 7, turns)
    assert (
        np.abs(one_by_all[2] - rotate_moments(raw[0], 7, turns[2])).max()
        <= 1e-13 * np.abs(raw).max()
    )


@pytest.mark.parametrize("degree", range(1, 6))
def test_a_symmetric_tensor_holds_each_moment_of_its_degree(degree):
    place = np.array([0.5, -1.25, 2.0])
    tensor = 1.0
    for _ in range(degree):
        tensor = np.multiply.outer(tensor, place)
    raw = np.prod(place ** monomials(degree), axis=1)
    assert np.array_equal(raw[tensor_index(degree)], tensor)
    assert np.array_equal(
        tensor.ravel()[_tensor_positions(degree)], raw[monomials(degree).sum(axis=1) == degree]
    )


@pytest.mark.parametrize("offset, size", [(1e60, 1e200), (-1e60, 1e200), (1e200, 1.0)])
def test_overflowing_image_has_no_information(offset, size):
    """The caller checks the result; numpy would warn on the console."""
    values = np.append(size, np.full(monomial_count(4) - 1, -size))
    with np.errstate(all="raise"):
        assert not np.isfinite(apply_translation(values, 4, np.full(3, offset))).all()
