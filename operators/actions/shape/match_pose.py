# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Pose: lay objects onto the active one by the poses that are their own."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from bpy.types import Context, Event, Object, Operator

from ....core.numerics.float32 import decimal
from ....core.shape.registration import FITS, Match
from ....core.verdict import internal_error
from ...bodies.shape import Shape, Skin, matched, surface_shape_of
from ...scene import reframe
from ...scene.transforms import Refused, world
from ...write.units import Units
from .. import selection
from ..modal import Stepwise
from ..snap import base as snapping


class OBJECT_OT_body_moments_match_pose(Stepwise, Operator):
    """Lay the other selected objects onto the active one"""

    bl_idname = "object.body_moments_match_pose"
    bl_label = "Match Pose"
    bl_description = (
        "Move and turn the other selected objects until they lie on the active one, by centers of mass and principal "
        "axes, and report how far their surfaces are apart. A symmetric object takes the nearest of its poses; a "
        "mirror image is left where it is"
    )
    bl_options = {"REGISTER", "UNDO"}
    DOING = "Comparing: {:.0%}. Esc cancels"
    CANCELLED = "Match Pose was cancelled; nothing was moved"

    @classmethod
    def poll(cls, context: Context) -> bool:
        if not selection.poll_selected(cls, context):
            return False
        if context.object is None or not any(obj != context.object for obj in context.view_layer.objects.selected):
            cls.poll_message_set("Select objects to move, and then the one that they shall lie on")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        self._begin(context)
        return self.all_at_once(context, len(self._others))

    def invoke(self, context: Context, _event: Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        self._begin(context)
        return self.begin_modal(context, len(self._others))

    def _begin(self, context: Context) -> None:
        self._others = [obj for obj in selection.selected(context) if obj != context.object]
        self._size = 0.0  # of the active object, once it is measured
        self._found: list[tuple[reframe.Plan, Match]] = []
        self._failures: list[tuple[str, str]] = []
        self._steps = self._compare(context)

    def _compare(self, context: Context) -> Iterator[float]:
        active = context.object
        try:
            target = surface_shape_of(active, context.evaluated_depsgraph_get())
        except snapping.REFUSALS as error:
            self.report({"ERROR"}, "{:s}: {:s}".format(active.name, getattr(error, "reason", str(error))))
            return
        yield 0.0
        self._size, skin = target.size, Skin(target)
        for _ in skin.grow():
            yield 0.0

        def find(obj: Object) -> Iterator[float]:
            _check(context, obj)
            shape = surface_shape_of(obj, context.evaluated_depsgraph_get())
            yield 0.3
            own = Skin(shape)
            yield from (0.4 + 0.5 * share for share in own.grow())
            self._found.append(_planned(context, obj, shape, target, matched(shape, target, own, skin)))

        yield from selection.one_by_one(self._others, find, snapping.REFUSALS, self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Nothing moves before all places are found, so that a cancelled run leaves everything where it was."""
        if not self._size:
            return {"CANCELLED"}
        active, units = context.object, Units.of(context.scene.unit_settings)
        moved, notes, fits = [], [], True
        for plan, found in self._found:  # parents first, for a child moves with its parent
            try:
                if _move(context, plan):
                    moved.append(plan.obj)
            except Exception as error:
                self._failures.append((plan.obj.name, internal_error.reason(error, snapping.REFUSALS)))
                continue
            notes.append(_told(plan.obj.name, found, self._size, units))
            fits &= found.largest <= FITS * self._size
        snapping.refresh(context, moved)
        if notes and fits and not self._failures:
            self.report(
                {"INFO"},
                "Laid {:s} onto {:s}. {:s}".format(
                    selection.counted(len(notes)), active.name, ". ".join(selection.listed(notes))
                ),
            )
            return {"FINISHED"}
        text = "Laid {count} onto " + active.name
        return selection.summarise(self, len(notes), len(self._others), text, self._failures, notes)


def _told(name: str, found: Match, size: float, units: Units) -> str:
    apart = "{:s}: at most {:s} apart, {:s} on average".format(
        name, units.text("length", found.largest), units.text("length", found.mean)
    )
    if found.largest > FITS * size:
        return apart + "; it is no copy, or is cut off somewhere"
    return apart


def _check(context: Context, obj: Object) -> None:
    """Raises where the object cannot be laid onto the active one."""
    reframe.check_movable(obj)
    if obj in selection.lineage(context.object):
        raise Refused("the active object is its child and would move with it; clear the parent first")


def _planned(context: Context, obj: Object, shape: Shape, target: Shape, found: Match) -> tuple[reframe.Plan, Match]:
    """Where the object lies on the target, and how well."""
    if found.mirrored:
        raise Refused("it is a mirror image of the active object, and no turn lays it there")
    unit = decimal(context.scene.unit_settings.scale_length)
    matrix = world(obj)
    matrix[:3, :3] = found.rotation @ matrix[:3, :3]
    matrix[:3, 3] = (target.center + found.rotation @ (matrix[:3, 3] * unit - shape.center)) / unit
    return reframe.Plan(obj, matrix, shape.size / unit, move_only=False), found


def _move(context: Context, plan: reframe.Plan) -> bool:
    """Bring the object there; whether it was elsewhere."""
    off = np.abs(plan.target - world(plan.obj))
    if off[:3, :3].max() <= 1e-7 and off[:3, 3].max() <= reframe.location_tolerance(plan.obj, plan.size):
        return False
    reframe.move(context, plan)
    return True


CLASSES = (OBJECT_OT_body_moments_match_pose,)
