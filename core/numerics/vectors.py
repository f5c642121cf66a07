# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors by their coordinates: three numbers of any type, or three arrays of one shape, a vector
in each place.
"""

from __future__ import annotations

from typing import Any, TypeAlias

# An int, float, Fraction, mpmath's number or an array: Python cannot name the common type of two
# such.
Number: TypeAlias = Any
Vector: TypeAlias = Any  # x, y, z: a tuple, a list, a row, or an array with three rows


def subtract(u: Vector, v: Vector) -> tuple[Any, Any, Any]:
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


def cross(u: Vector, v: Vector) -> tuple[Any, Any, Any]:
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def dot(u: Vector, v: Vector) -> Any:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
