# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums and products with their rounding errors, against rational numbers."""

from fractions import Fraction

import mpmath
import numpy as np
from body_moments.core.numerics.compensated import (
    compensated_normals,
    phase_factors,
    two_product,
    two_sum,
)

RNG = np.random.default_rng(6)


def any_size(shape, octaves):
    return RNG.uniform(-2.0, 2.0, shape) * 2.0 ** RNG.integers(-octaves, octaves, shape)


def rational(values):
    return list(map(Fraction, np.asarray(values).tolist()))


def test_a_sum_and_a_product_with_their_rests_are_exact():
    for octaves in (1, 60, 400):
        a, b = any_size((2, 2000), octaves)
        b[:500] = -a[:500] * (1.0 + RNG.integers(-4, 4, 500) * 2.0**-51)  # these sums cancel
        total, rest = map(rational, two_sum(a, b))
        product, low = map(rational, two_product(a, b))
        a, b = rational(a), rational(b)
        assert all(one + more == x + y for one, more, x, y in zip(total, rest, a, b))
        assert all(one + more == x * y for one, more, x, y in zip(product, low, a, b))


def test_the_normal_of_a_thin_triangle_has_all_its_digits():
    start, way = any_size((2, 3, 300), 2)
    a, b, c = (start + share * way + any_size((3, 300), 2) * 2.0**-40 for share in (0.0, 1.0, 0.5))
    found = compensated_normals(a, b, c)
    for column in range(300):
        p, q, r = (rational(corner[:, column]) for corner in (a, b, c))
        u, v = [x - y for x, y in zip(q, p)], [x - y for x, y in zip(r, p)]
        exact = [u[i] * v[j] - u[j] * v[i] for i, j in ((1, 2), (2, 0), (0, 1))]
        assert all(
            abs(Fraction(float(one)) - truth) <= abs(truth) * Fraction(1, 2**50)
            for one, truth in zip(found[:, column], exact)
        )


def test_phase_of_a_million_turns_keeps_its_accuracy():
    for dimension in (2, 3):
        q, x = any_size((200, dimension), 2) * 1e6, any_size(dimension, 2)
        for found, row in zip(phase_factors(q, x), q.tolist()):
            with mpmath.workdps(40):
                truth = mpmath.expj(-mpmath.fdot(row, x.tolist()))
            assert abs(found - complex(truth)) <= 1e-14
