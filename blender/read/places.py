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
