# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polynomials in x, y, z that a person types as a density: read safely, kept exactly, bounded on a
box.

Coefficients are rational numbers, so that a polynomial can be expanded about any point without
rounding: each coefficient is rounded once, when it is used. An expression is parsed by `ast`, and
only syntax named in `parse_polynomial` is accepted; nothing is evaluated.

On a box a polynomial lies between the least and the largest of its Bernstein coefficients (G. T.
Cargo and O. Shisha, "The Bernstein form of a polynomial", J. Res. Nat. Bur. Standards 70B, 1966);
halving the box brings the two closer.
"""

from __future__ import annotations

import ast
import heapq
import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np

from ..moments import U
from ..moments.exponents import monomial_count, monomial_index, monomials, order_from_count
from ..numerics import Array, ArrayLike, NDArray, power_table
from ..verdict import MeasureError
from .findings import (
    POLYNOMIAL_BEYOND_NUMBERS,
    POLYNOMIAL_DEGREE,
    POLYNOMIAL_EMPTY,
    POLYNOMIAL_NOT_ALLOWED,
    POLYNOMIAL_PART,
    POLYNOMIAL_TOO_LONG,
    POLYNOMIAL_UNREADABLE,
    POLYNOMIAL_UNUSABLE,
)

MAX_DEGREE = 17  # mass moments to order 3 then need those of the body to order 20
MAX_LENGTH = 4096  # bits of a number, and characters of a text
MAX_EXPONENT = 664  # largest power of two by which numbers may be large or small: 1e200
POINTS_PER_BLOCK = 1 << 15  # points that are evaluated together
MAX_BOXES = 600  # boxes that are halved for a bound
Exponents = tuple[int, int, int]
VARIABLES: dict[str, Exponents] = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
CORNERS = tuple(product((0, -1), repeat=3))


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A polynomial density with exact nonzero coefficients by (p, q, r); call it with (n, 3) points
    for its values.
    """

    terms: dict[Exponents, Fraction]

    @classmethod
    def from_list(cls, values: list[Fraction]) -> Polynomial:
        """Make a polynomial from exact coefficients of 1, x, y, z, x², xy, xz, y², yz, z², and so
        on.
        """
        rows = monomials(order_from_count(len(values))).tolist()
        return cls({tuple(row): value for row, value in zip(rows, values) if value})

    @property
    def degree(self) -> int:
        """The largest p+q+r; 0 if there are no terms."""
        return max((sum(powers) for powers in self.terms), default=0)

    def coefficients(self) -> Array:
        """Return (K,) coefficients in the order of `monomials`, each rounded once."""
        values = np.zeros(monomial_count(self.degree))
        for powers, value in self.float_terms().items():
            values[monomial_index(*powers)] = value
        return values

    def float_terms(self) -> dict[Exponents, float]:
        """Return the terms, each rounded once; MeasureError if one is beyond the range of
        numbers.
        """
        try:
            return {powers: float(value) for powers, value in self.terms.items()}
        except OverflowError as error:
            raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_BEYOND_NUMBERS) from error

    def translate(self, point: ArrayLike) -> Polynomial:
        """Return the polynomial q with q(u) = p(point + u), exactly."""
        terms = self.terms
        for axis, value in enumerate(np.asarray(point, float).tolist()):
            if value:
                terms = _translate(terms, axis, Fraction(value))
        return Polynomial(terms)

    def __call__(self, points: NDArray) -> Array:
        """Return the (n,) values at (n, 3) points."""
        points = np.asarray(points, np.float64)
        coefficients = self.coefficients()
        result = np.zeros(len(points))
        for start in range(0, len(points), POINTS_PER_BLOCK):
            part = points[start : start + POINTS_PER_BLOCK].T
            powers = [power_table(row, self.degree) for row in part]
            for (p, q, r), value in zip(monomials(self.degree), coefficients):
                if value:
                    result[start : start + POINTS_PER_BLOCK] += (
                        value * powers[0][p] * powers[1][q] * powers[2][r]
                    )
        return result

    def lower_bound(self, low: ArrayLike, high: ArrayLike) -> float:
        """Return a lower bound of the polynomial on a box, less rounding; boxes are halved as long
        as that may help.
        """
        low = np.asarray(low, float)
        high = np.asarray(high, float)
        local = self.translate(low).coefficients()
        top = monomials(self.degree)
        net = np.zeros((self.degree + 1,) * 3)
        net[tuple(top.T)] = local * np.multiply.reduce((high - low) ** top, axis=1)
        tolerance = 64.0 * U * (self.degree + 1) * float(np.abs(net).sum())
        every = range(self.degree + 1)
        bernstein = np.array(
            [[math.comb(i, j) / math.comb(self.degree, j) for j in every] for i in every]
        )
        for axis in range(3):  # from coefficients of t^j to Bernstein coefficients on [0, 1]
            net = np.moveaxis(np.tensordot(bernstein, net, (1, axis)), 0, axis)
        # a heap: the least bound first; the number breaks ties
        boxes = [(float(net.min()), 0, net)]
        for number in range(1, 2 * MAX_BOXES, 2):
            least, _, net = boxes[0]
            # corners of the net are values
            if least >= -tolerance or min(net[corner] for corner in CORNERS) < 0.0:
                break
            heapq.heappop(boxes)
            # Second differences bound the net's distance from the polynomial.
            curved = int(np.argmax([np.abs(np.diff(net, 2, axis)).max() for axis in range(3)]))
            for i, half in enumerate(_halves(net, curved)):
                heapq.heappush(boxes, (float(half.min()), number + i, half))
        return boxes[0][0] - tolerance


def parse_polynomial(text: str) -> Polynomial:
    """Parse a typed polynomial, such as ``1000 + 20*z``, or coefficients.

    MeasureError names a wrong part.
    """
    text = text.strip()
    if not text:
        raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_EMPTY)
    if len(text) > MAX_LENGTH:
        raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_TOO_LONG)
    try:
        tree = ast.parse(text, mode="eval").body
    except (SyntaxError, ValueError) as error:
        start = (
            max((error.offset or 1) - 1, 0)
            if isinstance(error, SyntaxError) and error.lineno in (None, 1)
            else 0
        )
        raise MeasureError(
            POLYNOMIAL_PART, fault=POLYNOMIAL_UNREADABLE, part=text[start:][:20] or text[:20]
        ) from error
    except (RecursionError, MemoryError) as error:
        raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_TOO_LONG) from error
    try:
        if isinstance(tree, (ast.Tuple, ast.List)):
            values = [_constant(_terms(item, text), item, text) for item in tree.elts]
            if order_from_count(len(values)) > MAX_DEGREE:
                raise MeasureError(
                    POLYNOMIAL_DEGREE, part=_source_text(tree, text), limit=MAX_DEGREE
                )
            return Polynomial.from_list(values)
        return Polynomial(_terms(tree, text))
    except RecursionError as error:
        raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_TOO_LONG) from error


def _terms(node: ast.expr, text: str) -> dict[Exponents, Fraction]:
    """Return the terms of a part of an expression."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        if isinstance(node.value, float) and not math.isfinite(node.value):
            raise MeasureError(
                POLYNOMIAL_PART,
                fault="is outside the range of numbers",
                part=_source_text(node, text),
            )
        # the decimal that was typed
        number = Fraction(node.value if isinstance(node.value, int) else str(node.value))
        return _validated(_nonzero({(0, 0, 0): number}), node, text)
    if isinstance(node, ast.Name) and node.id in VARIABLES:
        return {VARIABLES[node.id]: Fraction(1)}
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
        sign = -1 if isinstance(node.op, ast.USub) else 1
        return {powers: sign * value for powers, value in _terms(node.operand, text).items()}
    if isinstance(node, ast.BinOp):
        return _validated(_operation(node, text), node, text)
    raise MeasureError(POLYNOMIAL_PART, fault=POLYNOMIAL_NOT_ALLOWED, part=_source_text(node, text))


def _operation(node: ast.BinOp, text: str) -> dict[Exponents, Fraction]:
    left = _terms(node.left, text)
    right = _terms(node.right, text)
    if isinstance(node.op, (ast.Add, ast.Sub)):
        sign = 1 if isinstance(node.op, ast.Add) else -1
        zero = Fraction(0)
        return _nonzero(
            {one: left.get(one, zero) + sign * right.get(one, zero) for one in (*left, *right)}
        )
    if isinstance(node.op, ast.Mult):
        return _multiply(left, right, node, text)
    if isinstance(node.op, ast.Div):
        divisor = _constant(right, node.right, text)
        if not divisor:
            raise MeasureError(
                POLYNOMIAL_PART, fault="divides by zero", part=_source_text(node, text)
            )
        return {powers: value / divisor for powers, value in left.items()}
    if isinstance(node.op, ast.Pow):
        return _power(left, _constant(right, node.right, text), node, text)
    raise MeasureError(POLYNOMIAL_PART, fault=POLYNOMIAL_NOT_ALLOWED, part=_source_text(node, text))


def _power(
    base: dict[Exponents, Fraction], exponent: Fraction, node: ast.BinOp, text: str
) -> dict[Exponents, Fraction]:
    if exponent.denominator != 1 or not 0 <= exponent <= MAX_DEGREE:
        raise MeasureError(POLYNOMIAL_DEGREE, part=_source_text(node, text), limit=MAX_DEGREE)
    result = {(0, 0, 0): Fraction(1)}
    for _ in range(int(exponent)):
        result = _validated(_multiply(result, base, node, text), node, text)
    return result


def _multiply(
    left: dict[Exponents, Fraction], right: dict[Exponents, Fraction], node: ast.expr, text: str
) -> dict[Exponents, Fraction]:
    degrees = [max((sum(powers) for powers in terms), default=0) for terms in (left, right)]
    if sum(degrees) > MAX_DEGREE:
        raise MeasureError(POLYNOMIAL_DEGREE, part=_source_text(node, text), limit=MAX_DEGREE)
    result: dict[Exponents, Fraction] = {}
    for (a, factor), (b, value) in product(left.items(), right.items()):
        powers = a[0] + b[0], a[1] + b[1], a[2] + b[2]
        result[powers] = result.get(powers, 0) + factor * value
    return _nonzero(result)


def _nonzero(terms: dict[Exponents, Fraction]) -> dict[Exponents, Fraction]:
    """Return the terms that are not zero."""
    return {powers: value for powers, value in terms.items() if value}


def _constant(terms: dict[Exponents, Fraction], node: ast.expr, text: str) -> Fraction:
    if set(terms) - {(0, 0, 0)}:
        raise MeasureError(
            POLYNOMIAL_PART,
            fault="must be a number, without x, y and z",
            part=_source_text(node, text),
        )
    return terms.get((0, 0, 0), Fraction(0))


def _validated(
    terms: dict[Exponents, Fraction], node: ast.expr, text: str
) -> dict[Exponents, Fraction]:
    for value in terms.values():
        above = value.numerator.bit_length()
        below = value.denominator.bit_length()
        if max(above, below) > MAX_LENGTH or abs(above - below) > MAX_EXPONENT:
            raise MeasureError(
                POLYNOMIAL_PART,
                fault="is outside the range of numbers",
                part=_source_text(node, text),
            )
    return terms


def _source_text(node: ast.expr, text: str) -> str:
    part = ast.get_source_segment(text, node) or text
    return part if len(part) <= 40 else part[:39] + "…"


def _translate(
    terms: dict[Exponents, Fraction], axis: int, by: Fraction
) -> dict[Exponents, Fraction]:
    """Return the terms with (t + by)^n for t^n along one axis."""
    result: dict[Exponents, Fraction] = {}
    for powers, value in terms.items():
        for k in range(powers[axis] + 1):
            p, q, r = (*powers[:axis], k, *powers[axis + 1 :])
            factor = math.comb(powers[axis], k) * by ** (powers[axis] - k)
            result[p, q, r] = result.get((p, q, r), Fraction(0)) + value * factor
    return _nonzero(result)


def _halves(net: NDArray, axis: int) -> tuple[NDArray, NDArray]:
    """Return the Bernstein coefficients on both halves of a box, by de Casteljau's scheme."""
    coefficients = np.moveaxis(net, axis, 0).copy()
    last = len(coefficients) - 1
    left = np.empty_like(coefficients)
    right = np.empty_like(coefficients)
    for step in range(last + 1):
        left[step], right[last - step] = coefficients[0], coefficients[last - step]
        coefficients[: last - step] = (
            coefficients[: last - step] + coefficients[1 : last - step + 1]
        ) / 2.0
    return np.moveaxis(left, 0, axis), np.moveaxis(right, 0, axis)
