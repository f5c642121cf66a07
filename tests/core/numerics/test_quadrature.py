# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules are exact to the degree they are for, and no further."""

from math import factorial

import numpy as np
import pytest
from body_moments.core.numerics.quadrature import (
    gauss_legendre,
    gauss_legendre_with_ends,
    triangle_rule,
)

from tests.close import close


@pytest.mark.parametrize("points", range(1, 13))
def test_a_rule_on_a_unit_length_is_exact_to_its_degree(points):
    nodes, weights = gauss_legendre(points)
    assert (weights > 0.0).all() and (np.diff(nodes) > 0.0).all()
    for degree in range(2 * points):
        assert close(weights @ nodes**degree, 1.0 / (degree + 1), 1e-14)
    assert not close(weights @ nodes ** (2 * points), 1.0 / (2 * points + 1), 1e-13)
    with_ends, more = gauss_legendre_with_ends(points)
    assert with_ends.tolist() == [0.0, *nodes, 1.0] and more.tolist() == [0.0, *weights, 0.0]
    # they are kept
    assert not any(row.flags.writeable for row in (nodes, weights, with_ends, more))


def test_a_rule_of_many_points_is_exact_to_rounding():
    nodes, weights = gauss_legendre(27)
    for degree in range(54):
        assert abs(weights @ nodes**degree - 1.0 / (degree + 1)) <= 1e-14


@pytest.mark.parametrize("n", [*range(1, 11), 24])
def test_a_rule_over_a_triangle_is_exact_to_its_degree(n):
    """∫ a^i b^j c^k = i! j! k! / (i + j + k + 2)!, of barycentric coordinates."""
    places, weights = triangle_rule(n)
    assert places.shape == (3, len(weights)) and len(weights) == (7 if n == 3 else n * n)
    assert (weights > 0.0).all() and (places > 0.0).all() and close(places.sum(axis=0), 1.0, 1e-14)
    for degree in range(2 * n):
        for i in range(degree + 1):
            for j in range(degree - i + 1):
                powers = (i, j, degree - i - j)
                found = weights @ np.prod(places ** np.array(powers)[:, None], axis=0)
                truth = np.prod([float(factorial(power)) for power in powers]) / factorial(
                    degree + 2
                )
                assert close(found, truth, 1e-13)
    off = [
        weights @ place ** (2 * n) - factorial(2 * n) / factorial(2 * n + 2)
        for place in (*places, places[0] - places[1])
    ]
    assert n > 10 or max(map(abs, off)) > 1e-14  # rules of more points miss by less
