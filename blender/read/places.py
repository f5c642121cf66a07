# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of objects in double precision, as the file states them that they were imported from.

Blender's own matrices are in single precision, and an object has one.
"""

from __future__ import annotations

import numpy as np
from bpy.types import Object

from ...core.bodies import float64_matrix
from ...core.numerics import Array

_HALF_STEP = 2.0**-24  # relative rounding of a number in single precision
_ROUNDINGS = 8.0  # of the product of two matrices, and of the numbers in them
KEY = "body_file_places"  # a property of objects: the numbers of their matrices


def set_places(obj: Object, matrices: Array) -> None:
    """Give an object its (k, 4, 4) places in the world, or in the collection that is instanced."""
    obj[KEY] = np.asarray(matrices, np.float64).ravel().tolist()


def has_places(obj: Object) -> bool:
    """Return whether the object's file states its places."""
    return KEY in obj


def world_matrices(obj: Object) -> Array:
    """Return the (k, 4, 4) places of an object: the file's, else Blender's one."""
    if KEY in obj:
        return np.array(obj[KEY], np.float64).reshape(-1, 4, 4)
    return float64_matrix(obj.matrix_world)[None]


def place_error(obj: Object) -> float:
    """Return how far rounding to single precision may have moved an object, along the chain of its
    parents, in Blender units: 0 if its file states the place.
    """
    if KEY in obj:
        return 0.0
    line = [obj]
    while line[-1].parent is not None:
        line.append(line[-1].parent)
    error = 0.0
    for level, one in enumerate(reversed(line)):
        move = one.matrix_basis.translation.length
        if one.parent is None:
            error += _HALF_STEP * move
            continue
        inverse = float64_matrix(one.matrix_parent_inverse)
        above = float64_matrix(one.parent.matrix_world)
        move = _size(inverse[:3, :3]) * move + _size(inverse[:3, 3])
        error += _HALF_STEP * _size(above[:3, :3]) * move * (1.0 + _ROUNDINGS * level)
        error += _HALF_STEP * _ROUNDINGS * _size(above[:3, 3])
    return error + (_HALF_STEP * obj.matrix_world.translation.length if obj.constraints else 0.0)


def _size(values: Array) -> float:
    return float(np.sqrt(np.square(values).sum()))
