# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid-body constraints and bones as joints; where a constraint stops is asked of Blender's own
simulation.
"""

from math import inf

import bpy
import numpy as np
import pytest
from body_moments.blender.session.robots import bone_links, collection_links, object_links
from mathutils import Matrix

from tests.blender.characters import PARENTS, armature_of, skin_of
from tests.blender.objects import add, mesh_body
from tests.close import close
from tests.core import characters

pytestmark = pytest.mark.usefixtures("scene")
X, Y, Z = np.eye(3)


def rigid(obj, kind="ACTIVE"):
    with bpy.context.temp_override(object=obj, active_object=obj, selected_objects=[obj]):
        bpy.ops.rigidbody.object_add(type=kind)
    return obj


def body(name, location=(0, 0, 0), kind=None):
    obj = add(mesh_body(name), name, location, (0.3, -0.2, 0.5))
    return obj if kind is None else rigid(obj, kind)


def constraint(name, kind, first, second, location=(0, 0, 0), rotation=(0, 0, 0), **settings):
    holder = add(None, name, location, rotation)
    if bpy.context.scene.rigidbody_world is None:
        bpy.ops.rigidbody.world_add()
    bpy.ops.rigidbody.constraint_add(type=kind)
    own = holder.rigid_body_constraint
    own.object1, own.object2 = first, second
    for key, value in settings.items():
        setattr(own, key, value)
    bpy.context.view_layer.update()
    return holder


def robot():
    objects = [obj for obj in bpy.context.scene.objects if obj.type == "MESH"]
    return object_links(bpy.context, "r", objects)


def joints(made):
    return {joint.name: joint for joint in made.robot.joints}


def codes(made):
    return [one.code for one in made.findings]


def axes(joint):
    return [(free.kind, free.axis.tolist(), free.lower, free.upper) for free in joint.free]


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_hinge_stands_at_its_constraint_between_the_objects(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    base, arm = body("Base"), body("Arm", (4, 1, 2))
    holder = constraint("Elbow", "HINGE", base, arm, (1, 2, 3), (0.4, 0.1, -0.7))
    made = robot()
    (joint,) = made.robot.joints
    assert (joint.name, joint.parent, joint.child) == ("Elbow", "Base", "Arm") and not codes(made)
    place = made.robot.link("Arm").pose @ joint.pose
    assert np.abs(place.position - np.array((1, 2, 3)) * unit).max() < 1e-6 * unit
    assert np.abs(place.rotation - np.array(holder.matrix_world.to_3x3())).max() < 1e-6
    assert axes(joint) == [("rotate", Z.tolist(), -inf, inf)]
    holder.rigid_body_constraint.enabled = False
    assert not robot().robot.joints
    arm.parent = base
    assert not robot().robot.joints[0].free


KINDS = {
    "FIXED": (),
    "POINT": ("z", "y", "x"),
    "HINGE": ("z",),
    "SLIDER": ("X",),
    "PISTON": ("X", "x"),
    "GENERIC": ("X", "Y", "Z", "z", "y", "x"),
    "GENERIC_SPRING": ("X", "Y", "Z", "z", "y", "x"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_of_constraints_have_their_axes(kind):
    constraint("Joint", kind, body("Base"), body("Arm", (4, 1, 2)))
    (joint,) = robot().robot.joints
    found = [
        ("XYZ" if free.kind == "translate" else "xyz")[int(np.argmax(free.axis))]
        for free in joint.free
    ]
    assert tuple(found) == KINDS[kind] and joint.is_ball == (kind == "POINT")


def stop(kind, gravity, offset, flip, **limits):
    """Where the second object, or the first if it is flipped, comes to rest relative to its
    start.
    """
    scene = bpy.context.scene
    scene.gravity = gravity
    bpy.ops.rigidbody.world_add()
    world = scene.rigidbody_world
    world.substeps_per_frame = world.solver_iterations = 60
    base, arm = (
        add(mesh_body(name), name, place) for name, place in (("Base", (0, 0, 0)), ("Arm", offset))
    )
    rigid(base, "PASSIVE")
    rigid(arm)
    for index, obj in enumerate((base, arm)):
        obj.rigid_body.collision_collections = [layer == index for layer in range(20)]
    arm.rigid_body.angular_damping = arm.rigid_body.linear_damping = 0.5
    arm.rigid_body.use_deactivation = False
    constraint("Joint", kind, *((arm, base) if flip else (base, arm)), **limits)
    (joint,) = robot().robot.joints
    for frame in range(1, 180):
        scene.frame_set(frame)
    placed = arm.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world
    moved = placed @ Matrix.Translation(offset).inverted()
    return joint, moved.translation, moved.to_euler()


LOCKED = {
    "use_limit_{}_{}".format(kind, axis): True for kind in ("lin", "ang") for axis in "xyz"
} | {
    "limit_{}_{}_{}".format(kind, axis, end): 0.0
    for kind in ("lin", "ang")
    for axis in "xyz"
    for end in ("lower", "upper")
}
CASES = [
    ("HINGE", "ang_z", (0, -9.81, 0), (20, 0, 0)),
    ("SLIDER", "lin_x", (-9.81, 0, 0), (5, 0, 0)),
    ("PISTON", "ang_x", (0, 0, -9.81), (0, 20, 0)),
    ("GENERIC", "ang_y", (0, 0, -9.81), (20, 0, 0)),
    ("GENERIC", "lin_z", (0, 0, -9.81), (5, 0, 0)),
]


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize(("kind", "axis", "gravity", "offset"), CASES)
def test_limits_stop_where_the_simulation_stops(kind, axis, gravity, offset, flip):
    """The passive body is the parent, whichever object of the constraint it is."""
    limits = dict(LOCKED) if kind == "GENERIC" else {}
    if kind == "PISTON":
        limits = {"use_limit_lin_x": True, "limit_lin_x_lower": 0.0, "limit_lin_x_upper": 0.0}
    limits |= {
        "use_limit_" + axis: True,
        "limit_{}_lower".format(axis): -0.25,
        "limit_{}_upper".format(axis): 0.6,
    }
    joint, shift, turn = stop(kind, gravity, offset, flip, **limits)
    assert (joint.parent, joint.child) == ("Base", "Arm")
    (free,) = joint.free
    rotates, index = axis.startswith("ang"), "xyz".index(axis[-1])
    found = turn[index] if rotates else shift[index]
    sign = free.axis[index]
    ends = sorted((sign * free.lower, sign * free.upper))
    assert abs(sign) == 1.0 and free.kind == ("rotate" if rotates else "translate")
    assert close(found, ends[0] if found < 0.0 else ends[1], 0.02)


def test_equal_limits_lock_and_exchanged_limits_free_an_axis():
    base, arm = body("Base"), body("Arm", (4, 1, 2))
    holder = constraint("Joint", "GENERIC", base, arm, **LOCKED)
    own = holder.rigid_body_constraint
    own.limit_ang_x_lower, own.limit_ang_x_upper = 0.5, -0.5
    own.limit_lin_y_lower, own.limit_lin_y_upper = -1.0, 2.0
    bpy.context.scene.unit_settings.scale_length = 0.01
    (joint,) = robot().robot.joints
    (_, y, *ends), (*x, lower, upper) = axes(joint)
    assert y == Y.tolist() and close(ends, [-0.01, 0.02], 1e-6)
    assert x == ["rotate", X.tolist()] and (lower, upper) == (-inf, inf)


def test_parents_come_before_sides_and_loops_are_named():
    base, arm, hand = body("Base"), body("Arm", (4, 0, 0)), body("Hand", (8, 0, 0))
    arm.parent = base
    constraint("Shoulder", "HINGE", arm, base)
    constraint("Wrist", "HINGE", hand, arm)
    constraint("Brace", "FIXED", base, hand)
    constraint("Twist", "SLIDER", arm, base)
    made = robot()
    found = joints(made)
    # The brace holds the hand by the order of names; the wrist would close a loop.
    assert (found["Shoulder"].parent, found["Shoulder"].child) == ("Base", "Arm")
    assert found["Brace"].parent == "Base" and len(found) == 2
    (loop,) = [one for one in made.findings if one.code == "joints_left_out"]
    assert loop.values["joints"] == ["Twist", "Wrist"]


def test_groups_of_parents_hang_on_the_side_that_is_held():
    base, palm, finger = body("Base"), body("Palm", (4, 0, 0)), body("Finger", (8, 0, 0))
    finger.parent = palm
    constraint("Wrist", "HINGE", base, finger)
    made = robot()
    assert {(joint.parent, joint.child) for joint in made.robot.joints} == {
        ("Base", "Finger"),
        ("Finger", "Palm"),
    } or {(joint.parent, joint.child) for joint in made.robot.joints} == {
        ("Palm", "Finger"),
        ("Finger", "Base"),
    }
    assert sum(len(joint.free) for joint in made.robot.joints) == 1


def test_passive_bodies_and_a_fixed_base_are_fixed_to_the_world():
    base, arm = body("Base", kind="PASSIVE"), body("Arm", (4, 1, 2), kind="ACTIVE")
    body("Loose", (9, 9, 9))
    constraint("Hinge", "HINGE", arm, base)
    made = robot()
    assert {link.name: link.is_fixed for link in made.robot.links} == {
        "Base": True,
        "Arm": False,
        "Loose": False,
    }
    assert [(joint.parent, joint.child) for joint in made.robot.joints] == [("Base", "Arm")]
    assert [link.name for link in made.robot.with_fixed_roots().roots if not link.is_fixed] == []
    root = bpy.context.scene.collection
    grouped = collection_links(bpy.context, "r", root, list(root.all_objects))
    assert all(link.is_fixed for link in grouped.robot.links)


def test_constraints_without_two_links_are_named():
    arm, ground = (
        body("Arm", (4, 1, 2)),
        rigid(add(bpy.data.meshes.new("Ground"), "Ground"), "PASSIVE"),
    )
    constraint("Loose", "HINGE", None, arm)
    constraint("Idle", "HINGE", None, None)
    constraint("Foot", "HINGE", ground, arm)
    made = object_links(bpy.context, "r", [arm])
    (joint,) = made.robot.joints
    assert (joint.name, joint.parent) == ("Foot", "Ground") and made.robot.link(
        "Ground"
    ).inertial is None
    (found,) = [one for one in made.findings if one.code == "joints_left_out"]
    assert found.values["joints"] == ["Loose"] and made.robot.roots[0].is_fixed


def test_custom_properties_and_springs_are_the_values_of_joints():
    bpy.context.scene.unit_settings.scale_length = 0.1
    base, arm, hand = body("Base"), body("Arm", (4, 0, 0)), body("Hand", (8, 0, 0))
    settings = {
        "use_spring_ang_z": True,
        "spring_stiffness_ang_z": 5.0,
        "spring_damping_ang_z": 2.0,
    }
    constraint(
        "Elbow", "GENERIC_SPRING", base, arm, **{**LOCKED, "use_limit_ang_z": False}, **settings
    )
    wrist = constraint("Wrist", "SLIDER", arm, hand)
    (
        wrist["joint_damping"],
        wrist["joint_friction"],
        wrist["joint_effort"],
        wrist["joint_velocity"],
    ) = 1, 0.5, 20.0, 3.0
    wrist["joint_mimic"], wrist["joint_mimic_multiplier"], wrist["joint_mimic_offset"] = (
        "Elbow",
        0.5,
        0.25,
    )
    made = robot()
    found = joints(made)
    assert not codes(made) and close(found["Elbow"].free[0].values["stiffness"], 0.05, 1e-6)
    assert close(found["Elbow"].free[0].values["damping"], 0.02, 1e-6)
    expected = {"damping": 1.0, "friction": 0.5, "effort": 20.0, "velocity": 3.0}
    assert found["Wrist"].free[0].values == expected and tuple(found["Wrist"].mimic) == (
        "Elbow",
        0.5,
        0.25,
    )
    wrist["joint_effort"], wrist["joint_damping"], wrist["joint_friction"] = 0.0, "much", -1.0
    wrist["joint_mimic"] = "Nobody"
    made = robot()
    assert [one.values["key"] for one in made.findings] == [
        "joint_damping", "joint_friction", "joint_effort", "joint_mimic",
    ]  # fmt: skip
    assert (
        joints(made)["Wrist"].free[0].values == {"velocity": 3.0}
        and joints(made)["Wrist"].mimic is None
    )


def test_limited_locations_of_bones_slide():
    character = characters.box_skeleton()
    armature = armature_of(character, parents=PARENTS)
    skin_of(character, armature)
    bpy.context.scene.unit_settings.scale_length = 0.01
    armature.scale = (2, 2, 2)
    name = next(
        bone.name
        for bone in armature.pose.bones
        if bone.parent is not None and not bone.bone.use_connect
    )
    bone = armature.pose.bones[name]
    bone.lock_rotation = (True, True, False)
    bone["joint_effort"] = 9.0

    def found():
        made = bone_links(bpy.context, "r", [armature])
        (joint,) = [joint for joint in made.robot.joints if joint.child == name]
        return joint.free

    # Locations without a constraint stay locked.
    assert [free.kind for free in found()] == ["rotate"]
    limit = bone.constraints.new("LIMIT_LOCATION")
    limit.owner_space = "LOCAL"
    limit.use_min_y, limit.use_max_y, limit.min_y, limit.max_y = True, True, -0.5, 1.0
    limit.use_min_x, limit.use_max_x = True, True
    slide, turn = found()
    assert slide.kind == "translate" and slide.axis.tolist() == Y.tolist() and turn.kind == "rotate"
    assert close([slide.lower, slide.upper], [-0.01, 0.02], 1e-6) and slide.values == {
        "effort": 9.0
    }
    bone.lock_location[1] = True
    assert [free.kind for free in found()] == ["rotate"]
    bone.lock_location[1], limit.owner_space = False, "WORLD"
    assert [free.kind for free in found()] == ["rotate"]
