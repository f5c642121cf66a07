# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Origin to Center of Mass. Blender's own operator ignores modifiers and moves other users of
the data.
"""

import numpy as np
from bpy.types import Context, Operator

from . import reframe, selection, snapping
from .channels import world


class OBJECT_OT_body_moments_origin_to_center(Operator):
    """Move the origin to the exact center of mass of the evaluated body"""

    bl_idname = "object.body_moments_origin_to_center"
    bl_label = "Origin to Center of Mass"
    bl_description = (
        "Move the origin to the exact center of mass of the evaluated body. What can be "
        "seen does not move: children stay, other users of the data keep it, and where "
        "a modifier depends on the origin the object is left as it is"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selected(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected(context)
        plans: list[reframe.Plan] = []

        def plan(obj) -> bool:
            reframe.check(obj)
            body = snapping.body_of(context, obj)
            target = world(obj)
            if np.abs(target[:3, 3] - body.center).max() > reframe.location_tolerance(
                obj, body.size
            ):
                target[:3, 3] = body.center
                plans.append(reframe.Plan(obj, target, body.size, move_only=True))
            return True

        _, failures = selection.each(self, objects, plan, snapping.REFUSALS)
        return snapping.carry_out(
            self,
            context,
            objects,
            plans,
            failures,
            "Moved the origin of {count} to the center of mass",
        )


CLASSES = (OBJECT_OT_body_moments_origin_to_center,)
