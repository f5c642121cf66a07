# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Create Physics Rig: a rigid body with the exact mass for each bone's part, and a joint at each bone."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.types import Bone, Context, Object, Operator, PoseBone
from mathutils import Matrix

from ...blender.bodies.findings import BONE_PARTS_IMPOSSIBLE
from ...blender.bodies.rig import BonePart, Rig, measure_rig
from ...blender.read.rig import require_armature
from ...blender.read.tracking import tracking_paused
from ...blender.scene.made_collections import MadeCollection
from ...blender.scene.rigid_world import add_joint, add_rigid_bodies, require_rigid_world
from ...blender.write import reports
from ...core.mesh.surface import join_surfaces
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError, MeasureError, finding
from .. import selection
from ..findings import PHYSICS_RIG_CREATED, PHYSICS_RIG_TOO_LIGHT
from ..modal import redraw
from .measure import poll_armature

RIG_OF = "physics_rig_of"  # ID property of what is made: the armature object
MIN_MASS = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min


class OBJECT_OT_body_moments_physics_rig(Operator):
    """Create rigid bodies with the exact masses of the bones' parts, joined at the bones."""

    bl_idname = "object.body_moments_physics_rig"
    bl_label = "Create Physics Rig"
    bl_description = (
        "Create a rigid body for the part of each bone, in rest pose, with its exact mass, its origin at its center of "
        "mass and its axes along its principal axes, and a joint at each bone. One created before is replaced"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_armature(cls, context)

    def execute(self, context: Context) -> set[str]:
        try:
            rig = measure_rig(context, require_armature(context.object))
            parts = [part for part in rig.parts if part.measurement is not None]
            light = [part.name for part in parts if part.mass.total < MIN_MASS]
            if light:
                raise EditRefusedError(PHYSICS_RIG_TOO_LIGHT, subject=rig.armature.name, names=light, limit=MIN_MASS)
            require_rigid_world(context.scene, joints=True)
            with tracking_paused():
                bodies, joints = _create(context, rig, parts)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        missing = [part.name for part in rig.parts if part.measurement is None]
        more = [finding(BONE_PARTS_IMPOSSIBLE, count=len(missing), names=missing)] if missing else []
        selection.report(self, finding(PHYSICS_RIG_CREATED, count=bodies, joints=joints), *more)
        redraw(context)
        return {"FINISHED"}


def _create(context: Context, rig: Rig, parts: list[BonePart]) -> tuple[int, int]:
    """Make the objects; how many bodies and joints."""
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    made = MadeCollection(context, rig.armature, RIG_OF, "Physics Rig")
    bodies = {part.name: _body(made, rig.armature, part, unit) for part in parts}
    add_rigid_bodies(context, list(bodies.values()))
    for part in parts:
        physics = bodies[part.name].rigid_body
        physics.mass, physics.collision_shape = part.mass.total, "CONVEX_HULL"
    joints = 0
    for name, body in bodies.items():
        above = _parent_with_part(rig.armature.data.bones[name], bodies)
        if above is not None:
            _joint(context, made, rig.armature.pose.bones[name], bodies[above], body)
            joints += 1
    context.view_layer.update()
    return len(bodies), joints


def _body(made: MadeCollection, armature: Object, part: BonePart, unit: float) -> Object:
    """Add the object of a part: its closed pieces, in a frame at its center along its principal axes."""
    assert part.measurement is not None
    body = part.measurement.mass_properties
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = body.principal.axes, body.center / unit
    surface = join_surfaces([piece.transform(matrix[:3, :3], matrix[:3, 3]) for piece, matrix in part.surfaces])
    mesh = bpy.data.meshes.new("{:s} {:s}".format(armature.name, part.name))
    points = (surface.points / unit - frame[:3, 3]) @ frame[:3, :3]
    mesh.from_pydata(points, [], surface.triangles)
    mesh.validate()
    obj = bpy.data.objects.new(mesh.name, mesh)
    made.link(obj)
    obj.rotation_mode = "QUATERNION"
    obj.matrix_world = Matrix(frame)
    settings = obj.body_moments
    settings.mass_from, settings.mass = "MASS", part.mass.total
    return obj


def _parent_with_part(bone: Bone, bodies: dict[str, Object]) -> str | None:
    """Return the nearest bone above that has a body."""
    return next((parent.name for parent in bone.parent_recursive if parent.name in bodies), None)


def _joint(context: Context, made: MadeCollection, bone: PoseBone, above: Object, below: Object) -> None:
    """Add a joint at a bone's head, along its axes, with the limits of its inverse kinematics."""
    armature = bone.id_data
    joint = bpy.data.objects.new("{:s} {:s} Joint".format(armature.name, bone.name), None)
    joint.empty_display_size = 0.25 * bone.bone.length * float(np.mean(armature.matrix_world.to_scale()))
    made.link(joint)
    location, turn, _scale = (armature.matrix_world @ bone.bone.matrix_local).decompose()
    joint.rotation_mode = "QUATERNION"
    joint.location, joint.rotation_quaternion = location, turn
    constraint = add_joint(context, joint, "GENERIC")
    constraint.object1, constraint.object2, constraint.disable_collisions = above, below, True
    for axis in "xyz":
        setattr(constraint, "use_limit_lin_" + axis, True)
        setattr(constraint, "limit_lin_{:s}_lower".format(axis), 0.0)
        setattr(constraint, "limit_lin_{:s}_upper".format(axis), 0.0)
        locked, limited = getattr(bone, "lock_ik_" + axis), getattr(bone, "use_ik_limit_" + axis)
        setattr(constraint, "use_limit_ang_" + axis, locked or limited)
        low, high = (getattr(bone, "ik_{:s}_{:s}".format(end, axis)) for end in ("min", "max"))
        setattr(constraint, "limit_ang_{:s}_lower".format(axis), 0.0 if locked else low)
        setattr(constraint, "limit_ang_{:s}_upper".format(axis), 0.0 if locked else high)


CLASSES = (OBJECT_OT_body_moments_physics_rig,)
