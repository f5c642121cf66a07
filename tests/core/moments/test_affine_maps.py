# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Functionals of polynomials follow maps of the coordinates."""

import numpy as np
import pytest
from body_moments.core.moments.affine_maps import apply_translation
from body_moments.core.moments.monomials import monomial_count, monomials


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
