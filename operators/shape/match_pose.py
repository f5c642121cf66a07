# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Pose: lay the other selected objects onto the active one by centers of mass and principal
axes.
"""

from collections.abc import Generator, Iterator

from bpy.types import Context, Object, Operator

from ... import core
from ...blender import bodies, scene, session, write
from ...core.verdict import EditRefusedError, Finding, MeasureError, finding
from .. import findings, modal, selection


class OBJECT_OT_body_moments_match_pose(modal.ModalSteps, Operator):
    """Move and rotate the other selected objects onto the active object by centers of mass and
    principal axes, and report the distance between the surfaces. Symmetric objects take the nearest
    of their poses; mirror images are left unchanged
    """

    bl_label = "Match Pose"
    PROGRESS = "Comparing: {share:.0%}. Esc to cancel"
    CANCELED = "Match Pose canceled; nothing was moved"

    @classmethod
    def poll(cls, context: Context) -> bool:
        other_objects = [
            obj for obj in context.view_layer.objects.selected if obj != context.object
        ]
        if context.object is None or not other_objects:
            return write.reports.unavailable(
                cls, "Select the objects to move, then the object to match"
            )
        return selection.poll_object_mode(cls, context)

    def _begin(self, context: Context) -> int:
        self._others = [
            obj for obj in selection.selected_measurable(context) if obj != context.object
        ]
        self._size = 0.0  # size of the active object in m; 0 until it is measured
        self._plans: list[tuple[scene.reframe_meshes.Plan, core.shape.RigidMatch]] = []
        self._failures: list[Finding] = []
        self._steps = self._compare(context)
        return len(self._others)

    def _compare(self, context: Context) -> Generator[float, None, None]:
        # The shares 0.3 and 0.9 of an object's time are estimated.
        active = context.object
        try:
            target = bodies.comparable_shape_of(active, context.evaluated_depsgraph_get())
        except MeasureError as error:
            write.reports.report(self, write.reports.refusal(error.about(active.name)))
            return
        yield 0.0
        self._size = target.size
        target_skin = bodies.distance_from(target)
        yield 0.0

        def find(obj: Object) -> Iterator[float]:
            scene.require_matchable(context, obj)
            shape = bodies.comparable_shape_of(
                obj, context.evaluated_depsgraph_get(), flat=isinstance(target, bodies.FlatShape)
            )
            if type(shape) is not type(target):
                raise EditRefusedError(findings.FLAT_AND_BODY)
            yield 0.3
            source_skin = bodies.distance_from(shape)
            yield 0.9
            match = bodies.register_surfaces(shape, target, source_skin, target_skin)
            self._plans.append((scene.plan_match(context, obj, shape, target, match), match))

        yield from selection.iterate_objects(self._others, find, self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Move the objects after all places are known, so that a canceled run leaves everything in
        place.
        """
        if not self._size:  # `_compare` has reported why
            return {"CANCELLED"}
        moved_objects, distances = [], []
        for plan, match in self._plans:  # parents first, for a child moves with its parent
            try:
                if scene.move_to_match(context, plan):
                    moved_objects.append(plan.obj)
            except Exception as error:
                self._failures.append(write.reports.failure(plan.obj.name_full, error))
            else:
                distances.append(_distance(plan.obj.name, match, self._size))
        session.remeasure(context, moved_objects)
        summary = write.reports.phrase(
            "Moved {count} object onto {object}",
            "Moved {count} objects onto {object}",
            count=len(distances),
            object=context.object.name,
        )
        return selection.summarize(
            self, len(distances), len(self._others), summary, self._failures, distances
        )


def _distance(name: str, match: "core.shape.RigidMatch", size: float) -> Finding | str:
    # name: of the moved object. size: of the active one, in m
    values = {
        "object": name,
        "maximum": float(match.max_distance),
        "mean": float(match.mean_distance),
    }
    if not scene.is_copy(match, size):
        return finding(findings.POSE_NOT_A_COPY, **values)
    return write.reports.phrase(
        "{object}: surfaces at most {maximum:length} apart, {mean:length} on average", **values
    )
