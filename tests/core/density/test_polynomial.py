# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Typed polynomials: accepted and refused texts, and bounds that hold."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density.findings import POLYNOMIAL_BEYOND_NUMBERS, POLYNOMIAL_TOO_LONG
from body_moments.core.density.polynomial import MAX_DEGREE, Polynomial, parse_polynomial
from body_moments.core.verdict import MeasureError
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.findings import refused

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
        (
            "[1, 2, 0, 0, 0, 0, 0, 0, -3/2]",
            {(0, 0, 0): 1, (1, 0, 0): 2, (0, 1, 1): Fraction(-3, 2)},
        ),
        ("x**17", {(17, 0, 0): 1}),
    ],
)
def test_typed_number_is_taken_exactly(text, terms):
    assert parse_polynomial(text).terms == terms


def test_a_text_may_have_4096_characters_between_spaces():
    longest = "1 +" + " " * 4092 + "2"
    assert parse_polynomial("  " + longest + "\n").coefficients().tolist() == [3.0]
    with pytest.raises(MeasureError) as refusal:
        parse_polynomial(longest.replace("+", "+ "))
    assert refusal.value.finding.values["fault"] == POLYNOMIAL_TOO_LONG


@pytest.mark.parametrize(
    "text, code, part",
    [
        ("", "polynomial_unusable", None),
        ("20z", "polynomial_part", None),
        ("1000 +", "polynomial_part", "1000 +"),
        ("1000 + sin(z)", "polynomial_part", "sin(z)"),
        ("1000 + w", "polynomial_part", "w"),
        (") + x", "polynomial_part", ") + x"),
        ("1 + ) + 2" + 9 * "3", "polynomial_part", ") + 2" + 9 * "3"),
        ("1 + ) + 2" + 99 * "3", "polynomial_part", ") + 2" + 15 * "3"),
        ("(1 +\n+ ]", "polynomial_part", None),
        ("sin({})".format(35 * "x"), "polynomial_part", "sin({})".format(35 * "x")),
        ("sin({})".format(36 * "x"), "polynomial_part", "sin({}…".format(35 * "x")),
        ("x**y", "polynomial_part", "y"),
        ("x**2.5", "polynomial_degree", "x**2.5"),
        ("x**-1", "polynomial_degree", "x**-1"),
        ("x**18", "polynomial_degree", "x**18"),
        ("(x*y)**9", "polynomial_degree", "(x*y)**9"),
        ("1/x", "polynomial_part", "x"),
        ("z/0", "polynomial_part", "z/0"),
        ("x^2", "polynomial_part", "x^2"),
        ("x if y else z", "polynomial_part", None),
        ("__import__('os').system('true')", "polynomial_part", None),
        ("x.real", "polynomial_part", "x.real"),
        ("True*x", "polynomial_part", "True"),
        ("2j", "polynomial_part", "2j"),
        ("'a'", "polynomial_part", "'a'"),
        ("lambda: 1", "polynomial_part", None),
        ("x := 1", "polynomial_part", None),
        ("x; y", "polynomial_part", None),
        ("1e999", "polynomial_part", "1e999"),
        ("0x" + "f" * 4000, "polynomial_part", None),
        ("1e-300*x", "polynomial_part", "1e-300"),
        ("((9**17)**17)**17", "polynomial_part", None),
        ("x // 2", "polynomial_part", "x // 2"),
        ("1, x", "polynomial_part", "x"),
        ("(" * 900 + "x" + ")" * 900, "polynomial_part|polynomial_unusable", None),
        ("x" + "+x" * 2000, "polynomial_part|polynomial_unusable", None),
        ("+".join(["x"] * 5000), "polynomial_unusable", None),
        (", ".join(["1"] * 1141), "polynomial_degree", None),
        ("x\0", "polynomial_part|polynomial_unusable", None),
        ("\ufeffx", "polynomial_part|polynomial_unusable", None),
    ],
)
def test_anything_else_is_refused_and_the_offending_part_named(text, code, part):
    with pytest.raises(MeasureError) as refusal:
        parse_polynomial(text)
    finding = refusal.value.finding
    assert finding.code in code.split("|")
    assert part is None or finding.values["part"] == part
    assert finding.values.get("limit", 17) == 17
    assert len(str(refusal.value)) < 300


@settings(deadline=None)
@given(
    st.lists(SMALL, min_size=1, max_size=20),
    st.tuples(SMALL, SMALL, SMALL),
    st.tuples(SMALL, SMALL, SMALL),
)
def test_a_shift_is_exact(coefficients, point, place):
    """Small integers need no rounding, so the two values are equal to the bit."""
    typed = Polynomial.from_list([*map(Fraction, coefficients)])
    point, place = np.array(point), np.array(place)
    assert typed.translate(point)([place])[0] == typed([point + place])[0]


def test_coefficients_come_back():
    values = np.arange(1.0, 21.0)
    found = Polynomial.from_list([*map(Fraction, values)])
    assert np.array_equal(found.coefficients(), values) and found.degree == 3
    assert parse_polynomial("0").degree == 0 and np.array_equal(
        parse_polynomial("0").coefficients(), [0.0]
    )


@settings(deadline=None)
@given(
    st.lists(SMALL, min_size=1, max_size=35),
    st.tuples(SMALL, SMALL, SMALL),
    st.tuples(SMALL, SMALL, SMALL),
    st.integers(0, 2**31),
)
def test_polynomial_on_a_box_stays_above_its_bound(coefficients, one, other, seed):
    typed = Polynomial.from_list([*map(Fraction, coefficients)])
    low, high = np.minimum(one, other), np.maximum(one, other)
    bound = typed.lower_bound(low, high)
    places = low + (high - low) * np.random.default_rng(seed).random((200, 3))
    assert bound <= typed(places).min() + 1e-11 * (1.0 + abs(bound))
    assert bound <= typed(np.array([low, high])).min() + 1e-11 * (1.0 + abs(bound))


@pytest.mark.parametrize(
    "text", ["x**2 + 0.01", "(x - y)**2 + z + 1.01", "x**4 - x**2 + 0.26", "1000 + 999*z"]
)
def test_positive_polynomial_is_proven_positive(text):
    assert parse_polynomial(text).lower_bound((-1, -1, -1), (1, 1, 1)) > 0.0


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
def test_polynomial_touching_zero_differs_from_negative_one(text):
    """Halved along each axis in turn, a thousandth of the largest value was left in doubt."""
    assert 0.0 > parse_polynomial(text).lower_bound((-1.1, -1.2, -1.3), (1, 1.25, 1.5)) > -2e-7


def test_negative_polynomial_is_never_proven_positive():
    assert parse_polynomial("x**2 - 1e-6").lower_bound((-1, -1, -1), (1, 1, 1)) < 0.0
    assert parse_polynomial("1 - x**17").lower_bound((0, 0, 0), (1.001, 0, 0)) < 0.0
    assert parse_polynomial("x").lower_bound((2, 2, 2), (2, 2, 2)) == pytest.approx(2.0)


def test_values_beyond_the_range_of_numbers_are_refused():
    with refused("polynomial_unusable", fault=POLYNOMIAL_BEYOND_NUMBERS):
        parse_polynomial("z**17").lower_bound((0, 0, 1e30), (0, 0, 2e30))


def test_the_highest_degree_works():
    typed = parse_polynomial("(1 + x + y + z)**{:d}".format(MAX_DEGREE))
    assert typed([[1, 1, 1]])[0] == pytest.approx(4.0**MAX_DEGREE, rel=1e-13)
    assert typed.translate((0.5, 0.25, -1.0))([[0.5, 0.75, 2.0]])[0] == pytest.approx(
        4.0**MAX_DEGREE, rel=1e-13
    )
