# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Pose: lay objects onto the active one by the poses that are their own."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np
from bpy.types import Context, Event, Object, Operator

from ...blender.bodies.flat.flat_shape import FlatShape, comparable_shape_of, distance_from
from ...blender.bodies.shape.shape import Shape, register_surfaces
from ...blender.scene import reframe
from ...blender.scene.transforms import world
from ...blender.write import reports
from ...core.numerics.float32 import shortest_decimal
from ...core.shape.registration import MAX_FIT_RTOL, RigidMatch
from ...core.verdict.finding import EditRefusedError, Finding, MeasureError, finding
from .. import selection
from ..findings import (
    ACTIVE_IS_CHILD,
    FLAT_AND_BODY,
    FLAT_MIRROR_IMAGE,
    MIRROR_IMAGE,
    POSE_DISTANCE,
    POSE_NOT_A_COPY,
    POSES_MATCHED,
)
from ..modal import ModalSteps
from ..snap import base as snapping


class OBJECT_OT_body_moments_match_pose(ModalSteps, Operator):
    """Move the other selected objects onto the active object."""

    bl_idname = "object.body_moments_match_pose"
    bl_label = "Match Pose"
    bl_description = (
        "Move and rotate the other selected objects onto the active object by centers of mass and principal axes, and "
        "report the distance between the surfaces. Symmetric objects take the nearest of their poses; mirror images "
        "are left unchanged"
    )
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = "Comparing: {share:.0%}. Esc to cancel"
    CANCELED = "Match Pose canceled; nothing was moved"

    @classmethod
    def poll(cls, context: Context) -> bool:
        if not selection.poll_selection(cls, context):
            return False
        if context.object is None or not any(obj != context.object for obj in context.view_layer.objects.selected):
            return reports.unavailable(cls, "Select the objects to move, then the object to match")
        return True

    def execute(self, context: Context) -> set[str]:
        self._begin(context)
        return self.run_all_steps(context, len(self._others))

    def invoke(self, context: Context, _event: Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        self._begin(context)
        return self.start_modal(context, len(self._others))

    def _begin(self, context: Context) -> None:
        self._others = [obj for obj in selection.selected_measurable(context) if obj != context.object]
        self._size = 0.0  # size of the active object, once it is measured
        self._plans: list[tuple[reframe.Plan, RigidMatch]] = []
        self._failures: list[Finding] = []
        self._steps = self._compare(context)

    def _compare(self, context: Context) -> Generator[float, None, None]:
        active = context.object
        try:
            target = comparable_shape_of(active, context.evaluated_depsgraph_get())
        except MeasureError as error:
            reports.report(self, reports.refusal(error.about(active.name)))
            return
        yield 0.0
        self._size, skin = target.size, distance_from(target)
        for _ in skin.build():
            yield 0.0

        def find(obj: Object) -> Iterator[float]:
            _require_movable(context, obj)
            shape = comparable_shape_of(obj, context.evaluated_depsgraph_get(), isinstance(target, FlatShape))
            if type(shape) is not type(target):
                raise EditRefusedError(FLAT_AND_BODY)
            yield 0.3
            source_skin = distance_from(shape)
            yield from (0.4 + 0.5 * share for share in source_skin.build())
            self._plans.append(
                _plan_move(context, obj, shape, target, register_surfaces(shape, target, source_skin, skin))
            )

        yield from selection.iterate_objects(self._others, find, self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Move the objects after all places are known, so that a canceled run leaves everything in place."""
        if not self._size:
            return {"CANCELLED"}
        moved, distances = [], []
        for plan, match in self._plans:  # parents first, for a child moves with its parent
            try:
                if not _is_there(plan):
                    reframe.move(context, plan)
                    moved.append(plan.obj)
            except Exception as error:
                self._failures.append(reports.failure(plan.obj.name_full, error))
                continue
            distances.append(_distance(plan.obj.name, match, self._size))
        snapping.remeasure(context, moved)
        done = finding(POSES_MATCHED, count=len(distances), object=context.object.name)
        return selection.summarize(self, len(distances), len(self._others), done, self._failures, distances)


def _distance(name: str, found: RigidMatch, size: float) -> Finding:
    code = POSE_DISTANCE if found.max_distance <= MAX_FIT_RTOL * size else POSE_NOT_A_COPY
    return finding(code, object=name, maximum=float(found.max_distance), mean=float(found.mean_distance))


def _require_movable(context: Context, obj: Object) -> None:
    """Raise EditRefusedError if the object cannot be laid onto the active one."""
    reframe.check_movable(obj)
    if obj in selection.ancestors(context.object):
        raise EditRefusedError(ACTIVE_IS_CHILD)


def _plan_move(
    context: Context, obj: Object, shape: Shape | FlatShape, target: Shape | FlatShape, match: RigidMatch
) -> tuple[reframe.Plan, RigidMatch]:
    """Return the place of the object on the target, and the quality of the match."""
    if match.is_mirror_image:
        raise EditRefusedError(FLAT_MIRROR_IMAGE if isinstance(shape, FlatShape) else MIRROR_IMAGE)
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    matrix = world(obj)
    matrix[:3, :3] = match.rotation @ matrix[:3, :3]
    matrix[:3, 3] = (target.center + match.rotation @ (matrix[:3, 3] * unit - shape.center)) / unit
    return reframe.Plan(obj, matrix, shape.size / unit, move_only=False), match


def _is_there(plan: reframe.Plan) -> np.bool_:
    off = np.abs(plan.target - world(plan.obj))
    return off[:, :3].max() <= 1e-7 and off[:, 3].max() <= reframe.location_tolerance(plan.obj, plan.size)


CLASSES = (OBJECT_OT_body_moments_match_pose,)
