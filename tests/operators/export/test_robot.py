# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export and the exporters of collections: files of robots from the scene."""

import re
from xml.etree import ElementTree

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.bodies.rig import measure_rig
from body_moments.core.files import gltf_document
from body_moments.core.inertia.mass_properties import combine
from body_moments.core.numerics.rotations import rotation_matrix

from tests.blender.characters import armature_of, pose, skin_of
from tests.blender.exported_robots import SUFFIXES, assert_filled, exported_links
from tests.blender.objects import add, mesh_body, only
from tests.close import close
from tests.core import characters

pytestmark = pytest.mark.usefixtures("scene")


def measured(obj):
    return measure_object(obj, bpy.context.evaluated_depsgraph_get())


def pair():
    """A body with a child that is scaled, and one apart."""
    upper = add(mesh_body("Upper"), "Upper", (5, 3, -2), (0.3, 0.4, 0.5))
    fore = add(mesh_body("Fore"), "Fore.001", (1, 2, 3), (0.0, 0.0, 0.4), (2, 2, 2), parent=upper)
    tool = add(mesh_body("Tool"), "Tool", (0, 0, 4))
    bpy.context.view_layer.update()
    return upper, fore, tool


def whole(*objects):
    """What objects are together, along the axes of the first."""
    bodies = [measured(obj) for obj in objects]
    return combine([body.mass_moments for body in bodies]).in_frame(
        bodies[0].rotation, bodies[0].location
    )


def tensor(inertia, quaternion):
    turn = rotation_matrix(quaternion)
    return (turn * np.asarray(inertia)) @ turn.T


def export(name, path, **options):
    return getattr(bpy.ops.export_scene, "body_moments_" + name)(filepath=str(path), **options)


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.001, 0.0254])
@pytest.mark.parametrize(
    ("name", "links"),
    [
        (name, links)
        for name in SUFFIXES
        for links in ("OBJECT", "COLLECTION")
        if (name, links) != ("usd", "OBJECT")
    ],
)
def test_meshes_are_in_the_meters_of_the_inertials(tmp_path, name, links, unit):
    """USD by object states the unit of Blender's own geometry instead."""
    bpy.context.scene.unit_settings.scale_length = unit
    add(mesh_body("Upper"), "Upper", (5, 3, -2), (0.3, 0.4, 0.5))
    add(mesh_body("Tool"), "Tool", (0, 0, 4), (0, 0, 1), (2, 2, 2))
    path = tmp_path / ("robot" + {**SUFFIXES, "gltf": ".glb"}[name])
    assert export(name, path, links=links) == {"FINISHED"}
    links = exported_links(path).values()
    for link in links:
        assert_filled(link, 1000.0)
    volume = 0.7 * (3.25 - 1.0 + 2.25)
    assert close(sum(link.mass for link in links), 9.0 * 1000.0 * volume * unit**3, 1e-5)


def test_selected_objects_of_a_format_without_meshes(tmp_path):
    upper, fore, tool = pair()
    only(tool)
    export("sdf", tmp_path / "tool.sdf", use_selection=True, geometry="BOX")
    root = ElementTree.parse(tmp_path / "tool.sdf").getroot()
    assert [link.get("name") for link in root.iter("link")] == ["Tool"] and not [
        *tmp_path.glob("*/")
    ]
    sides = np.array(root.find(".//box/size").text.split(), float)
    body = measured(tool).in_object_frame()
    moments = body.mass / 12.0 * (sides @ sides - sides * sides)
    assert close(moments, body.principal.moments, 1e-13)


def test_collections_are_links_with_all_that_they_hold(tmp_path):
    upper, fore, tool = pair()
    outer, inner, other = (bpy.data.collections.new(name) for name in ("Arm", "Hand", "Tools"))
    bpy.context.scene.collection.children.link(outer)
    bpy.context.scene.collection.children.link(other)
    outer.children.link(inner)
    for obj, collection in ((upper, outer), (fore, inner), (tool, other)):
        bpy.context.scene.collection.objects.unlink(obj)
        collection.objects.link(obj)
    export("mjcf", tmp_path / "arm.xml", links="COLLECTION")
    root = ElementTree.parse(tmp_path / "arm.xml").getroot()
    bodies = {element.get("name"): element.find("inertial") for element in root.iter("body")}
    assert bodies.keys() == {"Arm", "Tools"}
    body, inertial = combine([measured(obj).mass_moments for obj in (upper, fore)]), bodies["Arm"]
    assert close(float(inertial.get("mass")), body.mass, 1e-14)
    assert close(np.array(inertial.get("pos").split(), float), body.center, 1e-14)
    found = tensor(*(np.array(inertial.get(key).split(), float) for key in ("diaginertia", "quat")))
    assert np.abs(found - body.inertia).max() < 1e-14 * np.abs(body.inertia).max()
    assert (tmp_path / "meshes" / "arm" / "arm.stl").stat().st_size == 84 + 2 * 50 * 20


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_usd_is_blenders_geometry_under_a_layer_of_masses(tmp_path, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    upper, fore, tool = pair()
    assert export("usd", tmp_path / "robot.usda") == {"FINISHED"}
    assert (tmp_path / "robot_geometry.usdc").is_file()
    text = (tmp_path / "robot.usda").read_text(encoding="utf-8")
    assert "@./robot_geometry.usdc@" in text and "metersPerUnit = {!r}\n".format(unit) in text
    assert text.count("PhysicsMassAPI") == 2 and "Fore_001" not in text  # a part of Upper's body
    body = whole(upper, fore)
    prim = text[text.index('over "Upper"') :]
    center = np.array(re.search(r"centerOfMass = \((.*)\)", prim)[1].split(","), float)
    assert close(center, body.center / unit, 1e-6)
    xx, yy, zz, xy, xz, yz = map(float, re.search(r"newton:inertia = \[(.*)\]", prim)[1].split(","))
    found = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) * unit**2
    assert np.abs(found - body.inertia).max() < 1e-13 * np.abs(body.inertia).max()


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_gltf_bodies_include_fixed_children(tmp_path, unit, reported):
    bpy.context.scene.unit_settings.scale_length = unit
    upper, fore, tool = pair()
    assert export("gltf", tmp_path / "robot.glb") == {"FINISHED"}
    document = gltf_document((tmp_path / "robot.glb").read_bytes())
    nodes = {node["name"]: node for node in document["nodes"]}
    assert {*document["extensionsUsed"]} >= {"KHR_physics_rigid_bodies", "OMI_physics_body"}
    assert "extensions" not in nodes["Fore.001"] and ("unit_scale" in reported.codes) == (
        unit != 1.0
    )
    motion = nodes["Upper"]["extensions"]["KHR_physics_rigid_bodies"]["motion"]
    assert nodes["Upper"]["extensions"]["OMI_physics_body"]["motion"] == {
        "type": "dynamic",
        **motion,
    }
    links = exported_links(tmp_path / "robot.glb")
    assert links.keys() == {"Upper", "Tool"}
    for link in links.values():
        assert_filled(link, 1000.0)
    assert close(links["Upper"].mass, whole(upper, fore).mass, 1e-14)


@pytest.mark.parametrize(
    "name, end",
    [
        ("urdf", "urdf"),
        ("sdf", "sdf"),
        ("mjcf", "xml"),
        ("usd", "usda"),
        ("gltf", "glb"),
        ("osim", "osim"),
    ],
)
def test_a_collection_remembers_its_exporter_and_runs_it_again(tmp_path, name, end):
    """In another session: path and options are in the file."""
    upper, fore, tool = pair()
    collection = bpy.data.collections.new("Robot")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(tool)
    layer = bpy.context.view_layer.layer_collection.children["Robot"]
    bpy.context.view_layer.active_layer_collection = layer
    assert bpy.ops.collection.exporter_add(name="IO_FH_body_moments_" + name) == {"FINISHED"}
    path = tmp_path / ("tool." + end)
    options = collection.exporters[0].export_properties
    options.filepath, options.inertial_only = str(path), True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert bpy.ops.collection.export_all() == {"FINISHED"}
    data = path.read_bytes()
    assert (
        b"Tool" in data and b"Upper" not in data and b"shape" not in data and b"visual" not in data
    )
    bpy.data.collections["Robot"].exporters[0].export_properties.inertial_only = False
    bpy.context.view_layer.active_layer_collection = (
        bpy.context.view_layer.layer_collection.children["Robot"]
    )
    assert bpy.ops.collection.export_all() == {"FINISHED"}
    assert path.read_bytes() != data and b"Upper" not in path.read_bytes()


@pytest.mark.parametrize("name", SUFFIXES)
def test_hinged_objects_are_exported_with_their_joint(tmp_path, name):
    """Blender's own geometry cannot hold a body that moves in another one."""
    upper, fore, tool = pair()
    bpy.ops.rigidbody.world_add()
    hinge = add(None, "Elbow", (1, 2, 3))
    bpy.ops.rigidbody.constraint_add(type="HINGE")
    hinge.rigid_body_constraint.object1, hinge.rigid_body_constraint.object2 = upper, fore
    path = tmp_path / ("robot" + {**SUFFIXES, "gltf": ".glb"}[name])
    assert export(name, path, fixed_base=True, use_collision=False) == {"FINISHED"}
    data = path.read_bytes()
    assert (
        b"Elbow" in data and b"Fore" in data and b"ollision" not in data and b"collider" not in data
    )
    for text in {
        "mjcf": [b"hinge"],
        "usd": [b"PhysicsRevoluteJoint", b"PhysicsArticulationRootAPI"],
    }.get(name, []):
        assert text in data
    assert b"freejoint" not in data and b'group="3"' not in data


def test_nothing_to_export_and_nowhere_to_write_are_refused(tmp_path):
    with pytest.raises(RuntimeError, match="no link"):
        export("urdf", tmp_path / "robot.urdf")
    pair()
    with pytest.raises(RuntimeError, match="cannot be written"):
        export("urdf", tmp_path / "missing" / "robot.urdf")
    assert not [*tmp_path.iterdir()]


def test_bones_are_links_in_their_rest_frames_with_their_limits(tmp_path):
    """A chain of boxes skinned to bones, posed: the links are where they rest."""
    character = characters.humanoid()
    names = list(character.names)
    parents = {child: names[0] for child in names[1:]}
    armature = armature_of(character, parents=parents)
    armature.location, armature.rotation_euler = (1, 2, 3), (0.1, 0.2, 0.3)
    skin_of(character, armature)
    pose(armature)
    bone = armature.pose.bones[names[1]]
    bone.use_ik_limit_x, bone.ik_min_x, bone.ik_max_x, bone.lock_ik_y = True, -0.5, 1.0, True
    rig = measure_rig(bpy.context, armature)
    assert export("urdf", tmp_path / "rig.urdf", links="BONE") == {"FINISHED"}
    root = ElementTree.parse(tmp_path / "rig.urdf").getroot()
    inertials = {link.get("name"): link.find("inertial") for link in root.iter("link")}
    assert {part.name for part in rig.parts} <= inertials.keys()
    for part in rig.parts:
        body = part.measurement.in_object_frame()
        assert float(inertials[part.name].find("mass").get("value")) == body.mass
        assert inertials[part.name].find("origin").get("xyz").split() == [
            repr(x + 0.0) for x in body.center.tolist()
        ]
    joints = [
        joint
        for joint in root.iter("joint")
        if joint.find("child").get("link").startswith(names[1])
    ]
    assert [(joint.get("type"), joint.find("axis").get("xyz")) for joint in joints] == [
        ("continuous", "0.0 0.0 1.0"),
        ("revolute", "1.0 0.0 0.0"),
    ]
    assert close(float(joints[1].find("limit").get("upper")), 1.0, 1e-6)
    assert joints[0].find("parent").get("link") == names[0]
    place = np.array(joints[0].find("origin").get("xyz").split(), float)
    rest = (
        armature.data.bones[names[0]].matrix_local.inverted()
        @ armature.data.bones[names[1]].head_local
    )
    assert np.abs(place - np.array(rest)).max() < 1e-5
    assert (tmp_path / "meshes" / "rig" / (names[1].lower() + ".stl")).is_file()
    only(armature)
    export("mjcf", tmp_path / "rig.xml", links="BONE", use_selection=True, geometry="NONE")
    first = ElementTree.parse(tmp_path / "rig.xml").getroot().find("worldbody/body")
    assert first.find("freejoint") is not None and len(first.findall("body")) == len(names) - 1
    export("gltf", tmp_path / "rig.glb", links="BONE")
    document = gltf_document((tmp_path / "rig.glb").read_bytes())
    nodes = {node["name"]: node for node in document["nodes"]}
    (limit,) = [
        limit
        for joint in document["extensions"]["KHR_physics_rigid_bodies"]["physicsJoints"]
        if joint["name"].startswith(names[1])
        for limit in joint["limits"]
        if limit["min"] < limit["max"]
    ]
    assert limit["angularAxes"] == [0] and close(limit["max"], 1.0, 1e-6)
    assert all("motion" in nodes[name]["extensions"]["KHR_physics_rigid_bodies"] for name in names)
    assert len(document["meshes"]) == len(names) and "buffers" in document
    export("usd", tmp_path / "rig.usda", links="BONE")
    text = (tmp_path / "rig.usda").read_text(encoding="utf-8")
    assert text.count("def Mesh ") == 2 * text.count('"PhysicsRigidBodyAPI"') == 2 * len(names)
    assert "physics:body1" in text
