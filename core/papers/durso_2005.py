# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""D'Urso's moments of polyhedra from the edges of their planar faces (Atti della IX Conferenza
ASITA, 2005).

With n the unit normal of a face, p⊥ the foot of the perpendicular from the origin on its plane and,
for each of its edges, c_j = (p_j x p_{j+1})·n, the paper gives M_0 (eq. 6), M_2 and M_3 as sums
over edges of c_j (p⊥·n) times tensor products of p_j, p_{j+1} and p⊥; M_1 (D'Urso 2004) is of the
same form. No face is cut into triangles.

- The printed M_3 is wrong. In its first bracket of 1/3 the third product reads p_{j+1} ⊗ p_j ⊗
  p_{j+1}, which stands in the second bracket already; it must be p_{j+1} ⊗ p_j ⊗ p_j. As printed
  the result is not even symmetric. `THIRD` is the corrected sum, `THIRD_AS_PRINTED` the printed
  one.
- In eq. 6 the inner sum ends at V^i, the face's own number of vertices.
- c_j (p⊥·n) is det(p⊥, p_j, p_{j+1}): the sum is that of Sheynin and Tuzikov over the fan with its
  apex in p⊥. Hence `moments`: any order, with any apex in the face's plane, by the same Σ_pqr.
- A face that is not planar has no one plane. Taken with its mean plane (Newell's normal through the
  mean of its corners) the volume is that of the fan from that mean, but M_1 and all higher ones
  belong to no body: they change with the origin. Such faces have to be cut into triangles first, as
  Blender draws them.

References, generic over the number type: `fractions.Fraction` in, exact rational moments out, as n
enters squared only.
"""

from collections.abc import Sequence
from itertools import product
from math import factorial

import numpy as np

from ..numerics import NDArray, Number, Vector, cross, dot
from .sheynin_tuzikov_2001 import _exponents_to, sigma

# (divisor of the sum of c_j (p⊥·n) times these products; the products: a is p_j, b is p_{j+1}, p is
# p⊥, with an integer multiple each). The paper's fractions are brought to one denominator: 1/5 ·
# 1/12 · {1, 1/2}, 1/6 · 1/20 · {1, 1/3, 1/6}.
ZEROTH = (6, {"": 1})
FIRST = (24, {"a": 1, "b": 1, "p": 1})
SECOND = (120, {"aa": 2, "ab": 1, "ba": 1, "bb": 2, "ap": 1, "pa": 1, "pp": 2, "bp": 1, "pb": 1})
THIRD = (720, {"".join(word): (6, 2, 1)[len(set(word)) - 1] for word in product("abp", repeat=3)})
THIRD_AS_PRINTED = (720, (THIRD[1] | {"baa": 0, "bab": 4}))
FORMULAS = (ZEROTH, FIRST, SECOND, THIRD)


def tensor(
    points: Sequence[Vector], faces: Sequence[Sequence[int]], formula: tuple[int, dict[str, int]]
) -> NDArray:
    """Return M_t = ∫ x ⊗ … ⊗ x dV by one of the formulas of this module.

    Parameters
    ----------
    points : sequence of (x, y, z)
        Fractions or floats.
    faces : sequence of sequence of int
        Corner indices, planar, counter-clockwise from outside.
    formula : tuple
        One of `ZEROTH`, `FIRST`, `SECOND`, `THIRD`, `THIRD_AS_PRINTED`.

    Returns
    -------
    (3,) * t array
        Of the points' own numbers.

    Examples
    --------
    >>> from fractions import Fraction
    >>> from body_moments.core.papers import durso_2005
    >>> points = [[Fraction(number) for number in row] for row in np.eye(4, 3, -1).tolist()]
    >>> faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    >>> durso_2005.tensor(points, faces, durso_2005.FIRST).tolist()
    [Fraction(1, 24), Fraction(1, 24), Fraction(1, 24)]
    """
    divisor, products = formula
    rank = len(next(iter(products)))
    total = np.zeros((3,) * rank, object)
    for face in faces:
        corners = [points[i] for i in face]
        normal, foot = _plane(corners)
        square = dot(normal, normal)
        if not square:
            continue  # without area, it bounds nothing
        height = dot(foot, normal)
        for a, b in zip(corners, [*corners[1:], corners[0]]):
            letters = {
                "a": np.array(a, object),
                "b": np.array(b, object),
                "p": np.array(foot, object),
            }
            weight = dot(cross(a, b), normal) * height / square  # c_j (p⊥·n), with n not normalized
            for word, multiple in products.items():
                term = np.array(weight * multiple, object)
                for letter in word:
                    term = np.multiply.outer(term, letters[letter])
                total = total + term
    return total / divisor


def moments(
    points: Sequence[Vector],
    faces: Sequence[Sequence[int]],
    order: int,
    apexes: Sequence[Vector] | None = None,
) -> list[Number]:
    """Return ∫ x^p y^q z^r dV to any order, by a fan over each face from an apex in its plane.

    Parameters
    ----------
    points, faces
        As for `tensor`.
    order : int
    apexes : sequence of (x, y, z), optional
        An apex for each face: any point of its plane, such as p⊥; by default the face's first
        corner.

    Returns
    -------
    list of numbers
        In the order of `monomials`.

    Examples
    --------
    >>> from body_moments.core.papers.durso_2005 import moments, perpendicular_feet
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    >>> feet = perpendicular_feet(points, faces)
    >>> [round(moments(points, faces, 2, apexes)[4] * 60, 12) for apexes in (None, feet)]
    [1.0, 1.0]
    """
    apexes = [points[face[0]] for face in faces] if apexes is None else apexes
    exponents = _exponents_to(order)
    sums: list[Number] = [0] * len(exponents)
    for face, apex in zip(faces, apexes):
        corners = [points[i] for i in face]
        for a, b in zip(corners, [*corners[1:], corners[0]]):
            det = dot(apex, cross(a, b))
            if det:
                sums = [total + det * sigma(m, apex, a, b) for total, m in zip(sums, exponents)]
    return [total / factorial(sum(m) + 3) for m, total in zip(exponents, sums)]


def perpendicular_feet(points: Sequence[Vector], faces: Sequence[Sequence[int]]) -> list[Vector]:
    """Return p⊥ of each face: the apexes with which `moments` is D'Urso's own sum.

    Parameters
    ----------
    points, faces
        As for `tensor`.

    Returns
    -------
    list of (x, y, z)

    Examples
    --------
    >>> from body_moments.core.papers.durso_2005 import perpendicular_feet
    >>> perpendicular_feet([(5, 0, 2), (6, 0, 2), (5, 1, 2)], [(0, 1, 2)])
    [(0.0, 0.0, 2.0)]
    """
    return [_plane([points[i] for i in face])[1] for face in faces]


def _plane(corners: Sequence[Vector]) -> tuple[Vector, Vector]:
    """Return Newell's normal, twice the area long, and the perpendicular's foot from the origin, of
    the mean plane.
    """
    normal = (0, 0, 0)
    for a, b in zip(corners, [*corners[1:], corners[0]]):
        normal = tuple(n + c for n, c in zip(normal, cross(a, b)))
    square = dot(normal, normal)
    if not square:
        return normal, corners[0]
    mean = [sum(corner[axis] for corner in corners) / len(corners) for axis in range(3)]
    distance = dot(mean, normal) / square
    return normal, tuple(distance * n for n in normal)
