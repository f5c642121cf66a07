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

from ..core.decimal import decimal
from . import reframe, selection, snapping, staleness
from .channels import Refused, require_own, world


class OBJECT_OT_body_moments_set_rigid_body_mass(Operator):
    """Set the mass of rigid bodies to the measured mass in kilograms"""

    bl_idname = "object.body_moments_set_rigid_body_mass"
    bl_label = "Set Rigid Body Mass"
    bl_description = (
        "Set the mass of rigid bodies to the measured mass in kilograms. The physics "
        "engine takes an object's origin as its center of mass: use Axes to Principal "
        "Axes as well"
    )
    bl_options = {"REGISTER", "UNDO"}

    add: BoolProperty(
        name="Add Rigid Bodies",
        description="Make objects without a rigid body active rigid bodies first",
        default=False,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selected(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected(context)
        elsewhere: list[str] = []

        def assign(obj: Object) -> bool:
            require_own(obj, "its rigid body's mass")
            if obj.rigid_body is None and not self.add:
                raise Refused(
                    "it is no rigid body; turn on Add Rigid Bodies, or add one in its physics "
                    "properties"
                )
            if obj.rigid_body is None and obj.type != "MESH":
                raise Refused("only meshes can be rigid bodies; convert it first")
            body = snapping.body_of(context, obj)
            limit = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min
            if body.mass < limit:
                raise Refused(
                    "its mass of {:.3g} kg is less than the {:.3g} kg that a rigid body can "
                    "have; raise its density".format(body.mass, limit)
                )
            changed = obj.rigid_body is None
            if changed:
                with context.temp_override(object=obj, active_object=obj, selected_objects=[obj]):
                    bpy.ops.rigidbody.object_add(type="ACTIVE")
            if np.float32(obj.rigid_body.mass) != np.float32(body.mass):
                obj.rigid_body.mass = body.mass
                changed = True
            if np.abs(world(obj)[:3, 3] - body.center).max() > reframe.location_tolerance(
                obj, body.size
            ):
                elsewhere.append(obj.name)
            return changed

        context.view_layer.update()  # edits of before are noted as such
        with staleness.paused():  # Blender reports a rigid body as a change of the shape
            count, failures = selection.each(objects, assign, snapping.REFUSALS)
            context.view_layer.update()
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
        return selection.summarise(self, count, len(objects), "Set the rigid body mass of {count}", failures, notes,
                                   idle="the masses were right already")


CLASSES = (OBJECT_OT_body_moments_set_rigid_body_mass,)
