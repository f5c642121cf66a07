# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Zhang and Chen's signed elementary shapes (ICIP 2001): area, volume and moments of 2-D and 3-D
meshes.

Every edge of a polygon makes a triangle with the origin, every triangle of a mesh a tetrahedron.
The elementary shape counts with the sign of its determinant (eqs 2 and 4; 5 and 6), an integral
over the inside is the sum of the elementary ones (eq. 9), and if the total comes out negative the
order of all vertices was the wrong one and is reversed. The moments of an elementary shape are in
an appendix that no copy of the paper at hand has; here they are from Dirichlet's integral over the
shape's barycentric coordinates λ:

    ∫ λ_1^{k_1} … λ_d^{k_d} = measure · d! k_1! … k_d! / (k_1 + … + k_d + d)!,

one term for each choice of a corner for every factor of the monomial. The rule that makes principal
axes unique (eq. 11) is `core/inertia/principal_frames.py:zhang_chen_frame`.

A reference: d^n terms for order n. Generic over the number type, exact in `fractions.Fraction`. The
paper's pose (eq. 11) is `zhang_chen_frame` in `core/inertia/principal_frames.py`, its Fourier
transform `core/fourier/transform.py`.
"""

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from math import factorial, prod

from ..numerics import Number, Vector, cross, dot


def signed_area(points: Sequence[Vector], edges: Sequence[tuple[int, int]]) -> Number:
    """Return the area within directed edges of 2-D points, by eq. 3.

    Parameters
    ----------
    points : sequence of (x, y)
    edges : sequence of (int, int)

    Returns
    -------
    number
        Positive if the inside lies to the left of the edges.

    Examples
    --------
    >>> from body_moments.core.papers.zhang_chen_2001 import signed_area
    >>> signed_area([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    1.0
    """
    return sum(_triangle(points[i], points[j]) for i, j in edges)


def signed_volume(points: Sequence[Vector], triangles: Sequence[tuple[int, int, int]]) -> Number:
    """Return the volume within triangles of 3-D points, by eq. 6.

    Parameters
    ----------
    points : sequence of (x, y, z)
    triangles : sequence of (int, int, int)

    Returns
    -------
    number
        Positive if the triangles are counter-clockwise from outside.

    Examples
    --------
    >>> from body_moments.core.papers.zhang_chen_2001 import signed_volume
    >>> points = [(0, 0, 0), (6, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> signed_volume(points, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    1.0
    """
    return sum(_tetrahedron(*(points[i] for i in triangle)) for triangle in triangles)


def mesh_moments(
    points: Sequence[Sequence[Number]],
    shapes: Sequence[Sequence[int]],
    exponents: Sequence[tuple[int, ...]],
) -> list[Number]:
    """Return ∫ x^p y^q (z^r) over the inside, by eq. 9.

    Parameters
    ----------
    points : sequence of 2 or 3 numbers each
    shapes : sequence of sequence of int
        Edges of a polygon, or triangles of a closed mesh, all outward or all inward: the inside
        counts positive either way.
    exponents : sequence of tuple of int

    Returns
    -------
    list of numbers
        One for each row of exponents.

    Examples
    --------
    >>> from body_moments.core.papers.zhang_chen_2001 import mesh_moments
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> triangles = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    >>> values = mesh_moments(points, triangles, [(2, 0, 0), (1, 1, 0)])
    >>> [round(float(value) * 120, 9) for value in values]
    [2.0, 1.0]
    """
    dimension = len(points[0])
    measure = _triangle if dimension == 2 else _tetrahedron
    sums: list[Number] = [0] * len(exponents)
    total: Number = 0
    for shape in shapes:
        corners = [points[i] for i in shape]
        size = measure(*corners)
        total = total + size
        sums = [
            value + size * _elementary_mean(row, corners) for value, row in zip(sums, exponents)
        ]
    return [-value for value in sums] if total < 0 else sums


def _elementary_mean(exponents: Sequence[int], corners: Sequence[Vector]) -> Number:
    """Return the mean of a monomial over the triangle or tetrahedron of the origin and d
    corners.
    """
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
