# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Zernike moments of a plane shape in a disc (Zernike 1934; Teague 1980 for shapes).

A_nm = sqrt((n+1)/π) ∫ R_nm(r) exp(-imφ) dA over the disc of radius 1, orthonormal: the sum of all |A_nm|², m = -n..n,
is at most the shape's area. Turned by θ a shape has A_nm exp(-imθ), and its mirror image in y = 0 has conj(A_nm).
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from ..moments.complex_form import complex_moments
from ..moments.exponents import monomials
from ..moments.moments import Moments

MAX_DISC_ORDER = 20  # the highest order that raw moments in float64 give


@lru_cache
def disc_degrees(order: int) -> tuple[tuple[int, int], ...]:
    """Return (n, m) for 0 ≤ m ≤ n ≤ order with n-m even, n first."""
    return tuple((n, m) for n in range(order + 1) for m in range(n % 2, n + 1, 2))


def disc_zernike(moments: Moments, radius: float) -> NDArray[np.complex128]:
    """Return (k,) A_nm, ordered as `disc_degrees`, of a shape by area moments about the disc's center, with z = 0."""
    degree = monomials(moments.order).sum(axis=1)
    scaled = Moments(moments.raw / radius ** (degree + 2.0), moments.about, moments.measure)
    c = {key: entry.value for key, entry in complex_moments(scaled).items()}
    return np.array(
        [
            sqrt((n + 1) / pi) * sum(factor * c[(s + m) // 2, (s - m) // 2].conjugate() for s, factor in _radial(n, m))
            for n, m in disc_degrees(moments.order)
        ]
    )


@lru_cache
def _radial(n: int, m: int) -> list[tuple[int, float]]:
    """Return (s, the coefficient of r^s) of R_nm."""
    return [
        (
            n - 2 * k,
            float(
                (-1) ** k
                * factorial(n - k)
                // (factorial(k) * factorial((n + m) // 2 - k) * factorial((n - m) // 2 - k))
            ),
        )
        for k in range((n - m) // 2 + 1)
    ]
