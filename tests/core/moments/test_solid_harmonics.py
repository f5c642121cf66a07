# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solid harmonics of single points against their polynomials, and the symbols that couple them
against known ones.
"""

from math import pi, sqrt

import numpy as np
import pytest
from body_moments.core.moments import exponents, solid_harmonics

from tests.close import close

POINT = np.array([0.7, -1.1, 0.4])
X, Y, Z = POINT
W, R2 = X + 1j * Y, float(POINT @ POINT)
# r^l Y_lm for m = 0..l, with the Condon-Shortley phase
KNOWN = {
    0: [sqrt(1 / (4 * pi))],
    1: [sqrt(3 / (4 * pi)) * Z, -sqrt(3 / (8 * pi)) * W],
    2: [
        sqrt(5 / (16 * pi)) * (3 * Z * Z - R2),
        -sqrt(15 / (8 * pi)) * W * Z,
        sqrt(15 / (32 * pi)) * W**2,
    ],
    3: [
        sqrt(7 / (16 * pi)) * Z * (5 * Z * Z - 3 * R2),
        -sqrt(21 / (64 * pi)) * W * (5 * Z * Z - R2),
        sqrt(105 / (32 * pi)) * W**2 * Z,
        -sqrt(35 / (64 * pi)) * W**3,
    ],
}


@pytest.mark.parametrize("order", range(9))
def test_harmonic_moments_of_a_point_are_solid_harmonics(order):
    found = solid_harmonics.harmonic_moments(
        np.prod(POINT ** exponents.monomials(order), axis=1), order
    )
    assert set(found) == {(n, l) for n in range(order + 1) for l in range(n % 2, n + 1, 2)}
    for (n, l), values in found.items():
        assert values.shape == (2 * l + 1,)
        assert close((np.abs(values) ** 2).sum(), (2 * l + 1) / (4 * pi) * R2**n, 1e-12)  # Unsöld
        if l in KNOWN:
            wanted = np.conj(KNOWN[l]) * R2 ** ((n - l) // 2)
            assert np.abs(values[l:] - wanted).max() <= 1e-14 * R2 ** (n / 2.0)
            mirrored = (-1.0) ** np.arange(l + 1) * np.conj(wanted)
            assert np.abs(values[l::-1] - mirrored).max() <= 1e-14 * R2 ** (n / 2.0)


@pytest.mark.parametrize(
    "l, k, n", [(0, 0, 0), (1, 1, 0), (1, 1, 1), (2, 1, 1), (2, 2, 2), (3, 2, 1), (4, 3, 5)]
)
def test_three_j_symbols_are_orthonormal(l, k, n):
    table = solid_harmonics._three_j(l, k, n)
    assert table.shape == (2 * l + 1, 2 * k + 1, 2 * n + 1)
    assert (
        np.abs(np.einsum("ijm,ijp->mp", table, table) - np.eye(2 * n + 1) / (2 * n + 1)).max()
        <= 1e-14
    )
    i, j, m = np.nonzero(table)
    assert (i - l + j - k + m - n == 0).all()


def test_three_j_symbols_match_tables():
    known = {
        (1, 1, 0, 0, 0): -1.0 / sqrt(3.0),
        (2, 1, 1, 0, 0): sqrt(2.0 / 15.0),
        (1, 1, 1, 1, -1): 1.0 / sqrt(6.0),
        (2, 2, 2, 0, 0): -sqrt(2.0 / 35.0),
        (2, 1, 1, 2, -1): 1.0 / sqrt(5.0),
    }
    for (l, k, n, i, j), value in known.items():
        assert close(solid_harmonics._three_j(l, k, n)[l + i, k + j, n - i - j], value, 1e-14)
