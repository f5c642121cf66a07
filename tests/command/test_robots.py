# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--format urdf, sdf, mjcf, usd and gltf: the scene's objects as links, with the numbers of their
records.
"""

import json
import os
import re
from xml.etree import ElementTree

import pytest

bpy = pytest.importorskip("bpy")
import numpy as np
from body_moments.command.measure.run import Run
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.verdict import finding
from body_moments.operators import batch

from tests.blender.batch_files import document, parsed
from tests.blender.characters import PARENTS, armature_of, skin_of
from tests.blender.exported_robots import SUFFIXES, assert_filled, exported_links
from tests.blender.objects import add, mesh_body
from tests.close import close
from tests.command.robot_files import exported, text
from tests.core import characters
from tests.core.bodies import box
from tests.core.mesh_files import stl

pytestmark = pytest.mark.usefixtures("scene")
UNITS = (1.0, 0.001)
KHR = "KHR_physics_rigid_bodies"
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])


def arm(unit=1.0):
    """A scene: an upper arm, under an empty; a forearm that is its child, scaled and mirrored; a
    tool apart.
    """
    bpy.context.scene.unit_settings.scale_length = unit
    frame = add(None, "Frame", (1, 0, 0), (0, 0, 0.5))
    upper = add(mesh_body("Upper"), "Upper", (5, 3, -2), (0.3, 0.4, 0.5))
    forearm = add(mesh_body("Fore"), "Fore arm", (1, 2, 3), (1.0, 0.2, -0.4), (2, -0.5, 1))
    tool = add(mesh_body("Tool"), "Tool", (0, 0, 4))
    upper.parent, forearm.parent = frame, upper
    bpy.context.view_layer.update()
    return upper, forearm, tool


def refused(*words):
    with pytest.raises(SystemExit) as ended:
        parsed(*words)
    return ended.value.code == 2


def numbers(words):
    return np.array(words.split(), float)


@pytest.mark.parametrize("unit", UNITS)
def test_urdf_has_joints_and_inertials_along_link_axes(unit):
    upper, forearm, tool = arm(unit)
    root = ElementTree.fromstring(text("measure", "--format", "urdf"))
    records = {entry["name"]: entry for entry in document("--frame", "object")["objects"]}
    links = {link.get("name"): link.find("inertial") for link in root.iter("link")}
    assert links.keys() == {*records, "base_link"}
    assert links["base_link"].find("mass").get("value") == "0"
    assert {links[name].find("origin").get("rpy") for name in records} == {"0 0 0"}
    joints = {joint.find("child").get("link"): joint for joint in root.iter("joint")}
    parents = {child: joint.find("parent").get("link") for child, joint in joints.items()}
    assert parents == {"Fore arm": "Upper", "Upper": "base_link", "Tool": "base_link"}
    place = numbers(joints["Upper"].find("origin").get("xyz"))
    assert close(place, np.array(upper.matrix_world.translation) * unit, 1e-7)
    away = upper.matrix_world.to_3x3().transposed() @ (
        forearm.matrix_world.translation - upper.matrix_world.translation
    )
    assert close(numbers(joints["Fore arm"].find("origin").get("xyz")), np.array(away) * unit, 1e-6)


@pytest.mark.parametrize("unit", UNITS)
def test_all_formats_hold_the_record_bodies(tmp_path, unit):
    arm(unit)
    records = {entry["name"]: entry for entry in document("--frame", "object")["objects"]}
    for name in ("urdf", "sdf", "mjcf", "osim"):
        for label, link in exported(tmp_path, name).items():
            check(records[label.replace("_", " ")], link.mass, link.center, link.inertia)
    usd = text("measure", "--format", "usd")
    for name, record in records.items():
        prim = usd[usd.index('"{}"'.format(name.replace(" ", "_"))) :]
        xx, yy, zz, xy, xz, yz = map(
            float, re.search(r"newton:inertia = \[(.*)\]", prim)[1].split(",")
        )
        mass = float(re.search(r"physics:mass = (.*)", prim)[1])
        check(
            record,
            record["mass"],
            record["center_of_mass"],
            [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
        )
        assert close(mass, record["mass"], 1e-7)
    gltf = json.loads(text("measure", "--format", "gltf"))
    bodies = {
        node["name"]: node
        for node in gltf["nodes"]
        if "motion" in node.get("extensions", {}).get(KHR, ())
    }
    assert bodies.keys() == records.keys() and "meshes" not in gltf
    for name, node in bodies.items():
        motion = node["extensions"][KHR]["motion"]
        x, y, z, w = motion["inertiaOrientation"]
        turn = Y_UP.T @ rotation_matrix([w, x, y, z])
        tensor = (turn * motion["inertiaDiagonal"]) @ turn.T
        check(records[name], motion["mass"], Y_UP.T @ motion["centerOfMass"], tensor)


def check(record, mass, center, tensor):
    assert mass == record["mass"] and list(center) == record["center_of_mass"]
    truth = np.array(record["inertia"])
    assert np.abs(tensor - truth).max() < 1e-14 * np.abs(truth).max()


def test_unmeasured_parent_passes_link_to_its_own_parent():
    upper, forearm, tool = arm()
    between = add(None, "Between")
    between.parent, tool.parent = forearm, between
    bpy.context.view_layer.update()
    root = ElementTree.fromstring(
        text("measure", "--format", "urdf", "--object", "Upper", "--object", "Tool")
    )
    (joint,) = root.iter("joint")
    assert (joint.find("parent").get("link"), joint.find("child").get("link")) == ("Upper", "Tool")


def test_inertials_alone_name_no_mesh(tmp_path):
    arm()
    for name in ("urdf", "sdf", "mjcf", "usd", "gltf", "osim"):
        found = text("measure", "--format", name, "--inertial-only")
        assert "mesh" not in found and "joint" not in found.lower() and "Fore" in found
    text("measure", "--format", "urdf", "--inertial-only", "--output", str(tmp_path / "robot.urdf"))
    assert [path.name for path in tmp_path.iterdir()] == ["robot.urdf"]


def test_meshes_are_written_along_link_axes(tmp_path):
    arm(0.001)
    path = tmp_path / "robot.urdf"
    text("measure", "--format", "urdf", "--output", str(path))
    record = {entry["name"]: entry for entry in document("--frame", "object")["objects"]}[
        "Fore arm"
    ]
    named = [mesh.get("filename") for mesh in ElementTree.parse(path).getroot().iter("mesh")]
    assert {tmp_path / name for name in named} == {*(tmp_path / "meshes" / "robot").iterdir()}
    # These formats embed meshes; in USD one is seen and one collides.
    for name, times in (
        ("usd", 2),
        ("gltf", 1),
    ):
        path = tmp_path / name / ("robot." + name)
        path.parent.mkdir()
        text("measure", "--format", name, "--output", str(path))
        assert [*path.parent.iterdir()] == [path]
        assert (
            len(re.findall(r'def Mesh|"primitives"', path.read_text(encoding="utf-8"))) == 3 * times
        )
    again = document(str(tmp_path / "meshes" / "robot" / "fore_arm.stl"), "--unit-scale", "1")[
        "objects"
    ][0]
    assert close(again["volume"], record["volume"], 1e-6)
    assert (
        np.abs(np.subtract(again["center_of_mass"], record["center_of_mass"])).max() < 1e-6 * 0.005
    )


@pytest.mark.parametrize("name", SUFFIXES)
def test_meshes_are_left_out_of_streams_and_on_request(tmp_path, name):
    """A robot on the standard output has no files beside it to name."""
    arm()
    path = tmp_path / ("robot" + SUFFIXES[name])
    for words in (
        (),
        ("--output", "/dev/stdout"),
        ("--output", "/dev/null"),
        ("--no-meshes", "--output", path),
    ):
        line = Run(parsed("measure", "--format", name, *words))
        line.measure()
        found = line.documents[0]["robot"]
        assert "mesh" not in found.lower() and "Fore" in found and not line.errors
    assert not [*tmp_path.iterdir()] and not os.path.exists("/dev/meshes")


@pytest.mark.parametrize("links", ["object", "collection"])
def test_instances_are_shown_by_their_link(tmp_path, links):
    part = bpy.data.collections.new("Part")
    part.objects.link(bpy.data.objects.new("Body", mesh_body()))
    instancer = add(None, "Twice as large", (1, 2, 3), (0.1, 0.2, 0.3), (2, 2, 2))
    instancer.instance_type, instancer.instance_collection = "COLLECTION", part
    bpy.context.view_layer.update()
    (link,) = exported(tmp_path, "urdf", "--links", links).values()
    assert_filled(link, 1000.0)


@pytest.mark.parametrize("name", SUFFIXES)
def test_links_without_faces_have_no_geometry_and_a_note(tmp_path, name, capsys):
    add(mesh_body("Solid"), "Solid")
    wire = bpy.data.curves.new("Wire", "CURVE")
    wire.dimensions = "3D"
    spline = wire.splines.new("POLY")
    spline.points.add(3)
    spline.points.foreach_set("co", [0, 0, 0, 1, 1, 0, 0, 1, 1, 2, 0, 1, 1, 2, 3, 1])
    add(wire, "Wire").body_moments.kind = "WIRE"
    links = exported(tmp_path, name)
    assert len(links["Solid"].corners) and not len(links["Wire"].corners)
    assert str(finding("robot_links_bare", count=1, links=["Wire"])) in capsys.readouterr().err


@pytest.mark.parametrize("name", ["urdf", "sdf", "mjcf"])
def test_meshes_in_blocks_are_links_without_geometry(tmp_path, name):
    path = tmp_path / "part.stl"
    path.write_bytes(stl(box((0, 0, 0), (1, 2, 3))))
    (link,) = exported(tmp_path, name, "--stream", "always", path).values()
    assert close(link.mass, 6000.0, 1e-12) and not len(link.corners)
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "part.stl",
        "robot" + SUFFIXES[name],
    ]


def test_robots_in_one_folder_keep_their_own_meshes(tmp_path):
    """Both robots have a link with one name."""
    body = add(mesh_body(), "Part")
    text("measure", "--format", "urdf", "--output", tmp_path / "small.urdf")
    body.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    text("measure", "--format", "urdf", "--output", tmp_path / "large.urdf")
    small, large = (
        exported_links(tmp_path / (name + ".urdf"))["Part"] for name in ("small", "large")
    )
    assert close(large.sides, 2.0 * small.sides, 1e-6)


def test_only_meshes_of_ours_are_replaced(tmp_path):
    """Neither is one of somebody else's without --force, nor is any of the others then."""
    arm()
    words = ("measure", "--format", "urdf", "--output", str(tmp_path / "robot.urdf"))
    for _ in range(2):
        text(*words)
    upper, tool = (tmp_path / "meshes" / "robot" / (name + ".stl") for name in ("upper", "tool"))
    upper.unlink()
    tool.write_bytes(b"mine" * 30)
    line = Run(parsed(*words))
    line.measure()
    (entry,) = line.documents[0]["errors"]
    assert str(tool) in entry["reason"] and "would be lost" in entry["reason"]
    assert (
        tool.read_bytes() == b"mine" * 30
        and not upper.exists()
        and "mesh" not in line.documents[0]["robot"]
    )
    text(*words, "--force")
    assert upper.is_file() and tool.read_bytes().startswith(b"Body Moments")
    tool.write_bytes(b"")
    text(*words)
    assert tool.read_bytes().startswith(b"Body Moments")


def test_the_mesh_that_is_measured_is_never_replaced(tmp_path):
    """A result of ours as it may be, and with --force."""
    add(mesh_body(), "Part")
    text("measure", "--format", "urdf", "--output", tmp_path / "robot.urdf")
    path = tmp_path / "meshes" / "robot" / "part.stl"
    before = path.read_bytes()
    words = (
        "measure",
        "--format",
        "urdf",
        "--unit-scale",
        "0.001",
        "--output",
        tmp_path / "robot.urdf",
        "--force",
    )
    line = Run(parsed(*words, path))
    line.measure()
    assert line.errors == 1 and path.read_bytes() == before


def test_an_older_robot_of_ours_is_replaced_and_another_is_not(tmp_path):
    arm()
    for name in ("urdf", "sdf", "mjcf", "usd", "gltf", "osim"):
        path = tmp_path / ("robot." + name)
        for _ in range(2):
            text("measure", "--format", name, "--output", str(path))
        path.write_text("<robot/>", encoding="utf-8")
        assert refused("measure", "--format", name, "--output", str(path))


def test_collections_and_bones_are_links_too(tmp_path):
    upper, forearm, tool = arm()
    hand = bpy.data.collections.new("Hand")
    bpy.context.scene.collection.children.link(hand)
    for obj in (upper, forearm):
        bpy.context.scene.collection.objects.unlink(obj)
        hand.objects.link(obj)
    root = ElementTree.fromstring(
        text("measure", "--format", "mjcf", "--links", "collection", "--density", "2000")
    )
    (body,) = root.iter("body")
    total = document("--density", "2000", "--object", "Upper", "--object", "Fore arm")["total"]
    assert body.get("name") == "Hand" and close(
        float(body.find("inertial").get("mass")), total["mass"], 1e-14
    )
    character = characters.box_skeleton()
    armature = armature_of(character, parents=PARENTS)
    skin_of(character, armature)
    path = tmp_path / "rig.urdf"
    root = ElementTree.fromstring(
        text("measure", "--format", "urdf", "--links", "bone", "--output", path)
    )
    assert {*character.names} <= {link.get("name") for link in root.iter("link")}
    assert len([*(tmp_path / "meshes" / "rig").iterdir()]) == len(character.names)
    for words, factor in ((("--density", "2000"), 2.0), (("--material", "Steel, Carbon"), 7.82)):
        given = ElementTree.fromstring(
            text("measure", "--format", "urdf", "--links", "bone", *words)
        )
        for mass, other in zip(root.iter("mass"), given.iter("mass"), strict=True):
            assert close(float(other.get("value")), factor * float(mass.get("value")), 1e-12)
    given = ElementTree.fromstring(
        text("measure", "--format", "urdf", "--links", "bone", "--mass", "5")
    )
    assert close(sum(float(mass.get("value")) for mass in given.iter("mass")), 5.0, 1e-12)


def test_fixed_base_and_colliders_follow_their_options(tmp_path):
    arm()
    for words, count in (((), 2), (("--fixed-base",), 0)):
        root = ElementTree.fromstring(text("measure", "--format", "mjcf", *words))
        assert len([*root.iter("freejoint")]) == count
    path = str(tmp_path / "robot.urdf")
    for words, count in (((), 3), (("--collision", "none", "--force"), 0)):
        root = ElementTree.fromstring(text("measure", "--format", "urdf", "--output", path, *words))
        assert (len([*root.iter("visual")]), len([*root.iter("collision")])) == (3, count)


def test_a_robot_without_links_is_an_error():
    arm()
    line = Run(parsed("measure", "--format", "urdf", "--links", "bone"))
    line.measure()
    (entry,) = line.documents[0]["errors"]
    assert line.errors == 1 and entry == {
        "name": None,
        "reason": str(finding("robot_without_links")),
    }


def test_existing_robot_is_kept_if_none_is_written(tmp_path, capfd):
    path = tmp_path / "robot.urdf"
    (tmp_path / "box.stl").write_bytes(stl(box()))
    for form in ("urdf", "gltf"):
        words = ["measure", "--format", form, "--output", str(path), "--force"]
        assert batch.main([*words, str(tmp_path / "box.stl")], channel=1) == 0
        before = path.read_bytes()
        for more in ([], ["--no-supervisor"]):
            assert batch.main([*words, *more, str(tmp_path / "none.stl")], channel=1) == 1
            assert path.read_bytes() == before and not [*tmp_path.glob("*.journal")]
            assert "no file was replaced" in capfd.readouterr().err


def test_unwritable_meshes_are_an_error_beside_the_robot(tmp_path):
    """A file takes the name of the meshes' folder."""
    arm()
    (tmp_path / "meshes").write_text("mine")
    path = tmp_path / "robot.urdf"
    line = Run(parsed("measure", "--format", "urdf", "--output", str(path)))
    line.measure()
    (entry,) = line.documents[0]["errors"]
    assert (
        line.errors == 1
        and line.internal_errors == 0
        and (tmp_path / "meshes").read_text() == "mine"
    )
    expected = finding("file_not_written", file=str(tmp_path / "meshes"), error="File exists")
    assert entry == {"name": None, "reason": str(expected)}
    assert (
        line.documents[0]["robot"].startswith("<?xml") and "mesh" not in line.documents[0]["robot"]
    )
