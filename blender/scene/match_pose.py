# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans that lay objects onto the active object by a match of their surfaces."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object

from ...core.numerics.float32 import shortest_decimal
from ...core.shape.registration import MAX_FIT_RTOL, RigidMatch
from ...core.verdict.finding import EditRefusedError
from ..bodies.flat.flat_shape import FlatShape
from ..bodies.shape.shape import Shape
from . import reframe
from .changes import ancestors
from .findings import FOLLOWS_MOVED, MIRROR_IMAGE
from .transforms import world


def require_matchable(context: Context, obj: Object) -> None:
    """Raise EditRefusedError if the object cannot be laid onto the active one."""
    reframe.check_movable(obj)
    if obj in ancestors(context.object):
        raise EditRefusedError(FOLLOWS_MOVED, follower=context.object.name, target=obj.name)


def plan_match(
    context: Context, obj: Object, shape: Shape | FlatShape, target: Shape | FlatShape, match: RigidMatch
) -> reframe.Plan:
    """Return the plan that lays the object onto the target; raise EditRefusedError for a mirror image."""
    if match.is_mirror_image:
        raise EditRefusedError(MIRROR_IMAGE)
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    matrix = world(obj)
    matrix[:3, :3] = match.rotation @ matrix[:3, :3]
    matrix[:3, 3] = (target.center + match.rotation @ (matrix[:3, 3] * unit - shape.center)) / unit
    return reframe.Plan(obj, matrix, shape.size / unit, move_only=False)


def is_copy(match: RigidMatch, size: float) -> bool:
    """Return whether the surfaces of a match lie on each other, by a tolerance relative to the body's size."""
    return match.max_distance <= MAX_FIT_RTOL * size


def move_to_match(context: Context, plan: reframe.Plan) -> bool:
    """Carry out a plan; return False if the object was in place already."""
    off = np.abs(plan.target - world(plan.obj))
    if off[:, :3].max() <= 1e-7 and off[:, 3].max() <= reframe.location_tolerance(plan.obj, plan.size):
        return False
    reframe.move(context, plan)
    return True
