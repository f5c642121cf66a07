# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Pose: lay objects onto the active one by the poses that are their own."""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object, Operator

from ..core.decimal import decimal
from ..core.matching import FITS, Match
from . import reframe, selection, snapping
from .channels import Channels, Refused, world
from .density import fixed_to
from .shape import Shape, Skin, matched, surface_shape_of
from .units import Units


class OBJECT_OT_body_moments_match_pose(Operator):
    """Lay the other selected objects onto the active one"""

    bl_idname = "object.body_moments_match_pose"
    bl_label = "Match Pose"
    bl_description = (
        "Move and turn the other selected objects until they lie on the active one, by centers of mass and principal "
        "axes, and report how far their surfaces are apart. A symmetric object takes the nearest of its poses; a "
        "mirror image is left where it is"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        if not selection.poll_selected(cls, context):
            return False
        if context.object is None or not any(obj != context.object for obj in context.view_layer.objects.selected):
            cls.poll_message_set("Select objects to move, and then the one that they shall lie on")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        active = context.object
        others = [obj for obj in selection.selected(context) if obj != active]
        try:
            target = surface_shape_of(active, context.evaluated_depsgraph_get())
        except snapping.REFUSALS as error:
            self.report({"ERROR"}, "{:s}: {:s}".format(active.name, getattr(error, "reason", str(error))))
            return {"CANCELLED"}
        skin = Skin(target)
        moved: list[Object] = []
        residuals: list[tuple[str, Match]] = []

        def lay(obj: Object) -> bool:
            # One after the other, for a child moves with its parent.
            found, changed = _lay(context, obj, target, skin)
            residuals.append((obj.name, found))
            if changed:
                moved.append(obj)
            return True

        done, failures = selection.each(self, others, lay, snapping.REFUSALS)
        snapping.refresh(context, moved)
        units = Units.of(context.scene.unit_settings)
        notes = [_told(name, found, target.size, units) for name, found in residuals]
        if all(found.largest <= FITS * target.size for _, found in residuals) and not failures and notes:
            self.report({"INFO"}, "Laid {:s} onto {:s}. {:s}".format(
                selection.counted(done), active.name, ". ".join(notes[:selection.LISTED])))
            return {"FINISHED"}
        return selection.summarise(self, done, len(others), "Laid {count} onto " + active.name, failures, notes)


def _told(name: str, found: Match, size: float, units: Units) -> str:
    apart = "{:s}: at most {:s} apart, {:s} on average".format(
        name, units.text("length", found.largest), units.text("length", found.mean))
    if found.largest > FITS * size:
        return apart + "; it is no copy, or is cut off somewhere"
    return apart


def _lay(context: Context, obj: Object, target: Shape, skin: Skin) -> tuple[Match, bool]:
    """Lay one object onto the target; how well it lies, and whether it was moved."""
    if obj.library is not None:
        raise Refused("it is linked from another file; make it local first")
    if fixed_to(obj) == "world":
        raise Refused("its density is a polynomial of world coordinates, and does not move with it; give it in its own "
                      "coordinates first")
    if obj in _parents(context.object):
        raise Refused("the active object is its child and would move with it; clear the parent first")
    shape = surface_shape_of(obj, context.evaluated_depsgraph_get())
    found = matched(shape, target, Skin(shape), skin)
    if found.mirrored:
        raise Refused("it is a mirror image of the active object, and no turn lays it there")
    unit = decimal(context.scene.unit_settings.scale_length)
    matrix = world(obj)
    matrix[:3, :3] = found.rotation @ matrix[:3, :3]
    matrix[:3, 3] = (target.center + found.rotation @ (matrix[:3, 3] * unit - shape.center)) / unit
    size = shape.size / unit
    if np.abs(matrix[:3, :3] - world(obj)[:3, :3]).max() <= 1e-7 and np.abs(
            matrix[:3, 3] - world(obj)[:3, 3]).max() <= reframe.location_tolerance(obj, size):
        return found, False
    saved = Channels(obj)
    try:
        reframe.reach(context, reframe.Plan(obj, matrix, size, move_only=False))
    except Refused:
        saved.restore()
        context.view_layer.update()
        raise
    return found, True


def _parents(obj: Object) -> list[Object]:
    found = []
    while obj.parent is not None:
        obj = obj.parent
        found.append(obj)
    return found


CLASSES = (OBJECT_OT_body_moments_match_pose,)
