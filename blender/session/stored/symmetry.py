# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetries of objects, stored on the objects in their own axes."""

from __future__ import annotations

import numpy as np
from bpy.types import Object

from ....core.shape.symmetries import Symmetry
from ...bodies.flat.flat_shape import FlatShape
from ...bodies.shape.shape import Shape
from ...read.fingerprint import scale_hash
from ..tracking import stamps

MAX_STORED_ELEMENTS = 32  # limit of stored elements of a symmetry: nobody reads more for a ball or a fine prism


def store_symmetry(
    obj: Object, shape: Shape | FlatShape, confirmed: Symmetry, allowed: Symmetry, tolerance: float
) -> None:
    """Store the symmetry that the surface confirms, and the group that the moments allow, on an object."""
    stored = obj.body_moments_symmetry
    stored.group, stored.compatible, stored.tolerance = confirmed.group, allowed.group, tolerance
    stored.of_display_mesh = shape.is_display_mesh
    stored.fingerprint = stamps.Stamp.parse(shape.fingerprint)._replace(transform=scale_hash(obj)).text
    stored.elements.clear()
    turn = shape.rotation.T
    for kind, order, direction in _elements(confirmed)[:MAX_STORED_ELEMENTS]:
        element = stored.elements.add()
        element.kind, element.order, element.direction = kind, order, turn @ _canonical_direction(turn, direction)


def _canonical_direction(turn: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Return the direction of a line whose largest component, in the object's axes, is positive."""
    local = turn @ direction
    return direction if local[np.argmax(np.abs(local))] > 0.0 else -direction


def _elements(found_symmetry: Symmetry) -> list[tuple[str, int, np.ndarray]]:
    if len(found_symmetry.revolution_axes) == 1:
        return [("ROUND", 0, found_symmetry.revolution_axes[0])] + [
            ("PLANE", 0, normal) for normal in found_symmetry.planes
        ]
    return [("AXIS", order, axis) for axis, order in found_symmetry.axes] + [
        ("PLANE", 0, normal) for normal in found_symmetry.planes
    ]
