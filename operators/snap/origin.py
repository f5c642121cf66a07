# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Origin to Center of Mass.

Blender's own operator ignores modifiers and moves other users of the data.
"""

import numpy as np
from bpy.types import Context, Object, Operator

from ...blender.scene import reframe
from ...blender.scene.transforms import world
from ...core.verdict.finding import finding
from .. import selection
from ..findings import ORIGINS_MOVED
from . import base as snapping


class OBJECT_OT_body_moments_origin_to_center(Operator):
    """Move the origin to the exact center of mass of the evaluated object."""

    bl_idname = "object.body_moments_origin_to_center"
    bl_label = "Origin to Center of Mass"
    bl_description = (
        "Move the origin to the exact center of mass of the evaluated object. Nothing visible moves: children and "
        "other users of the data stay in place. Objects whose modifiers depend on the origin are left unchanged"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        return snapping.reframe_selected(
            self,
            context,
            matrix_at_center,
            finding(ORIGINS_MOVED),
            move_only=True,
        )


def matrix_at_center(obj: Object, body: snapping.SnapTarget) -> np.ndarray | None:
    """Return the object's matrix with its origin at the body's center, or None if it is there already."""
    target = world(obj)
    off = np.abs(target[:3, 3] - body.center).max()
    if off <= reframe.location_tolerance(obj, body.size):
        return None
    target[:3, 3] = body.center
    return target


CLASSES = (OBJECT_OT_body_moments_origin_to_center,)
