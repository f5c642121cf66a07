# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume moments of any order of a mesh, plainly: Sheynin and Tuzikov by the recursion of its
generating function 1 / ((1-a·t)(1-b·t)(1-c·t)), all triangles at once, about a point, by default
the mean of the points.
"""

from math import factorial

import numpy as np
from body_moments.core.moments.raw import Moments, monomial_index, monomials


def moments(part, order, about=None):
    points, triangles = np.asarray(part[0], float), np.asarray(part[1])
    about = points.mean(axis=0) if about is None else np.asarray(about, float)
    corners = [(points - about)[triangles[:, k]].T for k in range(3)]
    det = np.einsum("in,in->n", corners[0], np.cross(corners[1].T, corners[2].T).T)
    table = np.zeros((monomial_index(0, 0, order) + 1, len(triangles)))
    table[0] = 1.0
    for corner in corners:
        for row in monomials(order)[1:]:
            for axis in np.flatnonzero(row):
                lower = row.copy()
                lower[axis] -= 1
                table[monomial_index(*row)] += corner[axis] * table[monomial_index(*lower)]
    weight = [
        factorial(p) * factorial(q) * factorial(r) / factorial(p + q + r + 3)
        for p, q, r in monomials(order).tolist()
    ]
    return Moments(np.array(weight) * (table @ det), about)
