# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is shown of a measured object, in the world and in Blender's units."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Object
from numpy.typing import NDArray

from ...core.numerics.float32 import shortest_decimal
from ...core.numerics.rotations import rotation_matrix
from ...core.verdict.finding import Severity
from ...core.verdict.method import Verdict
from ...operators.session import staleness
from ...operators.write import properties
from ...operators.write.messages import of_severity


@dataclass(frozen=True, eq=False)
class ShownBody:
    """center: (3,), axes: (3, 3) principal, as columns, gyration: (3,) radii, in Blender's units and world axes.
    verdict: "exact", "repaired", "doubtful" or "out of date"."""

    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    verdict: str


def shown_body(obj: Object) -> ShownBody | None:
    """What is shown of an object, None where it has no numbers."""
    numbers = properties.numbers(obj)
    if numbers is None:
        return None
    scene = bpy.context.scene
    unit = shortest_decimal(scene.unit_settings.scale_length)
    (mass,), _, _, _, center, _, moments, turn, _ = numbers
    if not mass > 0.0:
        return None
    location, rotation, _ = obj.matrix_world.decompose()
    rotation = rotation_matrix(rotation)
    axes = rotation @ (rotation_matrix(turn) if any(turn) else np.eye(3))
    world = np.array(location, np.float64) + rotation @ np.array(center) / unit
    gyration = np.sqrt(np.array(moments) / mass) / unit
    return ShownBody(world, axes, gyration, _verdict(obj))


def _verdict(obj: Object) -> str:
    if staleness.stale_reason(obj, bpy.context.scene) not in (None, "stale_transform"):
        return "out of date"
    method = properties.method(obj)
    if method is None or method.verdict == Verdict.OPEN:
        return "doubtful"
    if method.verdict in (Verdict.CAPPED, Verdict.REORIENTED):
        return "repaired"
    return "doubtful" if of_severity(properties.findings(obj), Severity.WARNING) else "exact"
