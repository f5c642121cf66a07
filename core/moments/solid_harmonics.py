# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments against solid harmonics, ∫ r^(2j) conj(r^l Y_lm) dV, from raw moments: they turn degree
by degree.

Under a rotation the 2l+1 of them with one j and l mix among themselves only, by Wigner's unitary
matrix; so their sum of squares is invariant, and so is any coupling of three of them to l = 0 (with
3j symbols). Y_lm are orthonormal, with the Condon-Shortley phase, and their polynomials are
(Varshalovich et al., Quantum Theory of Angular Momentum, 5.1)

    r^l Y_lm = sqrt((2l+1)/4π (l+m)! (l-m)!)
               Σ_k (-(x+iy)/2)^(k+m) ((x-iy)/2)^k z^(l-m-2k) / ((k+m)! k! (l-m-2k)!).
"""

from __future__ import annotations

from functools import lru_cache
from math import comb, factorial, pi, sqrt

import numpy as np

from ..numerics import Array, Complex, Index, NDArray
from .exponents import monomial_count, monomial_index, product_indices

Multiplets = dict[tuple[int, int], Complex]


def harmonic_moments(raw: NDArray, order: int) -> Multiplets:
    """Return {(n, l): (2l+1, …)} ∫ r^(n-l) conj(r^l Y_lm) for l ≤ n ≤ order, n-l even, from raw (K,
    …) moments.
    """
    result = {}
    for j in range(order // 2 + 1):
        for l in range(order - 2 * j + 1):
            block = raw[monomial_count(l - 1) : monomial_count(l)]
            half = np.add.reduce(along_first(_solid(l).conj(), block) * block, axis=1)  # m = 0..l
            result[l + 2 * j, l] = with_negative_orders(half)
        if order - 2 * j >= 2:
            products = zip(product_indices(order - 2 * j), product_indices(order - 2 * j - 1))
            # ∫ r² f for all f two orders lower: the rows of f x², f y² and f z² are added.
            raw = raw[np.array([twice[once] for twice, once in products])].sum(axis=0)
    return result


def along_first(table: NDArray, values: NDArray) -> NDArray:
    """Return `table` with trailing axes of length 1, so that it multiplies `values` along their
    first axis.
    """
    return table.reshape(*table.shape, *[1] * (values.ndim - 1))


def with_negative_orders(half: Complex) -> Complex:
    """Return (2l+1, …) for m = -l..l from (l+1, …) for m = 0..l: c[-m] = (-1)^m conj(c[m])."""
    sign = ((-1.0) ** np.arange(len(half) - 1, 0, -1)).reshape(-1, *[1] * (half.ndim - 1))
    return np.concatenate([half[:0:-1].conj() * sign, half])


def couple(a: NDArray, b: NDArray, c: NDArray) -> Array:
    """Return (…) Σ (l l' l''; m m' m'') a_m b_m' c_m'' of multiplets (2l+1, …); a pseudoscalar for
    odd l + l' + l''.
    """
    l, k, n = ((len(multiplet) - 1) // 2 for multiplet in (a, b, c))
    symbols, (i, j, m) = _nonzero_three_j(l, k, n)
    value = np.add.reduce(along_first(symbols, a) * a[i] * b[j] * c[m])
    return value.imag if (l + k + n) % 2 else value.real


@lru_cache
def _solid(l: int) -> Complex:
    """Return the (l+1, (l+1)(l+2)/2) coefficients of r^l Y_lm for m = 0..l in the ordered monomials
    of degree l.
    """
    start = monomial_count(l - 1)
    table = np.zeros((l + 1, monomial_count(l) - start), complex)
    for m in range(l + 1):
        norm = sqrt((2 * l + 1) / (4.0 * pi) * factorial(l + m) * factorial(l - m))
        for k in range((l - m) // 2 + 1):
            factor = (
                (-1.0) ** (k + m)
                / 2.0 ** (2 * k + m)
                / (factorial(k + m) * factorial(k) * factorial(l - m - 2 * k))
            )
            for i, value in enumerate(circular_coefficients(k + m, k)):
                table[m, monomial_index(2 * k + m - i, i, l - m - 2 * k) - start] += (
                    norm * factor * value
                )
    table.flags.writeable = False
    return table


@lru_cache(maxsize=1024)
def circular_coefficients(plus: int, minus: int) -> tuple[complex, ...]:
    """Return the coefficients of x^(n-i) y^i, i = 0..n, in (x+iy)^plus (x-iy)^minus."""
    plus_powers = [comb(plus, i) * 1j ** (i % 4) for i in range(plus + 1)]
    minus_powers = [comb(minus, i) * (-1j) ** (i % 4) for i in range(minus + 1)]
    return tuple(np.convolve(plus_powers, minus_powers).tolist())


@lru_cache(maxsize=256)
def _nonzero_three_j(a: int, b: int, c: int) -> tuple[Array, tuple[Index, ...]]:
    """Return the nonzero Wigner 3j symbols and their indices."""
    table = _three_j(a, b, c)
    return table[table != 0.0], np.nonzero(table)


def _three_j(a: int, b: int, c: int) -> Array:
    """Return (2a+1, 2b+1, 2c+1) Wigner's 3j symbols, by Racah's sum."""
    table = np.zeros((2 * a + 1, 2 * b + 1, 2 * c + 1))
    triangle = (
        factorial(a + b - c)
        * factorial(a - b + c)
        * factorial(-a + b + c)
        / factorial(a + b + c + 1)
    )
    for i in range(-a, a + 1):
        for j in range(max(-b, -c - i), min(b, c - i) + 1):
            k = -i - j
            total = sum(
                (-1) ** t
                / (
                    factorial(t)
                    * factorial(c - b + t + i)
                    * factorial(c - a + t - j)
                    * factorial(a + b - c - t)
                    * factorial(a - t - i)
                    * factorial(b - t + j)
                )
                for t in range(max(0, b - c - i, a - c + j), min(a + b - c, a - i, b + j) + 1)
            )
            size = (
                factorial(a + i)
                * factorial(a - i)
                * factorial(b + j)
                * factorial(b - j)
                * factorial(c + k)
                * factorial(c - k)
            )
            table[a + i, b + j, c + k] = (-1) ** (a - b - k) * sqrt(triangle * size) * total
    return table
