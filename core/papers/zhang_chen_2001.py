# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Zhang and Chen's signed elementary shapes (ICIP 2001): area, volume and moments of 2-D and 3-D meshes.

Every edge of a polygon makes a triangle with the origin, every triangle of a mesh a tetrahedron. The elementary shape
counts with the sign of its determinant (eqs 2 and 4; 5 and 6), whatever is an integral over the inside is the sum of
the elementary ones (eq. 9), and where the total comes out negative the order of all vertices was the wrong one and is
reversed. The moments of an elementary shape are in an appendix that no copy of the paper at hand has; here they are
from Dirichlet's integral over the shape's barycentric coordinates λ, of which

    ∫ λ_1^{k_1} … λ_d^{k_d} = measure · d! k_1! … k_d! / (k_1 + … + k_d + d)!,

one term for each choice of a corner for every factor of the monomial.

A reference: d^n terms for order n. Generic over the number type, exact in `fractions.Fraction`. The pose that the paper
derives from the moments (eq. 11) is in `pose`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from math import factorial, prod

from ..numerics.vectors import Number, Vector, cross, dot


def signed_area(points: Sequence[Vector], edges: Sequence[tuple[int, int]]) -> Number:
    """Eq. 3: the area within directed edges of 2-D points, positive where the inside lies to their left."""
    return sum(_triangle(points[i], points[j]) for i, j in edges)


def signed_volume(points: Sequence[Vector], triangles: Sequence[tuple[int, int, int]]) -> Number:
    """Eq. 6: the volume within triangles of 3-D points, positive where they are counter-clockwise from outside."""
    return sum(_tetrahedron(*(points[i] for i in triangle)) for triangle in triangles)


def mesh_moments(
    points: Sequence[Sequence[Number]], shapes: Sequence[Sequence[int]], exponents: Sequence[tuple[int, ...]]
) -> list[Number]:
    """Eq. 9: ∫ x^p y^q (z^r) over the inside for each row of exponents.

    points: rows of 2 or 3 numbers. shapes: edges of a polygon, or triangles of a closed mesh, all outward or all
    inward: what is inside counts positive either way.
    """
    dimension = len(points[0])
    measure = _triangle if dimension == 2 else _tetrahedron
    sums: list[Number] = [0] * len(exponents)
    total: Number = 0
    for shape in shapes:
        corners = [points[i] for i in shape]
        size = measure(*corners)
        total = total + size
        sums = [value + size * elementary_mean(row, corners) for value, row in zip(sums, exponents)]
    return [-value for value in sums] if total < 0 else sums


def elementary_mean(exponents: Sequence[int], corners: Sequence[Vector]) -> Number:
    """The mean of a monomial over the triangle or tetrahedron of the origin and d corners with d coordinates each."""
    dimension = len(corners)
    axes = [axis for axis, n in enumerate(exponents) for _ in range(n)]
    total = 0
    for choice in product(range(dimension), repeat=len(axes)):
        term = prod(factorial(k) for k in Counter(choice).values())
        for corner, axis in zip(choice, axes):
            term = term * corners[corner][axis]
        total = total + term
    return total * Fraction(factorial(dimension), factorial(len(axes) + dimension))


def _triangle(a: Vector, b: Vector) -> Number:
    return (-b[0] * a[1] + a[0] * b[1]) / 2


def _tetrahedron(a: Vector, b: Vector, c: Vector) -> Number:
    return dot(a, cross(b, c)) / 6
