# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of public functions, converted to arrays or refused by name.

Another shape or content is a ValueError that names the parameter, the shape that it must have and
the given one; an object of another class is a TypeError. In a shape a letter stands for any length,
a leading `...` for leading axes.
"""

from __future__ import annotations

from collections.abc import Sized
from types import EllipsisType
from typing import Any

import numpy as np

from .array_types import Array, ArrayLike, Integers, NDArray
from .arrays import indices_in_range

Length = int | str | EllipsisType


def number_array(
    name: str, values: ArrayLike, *shape: Length, finite: bool = False
) -> NDArray[Any]:
    """Return a parameter as an array of real numbers, without a change of their type."""
    array = _array(name, values, shape, "fiub", "real numbers")
    if finite and not np.isfinite(array).all():
        raise ValueError("{} must be finite".format(name))
    return array


def float_array(name: str, values: ArrayLike, *shape: Length, finite: bool = False) -> Array:
    """Return a parameter as an array of float64."""
    if (
        isinstance(values, np.ndarray)
        and values.dtype == np.float64
        and values.shape == shape
        and not finite
    ):
        return values  # the core passes arrays like this: no further calls
    return number_array(name, values, *shape, finite=finite).astype(np.float64, copy=False)


def unit_vector(name: str, values: ArrayLike) -> Array:
    """Return a (3,) parameter, which must not be zero, as a unit vector."""
    vector = float_array(name, values, 3, finite=True)
    largest = float(np.abs(vector).max())
    if not largest > 0.0:
        raise ValueError("{} must not be zero".format(name))
    vector = vector / largest
    return vector / float(np.linalg.norm(vector))


def index_array(name: str, values: ArrayLike, *shape: Length, count: int | None = None) -> Integers:
    """Return a parameter as an array of integers, from 0 to `count` - 1 if there is a count."""
    array = _array(name, values, shape, "iu", "integers")
    if array.dtype.kind not in "iu":  # an empty list has no integers
        array = array.astype(np.intp)
    if count is not None and not indices_in_range(array, count):
        raise ValueError("{} beyond 0…{:d}: no such point".format(name, count - 1))
    return array


def has_form(values: object, types: tuple[np.dtype, ...], row: tuple[Length, ...]) -> bool:
    """Return whether values are an array of one of these types with rows of this shape: it needs no
    conversion.
    """
    return (
        type(values) is np.ndarray
        and values.dtype in types
        and values.ndim > 0
        and values.shape[1:] == row
    )


def check_type(name: str, value: object, kind: type) -> None:
    """Raise TypeError if a parameter is not of a class."""
    if not isinstance(value, kind):
        raise TypeError("{} must be a {}, not {}".format(name, kind.__name__, type(value).__name__))


def check_order(name: str, value: object) -> None:
    """Raise ValueError if a parameter is not a natural number."""
    if not isinstance(value, (int, np.integer)) or value < 0:
        raise ValueError("{} not a natural number: {!r}".format(name, value))


def check_filled(name: str, values: Sized) -> None:
    """Raise ValueError if a parameter is empty."""
    if not len(values):
        raise ValueError("{} must not be empty".format(name))


def _array(
    name: str, values: ArrayLike, shape: tuple[Length, ...], kinds: str, content: str
) -> NDArray[Any]:
    """Return a parameter as an array of one of the dtype's `kinds`, or raise its `shape_error`."""
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):  # rows of different lengths
        raise shape_error(name, values, shape, content) from None
    if (array.dtype.kind in kinds or not array.size) and _has_shape(array.shape, shape):
        return array
    raise shape_error(name, array, shape, content)


def _has_shape(lengths: tuple[int, ...], shape: tuple[Length, ...]) -> bool:
    """Return whether an array with axes of these lengths has a shape."""
    if shape[:1] == (...,):
        shape = shape[1:]
        lengths = lengths[max(len(lengths) - len(shape), 0) :]
    return len(lengths) == len(shape) and all(
        not isinstance(expected, int) or expected == length
        for expected, length in zip(shape, lengths)
    )


def shape_error(name: str, values: object, shape: tuple[Length, ...], content: str) -> ValueError:
    """Return the error for a parameter of another shape or content."""
    expected = ", ".join(["..." if length is ... else str(length) for length in shape])
    comma = "," if len(shape) == 1 else ""
    given = (
        "{} {}".format(values.shape, values.dtype)
        if isinstance(values, np.ndarray)
        else type(values).__name__
    )
    return ValueError("{} must be ({}{}) {}, not {}".format(name, expected, comma, content, given))
