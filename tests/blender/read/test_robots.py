# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions and meshes from strangers: what is read, and what is refused."""

import contextlib
import json
import os
import struct

import bpy
import numpy as np
import pytest
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots import Roots, read_description
from body_moments.core.robots.read import xml
from body_moments.core.robots.read.meshes import read_mesh
from body_moments.core.streams.threemf import read_3mf
from body_moments.core.verdict import FileError

from tests.blender import batch_files
from tests.close import close

TETRAHEDRON = batch_files.TETRAHEDRON


def refusal(function, *arguments):
    with pytest.raises(FileError) as refused:
        function(*arguments)
    assert str(refused.value).endswith(".")  # it has a sentence
    return refused.value.finding.code


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def center(moments):
    return moments.about + moments.raw[1:4] / moments.raw[0]


def check(path, factor=1.0):
    """The tetrahedron, outward, scaled."""
    moments = polyhedron_moments(read_mesh(path)[0])[0]
    assert close(moments.raw[0], TETRAHEDRON["volume"] * factor**3, 1e-6)
    assert close(center(moments), np.array(TETRAHEDRON["center_of_mass"]) * factor, 1e-6)


def dae():
    points = " ".join(str(x) for corner in batch_files.CORNERS for x in corner)
    corners = " ".join(str(index) for face in batch_files.FACES for index in face)
    return """<?xml version="1.0"?>
    <COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
    <library_geometries><geometry id="g"><mesh>
      <source id="p"><float_array id="pa" count="12">{points}</float_array>
        <technique_common><accessor source="#pa" count="4" stride="3"/></technique_common></source>
      <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
      <triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{corners}</p>
</triangles></mesh>
    </geometry></library_geometries></COLLADA>""".format(**locals())


def test_meshes_that_blender_writes_are_read(tmp_path, scene):
    mesh = bpy.data.meshes.new("T")
    mesh.from_pydata(batch_files.CORNERS, [], batch_files.FACES)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("T", mesh))
    bpy.ops.wm.stl_export(filepath=str(tmp_path / "a.stl"))
    bpy.ops.wm.stl_export(filepath=str(tmp_path / "b.stl"), ascii_format=True)
    bpy.ops.wm.obj_export(filepath=str(tmp_path / "c.obj"), forward_axis="Y", up_axis="Z")
    bpy.ops.export_scene.gltf(filepath=str(tmp_path / "d.glb"), export_yup=False)
    for name in ("a.stl", "b.stl", "c.obj", "d.glb"):
        check(tmp_path / name)


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".glb", ".dae"])
def test_damaged_meshes_are_refused_whatever_is_in_them(tmp_path, suffix):
    rng = np.random.default_rng(5)
    whole = {
        ".stl": batch_files.stl_text().encode(),
        ".obj": batch_files.obj_text().encode(),
        ".dae": dae().encode(),
        ".glb": glb(),
    }[suffix]
    for cut in rng.integers(0, len(whole), 30):
        data = bytearray(whole)
        data[cut : cut + 3] = rng.bytes(3)
        path = write(tmp_path / ("a" + suffix), bytes(data))
        with contextlib.suppress(FileError):
            read_mesh(path)
    zeros = write(tmp_path / ("b" + suffix), b"\0" * 200)
    assert refusal(read_mesh, zeros) == "mesh_unreadable"


def glb():
    points = np.array(batch_files.CORNERS, "<f4").tobytes()
    order = np.array(batch_files.FACES, "<u2").tobytes()
    document = {
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 24},
        ],
        "buffers": [{"byteLength": 72}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = points + order
    body = (
        struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(binary), 0x004E4942)
        + binary
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def test_entities_are_refused(tmp_path):
    bomb = '<!DOCTYPE r [<!ENTITY a "x"><!ENTITY b "&a;&a;">]><robot name="&b;"/>'
    assert refusal(read_description, write(tmp_path / "a.urdf", bomb)) == "xml_entities"
    outside = '<!DOCTYPE r SYSTEM "file:///etc/passwd"><robot name="r"/>'
    assert refusal(read_description, write(tmp_path / "b.urdf", outside)) == "xml_entities"
    mesh = write(tmp_path / "a.dae", bomb.replace("robot", "COLLADA"))
    assert refusal(read_mesh, mesh) == "mesh_unreadable"


def test_invalid_descriptions_are_refused(tmp_path):
    deep = "<robot>" + "<link>" * 300 + "</link>" * 300 + "</robot>"
    for code, content in (
        ("file_too_large", deep),
        ("description_invalid", "<robot><link></robot>"),
        ("description_invalid", "<robot><link name='a'/><link name='a'/></robot>"),
        (
            "description_invalid",
            "<sdf version='1.9'><model name='m'><link name='a'/><link name='a'/></model></sdf>",
        ),
        (
            "description_invalid",
            "<mujoco><worldbody><body name='a'/><body name='a'/></worldbody></mujoco>",
        ),
        (
            "description_invalid",
            "<mujoco><worldbody><body>{0}{0}</body></worldbody></mujoco>".format(
                "<joint name='j'/>"
            ),
        ),
        ("description_invalid", b"\xff\xfe\0"),
        ("description_unknown", "<html/>"),
        ("file_without_objects", '<robot name="r"/>'),
        ("description_invalid", '#usda 1.0\ndef Xform "a" { double x = (1,'),
        ("description_invalid", b"#usda 1.0\n\xff"),
    ):
        assert refusal(read_description, write(tmp_path / "a.xml", content)) == code, content[:40]
    binary = write(tmp_path / "a.xml", b"PXR-USDC\0\0")
    # without and with usd-core
    assert refusal(read_description, binary) in (
        "usd_not_text",
        "file_unreadable",
    )
    assert refusal(read_description, tmp_path / "none.urdf") == "file_missing"
    assert refusal(read_description, tmp_path) == "file_unreadable"


@pytest.mark.parametrize(
    "content",
    [
        "<mujoco/>",
        "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>",
        "<mujoco><asset><mesh name='m' builtin='sphere' params='2'/></asset></mujoco>",
        "<sdf version='1.9'><world name='w'/></sdf>",
    ],
)
def test_model_without_bodies_has_no_links(tmp_path, content):
    assert read_description(write(tmp_path / "a.xml", content)).links == ()


def test_names_in_plugins_of_sdf_may_repeat(tmp_path):
    plugin = "<plugin name='p' filename='f'><joint name='j'/><joint name='j'/></plugin>"
    text = "<sdf version='1.9'><model name='m'><link name='a'/>{}</model></sdf>".format(plugin)
    (link,) = read_description(write(tmp_path / "a.sdf", text)).links
    assert link.name == "a"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="not on this system")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.urdf")
    assert refusal(read_description, tmp_path / "a.urdf") == "file_unreadable"
    os.mkfifo(tmp_path / "a.stl")
    assert refusal(Roots.for_file(tmp_path / "b.urdf").find, "a.stl") == "mesh_missing"


def test_meshes_are_found_within_the_folders_that_are_allowed(tmp_path, monkeypatch):
    package = tmp_path / "arm_description"
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    mesh = write(package / "meshes" / "a.stl", "")
    secret = write(tmp_path / "secret.stl", "")
    file = package / "urdf" / "arm.urdf"
    for name in (
        str(secret),
        "file://" + str(secret),
        "../../secret.stl",
        "package://../../secret.stl",
    ):
        assert refusal(Roots.for_file(file).find, name) == "mesh_outside", name
    assert Roots.for_file(file).find("../meshes/a.stl") == mesh.resolve()
    other = write(tmp_path / "src" / "more" / "other_meshes" / "b.stl", "")
    assert refusal(Roots.for_file(file).find, "package://other_meshes/b.stl") == "mesh_missing"
    assert (
        Roots.for_file(file, [tmp_path / "src"]).find("package://other_meshes/b.stl")
        == other.resolve()
    )
    monkeypatch.setenv("ROS_PACKAGE_PATH", os.pathsep.join(["/none", str(other.parents[1])]))
    assert Roots.for_file(file).find("package://other_meshes/b.stl") == other.resolve()
    write(package / "package.xml", "<package/>")
    roots = Roots.for_file(file)
    for name in (
        "../meshes/a.stl",
        "package://arm_description/meshes/a.stl",
        "package:///arm_description/meshes/a.stl",
        "meshes/a.stl",
        r"..\meshes\a.stl",
    ):
        assert roots.find(name) == mesh.resolve(), name
    assert refusal(roots.find, "package://../../secret.stl") == "mesh_outside"
    assert refusal(roots.find, "https://example.com/a.stl") == "mesh_outside"
    assert refusal(roots.find, "package://arm_description/meshes/b.stl") == "mesh_missing"
    write(package / "package.xml", "<package><name> arm </name></package>")
    assert Roots.for_file(file).find("package://arm/meshes/a.stl") == mesh.resolve()
    assert (
        Roots.for_file(file, [tmp_path]).find("package://arm_description/meshes/a.stl")
        == mesh.resolve()
    )
    assert (
        Roots.for_file(tmp_path / "out" / "arm.urdf", [package]).find("../meshes/a.stl")
        == mesh.resolve()
    )
    assert Roots.for_file(file, anywhere=True).find(str(secret)) == secret.resolve()


@pytest.mark.skipif(os.name == "nt", reason="not on this system")
def test_links_out_of_the_folder_are_not_followed(tmp_path):
    inside = tmp_path / "package" / "in"
    inside.mkdir(parents=True)
    write(tmp_path / "secret.stl", "")
    (inside / "a.stl").symlink_to(tmp_path / "secret.stl")
    assert refusal(Roots.for_file(inside / "r.urdf").find, "a.stl") == "mesh_outside"


def test_included_models_of_sdf_are_read_from_their_folders(tmp_path):
    """Meshes are found beside the included file; a model that includes itself, or is none, is
    refused at its line.
    """
    link = '<link name="{}"><inertial><mass>{}</mass></inertial></link>'
    world = (
        '<sdf version="1.9"><model '
        'name="m">{}<include><uri>model://arm</uri></include></model></sdf>'
    )
    file = write(tmp_path / "worlds" / "w.sdf", world.format("\n" + link.format("own", 1)))
    write(tmp_path / "arm" / "model.config", '<model><sdf version="1.9">arm.sdf</sdf></model>')
    model = '<sdf version="1.9"><model name="arm">\n {}</model></sdf>'
    write(tmp_path / "arm" / "arm.sdf", model.format(link.format("upper", 2)))
    own, upper = read_description(file).links
    assert (own.name, upper.name, upper.inertial.mass, upper.span) == (
        "m::own",
        "arm::upper",
        2.0,
        None,
    )
    assert (upper.place.line, upper.place.column) == (2, 2) and upper.place.file.endswith("arm.sdf")
    for text in (
        model.format("<include><uri>model://arm</uri></include>"),
        '<sdf version="1.9">\n<include><uri>model://arm</uri></include></sdf>',
        "<sdf",
        '<!DOCTYPE a []><sdf version="1"/>',
    ):
        write(tmp_path / "arm" / "arm.sdf", text)
        with pytest.raises(FileError) as refused:
            read_description(file)
        assert refused.value.finding.code == "include_unreadable"
        assert refused.value.finding.values["line"] == 2


def test_bytes_that_are_no_text_of_usd_do_not_hang(tmp_path):
    """Fuzzed layers are read or refused, in no time."""
    rng = np.random.default_rng(6)
    for _ in range(60):
        data = bytearray(USDA)
        place = int(rng.integers(len(data)))
        data[place : place + 2] = (
            rng.choice(list(b'"{}[]()=@<>#\n a1'), 2).astype(np.uint8).tobytes()
        )
        with contextlib.suppress(FileError):
            read_description(write(tmp_path / "a.usda", bytes(data)))


USDA = b"""#usda 1.0
(
    metersPerUnit = 0.01
    kilogramsPerUnit = 1
)
def Xform "w" ( doc = "a { b" )
{
    double3 xformOp:translate = (1, 2, 3)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Xform "body" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {
        float physics:mass = 2
        point3f physics:centerOfMass = (10, 20, 30)
        float3 physics:diagonalInertia = (100, 200, 250)
        quatf physics:principalAxes = (1, 0, 0, 0)
        float3 xformOp:scale = (2, 2, 2)
        uniform token[] xformOpOrder = ["xformOp:scale"]
        rel material:binding = </m>
        def Cube "c" ( prepend apiSchemas = ["PhysicsCollisionAPI"] ) { double size = 3 }
    }
}
"""


def test_unreadable_robot_file_is_refused_with_reason(tmp_path):
    (tmp_path / "a.stl").mkdir()
    for read, path, code in (
        (read_description, tmp_path / ("a" * 300 + ".urdf"), "file_unreadable"),
        (read_mesh, tmp_path / "a.stl", "mesh_unreadable"),
        (lambda path: read_3mf(str(path)), tmp_path / "a.stl", "file_unreadable"),
    ):
        with pytest.raises(FileError) as refused:
            read(path)
        found = refused.value.finding
        assert found.code == code and str(tmp_path) not in str(found)
        assert found.values.get("name", "a.stl") == "a.stl"


def test_a_usd_layer_is_only_so_deep(tmp_path):
    depth = xml.MAX_DEPTH + 2  # the outermost one counts as none
    layer = "#usda 1.0\n" + 'def Xform "a" {\n' * depth + "}\n" * depth
    assert refusal(read_description, write(tmp_path / "a.usda", layer)) == "file_too_large"
