# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normalized moments; complex moments of plane shapes, and their invariants under rotation.

    c_pq = ∫ (x + iy)^p (x - iy)^q dA,    c_qp = conj(c_pq).

Turned by θ a shape has c_pq exp(i(p-q)θ), and its mirror image has conj(c_pq). So products in which
the p - q add up to zero are invariants, with imaginary parts that distinguish hands: Flusser's
basis (Pattern Recognition 33, 2000) c_pq c_12^(p-q), complete if c_12 is not zero, and Hu's seven
(IRE Transactions on Information Theory 8, 1962).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..numerics import Array, Complex, Int64, NDArray
from ..verdict import MeasureError
from .affine_maps import apply_translation
from .exponents import monomial_index, monomials
from .findings import NORMALIZATION_UNDEFINED
from .raw import SECOND_MOMENT_INDEX, Measure, Moments, U
from .solid_harmonics import circular_coefficients

SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
SQUARES = SECOND_MOMENT_INDEX.diagonal()  # indices of x², y² and z²
SUM_ROUNDINGS = 8  # rounding of a sum of a few products, in units u, besides one for each term


@dataclass(frozen=True)
class ComplexBound:
    """A complex number and a bound of its error; `*` multiplies the numbers and bounds the error of
    the product.
    """

    value: complex
    bound: float

    def __mul__(self, other: ComplexBound) -> ComplexBound:
        value = self.value * other.value
        a = abs(self.value)
        b = abs(other.value)
        return ComplexBound(
            value, a * other.bound + b * self.bound + self.bound * other.bound + 4.0 * U * a * b
        )

    def conjugate(self) -> ComplexBound:
        """Return the complex conjugate, which belongs to the mirror image."""
        return ComplexBound(self.value.conjugate(), self.bound)

    def power(self, exponent: int) -> ComplexBound:
        """Return the number to a natural power, with its error bound."""
        product = ComplexBound(1.0 + 0.0j, 0.0)
        for _ in range(exponent):
            product = product * self
        return product


@dataclass(frozen=True)
class Invariant:
    """A number, computed from moments to `degree`, that does not change when a shape is turned.

    The bounds are of changes by rounding, and by storing coordinates as float32.
    """

    name: str
    degree: int
    value: complex
    rounding_error: float
    input_error: float
    is_complex: bool = False


def complex_moments(
    moments: Moments, bounds: Array | None = None
) -> dict[tuple[int, int], ComplexBound]:
    """Return {(p, q): c_pq}, p ≥ q, of a plane shape (z = 0). bounds: (K,) errors, by default
    `rounding_error`.
    """
    bounds = moments.rounding_error if bounds is None else bounds
    complex_by_powers = {}
    for powers, positions, factors in _expansions(moments.order):
        terms = factors * moments.raw[positions]
        error = float((np.abs(factors) * bounds[positions]).sum())
        error += (SUM_ROUNDINGS + len(factors)) * U * float(np.abs(terms).sum())
        complex_by_powers[powers] = ComplexBound(complex(terms.sum()), error)
    return complex_by_powers


@lru_cache
def _expansions(
    order: int,
) -> list[tuple[tuple[int, int], Int64, Complex]]:
    """Return, by degree, each (p, q), p ≥ q, with the indices and factors of the real moments that
    make up c_pq.
    """
    expansions = []
    for n in range(order + 1):
        for q in range(n // 2 + 1):
            factors = np.array(circular_coefficients(n - q, q))
            (y_powers,) = np.nonzero(factors)
            positions = monomial_index(n - y_powers, y_powers, 0 * y_powers)
            expansions.append(((n - q, q), positions, factors[y_powers]))
    return expansions


def hu_invariants(moments: Moments) -> list[Invariant]:
    """Return Hu's seven invariants, φ1 to φ7; the last has the opposite sign for a mirror image.

    The moments are a plane shape's, normalized (`normalize`), to third order at least.
    """

    def products(bounds: NDArray) -> list[ComplexBound]:
        c = complex_moments(moments.truncate(3), bounds[: len(moments.truncate(3).raw)])
        c20 = c[2, 0]
        c30 = c[3, 0]
        c21 = c[2, 1]
        c12 = c21.conjugate()
        cubed = c30 * c12.power(3)
        pairs = [c[1, 1], c20 * c20.conjugate(), c30 * c30.conjugate(), c21 * c12]
        return [*pairs, cubed, c20 * c12.power(2), ComplexBound(-1j * cubed.value, cubed.bound)]

    return [
        Invariant(
            "φ{:d}".format(i + 1),
            2 if i < 2 else 3,
            complex(rounded.value.real),
            rounded.bound,
            with_input.bound - rounded.bound,
        )
        for i, (rounded, with_input) in enumerate(_both(moments, products))
    ]


def flusser_invariants(moments: Moments) -> list[Invariant]:
    """Return Flusser's basis c_pq c_12^(p-q), p ≥ q, by degree from second order on; a mirror image
    has its conjugates.

    The moments are a plane shape's, normalized, to third order at least. If it has a rotational
    symmetry, c_12 is zero, and with it every invariant except those with p = q.
    """
    names = [(p, q) for (p, q), *_ in _expansions(moments.order) if p + q > 1]

    def products(bounds: NDArray) -> list[ComplexBound]:
        c = complex_moments(moments, bounds)
        c12 = c[2, 1].conjugate()
        return [c[p, q] * c12.power(p - q) for p, q in names]

    return [
        Invariant(
            _name(p, q),
            max(p + q, 2 if p == q else 3),
            rounded.value,
            rounded.bound,
            with_input.bound - rounded.bound,
            p > q,
        )
        for (p, q), (rounded, with_input) in zip(names, _both(moments, products))
    ]


def _both(moments: Moments, products) -> list[tuple[ComplexBound, ComplexBound]]:
    """Return products with bounds of rounding alone, paired with products that have bounds of the
    input errors too.
    """
    return list(
        zip(
            products(moments.rounding_error), products(moments.rounding_error + moments.input_error)
        )
    )


def _name(p: int, q: int) -> str:
    """Return the invariant's name, such as c11, c20 c12², or c10,3 c12⁷: with a comma if digits
    would run together.
    """
    first = "c{:d}{:s}{:d}".format(p, "," if p > 9 else "", q)
    power = "" if p - q == 1 else str(p - q).translate(SUPERSCRIPTS)
    return first if p == q else "{:s} c12{:s}".format(first, power)


def normalize(moments: Moments, by: str = "size") -> Moments:
    """Return the central moments without unit, about (0, 0, 0): independent of place and size of
    the body.

    by: "size" for μ / V^(1+n/3) of volumes and μ / A^(1+n/2) of areas, for degree n, as if the body
    were scaled to a volume, or area, of 1; "gyration" for μ / (m R^n) with R² = ∫ r² dm / m, from
    second order on, as if it were scaled to a radius of gyration and a mass of 1. The bounds hold
    for the body's true center. ValueError if `by` is neither or does not fit, MeasureError if there
    is too little to divide by.
    """
    if by not in ("size", "gyration"):
        raise ValueError("by not 'size', 'gyration': {!r}".format(by))
    dimension = {Measure.VOLUME: 3, Measure.AREA: 2}.get(moments.measure)
    if by == "size" and dimension is None:
        raise ValueError("masses need 'gyration'")
    uncertain = moments.rounding_error[0] + moments.input_error[0]
    if moments.order < (2 if by == "gyration" else 1) or not moments.total > 2.0 * uncertain:
        raise MeasureError(NORMALIZATION_UNDEFINED)
    body = moments.about_center()
    n = monomials(moments.order).sum(axis=1)
    trace = float(body.raw[SQUARES].sum()) if by == "gyration" else 1.0
    if by == "gyration":
        factor = (trace / body.total) ** (-n / 2.0) / body.total
    else:
        factor = body.total ** -(1.0 + n / dimension)
    bounds = []
    for error in (body.rounding_error, body.rounding_error + body.input_error):
        # The error of the center changes the moments by `center_effect`; divisors with an error
        # enlarge them by `stretch` at most.
        size = np.abs(body.raw) + error
        least_total = body.total - error[0]
        total_ratio = body.total / least_total
        center_error = (np.abs(body.raw[1:4]) + error[1:4]) / least_total + 2.0 * U * np.abs(
            body.about
        )
        shifted = apply_translation(size[None], moments.order, center_error[None])[0]
        center_effect = shifted - size + 8.0 * U * n * size
        if by == "gyration":
            trace_error = error[SQUARES].sum() + center_effect[SQUARES].sum()
            if not trace > 2.0 * trace_error:
                raise MeasureError(NORMALIZATION_UNDEFINED)
            trace_ratio = trace / (trace - trace_error)
            stretch = total_ratio ** np.abs(n / 2.0 - 1.0) * trace_ratio ** (n / 2.0)
        else:
            stretch = total_ratio ** (1.0 + n / dimension)
        moment_error = stretch * (error + center_effect)
        bounds.append(factor * (moment_error + (stretch - 1.0 + (8.0 + 4.0 * n) * U) * size))
    return Moments(
        body.raw * factor,
        np.zeros(3),
        moments.measure if by == "size" else Measure.MASS,
        bounds[0],
        (bounds[1] - bounds[0]) * bool(moments.input_error.any()),
    )
