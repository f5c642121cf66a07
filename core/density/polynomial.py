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
from typing import TypeAlias

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
    POLYNOMIAL_OUT_OF_RANGE,
    POLYNOMIAL_PART,
    POLYNOMIAL_TOO_LONG,
    POLYNOMIAL_UNREADABLE,
    POLYNOMIAL_UNUSABLE,
)

MAX_DEGREE = 17  # mass moments to order 3 then need those of the body to order 20
MAX_LENGTH = 4096  # characters of a text
MAX_BITS = 4096  # bits of a numerator or denominator
MAX_EXPONENT = 664  # largest power of two by which numbers may be large or small: 1e200
POINTS_PER_BLOCK = 1 << 15  # points that are evaluated together
MAX_BOXES = 600  # boxes that are halved for a bound
Exponents: TypeAlias = tuple[int, int, int]
Terms: TypeAlias = dict[Exponents, Fraction]
CONSTANT: Exponents = (0, 0, 0)
ZERO = Fraction(0)
VARIABLES: dict[str, Exponents] = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
CORNERS = tuple(product((0, -1), repeat=3))


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A polynomial density with exact nonzero coefficients by (p, q, r); call it with (n, 3) points
    for its values.
    """

    terms: Terms

    @classmethod
    def from_list(cls, coefficients: list[Fraction]) -> Polynomial:
        """Make a polynomial from exact coefficients of 1, x, y, z, x², xy, xz, y², yz, z², and so
        on.
        """
        exponents = map(tuple, monomials(order_from_count(len(coefficients))).tolist())
        return cls(_nonzero(dict(zip(exponents, coefficients))))

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
        result = np.zeros(len(points))
        for start in range(0, len(points), POINTS_PER_BLOCK):
            block = slice(start, start + POINTS_PER_BLOCK)
            x, y, z = (power_table(row, self.degree) for row in points[block].T)
            for (p, q, r), coefficient in self.float_terms().items():
                result[block] += coefficient * x[p] * y[q] * z[r]
        return result

    def lower_bound(self, low: ArrayLike, high: ArrayLike) -> float:
        """Return a lower bound of the polynomial on a box, less rounding; boxes are halved as long
        as that may help.
        """
        low = np.asarray(low, float)
        high = np.asarray(high, float)
        coefficients = self.translate(low).coefficients()
        exponents = monomials(self.degree)
        net = np.zeros((self.degree + 1,) * 3)  # coefficients by the powers of (x - low) / side
        net[tuple(exponents.T)] = coefficients * np.multiply.reduce(
            (high - low) ** exponents, axis=1
        )
        # Rounding of the net; 64 is chosen with a margin.
        tolerance = 64.0 * U * (self.degree + 1) * float(np.abs(net).sum())
        degrees = range(self.degree + 1)
        bernstein = np.array(
            [[math.comb(i, j) / math.comb(self.degree, j) for j in degrees] for i in degrees]
        )
        for axis in range(3):  # from coefficients of t^j to Bernstein coefficients on [0, 1]
            net = np.moveaxis(np.tensordot(bernstein, net, (1, axis)), 0, axis)
        # A heap with the least bound first. The number breaks ties, as nets cannot be compared.
        boxes = [(float(net.min()), 0, net)]
        for number in range(1, 2 * MAX_BOXES, 2):  # each pass adds two boxes
            least, _, net = boxes[0]
            # The corners of a net are values of the polynomial. If one of them is negative, the
            # bound stays negative, however often boxes are halved.
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
        start = 0
        if isinstance(error, SyntaxError) and error.lineno in (None, 1):
            start = max((error.offset or 1) - 1, 0)
        part = text[start : start + 20] or text[:20]
        raise MeasureError(POLYNOMIAL_PART, fault=POLYNOMIAL_UNREADABLE, part=part) from error
    except (RecursionError, MemoryError) as error:
        raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_TOO_LONG) from error
    try:
        return _Parser(text).polynomial(tree)
    except RecursionError as error:
        raise MeasureError(POLYNOMIAL_UNUSABLE, fault=POLYNOMIAL_TOO_LONG) from error


@dataclass(frozen=True)
class _Parser:
    """The terms of the parts of an expression; refusals quote the text of the part."""

    text: str

    def polynomial(self, tree: ast.expr) -> Polynomial:
        """Return the polynomial of an expression, or of a list of coefficients."""
        if not isinstance(tree, (ast.Tuple, ast.List)):
            return Polynomial(self.terms(tree))
        coefficients = [self.number(item) for item in tree.elts]
        if order_from_count(len(coefficients)) > MAX_DEGREE:
            raise self.degree_error(tree)
        return Polynomial.from_list(coefficients)

    def terms(self, node: ast.expr) -> Terms:
        """Return the terms of a part."""
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            if isinstance(node.value, float) and not math.isfinite(node.value):
                raise self.error(node, POLYNOMIAL_OUT_OF_RANGE)
            # The text of a float is the decimal that was typed.
            number = Fraction(node.value if isinstance(node.value, int) else str(node.value))
            return self.in_range(_nonzero({CONSTANT: number}), node)
        if isinstance(node, ast.Name) and node.id in VARIABLES:
            return {VARIABLES[node.id]: Fraction(1)}
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
            sign = -1 if isinstance(node.op, ast.USub) else 1
            return {powers: sign * value for powers, value in self.terms(node.operand).items()}
        if isinstance(node, ast.BinOp):
            return self.in_range(self.operation(node), node)
        raise self.error(node, POLYNOMIAL_NOT_ALLOWED)

    def operation(self, node: ast.BinOp) -> Terms:
        """Return the terms of a sum, difference, product, quotient or power."""
        left = self.terms(node.left)
        if isinstance(node.op, (ast.Add, ast.Sub)):
            right = self.terms(node.right)
            sign = 1 if isinstance(node.op, ast.Add) else -1
            return _nonzero(
                {
                    powers: left.get(powers, ZERO) + sign * right.get(powers, ZERO)
                    for powers in (*left, *right)
                }
            )
        if isinstance(node.op, ast.Mult):
            return self.multiply(left, self.terms(node.right), node)
        if isinstance(node.op, ast.Div):
            divisor = self.number(node.right)
            if not divisor:
                raise self.error(node, "divides by zero")
            return {powers: value / divisor for powers, value in left.items()}
        if isinstance(node.op, ast.Pow):
            return self.power(left, self.number(node.right), node)
        raise self.error(node, POLYNOMIAL_NOT_ALLOWED)

    def power(self, base: Terms, exponent: Fraction, node: ast.BinOp) -> Terms:
        if exponent.denominator != 1 or not 0 <= exponent <= MAX_DEGREE:
            raise self.degree_error(node)
        result = {CONSTANT: Fraction(1)}
        for _ in range(int(exponent)):
            result = self.in_range(self.multiply(result, base, node), node)
        return result

    def multiply(self, left: Terms, right: Terms, node: ast.BinOp) -> Terms:
        if Polynomial(left).degree + Polynomial(right).degree > MAX_DEGREE:
            raise self.degree_error(node)
        result: Terms = {}
        for (a, factor), (b, value) in product(left.items(), right.items()):
            powers = a[0] + b[0], a[1] + b[1], a[2] + b[2]
            result[powers] = result.get(powers, ZERO) + factor * value
        return _nonzero(result)

    def number(self, node: ast.expr) -> Fraction:
        """Return the value of a part without x, y and z."""
        terms = self.terms(node)
        if terms.keys() - {CONSTANT}:
            raise self.error(node, "must be a number, without x, y and z")
        return terms.get(CONSTANT, ZERO)

    def in_range(self, terms: Terms, node: ast.expr) -> Terms:
        """Return the terms of a part, or raise MeasureError if a coefficient is too large, small or
        long.
        """
        for value in terms.values():
            above = value.numerator.bit_length()
            below = value.denominator.bit_length()
            if max(above, below) > MAX_BITS or abs(above - below) > MAX_EXPONENT:
                raise self.error(node, POLYNOMIAL_OUT_OF_RANGE)
        return terms

    def error(self, node: ast.expr, fault: str) -> MeasureError:
        return MeasureError(POLYNOMIAL_PART, fault=fault, part=self.quote(node))

    def degree_error(self, node: ast.expr) -> MeasureError:
        """Return the refusal of a part whose degree is no whole number, or too large."""
        return MeasureError(POLYNOMIAL_DEGREE, part=self.quote(node), limit=MAX_DEGREE)

    def quote(self, node: ast.expr) -> str:
        """Return the text of a part, shortened if it is long."""
        part = ast.get_source_segment(self.text, node) or self.text
        return part if len(part) <= 40 else part[:39] + "…"


def _nonzero(terms: Terms) -> Terms:
    """Return the terms that are not zero."""
    return {powers: value for powers, value in terms.items() if value}


def _translate(terms: Terms, axis: int, offset: Fraction) -> Terms:
    """Return the terms with (t + offset)^n for t^n along one axis."""
    result: Terms = {}
    for powers, value in terms.items():
        for k in range(powers[axis] + 1):
            p, q, r = (*powers[:axis], k, *powers[axis + 1 :])
            factor = math.comb(powers[axis], k) * offset ** (powers[axis] - k)
            result[p, q, r] = result.get((p, q, r), ZERO) + value * factor
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
