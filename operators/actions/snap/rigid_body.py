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

from ....core.numerics.float32 import decimal
from ...read.quiet import paused
from ...scene import reframe
from ...scene.transforms import Refused, require_own, world
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
        return selection.poll_selected(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected(context)
        bodies: list[snapping.Body] = []

        def measure(obj: Object) -> bool:
            require_own(obj, "its rigid body's mass")
            if obj.rigid_body is None and not self.add:
                raise Refused("it is no rigid body; turn on Add Rigid Bodies, or add one in its physics properties")
            if obj.rigid_body is None and obj.type != "MESH":
                raise Refused("only meshes can be rigid bodies; convert it first")
            body = snapping.body_of(context, obj)
            limit = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min
            if body.mass < limit:
                raise Refused(
                    "its mass of {:.3g} kg is less than the {:.3g} kg that a rigid body can "
                    "have; raise its density".format(body.mass, limit)
                )
            bodies.append(body)
            return True

        context.view_layer.update()  # edits of before are noted as such
        with paused():  # Blender reports a rigid body as a change of the shape
            _, failures = selection.each(objects, measure, snapping.REFUSALS)
            new = [body.obj for body in bodies if body.obj.rigid_body is None]
            failures += _add(context, new)
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
        notes = []
        unit = decimal(context.scene.unit_settings.scale_length)
        if count and unit != 1.0 and context.scene.unit_settings.system != "NONE":
            notes = [
                "Blender's physics properties show masses times {:.6g}, the scene's unit scale cubed; physics takes "
                "the kilograms that were set".format(unit**3)
            ]
        if elsewhere and count:
            notes += [
                "Physics takes the origin as center of mass, which it is not for {:s}: use Axes "
                "to Principal Axes".format(", ".join(elsewhere[: selection.LISTED]))
            ]
        return selection.summarise(
            self,
            count,
            len(objects),
            "Set the rigid body mass of {count}",
            failures,
            notes,
            idle="the masses were right already",
        )


def _add(context: Context, objects: list[Object]) -> list[tuple[str, str]]:
    """Make them active rigid bodies, all by one operator; (name, reason) of those that Blender makes none of."""
    reason = "Blender makes no rigid body of it"
    if objects:
        try:
            with context.temp_override(object=objects[0], active_object=objects[0], selected_objects=objects):
                bpy.ops.rigidbody.objects_add(type="ACTIVE")
        except RuntimeError as error:
            reason = str(error)
    return [(obj.name_full, reason) for obj in objects if obj.rigid_body is None]


CLASSES = (OBJECT_OT_body_moments_set_rigid_body_mass,)
