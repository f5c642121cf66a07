# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fourier transforms in 120 digits by mpmath: divided differences by their plain recursion, so that
no case is special but phases that are equal to the last digit.
"""

from __future__ import annotations

import mpmath

DIGITS = 120


def solid(points, triangles, q) -> complex:
    """∫ exp(-i q·x) dV of the body inside closed triangles, q not 0."""
    with mpmath.workdps(DIGITS):
        total, q = mpmath.mpc(0), _exact(q)
        points = [_exact(point) for point in points]
        for triangle in triangles:
            corners = [points[int(i)] for i in triangle]
            total += _dot(q, _normal(*corners)) * _mean(corners, q)
        return complex(mpmath.j * total / _dot(q, q))


def area(points, triangles, q) -> complex:
    """∫ exp(-i q·x) dA over triangles."""
    with mpmath.workdps(DIGITS):
        total, q = mpmath.mpc(0), _exact(q)
        points = [_exact(point) for point in points]
        for triangle in triangles:
            corners = [points[int(i)] for i in triangle]
            normal = _normal(*corners)
            total += mpmath.sqrt(_dot(normal, normal)) * _mean(corners, q)
        return complex(total)


def polygon(loops, q) -> complex:
    """∫ exp(-i q·x) dA inside plane loops, q not 0."""
    with mpmath.workdps(DIGITS):
        total, q = mpmath.mpc(0), _exact(q)
        for loop in loops:
            loop = [_exact(point) for point in loop]
            for a, b in zip(loop, [*loop[1:], loop[0]]):
                across = q[0] * (b[1] - a[1]) - q[1] * (b[0] - a[0])
                total += across * mpmath.j * _first(_dot(q, a), _dot(q, b))
        return complex(mpmath.j * total / _dot(q, q))


def _mean(corners, q):
    """∫ exp(-i s) over the unit triangle: less the second divided difference of exp(-i s)."""
    low, middle, high = sorted(_dot(q, corner) for corner in corners)
    if low == high:
        return mpmath.expj(-low) / 2
    return (_first(low, middle) - _first(middle, high)) / (high - low)


def _first(a, b):
    """The first divided difference of exp(-i s)."""
    return -mpmath.j * mpmath.expj(-a) if a == b else (mpmath.expj(-b) - mpmath.expj(-a)) / (b - a)


def _exact(vector):
    return [mpmath.mpf(float(value)) for value in vector]


def _dot(u, v):
    return sum(x * y for x, y in zip(u, v))


def _normal(a, b, c):
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
