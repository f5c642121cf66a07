# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Set Rigid Body Mass, in kilograms.

Blender's own Calculate Mass weighs the collision shape, not the object.

Bullet, Blender's physics engine, takes the object's origin as the center of mass and a diagonal inertia along the
object's axes; after Axes to Principal Axes both are true.
"""

from typing import TYPE_CHECKING

from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator

from ...blender import scene, session
from ...blender.read.tracking import tracking_paused
from ...blender.scene.changes import require_storable_data
from ...blender.scene.findings import RIGID_BODY_MASS_TOO_SMALL, RIGID_BODY_NEEDS_MESH
from ...blender.write import reports
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError, Finding, finding
from .. import selection
from ..findings import NOT_A_RIGID_BODY, RIGID_BODY_CENTER_ELSEWHERE
from ..modal import ModalSteps

if TYPE_CHECKING:
    from ...blender.scene.snap_targets import SnapTarget


class OBJECT_OT_body_moments_set_rigid_body_mass(ModalSteps, selection.OnSelectionInObjectMode, Operator):
    """Set the mass of rigid bodies to the measured mass in kilograms."""

    bl_idname = "object.body_moments_set_rigid_body_mass"
    bl_label = "Set Rigid Body Mass"
    bl_description = (
        "Set the mass of rigid bodies to the measured mass in kilograms. The physics engine uses the origin as center "
        "of mass; use Axes to Principal Axes as well"
    )
    MAX_AT_ONCE = selection.MAX_OBJECTS_WITHOUT_REDRAW

    add: BoolProperty(
        name="Add Rigid Bodies",
        description="Add an active rigid body to objects without one",
    )
    axes: BoolProperty(
        name="Set Origins and Axes",
        description=(
            "Move origins to the centers of mass and align the local axes with the principal axes, as the physics "
            "engine takes them to be. Nothing visible moves"
        ),
    )

    def _begin(self, context: Context) -> int:
        self._objects = selection.selected_measurable(context)
        self._bodies: list[SnapTarget] = []
        self._failures: list[Finding] = []
        target_in_turn = scene.targets_in_turn(context, self._objects)

        def measure(obj: Object) -> None:
            require_storable_data(obj)
            if obj.rigid_body is None and not self.add:
                raise EditRefusedError(NOT_A_RIGID_BODY)
            if obj.rigid_body is None and obj.type != "MESH":
                raise EditRefusedError(RIGID_BODY_NEEDS_MESH)
            if obj.rigid_body is None:
                scene.rigid_world.require_rigid_world(context.scene)
            body = target_in_turn(obj)
            if body.mass < scene.rigid_world.MIN_MASS:
                raise EditRefusedError(
                    RIGID_BODY_MASS_TOO_SMALL, mass=float(body.mass), limit=scene.rigid_world.MIN_MASS
                )
            self._bodies.append(body)

        self._steps = selection.iterate_objects(self._objects, measure, self._failures)
        return len(self._objects)

    def _finish(self, context: Context) -> set[str]:
        bodies, failures = self._bodies, self._failures
        with tracking_paused():  # Blender reports a rigid body as a change of the shape
            new = [body.obj for body in bodies if body.obj.rigid_body is None]
            scene.rigid_world.add_rigid_bodies(context, new)
            changed = set(new)
            for body in bodies:
                before = body.obj.rigid_body.mass
                body.obj.rigid_body.mass = body.mass
                if body.obj.rigid_body.mass != before:
                    changed.add(body.obj)
            context.view_layer.update()
        findings = []
        if self.axes:
            objects = [body.obj for body in bodies]
            plans, refused = session.reframe_objects(context, objects, scene.matrix_along_axes, move_only=False)
            failures += refused
            changed |= {plan.obj for plan in plans}
            findings += [found.of_sources([plan.obj.name]) for plan in plans for found in plan.findings]
        count = len(changed)
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        if count and unit != 1.0 and context.scene.unit_settings.system != "NONE":
            findings.append(display_scaled(unit))
        elsewhere = [body.obj.name for body in bodies if scene.matrix_at_center(body.obj, body) is not None]
        if elsewhere and count:
            findings.append(finding(RIGID_BODY_CENTER_ELSEWHERE, objects=elsewhere))
        done = reports.phrase(
            "Set the rigid body mass of {count} object", "Set the rigid body mass of {count} objects", count=count
        )
        idle = reports.phrase("the masses are equal")
        return selection.summarize(self, count, len(self._objects), done, failures, findings, idle)


def display_scaled(unit: float) -> str:
    """Return the message that Blender shows masses multiplied by the cube of the unit scale."""
    return reports.phrase(
        "Physics properties show masses times {factor:.6g} (unit scale cubed); the physics engine uses kilograms.",
        factor=unit**3,
    )


CLASSES = (OBJECT_OT_body_moments_set_rigid_body_mass,)
