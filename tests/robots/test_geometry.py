# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with geometry, read back with it: meshes in MuJoCo, a layer over Blender's own in USD, motions in glTF."""

import json
from dataclasses import replace

import jsonschema
import mujoco
import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.robots.model import Joint, Link, Pose, Robot, Shape
from body_moments.core.robots.primitives import capsule_size, equal_inertia_shape
from body_moments.operators.write.robots import gltf, mjcf, usd
from body_moments.operators.write.robots.shapes import with_primitives
from body_moments.operators.write.robots.stl import to_stl
from pxr import Sdf, Usd, UsdPhysics

from tests.robots.links import ball, bodies, inertial, rotation, shaped

VECTOR = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
MOTION = {
    "mass": {"type": "number", "exclusiveMinimum": 0},
    "centerOfMass": VECTOR,
    "inertiaDiagonal": {**VECTOR, "items": {"type": "number", "exclusiveMinimum": 0}},
    "inertiaOrientation": {"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4},
    "linearVelocity": VECTOR,
    "angularVelocity": VECTOR,
    "gravityFactor": {"type": "number"},
}
# As the extensions' own descriptions have them. Zero mass or inertia is allowed there, and means something else.
SCHEMAS = {
    gltf.KHR: {
        "type": "object",
        "properties": {
            "motion": {
                "type": "object",
                "properties": {**MOTION, "isKinematic": {"type": "boolean"}},
                "additionalProperties": False,
            }
        },
        "required": ["motion"],
    },
    gltf.OMI: {
        "type": "object",
        "properties": {
            "motion": {
                "type": "object",
                "properties": {**MOTION, "type": {"enum": ["static", "kinematic", "dynamic"]}},
                "required": ["type"],
                "additionalProperties": False,
            }
        },
        "required": ["motion"],
    },
}


def near(found, truth, rel=1e-14):
    found, truth = np.asarray(found, float), np.asarray(truth, float)
    return np.abs(found - truth).max() <= rel * np.abs(truth).max()


def test_mujoco_loads_the_meshes_and_keeps_what_was_measured():
    """Flat ones too, which bound nothing."""
    rng = np.random.default_rng(3)
    points, triangles = shaped(rng, "sheared")
    sheet = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float), np.array([[0, 1, 2], [0, 2, 3]])
    solid = Link("solid", inertial(points, triangles), shapes=(Shape("mesh", file="meshes/solid.stl"),))
    flat = Link("flat", bodies(1).links[0].inertial, shapes=(Shape("mesh", file="meshes/flat.stl", sheet=True),))
    assets = {
        "meshes/solid.stl": to_stl(Surface.from_triangles(points, triangles)),
        "meshes/flat.stl": to_stl(Surface.from_triangles(*sheet)),
    }
    model = mujoco.MjModel.from_xml_string(mjcf.write(Robot("meshes", (solid, flat))), assets)
    assert model.body("solid").mass[0] == solid.inertial.mass and model.body("flat").mass[0] == flat.inertial.mass
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    corners = model.mesh_vert[: model.mesh_vertnum[0]]
    (geom,) = [index for index in range(model.ngeom) if model.geom_dataid[index] == 0]
    shown = corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
    reach = np.abs(points).max()
    assert all(np.abs(shown - point).max(axis=1).min() < 1e-6 * reach for point in points)


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_a_layer_of_masses_composes_with_the_geometry_that_it_names(unit):
    rng = np.random.default_rng(4)
    scale = np.array([2.0, 0.5, 3.0])
    pose = Pose(rng.normal(size=3), rotation(rng))
    root = Link("Würfel 1", bodies(1).links[0].inertial, pose, scale=scale)
    hand = Link("hand", bodies(2).links[1].inertial, Pose(rng.normal(size=3), rotation(rng)))
    robot = Robot("arm", (root, hand), (Joint("wrist", "Würfel 1", "hand"),))
    below = Sdf.Layer.CreateAnonymous(".usda")
    below.ImportFromString(
        '#usda 1.0\n(metersPerUnit = 1)\ndef Xform "root" { def Xform "Würfel_1" {\n'
        'double3 xformOp:scale = (2, 0.5, 3)\nuniform token[] xformOpOrder = ["xformOp:scale"]\n'
        'def Mesh "m" {\n}\ndef Xform "hand" {\n}\n}\n}\n'
    )
    text = usd.write_over(robot, {"Würfel 1": ["root", "Würfel_1"]}, below.identifier, unit)
    layer = Sdf.Layer.CreateAnonymous(".usda")
    assert layer.ImportFromString(text)
    stage = Usd.Stage.Open(layer)
    assert stage.GetMetadata("metersPerUnit") == unit
    found = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.MassAPI)]
    assert [prim.GetName() for prim in found] == ["Würfel_1"] and found[0].GetChild("m")
    body = robot.rigid_inertial(root)
    mass = UsdPhysics.MassAPI(found[0])
    assert near(np.array(mass.GetCenterOfMassAttr().Get()) * scale * unit, body.center, 1e-6)
    assert near(np.array(mass.GetDiagonalInertiaAttr().Get()) * unit**2, body.moments, 1e-6)
    together = root.inertial.mass + hand.inertial.mass
    assert near(body.mass, together)


def test_gltf_motions_are_what_their_schemas_allow_and_give_the_body_back():
    robot = bodies(60)
    document = {"nodes": [{"name": link.name} for link in robot.links]}
    assert gltf.add_rigid_bodies(document, robot, 1.0) == []
    turned = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    for link, node in zip(robot.links, json.loads(json.dumps(document))["nodes"]):
        for name, schema in SCHEMAS.items():
            jsonschema.validate(node["extensions"][name], schema)
        motion, true = node["extensions"][gltf.KHR]["motion"], link.inertial
        x, y, z, w = motion["inertiaOrientation"]
        axes = rotation_matrix([w, x, y, z])
        assert motion["mass"] == true.mass and near(motion["centerOfMass"], turned @ true.center)
        assert near((axes * motion["inertiaDiagonal"]) @ axes.T, turned @ true.inertia @ turned.T)
    document = {"nodes": [{"name": "a"}, {"name": "a"}]}
    robot = Robot("two", (replace(robot.links[0], name="a"),))
    assert [found.code for found in gltf.add_rigid_bodies(document, robot, 1.0)] == ["gltf_node_missing"]


@pytest.mark.parametrize("kind", ["box", "ellipsoid", "capsule"])
def test_primitives_have_the_inertia_that_mujoco_computes_for_them(kind):
    """With the density that gives them the mass; a capsule keeps the least moment and the mean of the others."""
    robot = bodies(60)
    links = [link for link in robot.links if link.inertial.moments[0] > 1e-4 * link.inertial.moments[2]]
    assert len(links) > 30
    for link in links:
        shape = equal_inertia_shape(link.inertial, kind)
        alone = with_primitives(Robot("one", (Link("b", link.inertial),)), kind)
        text = mjcf.write(alone)
        start = text.index("<inertial")
        text = text[:start] + text[text.index("/>", start) + 2 :]
        text = text.replace("<geom ", '<geom mass="{!r}" '.format(link.inertial.mass))
        model = mujoco.MjModel.from_xml_string(text)
        found, true = model.body("b"), link.inertial
        moments = np.sort(found.inertia)
        assert near(found.mass[0], true.mass, 1e-12) and near(found.ipos, shape.pose.position, 1e-12)
        if kind == "capsule":
            if true.moments[1] + true.moments[2] > 2.0 * true.moments[0] * (1 + 1e-9):
                assert near(moments[0], true.moments[0], 1e-9)
                assert near(moments[1:].sum(), true.moments[1:].sum(), 1e-9)
            continue
        axes = rotation_matrix(found.iquat)
        assert near((axes * found.inertia) @ axes.T, true.inertia, 1e-12)


def test_a_ball_is_a_capsule_without_length():
    body = inertial(*ball(24))
    radius, length = capsule_size(body.mass, np.full(3, body.moments.mean()))
    assert length == 0.0 and abs(radius - 1.0) < 0.02
