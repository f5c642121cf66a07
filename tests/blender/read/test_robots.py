# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions and meshes from strangers: what is read, and what is refused."""

import json
import os
import struct

import pytest

pytest.importorskip("bpy")
import contextlib

import bpy
import numpy as np
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.verdict.finding import FileError
from body_moments.operators.read.robots.descriptions import read_description
from body_moments.operators.read.robots.meshes import read_mesh
from body_moments.operators.read.robots.paths import Roots

from tests.blender import batch_files
from tests.close import close

TETRAHEDRON = batch_files.TETRAHEDRON
LINK = '<link name="a"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'


def refusal(function, *arguments):
    with pytest.raises(FileError) as refused:
        function(*arguments)
    assert str(refused.value).endswith(".")  # it has a sentence
    return refused.value.finding.code


def write(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def center(moments):
    return moments.about + moments.raw[1:4] / moments.raw[0]


def check(path, factor=1.0):
    """The tetrahedron, outward, scaled."""
    moments = polyhedron_moments(read_mesh(path)[0])[0]
    assert close(moments.raw[0], TETRAHEDRON["volume"] * factor**3, 1e-6)
    assert close(center(moments), np.array(TETRAHEDRON["center_of_mass"]) * factor, 1e-6)


def dae(up="Z_UP", meter="1", body="triangles", place="<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"):
    points = " ".join(str(x) for corner in batch_files.CORNERS for x in corner)
    corners = " ".join("{} 0".format(index) for face in batch_files.FACES for index in face)
    counts = "<vcount>3 3 3 3</vcount>" if body == "polylist" else ""
    lists = "<p>{}</p>".format(corners)
    if body == "polygons":
        lists = "".join("<p>{}</p>".format(" ".join("{} 0".format(i) for i in face)) for face in batch_files.FACES)
    return """<?xml version="1.0"?>
    <COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
    <asset><unit name="u" meter="{meter}"/><up_axis>{up}</up_axis></asset>
    <library_geometries><geometry id="g"><mesh>
      <source id="p"><float_array id="pa" count="12">{points}</float_array>
        <technique_common><accessor source="#pa" count="4" stride="3"/></technique_common></source>
      <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
      <{body} count="4"><input semantic="VERTEX" source="#v" offset="0"/>
      <input semantic="NORMAL" source="#p" offset="1"/>
      {counts}{lists}</{body}></mesh></geometry></library_geometries>
    <library_visual_scenes><visual_scene id="s"><node>{place}<instance_geometry url="#g"/></node></visual_scene>
    </library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".format(**locals())


@pytest.mark.parametrize("body", ["triangles", "polylist", "polygons"])
def test_collada_is_in_meters_along_its_own_axes(tmp_path, body):
    check(write(tmp_path / "a.dae", dae(body=body)))
    check(write(tmp_path / "b.dae", dae(meter="0.001")), 0.001)
    check(write(tmp_path / "c.dae", dae(place="<scale>2 2 2</scale>")), 2.0)
    for up, axis in (("Y_UP", (0, 1, 0)), ("X_UP", (1, 0, 0))):
        check(write(tmp_path / "d.dae", dae(up=up)))
        upright = read_mesh(tmp_path / "d.dae")[1]
        assert (upright @ axis == (0, 0, 1)).all() and np.linalg.det(upright) == 1.0
    assert read_mesh(tmp_path / "a.dae")[1] is None
    moved = polyhedron_moments(read_mesh(write(tmp_path / "e.dae", dae(place="<translate>1 2 3</translate>")))[0])[0]
    assert close(center(moved), np.array(TETRAHEDRON["center_of_mass"]) + (1, 2, 3), 1e-12)


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


def test_obj_counts_from_the_end_too_and_cuts_polygons(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    faces = "f 1 4 3 2\nf -4 -3 -2 -1\nf 1/1 2/2 6/3 5\nf 2//1 3 7 6\nf 3 4 8 \\\n7\nf 4 1 5 8\n"
    surface, _ = read_mesh(write(tmp_path / "a.obj", text + faces))
    assert len(surface.triangles) == 12 and close(polyhedron_moments(surface)[0].raw[0], 1.0, 1e-14)


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
    assert refusal(read_mesh, zeros) in ("mesh_damaged", "xml_invalid", "mesh_empty")


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
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "buffers": [{"byteLength": 72}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = points + order
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def test_entities_are_refused(tmp_path):
    bomb = '<!DOCTYPE r [<!ENTITY a "x"><!ENTITY b "&a;&a;">]><robot name="&b;"/>'
    assert refusal(read_description, write(tmp_path / "a.urdf", bomb)) == "xml_entities"
    outside = '<!DOCTYPE r SYSTEM "file:///etc/passwd"><robot name="r"/>'
    assert refusal(read_description, write(tmp_path / "b.urdf", outside)) == "xml_entities"
    mesh = write(tmp_path / "a.dae", bomb.replace("robot", "COLLADA"))
    assert refusal(read_mesh, mesh) == "xml_entities"


def test_what_is_no_description_is_refused(tmp_path):
    deep = "<robot>" + "<link>" * 300 + "</link>" * 300 + "</robot>"
    for code, content in (
        ("xml_too_large", deep),
        ("xml_invalid", "<robot><link></robot>"),
        ("xml_invalid", b"\xff\xfe\0"),
        ("description_unknown", "<html/>"),
        ("description_without_links", '<robot name="r"/>'),
        ("usd_not_text", b"PXR-USDC\0\0"),
        ("usda_invalid", '#usda 1.0\ndef Xform "a" { double x = (1,'),
        ("usda_invalid", b"#usda 1.0\n\xff"),
    ):
        assert refusal(read_description, write(tmp_path / "a.xml", content)) == code, content[:40]
    assert refusal(read_description, tmp_path / "none.urdf") == "file_missing"
    assert refusal(read_description, tmp_path) == "file_not_regular"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="not on this system")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.urdf")
    assert refusal(read_description, tmp_path / "a.urdf") == "file_not_regular"
    os.mkfifo(tmp_path / "a.stl")
    assert refusal(Roots.of(tmp_path / "b.urdf").find, "a.stl") == "mesh_missing"


def test_meshes_are_found_within_the_folders_that_are_allowed(tmp_path):
    package = tmp_path / "arm_description"
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    mesh = write(package / "meshes" / "a.stl", "")
    secret = write(tmp_path / "secret.stl", "")
    file = package / "urdf" / "arm.urdf"
    for name in ("../meshes/a.stl", str(secret), "file://" + str(secret), "../../secret.stl"):
        assert refusal(Roots.of(file).find, name) == "mesh_outside", name
    write(package / "package.xml", "<package/>")
    roots = Roots.of(file)
    for name in ("../meshes/a.stl", "package://arm_description/meshes/a.stl", "meshes/a.stl", r"..\meshes\a.stl"):
        assert roots.find(name) == mesh.resolve(), name
    assert refusal(roots.find, "package://../../secret.stl") in ("mesh_outside", "mesh_missing")
    assert refusal(roots.find, "https://example.com/a.stl") == "mesh_on_network"
    assert refusal(roots.find, "package://arm_description/meshes/b.stl") == "mesh_missing"
    assert Roots.of(file, [tmp_path]).find("package://arm_description/meshes/a.stl") == mesh.resolve()
    assert Roots.of(file, anywhere=True).find(str(secret)) == secret.resolve()


@pytest.mark.skipif(os.name == "nt", reason="not on this system")
def test_links_out_of_the_folder_are_not_followed(tmp_path):
    inside = tmp_path / "in"
    inside.mkdir()
    write(tmp_path / "secret.stl", "")
    (inside / "a.stl").symlink_to(tmp_path / "secret.stl")
    assert refusal(Roots.of(inside / "r.urdf").find, "a.stl") == "mesh_outside"


def test_a_number_that_is_none_is_a_finding_of_its_link(tmp_path):
    text = '<robot name="r"><link name="a"><inertial><mass value="heavy"/></inertial></link>{}</robot>'
    description = read_description(write(tmp_path / "a.urdf", text.format(LINK.format("a.stl"))))
    (first, second) = description.links
    assert [found.code for found in first.findings] == ["description_number"] and first.inertial is None
    assert second.shapes[0].shape.file == "a.stl" and second.moves


def test_sdf_states_its_poses_in_three_ways(tmp_path):
    text = """<sdf version="1.9"><model name="m"><link name="a">{}</link></model></sdf>"""
    tensor = "<mass>2</mass><inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia>"
    inertial = "<inertial><pose {}>{}</pose>" + tensor + "</inertial>"
    forms = (("", "1 2 3 0 0 1.5707963267948966"), ('degrees="true"', "1 2 3 0 0 90"))
    forms += (('rotation_format="quat_xyzw"', "1 2 3 0 0 0.7071067811865476 0.7071067811865476"),)
    for attributes, pose in forms:
        path = write(tmp_path / "a.sdf", text.format(inertial.format(attributes, pose)))
        (link,) = read_description(path).links
        assert link.inertial.center.tolist() == [1, 2, 3] and link.inertial.mass == 2.0
        assert np.abs(link.inertial.inertia - np.diag([2, 1, 2.5])).max() < 1e-15


def test_bytes_that_are_no_text_of_usd_do_not_hang(tmp_path):
    """Fuzzed layers are read or refused, in no time."""
    rng = np.random.default_rng(6)
    for _ in range(60):
        data = bytearray(USDA)
        place = int(rng.integers(len(data)))
        data[place : place + 2] = rng.choice(list(b'"{}[]()=@<>#\n a1'), 2).astype(np.uint8).tobytes()
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


def test_usd_is_read_in_meters_with_the_scale_of_its_prims(tmp_path):
    (link,) = read_description(write(tmp_path / "a.usda", USDA)).links
    assert link.name == "w/body" and close(link.inertial.center, np.array([0.2, 0.4, 0.6]), 1e-15)
    assert close(np.diag(link.inertial.inertia), np.array([0.01, 0.02, 0.025]), 1e-14)
    (shape,) = link.shapes
    assert shape.role == "collision" and close(np.array(shape.shape.size), np.full(3, 0.06), 1e-14)
