# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that are made for a character: rigid bodies with joints, and an empty at its center of
mass.

A bone's part moves with the bone, so an empty at the part's center is parented to the bone. Copy
Location constraints put one more empty at the weighted mean of these: the influence of each is its
part's share of the mass so far.
"""

import bpy
import numpy as np
from bpy.types import Context, Object, PoseBone
from mathutils import Matrix, Vector

from ...core.mesh import join_surfaces
from ...core.moments import affine_matrices
from ...core.verdict import EditRefusedError
from ..bodies.rig import BonePart, Rig
from ..scale import meters_per_unit
from .changes import MadeCollection
from .findings import RIGID_BODY_MASS_TOO_SMALL
from .rigid_world import MIN_MASS, add_joint, add_rigid_bodies, require_rigid_world

CENTER_OF = "center_of_mass_of"  # ID property of the made objects: the armature object
RIG_OF = "physics_rig_of"


def add_center(context: Context, rig: Rig) -> None:
    """Add an empty that follows the character's center of mass."""
    armature = rig.armature
    unit = meters_per_unit(context.scene)
    made = MadeCollection(context, armature, CENTER_OF, "Center of Mass")
    center = bpy.data.objects.new("{:s} Center of Mass".format(armature.name), None)
    center.empty_display_type = "SPHERE"
    center.show_in_front = True
    center.empty_display_size = (
        0.1 * float(rig.measurement.mass_properties.radii_of_gyration.max()) / unit
    )
    made.link(center)
    mass_so_far = 0.0
    for part in rig.parts:
        if part.mass.total <= 0.0:
            continue
        mass_so_far += part.mass.total
        constraint = center.constraints.new("COPY_LOCATION")
        constraint.name = part.name
        constraint.target = _follower(context, made, armature, part, unit)
        constraint.influence = part.mass.total / mass_so_far
    context.view_layer.update()


def _follower(
    context: Context, made: MadeCollection, armature: Object, part: BonePart, unit: float
) -> Object:
    """Add an empty at the center of a bone's part, parented to the bone, and return it."""
    bone = armature.data.bones[part.name]
    empty = bpy.data.objects.new("{:s} {:s} Center".format(armature.name, part.name), None)
    empty.empty_display_size = 0.1 * bone.length
    made.link(empty)
    rest = np.array(armature.matrix_world @ bone.matrix_local, np.float64)
    local = np.linalg.solve(rest, np.append(part.mass.center / unit, 1.0))[:3]
    empty.parent = armature
    empty.parent_type = "BONE"
    empty.parent_bone = bone.name
    empty.matrix_parent_inverse = Matrix.Identity(4)
    # children of a bone start at its tail
    empty.location = Vector(local) - Vector((0.0, bone.length, 0.0))
    empty.hide_set(True)
    return empty


def create_physics_rig(context: Context, rig: Rig) -> tuple[int, int]:
    """Create rigid bodies and joints of a character's parts; return the number of each."""
    parts = [part for part in rig.parts if part.measurement is not None]
    for part in parts:
        if part.mass.total < MIN_MASS:
            raise EditRefusedError(
                RIGID_BODY_MASS_TOO_SMALL,
                subject=part.name,
                mass=float(part.mass.total),
                limit=MIN_MASS,
            )
    require_rigid_world(context.scene, joints=True)
    unit = meters_per_unit(context.scene)
    made = MadeCollection(context, rig.armature, RIG_OF, "Physics Rig")
    bodies = {part.name: _body(made, rig.armature, part, unit) for part in parts}
    add_rigid_bodies(context, list(bodies.values()))
    for part in parts:
        physics = bodies[part.name].rigid_body
        physics.mass = part.mass.total
        physics.collision_shape = "CONVEX_HULL"
    joints = 0
    for name, body in bodies.items():
        bone = rig.armature.pose.bones[name]
        above = next(
            (bodies[parent.name] for parent in bone.parent_recursive if parent.name in bodies), None
        )
        if above is not None:
            _joint(context, made, bone, above, body)
            joints += 1
    context.view_layer.update()
    return len(bodies), joints


def _body(made: MadeCollection, armature: Object, part: BonePart, unit: float) -> Object:
    """Add the object of a part: its closed pieces, in a frame at its center along its principal
    axes.
    """
    assert part.measurement is not None
    body = part.measurement.mass_properties
    frame = affine_matrices(body.principal.axes, body.center / unit)
    surface = join_surfaces(
        [piece.transform(matrix[:3, :3], matrix[:3, 3]) for piece, matrix in part.surfaces]
    )
    mesh = bpy.data.meshes.new("{:s} {:s}".format(armature.name, part.name))
    points = (surface.points / unit - frame[:3, 3]) @ frame[:3, :3]
    mesh.from_pydata(points, [], surface.triangles)
    mesh.validate()
    obj = bpy.data.objects.new(mesh.name, mesh)
    made.link(obj)
    obj.rotation_mode = "QUATERNION"
    obj.matrix_world = Matrix(frame)
    obj.body_moments.mass_from = "MASS"
    obj.body_moments.mass = part.mass.total
    return obj


def _joint(
    context: Context, made: MadeCollection, bone: PoseBone, above: Object, below: Object
) -> None:
    """Add a joint at a bone's head, along its axes, with the limits of its inverse kinematics."""
    armature = bone.id_data
    joint = bpy.data.objects.new("{:s} {:s} Joint".format(armature.name, bone.name), None)
    joint.empty_display_size = (
        0.25 * bone.bone.length * float(np.mean(armature.matrix_world.to_scale()))
    )
    made.link(joint)
    location, turn, _scale = (armature.matrix_world @ bone.bone.matrix_local).decompose()
    joint.rotation_mode = "QUATERNION"
    joint.location = location
    joint.rotation_quaternion = turn
    constraint = add_joint(context, joint, "GENERIC")
    constraint.object1 = above
    constraint.object2 = below
    constraint.disable_collisions = True
    for axis in "xyz":
        locked = getattr(bone, "lock_ik_" + axis)
        limited = getattr(bone, "use_ik_limit_" + axis)
        setattr(constraint, "use_limit_lin_" + axis, True)
        setattr(constraint, "use_limit_ang_" + axis, locked or limited)
        for end, of_bone in (("lower", "min"), ("upper", "max")):
            angle = 0.0 if locked else getattr(bone, "ik_{:s}_{:s}".format(of_bone, axis))
            setattr(constraint, "limit_lin_{:s}_{:s}".format(axis, end), 0.0)
            setattr(constraint, "limit_ang_{:s}_{:s}".format(axis, end), angle)
