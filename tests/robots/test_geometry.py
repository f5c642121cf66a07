# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with geometry, read back with it: a layer over Blender's own in USD,
motions in glTF.
"""

import base64
import json
from dataclasses import replace

import jsonschema
import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.robots import is_ours, robot_text
from body_moments.core.robots.model import Joint, Link, Pose, Robot, Shape
from body_moments.core.robots.write import gltf, usd
from body_moments.core.robots.write.shapes import with_meshes
from pxr import Sdf, UsdGeom, UsdPhysics

from tests.robots.links import bodies, inertial, near, rotation, shaped, shapes
from tests.robots.stage import stage_of

NUMBER, INDEX = {"type": "number"}, {"type": "integer", "minimum": 0}
VECTOR = {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3}


def record(properties, **more):
    """The schema of an object with these properties alone."""
    return {"type": "object", "properties": properties, "additionalProperties": False, **more}


MOTION = {
    "mass": {"type": "number", "exclusiveMinimum": 0},
    "centerOfMass": VECTOR,
    "inertiaDiagonal": {**VECTOR, "items": {"type": "number", "exclusiveMinimum": 0}},
    "inertiaOrientation": {"type": "array", "items": NUMBER, "minItems": 4, "maxItems": 4},
    "linearVelocity": VECTOR,
    "angularVelocity": VECTOR,
    "gravityFactor": NUMBER,
}
KINDS = {"enum": ["static", "kinematic", "dynamic"]}
# The schemas of the extensions. Zero mass or inertia is allowed there, and means something else.
SCHEMAS = {
    name: {"type": "object", "properties": {"motion": motion}, "required": ["motion"]}
    for name, motion in (
        (gltf.KHR, record({**MOTION, "isKinematic": {"type": "boolean"}})),
        (gltf.OMI, record({**MOTION, "type": KINDS}, required=["type"])),
    )
}


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_usd_layer_of_masses_composes_with_its_geometry(unit):
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
    stage = stage_of(text)
    assert stage.GetMetadata("metersPerUnit") == unit
    found = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.MassAPI)]
    assert [prim.GetName() for prim in found] == ["Würfel_1"] and found[0].GetChild("m")
    body = robot.rigid_inertial(root)
    mass = UsdPhysics.MassAPI(found[0])
    assert near(np.array(mass.GetCenterOfMassAttr().Get()) * scale * unit, body.center, 1e-6)
    assert near(np.array(mass.GetDiagonalInertiaAttr().Get()) * unit**2, body.moments, 1e-6)
    together = root.inertial.mass + hand.inertial.mass
    assert near(body.mass, together)


def test_gltf_motions_are_valid_and_give_the_body_back():
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
    assert [found.code for found in gltf.add_rigid_bodies(document, robot, 1.0)] == [
        "gltf_node_missing"
    ]


AXES = {
    "type": "array",
    "items": {"enum": [0, 1, 2]},
    "minItems": 1,
    "maxItems": 3,
    "uniqueItems": True,
}
# The schemas of KHR_physics_rigid_bodies and KHR_implicit_shapes.
LIMIT = record(
    {"linearAxes": AXES, "angularAxes": AXES, "min": NUMBER, "max": NUMBER},
    oneOf=[{"required": ["linearAxes"]}, {"required": ["angularAxes"]}],
)
ONE_JOINT = record({"name": {"type": "string"}, "limits": {"type": "array", "items": LIMIT}})
JOINTS = {
    "type": "object",
    "properties": {"physicsJoints": {"type": "array", "items": ONE_JOINT}},
    "required": ["physicsJoints"],
}
JOINT = record(
    {"connectedNode": INDEX, "joint": INDEX, "enableCollision": {"type": "boolean"}},
    required=["connectedNode", "joint"],
)
ROUND = record({"height": NUMBER, "radiusTop": NUMBER, "radiusBottom": NUMBER})
FORMS = {
    "sphere": record({"radius": NUMBER}),
    "box": record({"size": VECTOR}),
    "capsule": ROUND,
    "cylinder": ROUND,
}
SHAPE = {
    "type": "object",
    "properties": {"type": {"enum": [*FORMS]}, **FORMS},
    "required": ["type"],
    "minProperties": 2,
    "maxProperties": 2,
}
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])


def placed(document):
    """Each node's place in the scene: position and rotation."""
    nodes, places = document["nodes"], {}
    waiting = [(index, np.zeros(3), np.eye(3)) for index in document["scenes"][0]["nodes"]]
    while waiting:
        index, position, turn = waiting.pop()
        x, y, z, w = nodes[index].get("rotation", (0, 0, 0, 1))
        position = position + turn @ nodes[index].get("translation", (0, 0, 0))
        turn = turn @ rotation_matrix([w, x, y, z])
        places[index] = position, turn
        waiting += [(child, position, turn) for child in nodes[index].get("children", ())]
    assert len(places) == len(nodes)
    return places


@pytest.mark.parametrize("away", [False, True])
def test_gltf_is_valid_and_stands_in_place(away):
    chain = bodies(24, chain=True, away=away)
    dressed = Link("dressed", chain.links[0].inertial, Pose(), shapes(chain.links[1].pose))
    robot = Robot("arm", (*chain.links, dressed), chain.joints)
    text, findings = robot_text(robot, "gltf")
    assert [found.code for found in findings] == ["robot_ellipsoid_as_box"] and is_ours(
        text.encode()
    )
    document = json.loads(text)
    of_root = document["extensions"]
    jsonschema.validate(of_root[gltf.KHR], JOINTS)
    for shape in of_root["KHR_implicit_shapes"]["shapes"]:
        jsonschema.validate(shape, SHAPE)
    places = placed(document)
    by_name = {node["name"]: index for index, node in enumerate(document["nodes"])}
    for link in robot.links:
        node, (position, turn) = document["nodes"][by_name[link.name]], places[by_name[link.name]]
        jsonschema.validate(node["extensions"][gltf.OMI], SCHEMAS[gltf.OMI])
        values = node["extensions"][gltf.KHR]["motion"]
        jsonschema.validate({"motion": values}, SCHEMAS[gltf.KHR])
        assert np.abs(turn - Y_UP @ link.pose.rotation @ Y_UP.T).max() < 1e-14
        x, y, z, w = values["inertiaOrientation"]
        axes = rotation_matrix([w, x, y, z])
        true = Y_UP @ link.inertial.inertia @ Y_UP.T
        assert (
            near((axes * values["inertiaDiagonal"]) @ axes.T, true)
            and values["mass"] == link.inertial.mass
        )
        assert near(
            position + turn @ values["centerOfMass"],
            Y_UP @ link.inertial.place(link.pose).center,
            1e-13,
        )
    for joint in robot.joints:
        check_joint(document, places, by_name, joint)


def check_joint(document, places, by_name, joint):
    """Both frames are one, in the bodies that it joins; freedom is about the axes that the robot
    has.
    """
    own = document["nodes"][by_name[joint.name]]["extensions"][gltf.KHR]["joint"]
    jsonschema.validate(own, JOINT)
    assert by_name[joint.name] in document["nodes"][by_name[joint.parent]]["children"]
    assert own["connectedNode"] in document["nodes"][by_name[joint.child]]["children"]
    (here, turn), (there, other) = places[by_name[joint.name]], places[own["connectedNode"]]
    assert np.abs(here - there).max() < 1e-12 and np.abs(turn - other).max() < 1e-12
    limits = document["extensions"][gltf.KHR]["physicsJoints"][own["joint"]]["limits"]
    held = {
        (kind, axis)
        for limit in limits
        if limit["min"] == limit["max"] == 0.0
        for kind in limit
        if kind[-4:] == "Axes"
        for axis in limit[kind]
    }
    assert len(held) == 6 - len(joint.free)
    position, child = places[by_name[joint.child]]
    assert np.abs(there - (position + child @ (Y_UP @ joint.pose.position))).max() < 1e-12
    for free in joint.free:
        kind = "linearAxes" if free.kind == "translate" else "angularAxes"
        along = turn.T @ child @ (Y_UP @ joint.pose.rotation @ free.axis)
        axis = int(np.argmax(np.abs(along)))
        assert abs(abs(along[axis]) - 1.0) < 1e-12 and (kind, axis) not in held
        told = [limit for limit in limits if limit.get(kind) == [axis]]
        assert len(told) == free.is_limited
        for limit in told:
            ends = (limit.get("min", -np.inf), limit.get("max", np.inf))
            assert (ends if along[axis] > 0 else (-ends[1], -ends[0])) == (free.lower, free.upper)


def test_meshes_are_embedded_in_single_file_formats():
    rng = np.random.default_rng(3)
    points, triangles = shaped(rng, "sheared")
    pose = Pose(rng.normal(size=3), rotation(rng))
    link = Link("solid", inertial(points, triangles), pose, (Shape("mesh"),))
    bare = Robot("meshes", (link,))
    robot, _ = with_meshes(bare, lambda _: Surface.from_triangles(points, triangles))
    true = points @ pose.rotation.T + pose.position
    document = json.loads(robot_text(robot, "gltf")[0])
    data = base64.b64decode(document["buffers"][0]["uri"].partition(",")[2])
    views = document["bufferViews"]
    parts = [data[view["byteOffset"] : view["byteOffset"] + view["byteLength"]] for view in views]
    found, faces = (
        np.frombuffer(parts[0], "<f4").reshape(-1, 3),
        np.frombuffer(parts[1], "<u4").reshape(-1, 3),
    )
    (index,) = [index for index, node in enumerate(document["nodes"]) if "mesh" in node]
    position, turn = placed(document)[index]
    shown = (found @ turn.T + position) @ Y_UP
    assert near(shown[faces], true[triangles], 1e-6)
    assert near(document["accessors"][0]["min"], found.min(axis=0), 0.0)
    assert len(views) == 2 and document["accessors"][1]["count"] == triangles.size
    # Readers of both drafts of the extension find the hull: by its mesh, or by a node that has it.
    (own,) = [one["extensions"] for one in document["nodes"] if "collider" in str(one)]
    geometry = own[gltf.KHR]["collider"]["geometry"]
    assert document["nodes"][geometry["node"]]["mesh"] == geometry["mesh"]
    stage = stage_of(robot_text(robot, "usd")[0])
    seen, mesh = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert (
        mesh.GetPrim().HasAPI(UsdPhysics.MeshCollisionAPI)
        and mesh.GetPurposeAttr().Get() == "guide"
    )
    assert (
        not seen.GetPrim().HasAPI(UsdPhysics.CollisionAPI)
        and seen.GetPurposeAttr().Get() == "default"
    )
    matrix = np.array(UsdGeom.XformCache().GetLocalToWorldTransform(mesh.GetPrim())).T
    shown = np.array(mesh.GetPointsAttr().Get(), float) @ matrix[:3, :3].T + matrix[:3, 3]
    faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    assert near(shown[faces], true[triangles], 1e-6)
    for name in ("usd", "gltf"):
        assert "Mesh" not in robot_text(bare, name)[0] and '"mesh"' not in robot_text(bare, name)[0]
