# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Empties that are moved while their children stay."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from bpy.types import Context, Object
from mathutils import Matrix
from numpy.typing import NDArray

from ...core.verdict.finding import EditRefusedError
from ..read.tracking import tracking_paused
from .changes import require_editable
from .findings import CHILD_NOT_HELD, TRANSFORM_CONSTRAINED
from .transforms import TransformChannels, world

PLACE_RTOL = 4e-6  # rounding of places in float32 matrices


def move_parent(context: Context, empty: Object, center: Sequence[float]) -> None:
    """Put an empty at a point while its children stay; raise EditRefusedError if constraints or locks prevent it."""
    require_editable(empty)
    children = [child for child in empty.children if child.parent_type == "OBJECT"]
    saved = TransformChannels(empty)
    inverses = {child: child.matrix_parent_inverse.copy() for child in children}
    places = {child: world(child) for child in empty.children_recursive}
    was = world(empty)
    size = float(np.abs([place[:3, 3] - center for place in places.values()]).max())
    tolerance = PLACE_RTOL * max(size, float(np.abs(center).max()))
    with tracking_paused():
        try:
            target = was.copy()
            target[:3, 3] = center
            empty.matrix_world = Matrix(target)
            context.view_layer.update()
            change = np.linalg.solve(world(empty), was)
            for child in children:
                child.matrix_parent_inverse = Matrix(change @ np.array(inverses[child], np.float64))
            context.view_layer.update()
            moved = [child for child, place in places.items() if not _is_at(child, place, tolerance)]
            if np.abs(world(empty)[:3, 3] - center).max() > tolerance:
                raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location", subject=empty.name)
            if moved:
                raise EditRefusedError(CHILD_NOT_HELD, subject=empty.name, object=moved[0].name)
        except BaseException:
            for child, inverse in inverses.items():
                child.matrix_parent_inverse = inverse
            saved.restore()
            context.view_layer.update()
            raise


def _is_at(obj: Object, place: NDArray, tolerance: float) -> bool:
    """Return whether an object is at a place: within `tolerance`, and with equal rotation and scale to rounding."""
    off = np.abs(world(obj) - place)
    return bool(off[:, 3].max() <= tolerance and off[:, :3].max() <= PLACE_RTOL * np.abs(place[:, :3]).max())
