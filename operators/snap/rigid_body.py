# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Set Rigid Body Mass, in kilograms.

Blender's own Calculate Mass weighs the collision shape, not the object.

Bullet, Blender's physics engine, takes the object's origin as the center of mass and a diagonal inertia along the
object's axes; Axes to Principal Axes makes that right.
"""

import bpy
import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Event, Object, Operator

from ...blender.read.tracking import tracking_paused
from ...blender.scene import reframe
from ...blender.scene.rigid_world import add_rigid_bodies, require_rigid_world
from ...blender.scene.transforms import require_storable_data, world
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError, Finding, finding
from .. import selection
from ..findings import (
    LIBRARY_OVERRIDE_MASS,
    NOT_A_RIGID_BODY,
    RIGID_BODY_CENTER_ELSEWHERE,
    RIGID_BODY_DISPLAY_SCALED,
    RIGID_BODY_MASS_TOO_SMALL,
    RIGID_BODY_MASSES_EQUAL,
    RIGID_BODY_MASSES_SET,
    RIGID_BODY_NEEDS_MESH,
)
from ..modal import MAX_OBJECTS_WITHOUT_REDRAW, ModalSteps
from . import base as snapping
from .principal_axes import matrix_along_axes


class OBJECT_OT_body_moments_set_rigid_body_mass(ModalSteps, Operator):
    """Set the mass of rigid bodies to the measured mass in kilograms."""

    bl_idname = "object.body_moments_set_rigid_body_mass"
    bl_label = "Set Rigid Body Mass"
    bl_description = (
        "Set the mass of rigid bodies to the measured mass in kilograms. The physics engine uses the origin as center "
        "of mass; use Axes to Principal Axes as well"
    )
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = "Measuring: {share:.0%}. Esc to cancel"
    CANCELED = "Measuring canceled; nothing was changed"

    add: BoolProperty(
        name="Add Rigid Bodies",
        description="Add an active rigid body to objects without one",
        default=False,
    )
    axes: BoolProperty(
        name="Set Origins and Axes",
        description=(
            "Move origins to the centers of mass and align the local axes with the principal axes, as the physics "
            "engine takes them to be. Nothing visible moves"
        ),
        default=False,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        return self.run_all_steps(context, self._begin(context))

    def invoke(self, context: Context, event: Event) -> set[str]:
        count = self._begin(context)
        if count <= MAX_OBJECTS_WITHOUT_REDRAW or context.window is None:
            return self.run_all_steps(context, count)
        return self.start_modal(context, count)

    def _begin(self, context: Context) -> int:
        self._objects = selection.selected_measurable(context)
        self._bodies: list[snapping.SnapTarget] = []
        self._failures: list[Finding] = []
        target_in_turn = snapping.targets_in_turn(context, self._objects)

        def measure(obj: Object) -> None:
            require_storable_data(obj, LIBRARY_OVERRIDE_MASS)
            if obj.rigid_body is None and not self.add:
                raise EditRefusedError(NOT_A_RIGID_BODY)
            if obj.rigid_body is None and obj.type != "MESH":
                raise EditRefusedError(RIGID_BODY_NEEDS_MESH)
            if obj.rigid_body is None:
                require_rigid_world(context.scene)
            body = target_in_turn(obj)
            limit = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min
            if body.mass < limit:
                raise EditRefusedError(RIGID_BODY_MASS_TOO_SMALL, mass=float(body.mass), limit=limit)
            self._bodies.append(body)

        self._steps = selection.iterate_objects(self._objects, measure, self._failures)
        return len(self._objects)

    def _finish(self, context: Context) -> set[str]:
        bodies, failures = self._bodies, self._failures
        with tracking_paused():  # Blender reports a rigid body as a change of the shape
            new = [body.obj for body in bodies if body.obj.rigid_body is None]
            add_rigid_bodies(context, new)
            changed = set(new)
            for body in bodies:
                if np.float32(body.obj.rigid_body.mass) != np.float32(body.mass):
                    body.obj.rigid_body.mass = body.mass
                    changed.add(body.obj)
            context.view_layer.update()
        findings = []
        if self.axes:
            plans, refused = snapping.reframe_objects(
                context, [body.obj for body in bodies], matrix_along_axes, move_only=False
            )
            failures += refused
            changed |= {plan.obj for plan in plans}
            findings += [found.of_sources([plan.obj.name]) for plan in plans for found in plan.findings]
        elsewhere = [
            body.obj.name
            for body in bodies
            if np.abs(world(body.obj)[:3, 3] - body.center).max() > reframe.location_tolerance(body.obj, body.size)
        ]
        count = len(changed)
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        if count and unit != 1.0 and context.scene.unit_settings.system != "NONE":
            findings.append(finding(RIGID_BODY_DISPLAY_SCALED, factor=unit**3))
        if elsewhere and count:
            findings.append(finding(RIGID_BODY_CENTER_ELSEWHERE, objects=elsewhere))
        done, idle = finding(RIGID_BODY_MASSES_SET, count=count), finding(RIGID_BODY_MASSES_EQUAL)
        return selection.summarize(self, count, len(self._objects), done, failures, findings, idle)


CLASSES = (OBJECT_OT_body_moments_set_rigid_body_mass,)
