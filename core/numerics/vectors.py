# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors by their coordinates: three numbers of any type, or three arrays of one shape, a vector in each place."""

from __future__ import annotations

from typing import Any, Protocol


class Number(Protocol):
    """The operations of a number type that generic formulas need: int, float, Fraction, mpmath's or an array.

    Python cannot name the common type of two such numbers, so results are unchecked.
    """

    def __add__(self, other: Any, /) -> Any: ...
    def __radd__(self, other: Any, /) -> Any: ...
    def __sub__(self, other: Any, /) -> Any: ...
    def __rsub__(self, other: Any, /) -> Any: ...
    def __mul__(self, other: Any, /) -> Any: ...
    def __rmul__(self, other: Any, /) -> Any: ...
    def __truediv__(self, other: Any, /) -> Any: ...
    def __pow__(self, other: Any, /) -> Any: ...
    def __neg__(self) -> Any: ...
    def __lt__(self, other: Any, /) -> Any: ...
    def __le__(self, other: Any, /) -> Any: ...
    def __gt__(self, other: Any, /) -> Any: ...


class Vector(Protocol):
    """x, y, z: a tuple, a list, a row, or an array with three rows."""

    def __getitem__(self, axis: int, /) -> Any: ...


def subtract(u: Vector, v: Vector) -> tuple[Any, Any, Any]:
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


def cross(u: Vector, v: Vector) -> tuple[Any, Any, Any]:
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def dot(u: Vector, v: Vector) -> Any:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
