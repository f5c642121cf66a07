# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Set Rigid Body Mass, in kilograms. Blender's own Calculate Mass weighs the collision shape,
not the object.

Bullet, Blender's physics engine, takes the object's origin as the center of mass and a diagonal
inertia along the object's axes; Axes to Principal Axes makes that right.
"""

import bpy
import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator

from ....core.numerics.float32 import shortest_decimal
from ....core.verdict.finding import EditRefusedError, Finding, finding
from ...read.quiet import paused
from ...scene import reframe
from ...scene.transforms import require_storable_data, world
from ...write import reports
from .. import selection
from . import base as snapping


class OBJECT_OT_body_moments_set_rigid_body_mass(Operator):
    """Set the mass of rigid bodies to the measured mass in kilograms"""

    bl_idname = "object.body_moments_set_rigid_body_mass"
    bl_label = "Set Rigid Body Mass"
    bl_description = (
        "Set the mass of rigid bodies to the measured mass in kilograms. The physics engine uses the origin as center "
        "of mass; use Axes to Principal Axes as well"
    )
    bl_options = {"REGISTER", "UNDO"}

    add: BoolProperty(
        name="Add Rigid Bodies",
        description="Add an active rigid body to objects without one",
        default=False,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        bodies: list[snapping.SnapTarget] = []

        def measure(obj: Object) -> bool:
            require_storable_data(obj, "library_override_mass")
            if obj.rigid_body is None and not self.add:
                raise EditRefusedError("not_a_rigid_body")
            if obj.rigid_body is None and obj.type != "MESH":
                raise EditRefusedError("rigid_body_needs_mesh")
            body = snapping.snap_target(context, obj)
            limit = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min
            if body.mass < limit:
                raise EditRefusedError("rigid_body_mass_too_small", mass=float(body.mass), limit=limit)
            bodies.append(body)
            return True

        context.view_layer.update()  # edits of before are noted as such
        with paused():  # Blender reports a rigid body as a change of the shape
            _, failures = selection.apply_to_all(objects, measure)
            new = [body.obj for body in bodies if body.obj.rigid_body is None]
            failures += _add_rigid_bodies(context, new)
            changed = {obj for obj in new if obj.rigid_body is not None}
            for body in bodies:
                if body.obj.rigid_body is not None and np.float32(body.obj.rigid_body.mass) != np.float32(body.mass):
                    body.obj.rigid_body.mass = body.mass
                    changed.add(body.obj)
            count = len(changed)
            context.view_layer.update()
        elsewhere = [
            body.obj.name
            for body in bodies
            if body.obj.rigid_body is not None
            and np.abs(world(body.obj)[:3, 3] - body.center).max() > reframe.location_tolerance(body.obj, body.size)
        ]
        findings = []
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        if count and unit != 1.0 and context.scene.unit_settings.system != "NONE":
            findings.append(finding("rigid_body_display_scaled", factor=unit**3))
        if elsewhere and count:
            findings.append(finding("rigid_body_center_elsewhere", objects=elsewhere))
        done, idle = finding("rigid_body_masses_set", count=count), finding("rigid_body_masses_equal")
        return selection.summarize(self, count, len(objects), done, failures, findings, idle)


def _add_rigid_bodies(context: Context, objects: list[Object]) -> list[Finding]:
    """Make them active rigid bodies, all by one operator; why Blender makes none of some."""
    refusal = EditRefusedError("rigid_body_not_added_unknown")
    if objects:
        try:
            with context.temp_override(object=objects[0], active_object=objects[0], selected_objects=objects):
                bpy.ops.rigidbody.objects_add(type="ACTIVE")
        except RuntimeError as error:
            refusal = EditRefusedError("rigid_body_not_added", error=" ".join(str(error).split()))
    return [reports.failure(obj.name_full, refusal) for obj in objects if obj.rigid_body is None]


CLASSES = (OBJECT_OT_body_moments_set_rigid_body_mass,)
