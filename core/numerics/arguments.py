# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of public functions, converted to arrays or refused by name.

Nested lists of numbers are as good as arrays. Another shape or content is a ValueError that names the parameter, the
shape that it must have and the given one; an object of another class is a TypeError that names both classes.

In a shape a letter stands for any length, and a leading `...` for any leading axes.
"""

from __future__ import annotations

from types import EllipsisType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arrays import indices_in_range

Length = int | str | EllipsisType


def number_array(name: str, values: ArrayLike, *shape: Length, finite: bool = False) -> NDArray[Any]:
    """Return a parameter as an array of real numbers, of the type that they have."""
    array = _array(name, values, shape, "fiub", "real numbers")
    if finite and not np.isfinite(array).all():
        raise ValueError("{} must be finite".format(name))
    return array


def float_array(name: str, values: ArrayLike, *shape: Length, finite: bool = False) -> NDArray[np.float64]:
    """Return a parameter as an array of float64."""
    return number_array(name, values, *shape, finite=finite).astype(np.float64, copy=False)


def index_array(name: str, values: ArrayLike, *shape: Length, count: int | None = None) -> NDArray[np.integer]:
    """Return a parameter as an array of integers, from 0 to `count` - 1 if there is a count."""
    array = _array(name, values, shape, "iu", "integers")
    if array.dtype.kind not in "iu":  # nothing has no type
        array = array.astype(np.intp)
    if count is not None and not indices_in_range(array, count):
        raise ValueError("{} must be from 0 to {:d}: no such point".format(name, count - 1))
    return array


def check_type(name: str, value: object, kind: type) -> None:
    """Raise TypeError if a parameter is not of a class."""
    if not isinstance(value, kind):
        raise TypeError("{} must be of class {}, not {}".format(name, kind.__name__, type(value).__name__))


def check_order(name: str, value: object) -> None:
    """Raise ValueError if a parameter is not a natural number."""
    if not isinstance(value, (int, np.integer)) or value < 0:
        raise ValueError("{} must be a natural number, not {!r}".format(name, value))


def _array(name: str, values: ArrayLike, shape: tuple[Length, ...], kinds: str, content: str) -> NDArray[Any]:
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):  # rows of different lengths
        array = None
    if array is not None and (array.dtype.kind in kinds or not array.size) and _fits(array.shape, shape):
        return array
    expected = ", ".join("..." if length is ... else str(length) for length in shape) + "," * (len(shape) == 1)
    given = type(values).__name__ if array is None else "{} of shape {}".format(array.dtype, array.shape)
    raise ValueError("{} must be {} of shape ({}), not {}".format(name, content, expected, given))


def _fits(given: tuple[int, ...], expected: tuple[Length, ...]) -> bool:
    if expected and expected[0] is ...:
        expected = expected[1:]
        given = given[max(len(given) - len(expected), 0) :]
    return len(given) == len(expected) and all(
        not isinstance(length, int) or length == own for own, length in zip(given, expected)
    )
