# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polynomials that are typed: what is taken, what is refused and how, and bounds that hold."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density.polynomial import HIGHEST, Polynomial, parse
from hypothesis import given, settings
from hypothesis import strategies as st

SMALL = st.integers(-5, 5).map(float)


@pytest.mark.parametrize(
    "text, terms",
    [
        ("1000 + 20*z", {(0, 0, 0): 1000, (0, 0, 1): 20}),
        (" -x ", {(1, 0, 0): -1}),
        ("0.1", {(0, 0, 0): Fraction(1, 10)}),
        ("1e-3*x", {(1, 0, 0): Fraction(1, 1000)}),
        ("(x + y)**2 - x**2 - 2*x*y", {(0, 2, 0): 1}),
        ("x/3 + +y", {(1, 0, 0): Fraction(1, 3), (0, 1, 0): 1}),
        ("x - x", {}),
        ("2**3*z", {(0, 0, 1): 8}),
        ("x**0", {(0, 0, 0): 1}),
        ("z/(1 + 1)", {(0, 0, 1): Fraction(1, 2)}),
        ("1000, 0, 0, 20", {(0, 0, 0): 1000, (0, 0, 1): 20}),
        ("[1, 2, 0, 0, 0, 0, 0, 0, -3/2]", {(0, 0, 0): 1, (1, 0, 0): 2, (0, 1, 1): Fraction(-3, 2)}),
        ("x**17", {(17, 0, 0): 1}),
    ],
)
def test_what_is_typed_is_taken_exactly(text, terms):
    assert parse(text).terms == terms


@pytest.mark.parametrize(
    "text, told",
    [
        ("", "There is no polynomial"),
        ("20z", "needs its \\*"),
        ("1000 +", "cannot be read"),
        ("1000 + sin(z)", "“sin\\(z\\)” cannot be part"),
        ("1000 + w", "“w” is none of x, y, z"),
        ("x**y", "“y” must be a number"),
        ("x**2.5", "“x\\*\\*2.5” has an exponent"),
        ("x**-1", "has an exponent"),
        ("x**18", "from 0 to 17"),
        ("(x*y)**9", "degree above 17"),
        ("1/x", "“x” must be a number"),
        ("z/0", "divides by zero"),
        ("x^2", "a power is written \\*\\*"),
        ("x if y else z", "cannot be part"),
        ("__import__('os').system('true')", "cannot be part"),
        ("x.real", "“x.real” cannot be part"),
        ("True*x", "“True” cannot be part"),
        ("2j", "“2j” cannot be part"),
        ("'a'", "cannot be part"),
        ("lambda: 1", "cannot be part"),
        ("x := 1", "cannot be read"),
        ("x; y", "cannot be read"),
        ("1e999", "“1e999” is too large"),
        ("0x" + "f" * 4000, "too large or too small"),
        ("1e-300*x", "too large or too small"),
        ("((9**17)**17)**17", "too large or too small"),
        ("x // 2", "cannot be part"),
        ("1, x", "“x” must be a number"),
        ("(" * 900 + "x" + ")" * 900, "cannot be read"),
        ("x" + "+x" * 2000, "cannot be read|nested too deeply"),
        ("+".join(["x"] * 5000), "too long"),
        (", ".join(["1"] * 1141), "too many coefficients|too long"),
        ("x\0", "cannot be read"),
        ("\ufeffx", "cannot be read"),
    ],
)
def test_anything_else_is_refused_and_the_offending_part_named(text, told):
    with pytest.raises(ValueError, match=told) as refusal:
        parse(text)
    message = str(refusal.value)
    assert len(message) < 300 and message.endswith(".") and message[0] in "TAa“"


@settings(deadline=None)
@given(st.lists(SMALL, min_size=1, max_size=20), st.tuples(SMALL, SMALL, SMALL), st.tuples(SMALL, SMALL, SMALL))
def test_a_shift_is_exact(coefficients, point, place):
    """Small integers need no rounding, so the two values are equal to the bit."""
    polynomial = Polynomial.from_coefficients(coefficients)
    point, place = np.array(point), np.array(place)
    assert polynomial.shifted(point)([place])[0] == polynomial([point + place])[0]


def test_coefficients_come_back():
    values = np.arange(1.0, 21.0)
    assert np.array_equal(Polynomial.from_coefficients(values).coefficients(), values)
    assert Polynomial.from_coefficients(values).degree == 3
    assert parse("0").degree == 0 and np.array_equal(parse("0").coefficients(), [0.0])
    for value in (np.nan, np.inf):
        with pytest.raises(ValueError, match="are finite numbers"):
            Polynomial.from_coefficients([1.0, value])


@settings(deadline=None)
@given(
    st.lists(SMALL, min_size=1, max_size=35),
    st.tuples(SMALL, SMALL, SMALL),
    st.tuples(SMALL, SMALL, SMALL),
    st.integers(0, 2**31),
)
def test_nothing_on_a_box_is_below_the_bound(coefficients, one, other, seed):
    polynomial = Polynomial.from_coefficients(coefficients)
    low, high = np.minimum(one, other), np.maximum(one, other)
    bound = polynomial.lower_bound(low, high)
    places = low + (high - low) * np.random.default_rng(seed).random((200, 3))
    assert bound <= polynomial(places).min() + 1e-11 * (1.0 + abs(bound))
    assert bound <= polynomial(np.array([low, high])).min() + 1e-11 * (1.0 + abs(bound))


@pytest.mark.parametrize("text", ["x**2 + 0.01", "(x - y)**2 + z + 1.01", "x**4 - x**2 + 0.26", "1000 + 999*z"])
def test_what_is_positive_is_proven_so(text):
    assert parse(text).lower_bound((-1, -1, -1), (1, 1, 1)) > 0.0


@pytest.mark.parametrize(
    "text",
    [
        "z**2",
        "(x - 0.3)**2*(x + 0.7)**2",
        "(1 - z**2)**2",
        "(x*y)**2",
        "(x - 0.4)**2 + 100*z**4",
        "(x**2 + y**2)*z**2",
        "(x - 0.4)**2*(y - 0.2)**2*(z + 0.1)**2",
    ],
)
def test_what_touches_zero_on_planes_and_lines_is_told_from_what_is_negative(text):
    """Halved along each axis in turn, a thousandth of the largest value was left in doubt."""
    assert 0.0 > parse(text).lower_bound((-1.1, -1.2, -1.3), (1, 1.25, 1.5)) > -2e-7


def test_what_is_negative_somewhere_is_never_proven_positive():
    assert parse("x**2 - 1e-6").lower_bound((-1, -1, -1), (1, 1, 1)) < 0.0
    assert parse("1 - x**17").lower_bound((0, 0, 0), (1.001, 0, 0)) < 0.0
    assert parse("x").lower_bound((2, 2, 2), (2, 2, 2)) == pytest.approx(2.0)


def test_values_beyond_the_range_of_numbers_are_refused():
    with pytest.raises(ValueError, match="beyond the range of numbers"):
        parse("z**17").lower_bound((0, 0, 1e30), (0, 0, 2e30))


def test_the_highest_degree_works():
    polynomial = parse("(1 + x + y + z)**{:d}".format(HIGHEST))
    assert polynomial([[1, 1, 1]])[0] == pytest.approx(4.0**HIGHEST, rel=1e-13)
    assert polynomial.shifted((0.5, 0.25, -1.0))([[0.5, 0.75, 2.0]])[0] == pytest.approx(4.0**HIGHEST, rel=1e-13)


def test_coefficients_that_are_not_finite_are_refused():
    for value in (float("inf"), float("nan")):
        with pytest.raises(ValueError, match="finite"):
            Polynomial.from_coefficients([1.0, value])
