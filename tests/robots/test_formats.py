# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each format read back by a consumer of its own: mass, center, tensor, places and joints."""

import math
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.robots.model import FreeAxis, Inertial, Joint, Link, Pose, Robot
from body_moments.core.robots.write import mjcf, sdf, urdf, usd
from body_moments.core.robots.write.text import roll_pitch_yaw
from body_moments.core.robots.write.texts import robot_text
from pxr import UsdGeom, UsdPhysics
from urdf_parser_py.urdf import URDF

from tests.blender.robot_truth import fixed_angles
from tests.robots import sdf_schema
from tests.robots.links import bodies, near, rotation, shapes
from tests.robots.stage import stage_of

SINGLE = 2.0**-23


def tensor(moments, axes):
    return (axes * np.asarray(moments)) @ axes.T


@pytest.fixture(scope="module")
def chain():
    return bodies(24, chain=True)


@pytest.fixture(scope="module")
def many():
    return bodies(500)


@pytest.mark.parametrize("pitch", [0.3, math.pi / 2, -math.pi / 2, math.pi / 2 - 1e-9, 1.57079632])
def test_angles_give_the_rotation_back_at_the_poles_too(pitch):
    for roll, yaw in ((0.0, 0.0), (2.0, -1.0), (-3.0, 3.0)):
        turn = fixed_angles(roll, pitch, yaw)
        assert np.abs(fixed_angles(*roll_pitch_yaw(turn)) - turn).max() < 1e-15


def test_mujoco_takes_all_bodies_and_gives_their_inertia(many):
    heavy = Robot(
        "many", tuple(link for link in many.links if link.inertial.moments[0] > mjcf.LEAST)
    )
    assert len(heavy.links) > 400 and not mjcf.check(heavy)
    model = mujoco.MjModel.from_xml_string(mjcf.write(heavy))
    for link in heavy.links:
        body, true = model.body(link.name), link.inertial
        axes = rotation_matrix(body.iquat)
        assert body.mass[0] == true.mass and (body.ipos == true.center).all()
        assert near(tensor(body.inertia, axes), true.inertia)


def test_mujoco_moves_the_joints_within_their_limits(chain):
    model = mujoco.MjModel.from_xml_string(mjcf.write(chain))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for link in chain.links:
        assert near(data.body(link.name).xpos, link.pose.position, 1e-13, 10.0)
        assert near(data.body(link.name).xmat.reshape(3, 3), link.pose.rotation, 1e-13)
    assert model.joint(0).type[0] == mujoco.mjtJoint.mjJNT_FREE
    for joint in chain.joints:
        for count, free in enumerate(joint.free, start=1):
            if joint.is_ball:
                assert model.joint(joint.name).type[0] == mujoco.mjtJoint.mjJNT_BALL
                break
            told = model.joint(
                joint.name if len(joint.free) == 1 else "{}_{}".format(joint.name, count)
            )
            assert (
                near(told.axis, free.axis) and bool(model.jnt_limited[told.id]) == free.is_limited
            )
            if free.is_limited:
                assert tuple(told.range) == (free.lower, free.upper)


@pytest.mark.parametrize("form", [mjcf, urdf])
def test_tiny_body_is_raised_by_mujoco_with_a_finding(form):
    small = bodies(1).links[0].inertial
    factor = 1e-16 / small.moments[0]
    tiny = Inertial(
        small.mass * factor,
        small.center,
        small.inertia * factor,
        small.moments * factor,
        small.axes,
    )
    robot = Robot("tiny", (Link("grain", tiny),))
    assert [found.code for found in form.check(robot)] == ["inertia_too_small"]
    model = mujoco.MjModel.from_xml_string(form.write(robot))
    assert (
        model.body("grain").mass[0] >= form.LEAST
        and model.body("grain").inertia.min() == form.LEAST
    )


def test_sdf_moments_of_any_body_meet_the_parser_test(many):
    """No principal moment exceeds the sum of the others, which is Error Code 19 of the parser."""
    root = ElementTree.fromstring(sdf.write(many))
    sdf_schema.validate(root)
    for element in root.iter("inertia"):
        xx, xy, xz, yy, yz, zz = (float(child.text) for child in element)
        assert xy == xz == yz == 0.0 and xx + yy + zz >= 2.0 * max(xx, yy, zz)


def test_sdf_joints_and_shapes_are_valid(chain):
    dressed = Link("dressed", chain.links[0].inertial, Pose(), shapes(chain.links[1].pose))
    robot = Robot("world", (*chain.links, dressed), chain.joints)
    root = ElementTree.fromstring(sdf.write(robot))
    sdf_schema.validate(root)
    assert root.find("model").get("name") == "world_"
    types = {joint.get("name"): joint.get("type") for joint in root.iter("joint")}
    kinds = ["fixed", "revolute", "prismatic", "revolute", "ball", "universal"]
    assert types == {joint.name: kinds[(index + 1) % 6] for index, joint in enumerate(chain.joints)}
    assert not sdf.check(chain)


def test_usd_in_single_precision_breaks_no_triangle_inequality(many):
    stage = stage_of(usd.write(many))
    assert (
        UsdGeom.GetStageMetersPerUnit(stage) == 1.0
        and UsdPhysics.GetStageKilogramsPerUnit(stage) == 1.0
    )
    for link in many.links:
        prim, true = stage.GetPrimAtPath("/Robot/" + usd.identifier(link.name)), link.inertial
        assert prim.HasAPI(UsdPhysics.RigidBodyAPI)
        mass = UsdPhysics.MassAPI(prim)
        moments = np.array(mass.GetDiagonalInertiaAttr().Get(), float)
        turn = mass.GetPrincipalAxesAttr().Get()
        axes = rotation_matrix([turn.real, *turn.imaginary])
        assert moments.sum() >= 2.0 * moments.max() and moments.min() > 0.0
        assert near(mass.GetMassAttr().Get(), true.mass, SINGLE)
        assert near(mass.GetCenterOfMassAttr().Get(), true.center, SINGLE)
        assert near(moments, true.moments, 2.0 * SINGLE) and near(
            tensor(moments, axes), true.inertia, 8.0 * SINGLE
        )
        xx, yy, zz, xy, xz, yz = prim.GetAttribute("newton:inertia").Get()
        assert near([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], true.inertia)


@pytest.mark.parametrize("away", [False, True])
def test_usd_links_stand_in_place_and_joints_hold_them(away):
    chain = bodies(24, chain=True, away=away)
    stage = stage_of(usd.write(chain))
    assert stage.GetDefaultPrim().HasAPI(UsdPhysics.ArticulationRootAPI)
    cache = UsdGeom.XformCache()
    places = {}
    for link in chain.links:
        matrix = np.array(
            cache.GetLocalToWorldTransform(
                stage.GetPrimAtPath("/Robot/" + usd.identifier(link.name))
            )
        ).T
        assert near(matrix[:3, 3], link.pose.position, 1e-13) and near(
            matrix[:3, :3], link.pose.rotation, 1e-13
        )
        places["/Robot/" + usd.identifier(link.name)] = matrix
    for joint in chain.joints:
        prim = UsdPhysics.Joint(stage.GetPrimAtPath("/Robot/" + usd.identifier(joint.name)))
        ends = []
        for body, point, turn in (
            (prim.GetBody0Rel(), prim.GetLocalPos0Attr(), prim.GetLocalRot0Attr()),
            (prim.GetBody1Rel(), prim.GetLocalPos1Attr(), prim.GetLocalRot1Attr()),
        ):
            matrix = places[str(body.GetTargets()[0])]
            quaternion = turn.Get()
            frame = matrix[:3, :3] @ rotation_matrix([quaternion.real, *quaternion.imaginary])
            ends.append((matrix[:3, :3] @ np.array(point.Get()) + matrix[:3, 3], frame))
        assert near(ends[0][0], ends[1][0], 1e-5, 10.0) and near(ends[0][1], ends[1][1], 1e-5)
        true = chain.link(joint.child).pose @ joint.pose
        assert near(ends[1][0], true.position, 1e-5, 10.0)
        if len(joint.free) == 1:
            axis = true.rotation @ joint.free[0].axis
            assert near(ends[1][1][:, 0], axis, 1e-6)
            low = prim.GetPrim().GetAttribute("physics:lowerLimit").Get()
            lower = joint.free[0].lower
            true = math.degrees(lower) if joint.free[0].kind == "rotate" else lower
            assert low == true or near(low, true, SINGLE)


def test_forbidden_names_are_changed_and_stay_unique():
    names = [
        "world",
        "a::b",
        "a__b",
        "<&\"'>",
        "Würfel",
        "Würfel ",
        "1",
        "_1",
        "\x00\n",
        "",
        " ",
        "  ",
        " a",
        "_a",
    ]
    inertial = bodies(1).links[0].inertial
    both = tuple(FreeAxis(kind, np.eye(3)[0]) for kind in ("rotate", "translate"))
    # MJCF has a joint for each axis: world_1 and world_2.
    joints = (
        Joint("world", names[0], names[1], both),
        Joint("world_1", names[1], names[2], both[:1]),
        Joint("world_2", names[2], names[3], both[1:]),
    )
    robot = Robot("odd --> name", tuple(Link(name, inertial) for name in names), joints)
    model = mujoco.MjModel.from_xml_string(robot_text(robot, "mjcf")[0])
    assert len({model.body(index).name for index in range(model.nbody)}) == len(names) + 1
    moving = {model.joint(index).name for index in range(model.njnt)} - {""}
    assert len(moving) == 4 and {"world_1", "world_2"} <= moving
    assert len(URDF.from_xml_string(urdf.write(robot).encode()).link_map) == len(names) + 2
    sdf_schema.validate(ElementTree.fromstring(sdf.write(robot)))
    stage = stage_of(usd.write(robot))
    assert sum(prim.HasAPI(UsdPhysics.MassAPI) for prim in stage.Traverse()) == len(names)


def test_shapes_are_read_as_they_were_meant(chain):
    pose = Pose(np.array([1.0, 2.0, 3.0]), rotation(np.random.default_rng(1)))
    robot = Robot("dressed", (Link("body", chain.links[0].inertial, Pose(), shapes(pose)),))
    model = mujoco.MjModel.from_xml_string(mjcf.write(robot))
    sizes = [model.geom_size[index].tolist() for index in range(model.ngeom)]
    assert sizes[::2] == sizes[1::2]  # One is seen, one collides.
    assert sizes[::2] == [
        [0.5, 1.0, 1.5],
        [0.5, 0, 0],
        [0.25, 0.5, 0],
        [0.25, 1.0, 0],
        [1.0, 2.0, 3.0],
    ]
    assert model.geom_contype.tolist() == model.geom_conaffinity.tolist() == [0, 1] * 5
    assert model.geom_group.tolist() == [2, 3] * 5
    assert near(model.body("body").mass, chain.links[0].inertial.mass)  # not from the shapes
    (link,) = URDF.from_xml_string(urdf.write(robot).encode()).links
    kinds = [type(shape.geometry).__name__ for shape in link.collisions]
    assert kinds == ["Box", "Sphere", "Cylinder", "Sphere", "Sphere", "Cylinder", "Box"]
    assert [found.code for found in urdf.check(robot)] == ["robot_ellipsoid_as_box"]
    stage = stage_of(usd.write(robot))
    assert sum(prim.HasAPI(UsdPhysics.CollisionAPI) for prim in stage.Traverse()) == 5
