# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Complex moments and their invariants, against sums over a few points of the plane."""

from itertools import product

import numpy as np
from body_moments.core.moments.complex_form import (
    ComplexBound,
    complex_moments,
    flusser_invariants,
    hu_invariants,
)
from body_moments.core.moments.raw import Moments, U, monomials

RNG = np.random.default_rng(7)
WEIGHTS, PLACES = (
    RNG.uniform(0.5, 1.0, 9),
    RNG.uniform(-1.0, 1.0, 9) + 1j * RNG.uniform(-1.0, 1.0, 9),
)


def of_points(order, places=PLACES, input_error=0.0):
    powers = monomials(order)
    terms = (
        WEIGHTS
        * places.real ** powers[:, :1]
        * places.imag ** powers[:, 1:2]
        * (powers[:, 2:] == 0)
    )
    raw = terms.sum(axis=1)
    bounds = 20.0 * U * np.abs(terms).sum(axis=1)
    return Moments(raw, np.zeros(3), "area", bounds, np.full_like(raw, input_error))


def truth(p, q, places=PLACES):
    return (WEIGHTS * places**p * places.conj() ** q).sum()


def test_complex_moments_are_sums_of_powers_of_the_places():
    found = complex_moments(of_points(12))
    assert list(found) == [(n - q, q) for n in range(13) for q in range(n // 2 + 1)]
    for (p, q), one in found.items():
        assert abs(one.value - truth(p, q)) <= one.bound <= 1e-11 and one.bound > 0.0
    moments = of_points(12)
    wider = complex_moments(moments, 2.0 * moments.rounding_error)
    assert all(
        wider[key].bound > found[key].bound and wider[key].value == found[key].value
        for key in found
    )


def test_products_are_within_bounds_for_inexact_factors():
    one, other = ComplexBound(2.0 - 1.0j, 0.25), ComplexBound(-0.5 + 3.0j, 0.125)
    both, cubed = one * other, one.power(3)
    assert both.value == one.value * other.value and abs(cubed.value - one.value**3) <= 1e-14
    assert one.power(0) == ComplexBound(1.0 + 0.0j, 0.0)
    assert (one.conjugate().value, one.conjugate().bound) == (2.0 + 1.0j, 0.25)
    worst = worst_cubed = 0.0
    for first, second in product(np.exp(2j * np.pi * np.arange(36) / 36), repeat=2):
        a, b = one.value + 0.25 * first, other.value + 0.125 * second
        worst, worst_cubed = (
            max(worst, abs(a * b - both.value)),
            max(worst_cubed, abs(a**3 - cubed.value)),
        )
    assert (
        0.98 * both.bound <= worst <= both.bound
        and 0.98 * cubed.bound <= worst_cubed <= cubed.bound
    )


def test_hu_invariants_match_his_paper():
    c20, c30, c21, c12 = (truth(*pair) for pair in ((2, 0), (3, 0), (2, 1), (1, 2)))
    expected = [truth(1, 1), abs(c20) ** 2, abs(c30) ** 2, abs(c21) ** 2]
    expected += [(c30 * c12**3).real, (c20 * c12**2).real, (c30 * c12**3).imag]
    found = hu_invariants(of_points(5, input_error=1e-6))
    assert [one.name for one in found] == ["φ1", "φ2", "φ3", "φ4", "φ5", "φ6", "φ7"]
    assert [one.degree for one in found] == [2, 2, 3, 3, 3, 3, 3] and not any(
        one.is_complex for one in found
    )
    for one, value in zip(found, expected):
        assert abs(one.value - value) <= one.rounding_error < 1e-12 < 1e-6 < one.input_error < 1e-3
        assert one.value.imag == 0.0


def test_flusser_s_basis_to_order_twelve_with_its_names():
    found = flusser_invariants(of_points(12, input_error=1e-9))
    pairs = [(n - q, q) for n in range(2, 13) for q in range(n // 2 + 1)]
    digits = dict(zip("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    c12 = truth(1, 2)
    for one, (p, q) in zip(found, pairs, strict=True):
        expected = truth(p, q) * c12 ** (p - q)
        assert abs(one.value - expected) <= one.rounding_error <= 1e-10 * (1.0 + abs(expected))
        power = "".join(digits[digit] for digit in str(p - q)) if p - q > 1 else ""
        first = "c{},{}".format(p, q) if p > 9 else "c{}{}".format(p, q)
        assert one.name == (first if p == q else "{} c12{}".format(first, power))
        assert one.is_complex == (p > q) and one.degree == (
            2 if (p, q) == (1, 1) else max(p + q, 3 if p > q else 2)
        )
        assert one.input_error > 0.0
    assert {"c11", "c21 c12", "c20 c12²", "c10,2 c12⁸", "c12,0 c12¹²"} <= {
        one.name for one in found
    }
