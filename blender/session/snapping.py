# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""New origins and axes of objects; objects with stored results are measured again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from bpy.types import Context, Object
from numpy.typing import NDArray

from ...core.verdict import Finding, internal_error
from .. import bodies, read, scene, write
from .stored import assembly, results
from .tracking import staleness


def remeasure(
    context: Context,
    objects: Sequence[Object],
    measurements: Mapping[Object, bodies.stack.Measured] | None = None,
) -> None:
    """Measure and store results anew of objects that have stored results and have moved.

    measurements: those of objects that have not moved since; these are only stored.
    """
    measurements = measurements or {}
    stored = [obj for obj in objects if write.properties.is_stored(obj)]
    if not stored:
        return
    measured = [(obj, measurements[obj]) for obj in stored if obj in measurements]
    for together in bodies.measure_object.measure_many(
        [obj for obj in stored if obj not in measurements], context.evaluated_depsgraph_get()
    ):
        for obj, outcome in together:
            # stored results stay, and the panel shows that they are out of date
            if isinstance(outcome, Exception):  # prints the traceback of an internal error
                internal_error.finding_of(outcome)
            else:
                measured.append((obj, outcome))
    for refusal in results.store_measured(context, measured).values():
        internal_error.finding_of(refusal)


def reframe_objects(
    context: Context,
    objects: Sequence[Object],
    target_matrix: Callable[[Object, scene.snap_targets.SnapTarget], NDArray | None],
    move_only: bool,
    strict: bool = False,
) -> tuple[list[scene.reframe.Plan], list[Finding]]:
    """Give objects the frames of `target_matrix` while nothing visible moves, and measure stored
    results again; return finished plans and refusals.

    target_matrix: returns an object's (4, 4) frame in the world, in Blender units, or None to leave
    it as it is. move_only: whether the frames have the objects' own axes. strict: as in
    `snap_targets.target_of`.
    """

    def plans_of(
        subjects: Sequence[Object], unplanned: dict[Object, bodies.stack.Measured], by_shape: bool
    ) -> tuple[list[scene.reframe.Plan], list[Finding]]:
        """Return plans and refusals; measurements of objects that stay as they are go to
        `unplanned` if their results are stored. by_shape: moments to sixth order choose among axes
        that lower ones leave open.
        """
        plans: list[scene.reframe.Plan] = []
        failures: list[Finding] = []
        measure_next = bodies.measure_object.measured_in_turn(
            subjects, context.evaluated_depsgraph_get()
        )
        with write.reports.progress(len(subjects)) as step:
            for finished, obj in enumerate(subjects, 1):
                try:
                    scene.reframe.check(obj)
                    outcome = measure_next(obj)
                    body = scene.snap_targets.target_of(context, obj, outcome, strict, by_shape)
                    target = target_matrix(obj, body)
                except Exception as error:
                    failures.append(write.reports.failure(obj.name_full, error))
                else:
                    if target is not None:
                        plans.append(
                            scene.reframe.Plan(obj, target, body.size, move_only=move_only)
                        )
                    elif write.properties.is_stored(obj):
                        unplanned[obj] = outcome
                step(finished)
        return plans, failures

    plans, failures = plans_of(objects, {}, not move_only)
    unchanged: dict[Object, bodies.stack.Measured] = {}
    with assembly.kept_up_to_date(context):
        with read.tracking.tracking_paused(), write.reports.progress(len(plans)) as step:
            changed, refused = scene.reframe.reframe(context, plans, step)
            failures += [write.reports.failure(obj.name_full, refusal) for obj, refusal in refused]
            # A new scale may cut faces that are not flat into other triangles. The axes of this
            # other body differ slightly, and the choice among open axes stays that of the first.
            if not move_only:
                again, _ = plans_of([plan.obj for plan in changed], unchanged, by_shape=False)
                scene.reframe.reframe(context, again)
        remeasure(context, [plan.obj for plan in changed], unchanged)
    if not move_only:
        staleness.mark_axes_changed(plan.obj for plan in changed)
    return changed, failures
