# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates in files that are no finite numbers: Blender's importers put others there, and say
nothing.
"""

import base64
import json
import math
import struct
import zlib

import pytest

bpy = pytest.importorskip("bpy")
import numpy as np
from body_moments.command.files import finite
from body_moments.command.files.importers import import_mesh
from body_moments.core.files.text_fields import NUMBER
from body_moments.core.verdict import FileError, finding

from tests.blender import batch_files as files
from tests.blender.batch_files import document, measured, reason, sentence

pytestmark = pytest.mark.usefixtures("registered")

WORDS = [
    "nan",
    "-NaN",
    "NAN(0x1)",
    "inf",
    "+INF",
    "-Infinity",
    "1e999",
    "-1E+39",
    "1e0039",
    "4" + "0" * 38,
]
WORDS += [
    "1.#INF",
    "-1.#IND",
    "1.#QNAN",
    "7" * 31 + "e8",
    "0.5e39",
    "3.5e38",
    "7" * 30 + "e09",
    "4.e38",
]
NO_NUMBERS = ["1.0x0", "1.0D0", "l.0", "--1", "1e", "1.0.0", "0x1", "1_0", "٣"]
FINITE = [
    "1e-999",
    "1E+02",
    "-1.5e+037",
    "0." + "1" * 60,
    "3.4e38",
    "1e+00",
    "2.0e-39",
    ".5",
    "0" * 40 + "1",
    "1e05",
]


def refused(count, code, **place):
    return sentence("non_finite_coordinates", count=count, place=finding(code, **place).as_record())


def checked(path):
    """The finding about a file's numbers; None where all are finite."""
    try:
        import_mesh(str(path)) if path.suffix in (".stl", ".ply") else finite.check_numbers(
            str(path), path.suffix
        )
    except FileError as error:
        return error.finding
    return None


def said(path, count, code, **place):
    found = checked(path)
    assert found == finding(
        "non_finite_coordinates", count=count, place=finding(code, **place).as_record()
    )


AXES = [f"property float {axis}" for axis in "xyz"]


def texts(word):
    """A tetrahedron whose third corner has that word as its x, and the line of the word, by the
    name of a file.
    """
    corners = [list(map(str, corner)) for corner in files.CORNERS]
    corners[2][0] = word
    stl = files.stl_text(corners).replace("facet normal 0 0 0", "facet normal nan nan nan")
    obj = "# nan inf\no inf\n" + "".join(
        "v {} {} {}\nvn nan 0 1e99\n".format(*corner) for corner in corners
    )
    obj += files.obj_text()[files.obj_text().index("f ") :]
    head = ["ply", "format ascii 1.0", "comment nan", "element vertex 4", *AXES]
    head += ["element face 4", "property list uchar int vertex_indices", "end_header", ""]
    ply = "\n".join(head) + "".join("{} {} {}\n".format(*corner) for corner in corners)
    ply += "".join("3 {} {} {}\n".format(*face) for face in files.FACES)
    return {"t.stl": (stl, 5), "t.obj": (obj, 7), "t.ply": (ply, 13)}


@pytest.mark.parametrize("name", ["t.stl", "t.obj", "t.ply"])
def test_text_with_nan_or_infinity_is_refused(tmp_path, name):
    for word in WORDS:
        text, line = texts(word)[name]
        files.write_text(tmp_path / name, text)
        values = {"text": word[:60], "expected": NUMBER}
        assert checked(tmp_path / name) == finding("line_misread", line=line, **values)
    for word in FINITE:
        files.write_text(tmp_path / name, texts(word)[name][0])
        assert checked(tmp_path / name) is None, word
    assert measured(files.write_text(tmp_path / name, texts("0")[name][0]))[
        "volume"
    ] == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("name", ["t.stl", "t.obj", "t.ply"])
def test_words_that_are_no_numbers_are_refused_streamed_or_not(tmp_path, name):
    path = tmp_path / name
    for word in (*NO_NUMBERS, "1,0"):
        text, line = texts(word)[name]
        files.write_text(path, text)
        values = {"text": word, "expected": NUMBER}
        for stream in ("never", "always")[: 1 + (name != "t.obj")]:
            assert reason(path, "--stream", stream) == sentence("line_misread", line=line, **values)
    text, line = texts("")[name]  # one number is missing
    files.write_text(path, text)
    for stream in ("never", "always")[: 1 + (name != "t.obj")]:
        assert "Line {} ".format(line + (name == "t.stl")) in reason(path, "--stream", stream)


@pytest.fixture
def gltf(tmp_path):
    """A box as .gltf and .bin: its document, and the bytes of its positions."""
    files.box_file(tmp_path / "box.gltf")
    text = json.loads((tmp_path / "box.gltf").read_text(encoding="utf-8"))
    return text, bytearray((tmp_path / "box.bin").read_bytes())


def position(text):
    accessor = text["accessors"][text["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    return accessor, text["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)


def test_a_gltf_with_a_position_that_is_not_finite_is_refused(tmp_path, gltf):
    text, binary = gltf
    path = tmp_path / "box.gltf"
    assert measured(path)["volume"] == pytest.approx(6.0, rel=1e-6)
    accessor, start = position(text)
    normals = text["accessors"][text["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]]
    struct.pack_into(
        "<f", binary, text["bufferViews"][normals["bufferView"]]["byteOffset"], math.nan
    )
    (tmp_path / "box.bin").write_bytes(binary)
    assert checked(path) is None
    struct.pack_into("<f", binary, start + 12 * 5 + 4, math.nan)
    (tmp_path / "box.bin").write_bytes(binary)
    name = text["meshes"][0]["name"]
    assert reason(path) == refused(1, "at_row", element="mesh “{}”, row".format(name), row=5)
    # Repeat it with a single file, and with the data as text.
    text["buffers"][0].pop("uri")
    head = json.dumps(text).encode()
    head += b" " * (-len(head) % 4)
    body = (
        struct.pack("<I4s", len(head), b"JSON")
        + head
        + struct.pack("<I4s", len(binary), b"BIN\0")
        + binary
    )
    (tmp_path / "box.glb").write_bytes(struct.pack("<4s2I", b"glTF", 2, 12 + len(body)) + body)
    said(tmp_path / "box.glb", 1, "at_row", element="mesh “{}”, row".format(name), row=5)
    text["buffers"][0]["uri"] = (
        "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    )
    files.write_text(path, json.dumps(text))
    said(path, 1, "at_row", element="mesh “{}”, row".format(name), row=5)


def test_gltf_text_numbers_and_overrides_are_checked(tmp_path, gltf):
    text, binary = gltf
    path = tmp_path / "box.gltf"
    accessor, _ = position(text)
    for key, values in (("translation", [0, "word", "word"]), ("matrix", ["word", *range(15)])):
        text["nodes"][0][key] = values
        files.write_text(path, json.dumps(text).replace('"word"', "1e39"))
        said(path, values.count("word"), "at_row", element="node", row=text["nodes"][0]["name"])
        del text["nodes"][0][key]
    end = len(binary)
    binary += struct.pack("<2H6f", 4, 7, *5 * [0.0], math.inf)
    view = len(text["bufferViews"])
    for offset, length in ((end, 4), (end + 4, 24)):
        text["bufferViews"].append({"buffer": 0, "byteOffset": offset, "byteLength": length})
    indices = {"bufferView": view, "componentType": 5123}
    accessor["sparse"] = {"count": 2, "indices": indices, "values": {"bufferView": view + 1}}
    text["buffers"][0]["byteLength"] = len(binary)
    (tmp_path / "box.bin").write_bytes(binary)
    place = {"element": "mesh “{}”, row".format(text["meshes"][0]["name"]), "row": 7}
    for nothing in (0, None):  # null stands for nothing
        accessor["byteOffset"] = nothing
        files.write_text(path, json.dumps(text | {"skins": [] if nothing == 0 else None}))
        said(path, 1, "at_row", **place)


def test_gltf_checks_cover_only_placed_points(tmp_path):
    numbers = np.zeros((6, 4), "<f4")
    numbers[:, 3] = math.nan  # between the rows
    numbers[4, 1] = math.inf
    (tmp_path / "t.bin").write_bytes(numbers.tobytes())
    view = {"buffer": 0, "byteLength": numbers.nbytes, "byteStride": 16}
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"} for count in (4, 6)
    ]
    text = {
        "buffers": [{"uri": "t.bin", "byteLength": numbers.nbytes}],
        "bufferViews": [view],
        "accessors": accessors,
    }
    instancing = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}
    other = finding("at_row", element="accessor 1, row", row=4)
    of_mesh = finding("at_row", element="mesh “0”, row", row=4)
    for more, place in (
        (
            {
                "meshes": [
                    {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 1}}]}
                ]
            },
            None,
        ),
        ({"meshes": [{"primitives": [{"attributes": {"POSITION": 1}}]}]}, of_mesh),
        (
            {
                "meshes": [
                    {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}]}
                ]
            },
            of_mesh,
        ),
        ({"skins": [{"inverseBindMatrices": 1}]}, other),
        ({"animations": [{"samplers": [{"input": 0, "output": 1}]}]}, other),
        ({"animations": [{"samplers": [{"input": 1, "output": 0}]}]}, other),
        ({"nodes": [{"extensions": instancing}]}, other),
    ):
        files.write_text(tmp_path / "t.gltf", json.dumps(text | more))
        found = checked(tmp_path / "t.gltf")
        assert found == (
            place and finding("non_finite_coordinates", count=1, place=place.as_record())
        )
    for name in ("EXT_meshopt_compression", "KHR_meshopt_compression"):
        view["extensions"] = {name: {}}
        files.write_text(tmp_path / "t.gltf", json.dumps(text | more))
        assert checked(tmp_path / "t.gltf") is None


def test_gltf_error_names_its_missing_or_short_buffer(tmp_path, gltf):
    text, binary = gltf
    (tmp_path / "box.bin").write_bytes(binary[:50])
    cause = finding("damage_size", bytes=50, total=len(binary))
    expected = sentence("file_damaged", file="box.bin", cause=cause.as_record())
    assert reason(tmp_path / "box.gltf") == expected
    text["buffers"][0]["uri"] = "no%20more.bin"
    files.write_text(tmp_path / "box.gltf", json.dumps(text))
    assert reason(tmp_path / "box.gltf") == sentence("missing_references", names=["no more.bin"])


@pytest.mark.parametrize("name", ["draco_mesh", "meshopt"][bpy.app.version < (5, 0, 0) :])
def test_missing_gltf_decoder_is_named_with_a_remedy(tmp_path, gltf, name):
    """The wheel of 5.2 lacks the libraries; that of 4.5 has Draco, and no meshopt at all."""
    text, _ = gltf
    extension = "KHR_{}_compression".format(name)
    text["extensionsUsed"] = text["extensionsRequired"] = [extension]
    view = {"buffer": 0, "byteLength": 8, "byteStride": 12, "count": 8, "mode": "ATTRIBUTES"}
    for one in text["bufferViews"]:
        one["extensions"] = {extension: view} if name == "meshopt" else {}
    for mesh in text["meshes"]:
        draco = {extension: {"bufferView": 0, "attributes": {"POSITION": 0}}}
        mesh["primitives"][0]["extensions"] = draco if name == "draco_mesh" else {}
    files.write_text(tmp_path / "box.gltf", json.dumps(text))
    said = reason(tmp_path / "box.gltf")
    assert name.partition("_")[0].capitalize() in said and "blender -b" in said


def fbx_file(path, values, packed):
    """A binary FBX file of nothing but vertices."""

    def node(name, content, at, properties=b""):
        head = 13 + len(name) + len(properties)
        inner = content(at + head) + bytes(13) if content else b""
        sizes = at + head + len(inner), bool(properties), len(properties), len(name)
        return struct.pack("<3IB", *sizes) + name + properties + inner

    data = np.array(values, "<f8").tobytes()
    stored = zlib.compress(data) if packed else data
    array = b"d" + struct.pack("<3I", len(values), packed, len(stored)) + stored
    other, inner = node(b"Any", None, 27), [b"Vertices", None]
    objects = node(
        b"Objects", lambda at: node(b"Geometry", lambda at: node(*inner, at, array), at), 27 + 16
    )
    path.write_bytes(
        b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400) + other + objects + bytes(13)
    )


@pytest.mark.parametrize("packed", [0, 1])
def test_the_vertices_of_an_fbx_are_looked_at(tmp_path, packed):
    path = tmp_path / "t.fbx"
    values = np.random.default_rng(1).normal(size=300_000)
    fbx_file(path, values, packed)
    assert checked(path) is None
    values[[299_999, 200_000]] = math.nan, 1e39
    fbx_file(path, values, packed)
    said(path, 2, "at_row", element="vertex", row=66_666)


@pytest.mark.parametrize("head", ["Vertices: *12 {\n\t\t\ta: ", "Vertices: "])
def test_the_vertices_of_an_fbx_of_text_are_looked_at(tmp_path, head):
    path = tmp_path / "t.fbx"
    text = '; FBX 7.4.0 project file\nObjects:  {\n\tGeometry: 1, "Geometry::inf", "Mesh" {\n'
    text += "\t\tNormals: *3 {\n\t\t\ta: nan,1e999,0\n\t\t}\n\t\t"
    after = "\n\t\t}\n\t\tWeights: *1 {\n\t\t\ta: nan\n\t\t}\n\t}\n}\n"
    for word in (*FINITE, *WORDS, *NO_NUMBERS):
        files.write_text(path, text + head + "0,0,0,1,0,0,0,\n" + word + ",0,\n0,0,3" + after)
        line = (text + head).count("\n") + 2
        values = {"text": word[:60], "expected": NUMBER}
        assert checked(path) == (
            None if word in FINITE else finding("line_misread", line=line, **values)
        )
    values = {"text": "nan", "expected": NUMBER}
    files.write_text(path, "; Vertices: are numbers\nVertices: 0,0,0,nan,0,0")
    assert checked(path) == finding("line_misread", line=2, **values)
    files.write_text(
        path, "Vertices: 0,0,0,1,\n0,0\nPolygonVertexIndex: 0,nan\nOther: *1 {\na: nan}"
    )
    assert checked(path) is None


def test_an_fbx_of_blender_is_looked_at(tmp_path):
    path = tmp_path / "part.fbx"
    files.box_file(path)
    data = path.read_bytes()
    at = data.index(b"\x08Verticesd") + 9
    count, packed, size = struct.unpack_from("<3I", data, at + 1)
    raw = bytearray(zlib.decompress(data[at + 13 : at + 13 + size]))
    raw[:] = np.full(count, math.inf).tobytes()
    stored = zlib.compress(bytes(raw), 9).ljust(size, b"\0")
    assert packed and len(stored) == size
    path.write_bytes(data[: at + 13] + stored + data[at + 13 + size :])
    assert reason(path) == refused(24, "at_row", element="vertex", row=0)


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".glb", ".gltf", ".fbx"])
def test_blender_exports_pass_the_check_and_noise_too(tmp_path, suffix):
    path = tmp_path / f"part{suffix}"
    files.box_file(path)
    assert document(path)["errors"] == []
    rng = np.random.default_rng(7)
    data = bytearray(path.read_bytes())
    for _ in range(60):
        broken = bytearray(data)
        for at in rng.integers(0, len(data), 5):
            broken[at] = rng.integers(256)
        path.write_bytes(broken[: rng.integers(1, len(data))] if rng.integers(2) else broken)
        checked(path)  # raises nothing else
