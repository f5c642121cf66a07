# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Origin to Center of Mass.

Blender's own operator ignores modifiers and moves other users of the data.
"""

from bpy.types import Context, Operator

from .. import selection
from .base import reframe_selected


class OBJECT_OT_body_moments_origin_to_center(selection.OnSelectionInObjectMode, Operator):
    """Move the origin to the exact center of mass of the evaluated object."""

    bl_idname = "object.body_moments_origin_to_center"
    bl_label = "Origin to Center of Mass"
    bl_description = (
        "Move the origin to the exact center of mass of the evaluated object. Nothing visible moves: children and "
        "other users of the data stay in place. Objects whose modifiers depend on the origin are left unchanged"
    )
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        done = (
            "Moved the origin of {count} object to the center of mass",
            "Moved the origins of {count} objects to the center of mass",
        )
        return reframe_selected(self, context, False, done)


CLASSES = (OBJECT_OT_body_moments_origin_to_center,)
