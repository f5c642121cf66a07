# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of the snapping operators.

They find the current place of the body, in Blender units, and update stored results.

Directions of nearly equal moments are not fixed by a body whose coordinates are float32: measured again they turn, by
about rounding over the gap between the moments. Whether axes are principal is therefore decided by the tensor, which
must be diagonal in them to rounding, not from the angle between two measured frames.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator
from numpy.typing import NDArray

from ...blender.bodies.measure_object import Measured, measure_body
from ...blender.bodies.stacks.many import measure_many, measured_in_turn
from ...blender.bodies.stacks.stack import Stacked
from ...blender.read.tracking import tracking_paused
from ...blender.scene import reframe
from ...blender.session.findings import OPEN_OBJECT
from ...blender.session.stored import assembly, results
from ...blender.session.tracking import staleness
from ...blender.settings.options import MeasureOptions
from ...blender.write import properties, reports
from ...core.inertia.principal_frames import zhang_chen_frame
from ...core.inertia.third_moment_frames import EQUAL_AXES
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict import internal_error
from ...core.verdict.finding import EditRefusedError, Finding, finding
from ...core.verdict.method import Verdict
from .. import selection
from ..findings import ALREADY_IN_PLACE
from ..modal import progress

STRICT_PROPERTY = BoolProperty(
    name="Zhang and Chen's Rule",
    description=(
        "Take axes 1 and 2 in the direction of positive third moments, as in the paper. Objects for which "
        "the rule is undefined, such as most symmetric ones, are left unchanged"
    ),
    default=False,
)
POSE, CENTER = MeasureOptions(pose=True), MeasureOptions(axes=False)
NOTHING: Mapping[Object, Measured | Stacked] = {}
MAX_DIRECTION_NOISE = 1e-3  # rounding in float32 of directions fixed by moments of higher order
DIAGONAL_RTOL = 4e-7  # products of inertia by rounding in float32, relative to the trace


@dataclass(frozen=True)
class SnapTarget:
    """An object as measured now, world axes, lengths in Blender units.

    center (3,), axes (3, 3) principal, as columns, det +1; inertia (3, 3) about the center in kg·m²; gyration (3,)
    radii; size: the largest of them; finding: about free choices. shape_axes: the axes of equal moments fixed by the
    shape itself; is_unique: the shape fixes all.
    """

    obj: Object
    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    inertia: NDArray[np.float64]
    gyration: NDArray[np.float64]
    mass: float
    finding: Finding | None
    shape_axes: tuple[int, ...] = ()
    is_unique: bool = False

    @property
    def size(self) -> float:
        return float(self.gyration.max())

    def is_principal(self, frame: NDArray) -> bool:
        """Return whether the columns of `frame` are this body's principal axes, as far as its coordinates can show.

        The axes must be in this order and with these signs.
        """
        tensor = frame.T @ self.inertia @ frame
        limit = DIAGONAL_RTOL * np.trace(tensor)
        diagonal = np.diag(tensor)
        off = np.abs(tensor - np.diag(diagonal)).max()
        along = (frame * self.axes).sum(axis=0)
        return bool(
            off <= limit
            and (np.diff(diagonal) >= -limit).all()
            and self._matches_shape_axes(frame)
            and (self.shape_axes or (along > -0.5).all())
        )

    def _matches_shape_axes(self, frame: NDArray) -> bool:
        """Return whether axes of equal moments lie as the shape requires: a cube's sides along any of its own axes."""
        cosines = (frame.T @ self.axes)[:, self.shape_axes]
        expected = np.eye(3)[:, self.shape_axes] if self.is_unique else np.round(cosines)
        return bool((np.abs(cosines - expected) <= MAX_DIRECTION_NOISE).all())


def targets_in_turn(
    context: Context, objects: Sequence[Object], strict: bool = False
) -> Callable[[Object], SnapTarget]:
    """Return a function that gives the `snap_target` of one object at a time, measured in batches.

    The scene must not change meanwhile.
    """
    measured = measured_in_turn(objects, context.evaluated_depsgraph_get(), POSE)
    return lambda obj: target_of(context, obj, measured(obj), strict)


def snap_target(context: Context, obj: Object, strict: bool = False) -> SnapTarget:
    """Measure an object for snapping.

    Raises EditRefusedError if its numbers depend on a reference point. strict: use the axes of Zhang and Chen's rule,
    or refuse the object if it has none.
    """
    return target_of(context, obj, measure_body(obj, context.evaluated_depsgraph_get(), POSE), strict)


def target_of(context: Context, obj: Object, measured: Measured | Stacked, strict: bool) -> SnapTarget:
    """Return the `snap_target` of a measured object."""
    if measured.method.verdict == Verdict.OPEN:
        raise EditRefusedError(OPEN_OBJECT)
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    body = measured.mass_properties
    principal = body.principal
    if strict:
        # By itself, its third moments are found exactly where they are doubtful.
        depsgraph = context.evaluated_depsgraph_get()
        own = measure_body(obj, depsgraph, POSE) if isinstance(measured, Stacked) else measured
        measurement = own.measurement
        body_of = None if measurement.kind == "shell" else own.body
        refine = None if body_of is None or body_of.mass is not None else body_of.third_order
        principal = zhang_chen_frame(measurement.mass_moments[0], refine)
    return SnapTarget(
        obj=obj,
        center=body.center / unit,
        axes=principal.axes,
        inertia=body.inertia,
        gyration=body.radii_of_gyration / unit,
        mass=body.mass,
        finding=principal.finding,
        shape_axes=tuple(i for i in EQUAL_AXES[principal.symmetry] if i not in principal.undetermined_axes),
        is_unique=principal.is_unique,
    )


def remeasure(
    context: Context, objects: Sequence[Object], known: Mapping[Object, Measured | Stacked] = NOTHING
) -> None:
    """Measure and store again the objects with stored results, after an operator has moved them.

    known: measurements of objects that have not moved since.
    """
    stored = [obj for obj in objects if properties.is_stored(obj)]
    if not stored:
        return
    measured, fresh, shapes = [(obj, known[obj]) for obj in stored if obj in known], [], {}
    shapes.update((obj, outcome.shape_digest) for obj, outcome in measured if isinstance(outcome, Stacked))
    unknown = [obj for obj in stored if obj not in known]
    for together in measure_many(unknown, context.evaluated_depsgraph_get(), POSE):
        for obj, outcome in together:
            if isinstance(outcome, Exception):  # stored results stay, and the panel shows that they are out of date
                internal_error.finding_of(outcome)
            else:
                measured.append((obj, outcome))
                if isinstance(outcome, Stacked):
                    shapes[obj] = outcome.shape_digest
    for obj, refusal in results.store_many(measured, context.scene):
        if refusal is None:
            fresh.append(obj)
        else:
            internal_error.finding_of(refusal)
    staleness.mark_up_to_date(context, fresh, shapes)


def reframe_objects(
    context: Context,
    objects: Sequence[Object],
    target_matrix: Callable[[Object, SnapTarget], NDArray | None],
    move_only: bool,
    strict: bool = False,
) -> tuple[list[reframe.Plan], list[Finding]]:
    """Carry out `reframe_selected` for objects; return the changes, and the reasons for refusals."""

    def plans_of(
        chosen: Sequence[Object], right: dict[Object, Measured | Stacked] | None = None
    ) -> tuple[list[reframe.Plan], list[Finding]]:
        """Plan the moves. right: gets the measurements of objects to be stored that are in place already."""
        plans: list[reframe.Plan] = []
        measured = measured_in_turn(chosen, context.evaluated_depsgraph_get(), CENTER if move_only else POSE)

        def plan(obj: Object) -> None:
            reframe.check(obj)
            outcome = measured(obj)
            body = target_of(context, obj, outcome, strict)
            target = target_matrix(obj, body)
            if target is not None:
                plans.append(reframe.Plan(obj, target, body.size, move_only=move_only))
            elif right is not None and properties.is_stored(obj):
                right[obj] = outcome

        return plans, selection.apply_to_all(chosen, plan)[1]

    plans, failures = plans_of(objects)
    known: dict[Object, Measured | Stacked] = {}
    with assembly.kept_up_to_date(context):
        with tracking_paused(), progress(len(plans)) as step:
            changed, refused = reframe.reframe(context, plans, step)
            failures += [reports.failure(obj.name_full, refusal) for obj, refusal in refused]
            if not move_only:  # without its scale Blender cuts what is not flat into other triangles: another body
                reframe.reframe(context, plans_of([plan_done.obj for plan_done in changed], known)[0])
        remeasure(context, [plan.obj for plan in changed], known)
    if not move_only:
        staleness.mark_axes_changed(plan.obj for plan in changed)
    return changed, failures


def reframe_selected(
    operator: Operator,
    context: Context,
    target_matrix: Callable[[Object, SnapTarget], NDArray | None],
    done: Finding,
    move_only: bool,
    strict: bool = False,
) -> set[str]:
    """Give each selected object the matrix that `target_matrix` returns, while nothing visible moves, and report it.

    `target_matrix` returns None if the object is in place already. done: the report; it gets the value `count`.
    """
    objects = selection.selected_measurable(context)
    changed, failures = reframe_objects(context, objects, target_matrix, move_only, strict)
    findings = [found.of_sources([plan.obj.name]) for plan in changed for found in plan.findings]
    done = replace(done, values={"count": len(changed)})
    idle = finding(ALREADY_IN_PLACE)
    return selection.summarize(operator, len(changed), len(objects), done, failures, findings, idle)
