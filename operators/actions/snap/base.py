# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the snapping operators share: where the body is now, in Blender units, and refreshing
what was stored.

Directions of nearly equal moments are not fixed by a body whose coordinates are float32: measured
again they turn, by about rounding over the gap between the moments. Whether axes are principal is
therefore decided by the tensor, which must be diagonal in them to rounding, not from the angle
between two measured frames.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator
from numpy.typing import NDArray

from ....core.inertia.principal_frame import zhang_chen_frame
from ....core.inertia.second_order import EQUAL_AXES
from ....core.numerics.float32 import shortest_decimal
from ....core.verdict import internal_error
from ....core.verdict.finding import EditRefusedError, Finding, finding
from ....core.verdict.method import Verdict
from ...bodies.measure_object import measure_body
from ...read.quiet import paused
from ...scene import reframe
from ...session import results, staleness
from ...settings.options import MeasureOptions
from ...write import properties, reports
from .. import selection
from ..modal import progress

STRICT_PROPERTY = BoolProperty(
    name="Zhang and Chen's Rule",
    description=(
        "Take axes 1 and 2 in the direction of positive third moments, as in the paper. Objects for which "
        "the rule is undefined, such as most symmetric ones, are left unchanged"
    ),
    default=False,
)
MAX_DIRECTION_NOISE = 1e-3  # what float32 coordinates may turn directions by that moments of higher order fix
DIAGONAL_RTOL = 4e-7  # of the trace: what float32 coordinates leave of products of inertia


@dataclass(frozen=True)
class SnapTarget:
    """An object as measured now, world axes, lengths in Blender units.

    center (3,), axes (3, 3) principal, as columns, det +1; inertia (3, 3) about the center in
    kg·m²; gyration (3,) radii; size: the largest of them; finding: what was free to choose. shape_axes: the
    axes of equal moments whose directions are the shape's own; is_unique: whether the shape fixes all.
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
        """Whether the columns of `frame` are this body's principal axes, in this order and with
        these signs, as far as its coordinates can show."""
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
        """Whether the axes of equal moments lie as the shape requires: a cube's sides along any of its
        own axes."""
        cosines = (frame.T @ self.axes)[:, self.shape_axes]
        expected = np.eye(3)[:, self.shape_axes] if self.is_unique else np.round(cosines)
        return bool((np.abs(cosines - expected) <= MAX_DIRECTION_NOISE).all())


def snap_target(context: Context, obj: Object, strict: bool = False) -> SnapTarget:
    """Measure an object; EditRefusedError where its numbers depend on a reference point. strict: with the axes of Zhang
    and Chen's rule, or refused where it has none."""
    measured = measure_body(obj, context.evaluated_depsgraph_get(), MeasureOptions(pose=True))
    measurement = measured.measurement
    if measurement.method.verdict == Verdict.OPEN:
        raise EditRefusedError("open_object")
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    body = measurement.mass_properties
    principal = body.principal
    if strict:
        varied = measurement.kind == "shell" or measured.body.mass is not None
        principal = zhang_chen_frame(measurement.mass_moments[0], None if varied else measured.body.third_order)
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


def remeasure(context: Context, objects: list[Object]) -> None:
    """Measure and store again the objects that carry results: an operator that moved them keeps
    them up to date.
    """
    stored = [obj for obj in objects if properties.is_stored(obj)]
    if not stored:
        return
    context.view_layer.update()
    depsgraph = context.evaluated_depsgraph_get()
    fresh = []
    for obj in stored:
        try:
            results.store(obj, measure_body(obj, depsgraph, MeasureOptions(pose=True)), context.scene)
        except Exception as error:  # what is stored stays, and the panel shows that it is out of date
            internal_error.finding_of(error)
            continue
        fresh.append(obj)
    staleness.mark_up_to_date(context, fresh)


def reframe_selected(
    operator: Operator,
    context: Context,
    target_matrix: Callable[[Object, SnapTarget], NDArray | None],
    done: Finding,
    move_only: bool,
    strict: bool = False,
) -> set[str]:
    """Give each selected object the matrix that `target_matrix` returns for it, while nothing visible moves, and report
    it. `target_matrix` returns None where the object is right as it is. done: the report; it gets the value `count`.
    """
    objects = selection.selected_measurable(context)
    plans: list[reframe.Plan] = []

    def plan(obj: Object) -> bool:
        reframe.check(obj)
        body = snap_target(context, obj, strict)
        target = target_matrix(obj, body)
        if target is not None:
            plans.append(reframe.Plan(obj, target, body.size, move_only=move_only))
        return True

    _, failures = selection.apply_to_all(objects, plan)
    with paused(), progress(len(plans)) as step:
        changed, refused = reframe.reframe(context, plans, step)
        failures += [reports.failure(obj.name_full, refusal) for obj, refusal in refused]
        if not move_only:  # without its scale Blender cuts what is not flat into other triangles: another body
            plans.clear()
            selection.apply_to_all([plan_done.obj for plan_done in changed], plan)
            reframe.reframe(context, plans)
    remeasure(context, [plan.obj for plan in changed])
    if not move_only:
        staleness.mark_axes_changed(plan.obj for plan in changed)
    findings = [found.of_sources([plan.obj.name]) for plan in changed for found in plan.findings]
    done = replace(done, values={"count": len(changed)})
    idle = finding("already_in_place")
    return selection.summarize(operator, len(changed), len(objects), done, failures, findings, idle)
