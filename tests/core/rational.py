# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Integrals of polynomials over simplices in rational arithmetic, by substitution and nothing else.

A monomial is pulled back to the unit simplex as a polynomial in its barycentric coordinates, by
multiplying linear forms out, and integrated by Dirichlet's ∫ t^k dt = k! / (|k| + d)!. No formula
of the add-on's is used.
"""

from collections import defaultdict
from fractions import Fraction
from itertools import permutations
from math import factorial, prod


def fractions(points):
    """Rows of floats or integers, taken exactly."""
    return [tuple(Fraction(float(x)) for x in point) for point in points]


def determinant(rows):
    """Evaluate the definition: the sum over permutations."""
    n, total = len(rows), Fraction(0)
    for order in permutations(range(n)):
        inversions = sum(order[i] > order[j] for i in range(n) for j in range(i + 1, n))
        total += (-1) ** inversions * prod((rows[i][order[i]] for i in range(n)), start=Fraction(1))
    return total


def pulled_back(exponents, start, vectors):
    """x^α at start + Σ t_i vectors_i as {powers of t: coefficient}."""
    d = len(vectors)
    polynomial = {(0,) * d: Fraction(1)}
    for axis, n in enumerate(exponents):
        for _ in range(n):
            image = defaultdict(Fraction)
            for powers, value in polynomial.items():
                image[powers] += value * start[axis]
                for i in range(d):
                    image[(*powers[:i], powers[i] + 1, *powers[i + 1 :])] += (
                        value * vectors[i][axis]
                    )
            polynomial = image
    return polynomial


def unit_simplex(polynomial, d):
    return sum(
        (
            value * Fraction(prod(factorial(k) for k in powers), factorial(sum(powers) + d))
            for powers, value in polynomial.items()
        ),
        Fraction(0),
    )


def enclosed(points, simplices, exponents, about=None, signs=None):
    """∫ x^α over the cones from `about` to (n-1)-simplices in n dimensions."""
    n = len(points[0])
    about = about or (Fraction(0),) * n
    total = Fraction(0)
    for row, simplex in enumerate(simplices):
        vectors = [tuple(x - o for x, o in zip(points[i], about)) for i in simplex]
        weight = determinant(vectors) * (1 if signs is None else signs[row])
        if weight:
            total += weight * unit_simplex(pulled_back(exponents, (Fraction(0),) * n, vectors), n)
    return total


def facets(points, simplices, exponents, measure):
    """∫ x^α over (n-1)-simplices; measure: (n-1)! times the content of each, as fractions."""
    total = Fraction(0)
    for simplex, size in zip(simplices, measure):
        first = points[simplex[0]]
        vectors = [tuple(x - o for x, o in zip(points[i], first)) for i in simplex[1:]]
        total += size * unit_simplex(pulled_back(exponents, first, vectors), len(vectors))
    return total
