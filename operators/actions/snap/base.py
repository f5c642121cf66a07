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
from dataclasses import dataclass

import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator
from numpy.typing import NDArray

from ....core.inertia.principal_frame import EQUAL_AXES, strict_frame
from ....core.numerics.float32 import decimal
from ....core.verdict import internal_error
from ...bodies.measure_object import measure_body
from ...read import Unreadable
from ...read.quiet import paused
from ...scene import reframe
from ...scene.transforms import Refused
from ...session import results, staleness
from ...settings.options import MeasureOptions
from ...write import properties
from .. import selection

STRICT = BoolProperty(
    name="Zhang and Chen's Rule",
    description=(
        "Take axes 1 and 2 in the direction of positive third moments, as the paper does, and refuse "
        "the bodies of which that rule says nothing: most that have a symmetry"
    ),
    default=False,
)
REFUSALS = (Refused, Unreadable, ValueError, RuntimeError)
TURNED = 1e-3  # what float32 coordinates may turn directions by that moments of higher order fix
DIAGONAL = 4e-7  # of the trace: what float32 coordinates leave of products of inertia


@dataclass(frozen=True)
class Body:
    """An object as measured now, world axes, lengths in Blender units.

    center (3,), axes (3, 3) principal, as columns, det +1; inertia (3, 3) about the center in
    kg·m²; gyration (3,) radii; size: the largest of them; note: what was free to choose. own: the
    axes of equal moments whose directions are the shape's own; unique: whether the shape fixes all.
    """

    obj: Object
    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    inertia: NDArray[np.float64]
    gyration: NDArray[np.float64]
    mass: float
    note: str
    own: tuple[int, ...] = ()
    unique: bool = False

    @property
    def size(self) -> float:
        return float(self.gyration.max())

    def is_principal(self, frame: NDArray) -> bool:
        """Whether the columns of `frame` are this body's principal axes, in this order and with
        these signs, as far as its coordinates can tell."""
        tensor = frame.T @ self.inertia @ frame
        limit = DIAGONAL * np.trace(tensor)
        diagonal = np.diag(tensor)
        off = np.abs(tensor - np.diag(diagonal)).max()
        along = (frame * self.axes).sum(axis=0)
        return bool(
            off <= limit
            and (np.diff(diagonal) >= -limit).all()
            and self._has_own(frame)
            and (self.own or (along > -0.5).all())
        )

    def _has_own(self, frame: NDArray) -> bool:
        """Whether the axes of equal moments lie as the shape requires: a cube's sides along any of its
        own axes."""
        cosines = (frame.T @ self.axes)[:, self.own]
        wanted = np.eye(3)[:, self.own] if self.unique else np.round(cosines)
        return bool((np.abs(cosines - wanted) <= TURNED).all())


def body_of(context: Context, obj: Object, strict: bool = False) -> Body:
    """Measure an object; Refused where its numbers depend on a reference point. strict: with the
    axes of Zhang and Chen's rule, or refused where it has none."""
    measured = measure_body(obj, context.evaluated_depsgraph_get(), MeasureOptions(pose=True))
    measurement = measured.measurement
    if measurement.method.endswith("open"):
        raise Refused(
            "it is open and cannot be capped, so that its center is not its own; close it, or set its kind to Shell"
        )
    unit = decimal(context.scene.unit_settings.scale_length)
    body = measurement.mass_properties
    principal = body.principal
    if strict:
        varied = measurement.kind == "shell" or measured.body.mass is not None
        principal = strict_frame(measurement.mass_moments[0], None if varied else measured.body.refined)
    return Body(
        obj=obj,
        center=body.center / unit,
        axes=principal.axes,
        inertia=body.inertia,
        gyration=body.radii_of_gyration / unit,
        mass=body.mass,
        note=principal.note,
        own=tuple(i for i in EQUAL_AXES[principal.symmetry] if i not in principal.free),
        unique=principal.unique,
    )


def refresh(context: Context, objects: list[Object]) -> None:
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
        except Exception as error:  # what is stored stays, and the panel says that it is out of date
            internal_error.reason(error, REFUSALS)
            continue
        fresh.append(obj)
    staleness.settle(context, fresh)


def reframe_selected(
    operator: Operator,
    context: Context,
    wanted: Callable[[Object, Body], NDArray | None],
    text: str,
    move_only: bool,
    strict: bool = False,
) -> set[str]:
    """Give each selected object the matrix that `wanted` returns for it, while nothing visible moves, and report it.
    `wanted` returns None where the object is right as it is.
    """
    objects = selection.selected(context)
    plans: list[reframe.Plan] = []

    def plan(obj: Object) -> bool:
        reframe.check(obj)
        body = body_of(context, obj, strict)
        target = wanted(obj, body)
        if target is not None:
            plans.append(reframe.Plan(obj, target, body.size, move_only=move_only))
        return True

    _, failures = selection.each(objects, plan, REFUSALS)
    with paused(), selection.progress(len(plans)) as step:
        done, refused = reframe.reframe(context, plans, step)
        failures += [(obj.name, reason) for obj, reason in refused]
        if not move_only:  # without its scale Blender cuts what is not flat into other triangles: another body
            plans.clear()
            selection.each([one.obj for one in done], plan, REFUSALS)
            reframe.reframe(context, plans)
    refresh(context, [plan.obj for plan in done])
    if not move_only:
        staleness.mark_turned(plan.obj for plan in done)
    notes = ["{:s} {:s}".format(plan.obj.name, note) for plan in done for note in plan.notes]
    return selection.summarise(
        operator, len(done), len(objects), text, failures, notes, idle="all of it was there already"
    )
