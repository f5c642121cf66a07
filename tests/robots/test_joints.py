# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints away from the links' origins, fixed bases, and values of joints, in the programs that read
the files.

The truth is the product of exponentials: each joint turns and moves all that it holds about its
place in the world.
"""

import json
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import opensim
import pinocchio
import pytest
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.robots import (
    Candidate,
    Connection,
    assemble_robot,
    with_primitives,
    without_collision,
)
from body_moments.core.robots.model import (
    FreeAxis,
    Joint,
    Link,
    Mimic,
    Pose,
    Robot,
    combine_inertials,
)
from body_moments.core.robots.write import gltf, mjcf, sdf, urdf, usd
from body_moments.core.robots.write.texts import check, robot_text
from pxr import UsdPhysics, UsdValidation
from urdf_parser_py.urdf import URDF

from tests.blender.robot_truth import about
from tests.robots import sdf_schema
from tests.robots.consumers import summed
from tests.robots.links import free_axes, inertial, near, rotation, shaped
from tests.robots.stage import stage_of

KINDS = ("ball", "box", "sheared")


def assembly(seed, size=1.0):
    """A random tree of bodies with joints anywhere, some stated from the child's side, some of
    parents alone.
    """
    rng = np.random.default_rng(seed)
    candidates, connections = [], []
    for index in range(int(rng.integers(2, 9))):
        name = "link {}".format(index)
        points, triangles = shaped(rng, KINDS[index % 3])
        pose = Pose(size * rng.normal(size=3), rotation(rng))
        link = Link(
            name,
            inertial(size * points, triangles, 1000.0 / size**5),
            pose,
            is_fixed=index == 0 and seed % 2 == 0,
        )
        above = "link {}".format(rng.integers(index)) if index else ""
        is_parent = bool(rng.integers(2))
        candidates.append(Candidate(name, link, [above] if index and is_parent else ()))
        if index and not (is_parent and rng.integers(3) == 0):
            sides = (name, above) if rng.integers(2) else (above, name)
            place = Pose(size * rng.normal(size=3), rotation(rng))
            free = free_axes(rng, int(rng.integers(1, 6)))
            if index % 4 == 3:  # a piston, which its other side sees turn first
                free = (
                    FreeAxis("translate", np.eye(3)[2], -0.25, 0.5),
                    FreeAxis("rotate", np.eye(3)[2]),
                )
            connections.append(Connection("joint {}".format(index), *sides, place, free))
    robot, findings = assemble_robot("random", candidates, connections)
    assert not findings and len(robot.joints) == len(candidates) - 1
    return robot


def moved(robot, values):
    """The map of each link's points in the world, (4, 4), at values for each joint's axes."""
    maps = {link.name: np.eye(4) for link in robot.roots}
    for link in robot.ordered():
        joint = robot.joint_of(link.name)
        if joint is None:
            continue
        frame, total = link.pose @ joint.pose, maps[joint.parent]
        for free, value in zip(joint.free, values[joint.name]):
            step, axis = np.eye(4), frame.rotation @ free.axis
            if free.kind == "translate":
                step[:3, 3] = value * axis
            else:
                step[:3, :3] = about(axis, value)
                step[:3, 3] = frame.position - step[:3, :3] @ frame.position
            total = total @ step
        maps[link.name] = total
    return maps


def random_values(robot, rng):
    return {joint.name: rng.uniform(-0.25, 0.25, len(joint.free)) for joint in robot.joints}


def load(robot, form):
    """MuJoCo's model and data in the zero pose, and the place of the world in its own."""
    model = mujoco.MjModel.from_xml_string(robot_text(robot, form)[0])
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    (root,) = robot.roots
    is_placed = form == "mjcf" or root.is_fixed
    place = Pose() if is_placed else root.pose.inverse()  # A root of URDF is its world.
    return model, data, place


def set_joints(model, data, robot, values):
    for joint in robot.joints:
        if (
            joint.is_ball
            and model.jnt_type[model.joint(joint.name).id if has(model, joint.name) else 0] == BALL
        ):
            turn = np.eye(3)
            for free, value in zip(joint.free, values[joint.name]):
                turn = turn @ about(joint.pose.rotation @ free.axis, value)
            mujoco.mju_mat2Quat(data.joint(joint.name).qpos, turn.ravel())
            continue
        names = ["{}_axis_{}", "{}_{}"]
        for count, value in enumerate(values[joint.name], start=1):
            tried = [name.format(joint.name, count) for name in names] + [joint.name]
            (name, *_) = [name for name in tried if has(model, name)]
            data.joint(name).qpos[0] = value
    mujoco.mj_forward(model, data)


BALL = mujoco.mjtJoint.mjJNT_BALL


def has(model, name):
    return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0


@pytest.mark.parametrize("form", ["mjcf", "urdf"])
def test_100_assemblies_weigh_and_move_in_mujoco_as_stated(form):
    """Mass, center and inertia of the whole in the zero pose; marked points as the joints turn."""
    for seed in range(100):
        robot = assembly(seed, (1.0, 0.01, 10.0, 0.001)[seed % 4])
        rng = np.random.default_rng(seed)
        model, data, place = load(robot, form)
        turns = data.ximat[1:].reshape(-1, 3, 3)
        tensors = (turns * model.body_inertia[1:, None]) @ turns.transpose(0, 2, 1)
        mass, center, inertia = summed(zip(model.body_mass[1:], data.xipos[1:], tensors))
        parts = [link.inertial.place(place @ link.pose) for link in robot.links]
        truth = combine_inertials(parts)
        assert abs(mass / truth.mass - 1.0) < 1e-9 and near(inertia, truth.inertia, 1e-9)
        reach = np.sqrt(np.trace(truth.inertia) / truth.mass)
        assert near(center, truth.center, 1e-9, reach)
        values = random_values(robot, rng)
        marks = {}
        for link in robot.links:
            point = link.pose.position + rng.normal(size=3)
            body = data.body(link.name)
            start = place.rotation @ point + place.position
            marks[link.name] = point, body.xmat.reshape(3, 3).T @ (start - body.xpos)
        set_joints(model, data, robot, values)
        maps = moved(robot, values)
        for link in robot.links:
            point, own = marks[link.name]
            body = data.body(link.name)
            found = body.xmat.reshape(3, 3) @ own + body.xpos
            true = maps[link.name][:3, :3] @ point + maps[link.name][:3, 3]
            reach = max(1.0, np.abs(true).max())
            assert np.abs(found - (place.rotation @ true + place.position)).max() < 1e-12 * reach


def test_pinocchio_loads_100_random_assemblies_and_agrees():
    """URDF: freedom, limits, and the links' places as the joints turn."""
    for seed in range(100):
        robot = assembly(seed, (1.0, 0.01, 10.0)[seed % 3])
        (root,) = robot.roots
        place = Pose() if root.is_fixed else root.pose.inverse()
        model = pinocchio.buildModelFromXML(robot_text(robot, "urdf")[0])
        data, rng, q = model.createData(), np.random.default_rng(seed), pinocchio.neutral(model)
        assert model.nv == sum(len(joint.free) for joint in robot.joints)
        values = random_values(robot, rng)
        for joint in robot.joints:
            for count, (free, value) in enumerate(zip(joint.free, values[joint.name]), start=1):
                last = count == len(joint.free)
                one = model.joints[
                    model.getJointId(joint.name if last else "{}_axis_{}".format(joint.name, count))
                ]
                q[one.idx_q : one.idx_q + one.nq] = (
                    value if one.nq == 1 else (np.cos(value), np.sin(value))
                )
                if free.is_limited:
                    ends = model.lowerPositionLimit[one.idx_q], model.upperPositionLimit[one.idx_q]
                    assert ends == (free.lower, free.upper)
        pinocchio.framesForwardKinematics(model, data, q)
        maps = moved(robot, values)
        for link in robot.links:
            frame = data.oMf[model.getFrameId(link.name)]
            total = place.matrix @ maps[link.name] @ link.pose.matrix
            joint = robot.joint_of(link.name)
            # A link's origin is at its joint.
            own = Pose() if joint is None else Pose(joint.pose.position)
            size = max(1.0, np.abs(total[:3, 3]).max())
            assert np.abs(frame.homogeneous - total @ own.matrix).max() < 1e-12 * size


def test_opensim_loads_40_random_assemblies_and_agrees():
    """Freedom, ranges, and where bodies are as the coordinates change."""
    opensim.Logger.setLevelString("off")
    for seed in range(40):
        robot = assembly(seed, (1.0, 0.1, 10.0)[seed % 3])
        Path("robot.osim").write_text(robot_text(robot, "osim")[0], encoding="utf-8")
        model, rng = opensim.Model("robot.osim"), np.random.default_rng(seed)
        state = model.initSystem()
        values = random_values(robot, rng)
        for joint in robot.joints:
            name = usd.identifier(joint.name)
            found = model.getJointSet().get(name)
            coordinates = [found.get_coordinates(index) for index in range(found.numCoordinates())]
            assert len(coordinates) == len(joint.free)
            if joint.is_ball:
                values[joint.name][:] = 0.0  # The order of its axes is OpenSim's own.
                continue
            # A joint that turns before it moves is stated from its other side.
            is_turned = [free.kind for free in joint.free] == ["rotate", "translate"]
            pairs = list(zip(joint.free, values[joint.name]))[:: -1 if is_turned else 1]
            for (free, value), coordinate in zip(
                sorted(pairs, key=lambda pair: pair[0].kind), coordinates, strict=True
            ):
                coordinate.setValue(state, float(value))
                if free.is_limited:
                    assert (coordinate.getRangeMin(), coordinate.getRangeMax()) == (
                        free.lower,
                        free.upper,
                    )
        model.realizePosition(state)
        maps = moved(robot, values)
        for link in robot.links:
            found = model.getBodySet().get(usd.identifier(link.name)).getTransformInGround(state)
            turn = np.array([[found.R().asMat33().get(i, j) for j in range(3)] for i in range(3)])
            true = maps[link.name] @ link.pose.matrix
            assert np.abs(vector(found.p()) - true[:3, 3]).max() < 1e-11 * max(
                1.0, np.abs(true[:3, 3]).max()
            )
            assert np.abs(turn - true[:3, :3]).max() < 1e-11


def vector(values):
    return np.array([values.get(index) for index in range(3)])


def test_sdf_joint_frames_stand_where_they_are_meant():
    robot = assembly(7)
    root = ElementTree.fromstring(sdf.write(robot))
    sdf_schema.validate(root)
    elements = {element.get("name"): element for element in root.iter("joint")}
    for joint in robot.joints:
        element = elements[joint.name]
        if not joint.pose.position.any():  # of a parent alone
            assert element.find("pose") is None
            continue
        x, y, z, *turn, w = map(float, element.findtext("pose").split())
        assert np.abs(np.array([x, y, z]) - joint.pose.position).max() < 1e-15
        assert np.abs(rotation_matrix([w, *turn]) - joint.pose.rotation).max() < 1e-14


def arm(values=None, mimic=None, is_fixed=False, free=None):
    """A base, an arm on a hinge and a hand on a slide."""
    rng = np.random.default_rng(2)
    x, _, z = np.eye(3)
    body = inertial(*shaped(rng, "box"))
    links = [
        Link(name, body, Pose(rng.normal(size=3)), is_fixed=is_fixed and name == "base")
        for name in ("base", "arm", "hand")
    ]
    free = free or (FreeAxis("rotate", z, -1.0, 1.0, values or {}),)
    hinge = Joint("hinge", "base", "arm", free, Pose(rng.normal(size=3)))
    slide = Joint(
        "slide", "arm", "hand", (FreeAxis("translate", x, 0.0, 0.5, values or {}),), mimic=mimic
    )
    return Robot("arm", tuple(links), (hinge, slide))


def test_fixed_base_does_not_fall_in_any_format():
    for is_fixed in (False, True):
        robot = arm(is_fixed=is_fixed)
        for form in ("mjcf", "urdf"):
            model = mujoco.MjModel.from_xml_string(robot_text(robot, form)[0])
            assert model.nq == 2 + (0 if is_fixed or form == "urdf" else 7)
        tree = URDF.from_xml_string(urdf.write(robot).encode())
        assert tree.get_root() == ("world" if is_fixed else "base")
        joints = ElementTree.fromstring(sdf.write(robot)).iter("joint")
        assert [
            joint.findtext("child") for joint in joints if joint.findtext("parent") == "world"
        ] == ["base"] * is_fixed
        stage = stage_of(usd.write(robot))
        alone = [prim for prim in stage.Traverse() if prim.IsA(UsdPhysics.FixedJoint)]
        assert len(alone) == is_fixed
        for prim in alone:
            joint = UsdPhysics.Joint(prim)
            assert (
                not joint.GetBody0Rel().GetTargets()
                and str(joint.GetBody1Rel().GetTargets()[0]) == "/Robot/base"
            )
            assert (
                np.abs(
                    np.array(joint.GetLocalPos0Attr().Get()) - robot.links[0].pose.position
                ).max()
                < 1e-6
            )
        (node,) = [
            node for node in json.loads(gltf.write(robot))["nodes"] if node["name"] == "base"
        ]
        khr, omi = (
            node["extensions"][name]["motion"]
            for name in ("KHR_physics_rigid_bodies", "OMI_physics_body")
        )
        assert khr.get("isKinematic", False) == is_fixed and omi["type"] == (
            "kinematic" if is_fixed else "dynamic"
        )


VALUES = {"damping": 0.5, "friction": 0.25, "effort": 12.0, "velocity": 3.0, "stiffness": 7.0}


def test_stated_values_of_joints_are_in_each_format():
    robot = arm(VALUES, Mimic("hinge", 0.25, 0.125))
    lost = {}
    for form in ("urdf", "sdf", "mjcf", "usd", "gltf"):
        found = [one for one in check(robot, form) if one.code != "joints_all_fixed"]
        lost[form] = [(one.code, one.values["values"]) for one in found]
    assert lost == {
        "urdf": [("joint_values_lost", ["stiffness"])],
        "sdf": [("joint_values_lost", ["mimic"])],
        "mjcf": [("joint_values_lost", ["velocity"])],
        **dict.fromkeys(
            ("usd", "gltf"), [("joint_values_lost", ["friction", "mimic", "velocity"])]
        ),
    }
    hinge, slide = URDF.from_xml_string(urdf.write(robot).encode()).joints
    for joint in (hinge, slide):
        assert (joint.dynamics.damping, joint.dynamics.friction) == (0.5, 0.25)
        assert (joint.limit.effort, joint.limit.velocity) == (12.0, 3.0)
    assert (slide.mimic.joint, slide.mimic.multiplier, slide.mimic.offset) == ("hinge", 0.25, 0.125)
    root = ElementTree.fromstring(sdf.write(robot))
    sdf_schema.validate(root)
    for name, value in (
        ("damping", 0.5),
        ("friction", 0.25),
        ("spring_stiffness", 7.0),
        ("effort", 12.0),
        ("velocity", 3.0),
    ):
        assert [float(element.text) for element in root.iter(name)] == [value] * 2
    model = mujoco.MjModel.from_xml_string(mjcf.write(robot))
    assert (
        model.dof_damping[-2:].tolist() == [0.5] * 2
        and model.dof_frictionloss[-2:].tolist() == [0.25] * 2
    )
    assert (
        model.jnt_stiffness.tolist()[1:] == [7.0] * 2
        and model.jnt_actfrcrange[1:].tolist() == [[-12.0, 12.0]] * 2
    )
    assert model.eq_data[0, :3].tolist() == [0.125, 0.25, 0.0]
    assert (model.eq_obj1id[0], model.eq_obj2id[0]) == (
        model.joint("slide").id,
        model.joint("hinge").id,
    )
    stage = stage_of(usd.write(robot))
    for name, direction, unit in (("hinge", "angular", np.pi / 180.0), ("slide", "linear", 1.0)):
        drive = UsdPhysics.DriveAPI.Get(stage.GetPrimAtPath("/Robot/" + name), direction)
        assert (
            abs(drive.GetDampingAttr().Get() - 0.5 * unit) < 1e-7
            and drive.GetMaxForceAttr().Get() == 12.0
        )
        assert abs(drive.GetStiffnessAttr().Get() - 7.0 * unit) < 1e-7
    joints = json.loads(gltf.write(robot))["extensions"]["KHR_physics_rigid_bodies"][
        "physicsJoints"
    ]
    common = {"mode": "force", "axis": 0, "damping": 0.5, "stiffness": 7.0, "maxForce": 12.0}
    assert [joint["drives"] for joint in joints] == [
        [{"type": kind, **common}] for kind in ("angular", "linear")
    ]


def test_missing_efforts_are_placeholders_with_a_note():
    for values, names in (
        (VALUES, []),
        ({"effort": 1.0}, ["hinge", "slide"]),
        ({}, ["hinge", "slide"]),
    ):
        found = [one for one in urdf.check(arm(values)) if one.code == "urdf_effort_unknown"]
        assert [one.values["joints"] for one in found] == ([names] if names else [])
    (limit, _) = [
        joint.limit
        for joint in URDF.from_xml_string(urdf.write(arm({"effort": 1.0})).encode()).joints
    ]
    assert (limit.effort, limit.velocity) == (1.0, urdf.VELOCITY)


def test_sdf_has_a_joint_and_a_light_link_for_each_axis():
    x, y, z = np.eye(3)
    piston = (FreeAxis("translate", x, 0.0, 1.0), FreeAxis("rotate", x))
    socket = (FreeAxis("rotate", z, -1.0, 1.0), FreeAxis("rotate", y), FreeAxis("rotate", x))
    for free in (piston, socket):
        robot = arm(free=free)
        root = ElementTree.fromstring(sdf.write(robot))
        sdf_schema.validate(root)
        (found,) = sdf.check(robot)
        assert found.code == "sdf_frames_added" and found.values["joints"] == ["hinge"]
        joints = {joint.get("name"): joint for joint in root.iter("joint")}
        below, kinds = "base", {"translate": "prismatic", "rotate": "revolute"}
        for count, one in enumerate(free, start=1):
            joint = joints["hinge" if count == len(free) else "hinge_axis_{}".format(count)]
            assert joint.findtext("parent") == below and joint.get("type") == kinds[one.kind]
            assert np.array_equal(np.array(joint.findtext("axis/xyz").split(), float), one.axis)
            below = joint.findtext("child")
        masses = {
            link.get("name"): float(link.findtext("inertial/mass")) for link in root.iter("link")
        }
        true = robot.link("arm").inertial.mass
        assert below == "arm" and masses["arm_axis_1"] == true * 2.0**-20
        parts = [mass for name, mass in masses.items() if name.startswith("arm")]
        assert abs(sum(parts) / true - 1.0) < 1e-15


def test_links_on_fixed_joints_alone_have_a_note():
    links = arm().links
    stiff = Robot("stiff", links, (Joint("a", "base", "arm"), Joint("b", "arm", "hand")))
    for form in ("urdf", "mjcf"):
        assert [one.code for one in check(stiff, form)] == ["joints_all_fixed"]
        assert "joints_all_fixed" not in [one.code for one in check(arm(), form)]
        assert not check(stiff, form, inertial_only=True) and not check(
            Robot("one", links[:1]), form
        )


def test_colliders_are_left_out_on_request():
    robot = without_collision(with_primitives(arm(), "box"))
    assert "collision" not in urdf.write(robot) and urdf.write(robot).count("<visual>") == 3
    assert "collision" not in sdf.write(robot) and 'group="3"' not in mjcf.write(robot)
    assert "PhysicsCollisionAPI" not in usd.write(robot) and usd.write(robot).count("def Cube") == 3
    assert "collider" not in gltf.write(robot)
    assert replace(robot.links[0].shapes[0], collides=True).collides


def test_usd_breaks_no_rule_of_its_own_validators():
    """Articulations, joints, bodies and colliders, among others."""
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    pair = Robot(
        "pair", (*assembly(3).links, Link("apart", arm().links[0].inertial)), assembly(3).joints
    )
    for robot in (
        arm(VALUES, is_fixed=True),
        arm(),
        assembly(3),
        pair,
        Robot("one", arm().links[:1]),
    ):
        stage = stage_of(usd.write(with_primitives(robot, "box")))
        errors = UsdValidation.ValidationContext(validators).Validate(stage)
        assert not [error.GetMessage() for error in errors]
        # Newton refuses an articulation of several trees.
        roots = [
            prim.GetName()
            for prim in stage.Traverse()
            if prim.HasAPI(UsdPhysics.ArticulationRootAPI)
        ]
        trees = ["Robot"] if robot.joints else []
        assert roots == ([usd.identifier(pair.roots[0].name)] if robot is pair else trees)


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_usd_layer_of_masses_holds_fixed_roots(unit):
    robot = Robot("arm", arm(is_fixed=True).links)
    paths = {link.name: ["scene", link.name] for link in robot.links}
    layer = stage_of(usd.write_over(robot, paths, "./geometry.usdc", unit)).GetRootLayer()
    (prim,) = [
        spec
        for spec in layer.GetPrimAtPath("/scene").nameChildren
        if spec.typeName == "PhysicsFixedJoint"
    ]
    assert prim.relationships["physics:body1"].targetPathList.explicitItems == ["/scene/base"]
    place = np.array(prim.attributes["physics:localPos0"].default) * unit
    assert (
        np.abs(place - robot.links[0].pose.position).max() < 1e-6
        and len(layer.GetPrimAtPath("/scene").nameChildren) == 4
    )
