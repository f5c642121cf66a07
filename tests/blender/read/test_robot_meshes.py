# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random triangles in every way that meshes of robots store them: they come back as they were
placed.
"""

import json
import struct

import numpy as np
import pytest
from body_moments.core.robots.read.meshes import read_mesh
from body_moments.core.verdict import FileError

from tests.blender.robot_truth import about, near, quaternion, text

SEEDS = pytest.mark.parametrize("seed", range(6))


def placed(rng):
    """(4, 4) of a translation, a rotation and scales, one of them negative or none; and these."""
    axis, angle, move = rng.normal(size=3), rng.uniform(-3, 3), rng.normal(size=3)
    scales = rng.uniform(0.5, 2, 3) * (rng.choice([-1, 1]), 1, 1)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = about(axis, angle) @ np.diag(scales), move
    return matrix, axis, angle, move, scales


def facing(corners, matrix):
    """(n, 3, 3) corners where they stand, facing as before where that mirrors."""
    found = corners @ matrix[:3, :3].T + matrix[:3, 3]
    return found[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else found


def check(path, expected, rel=1e-12):
    """The triangles in any order, each from any of its corners."""
    surface, upright = read_mesh(path)

    def ordered(corners):
        first = np.lexsort(corners.round(4).transpose(2, 0, 1)[::-1], axis=1)[:, 0]
        turned = np.array([np.roll(one, -k, axis=0) for one, k in zip(corners, first)])
        return turned[np.lexsort(turned.reshape(-1, 9).round(4).T[::-1])]

    assert surface.triangles.shape == (len(expected), 3)
    assert near(
        ordered(surface.points[surface.triangles].astype(float)), ordered(np.asarray(expected)), rel
    )
    return upright


def fans(polygons):
    return np.array([(face[0], *pair) for face in polygons for pair in zip(face[1:], face[2:])])


@SEEDS
def test_stl_and_obj(tmp_path, seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(9, 3)).astype(np.float32).astype(float)
    polygons = [rng.permutation(9)[:count].tolist() for count in (3, 4, 5, 3)]
    corners = points[fans(polygons)]
    rows = np.zeros(
        len(corners),
        np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]),
    )
    rows["corners"] = corners
    binary = struct.pack("<80sI", b"solid", len(rows)) + rows.tobytes()
    (tmp_path / "a.stl").write_bytes(binary)
    lines = ["facet normal 0 0 1\nouter loop\n", *["VERTEX {}\n"] * 3, "endloop\nendfacet\n"]
    facets = "".join("".join(lines).format(*map(text, one)) for one in corners)
    (tmp_path / "b.stl").write_text(" \nsolid \n{}endsolid".format(facets))
    for name in "ab":
        assert check(tmp_path / (name + ".stl"), corners) is None
    faces, halves = [], (points[:5], points[5:])
    for number, face in enumerate(polygons):
        relative = [index - 9 for index in face] if number % 2 else [index + 1 for index in face]
        faces.append(
            "f " + " ".join("{}{}".format(i, ["", "/1", "//2", "/1/2"][number]) for i in relative)
        )
    obj = [
        "# f 1 2 3",
        "",
        *("v {} 0.5 0.5 0.5".format(text(point)) for half in halves for point in half),
    ]
    (tmp_path / "c.obj").write_text(
        "\n".join([*obj, *["vn 0 0 1"] * 2, "g all", *faces]).replace(" ", " \\\n", 1)
    )
    assert check(tmp_path / "c.obj", corners) is None
    for name, content in (
        ("a.stl", binary[:-1].replace(b"solid", b"")),
        ("a.stl", bytes(80) + struct.pack("<I", len(rows) + 1) + binary[84:]),
        ("b.stl", b"solid\nvertex 0 0 0 vertex 1 0 0 endsolid"),
        ("b.stl", facets.encode()),
        ("c.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4"),
        ("c.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4"),
        ("c.obj", b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3"),
        ("c.obj", b"v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3"),
    ):
        assert refusal(tmp_path / name, content) == "mesh_unreadable", content
    for name, content in (
        ("a.stl", struct.pack("<80sI", b"", 0)),
        ("c.obj", b"v 0 0 0"),
        ("b.stl", b"solid endsolid"),
    ):
        assert refusal(tmp_path / name, content) == "mesh_unreadable"
    assert refusal(tmp_path / "a.ply", b"") == "mesh_unreadable"


def refusal(path, content):
    path.write_bytes(content)
    with pytest.raises(FileError) as refused:
        read_mesh(path)
    assert refused.value.finding.values["name"] == path.name
    return refused.value.finding.code


def glb(document, binary):
    def chunk(kind, data, fill):
        data += fill * (-len(data) % 4)
        return struct.pack("<II", len(data), kind) + data

    body = chunk(0x4E4F534A, json.dumps(document).encode(), b" ")
    body += chunk(0x004E4942, binary, b"\0") + chunk(0x12345678, b"what", b" ")
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def random_glb(rng):
    """A document, its buffer, and the triangles that its scene shows."""
    mapped = [placed(rng) for _ in range(3)]
    points = rng.normal(size=(3, 7, 3)).astype("<f4")
    orders = rng.integers(0, 7, (3, 12)).astype([np.uint8, np.uint16, np.uint32][rng.integers(3)])
    kind = {1: 5121, 2: 5123, 4: 5125}[orders.itemsize]
    binary, views, accessors = bytearray(b"pad!"), [], []
    for number in range(3):  # points of two meshes lie among other bytes
        stride, start, ahead = 12 + 8 * number, len(binary), 4 * number
        rows = np.zeros((7, stride), np.uint8)
        rows[:, :12] = points[number].view(np.uint8)
        binary += b"\7" * ahead + rows.tobytes()
        views.append(
            {"buffer": 0, "byteOffset": start, **({"byteStride": stride} if number else {})}
        )
        accessor = {"bufferView": len(views) - 1, "componentType": 5126, "count": 7, "type": "VEC3"}
        accessors.append({**accessor, **({"byteOffset": ahead} if ahead else {})})
        views.append({"byteOffset": len(binary)})
        binary += orders[number].tobytes() + b"\7" * (-orders[number].nbytes % 4)
        accessors.append(
            {"bufferView": len(views) - 1, "componentType": kind, "count": 12, "type": "SCALAR"}
        )
    meshes_of = [
        [
            {"attributes": {"POSITION": 0}, "indices": 1, "mode": 1},
            {"attributes": {"POSITION": 0}, "indices": 1},
        ],
        [{"attributes": {"POSITION": 2}, "indices": 3, "mode": 4}, {"attributes": {"POSITION": 2}}],
        [{"attributes": {"POSITION": 4}, "indices": 5}],
    ]
    (_, axis, angle, move, scales), (second, *_), _ = mapped
    w, *xyz = quaternion(axis, angle)
    document = {
        "scene": 1,
        "scenes": [{"nodes": [3]}, {"nodes": [0, 2]}, {}],
        "nodes": [
            {
                "translation": move.tolist(),
                "rotation": [*xyz, w],
                "scale": scales.tolist(),
                "mesh": 0,
                "children": [1],
            },
            {"matrix": second.T.ravel().tolist(), "mesh": 1},
            {"mesh": 2},
            {"mesh": 2, "scale": [3, 3, 3]},
        ],
        "meshes": [{"primitives": primitives} for primitives in meshes_of],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    first, inner = mapped[0][0], mapped[0][0] @ second
    points = points.astype(float)
    expected = [
        *facing(points[0][orders[0].reshape(-1, 3)], first),
        *facing(points[1][orders[1].reshape(-1, 3)], inner),
        *facing(points[1][:6].reshape(-1, 3, 3), inner),
        *points[2][orders[2].reshape(-1, 3)],
    ]
    return document, bytes(binary), expected


@SEEDS
def test_glb(tmp_path, seed):
    rng = np.random.default_rng(seed)
    document, binary, expected = random_glb(rng)
    path = tmp_path / "a.glb"
    path.write_bytes(glb(document, binary))
    assert check(path, expected) is None
    del document["scene"]
    document["nodes"][3]["scale"] = [1, 1, 1]
    path.write_bytes(glb(document, binary))
    check(path, expected[-4:])  # of the first scene
    document["scene"] = 1
    end = (
        document["bufferViews"][-1]["byteOffset"]
        + 12 * {5121: 1, 5123: 2, 5125: 4}[document["accessors"][5]["componentType"]]
    )
    document["buffers"][0]["byteLength"] = end - end % 4
    path.write_bytes(glb(document, binary[: end - end % 4]))
    check(path, expected) if not end % 4 else None
    whole = json.dumps(document)

    def changed(*place, value):
        other = json.loads(whole)
        inner = other
        for key in place[:-1]:
            inner = inner[key]
        inner[place[-1]] = value
        return glb(other, binary)

    for content in (
        b"glTX" + glb(document, binary)[4:],
        glb([], binary),
        glb(document, binary[: end - 4]),
        changed("accessors", 1, "count", value=-1),
        changed("accessors", 0, "sparse", value={}),
        changed("accessors", 1, "componentType", value=1),
        changed("accessors", 1, "type", value="MAT3"),
        changed("buffers", 0, "uri", value="a.bin"),
        changed("bufferViews", 0, "byteStride", value=11),
        changed("nodes", 1, "children", value=[0]),
        changed("nodes", 1, "children", value=[9]),
        changed("scene", value=5),
        changed("scenes", 1, value="a"),
        changed("nodes", 2, value="a"),
        changed("bufferViews", 0, value="a"),
    ):
        assert refusal(path, content) == "mesh_unreadable"


UPRIGHT = {"Y_UP": [[1, 0, 0], [0, 0, -1], [0, 1, 0]], "X_UP": [[0, -1, 0], [0, 0, -1], [1, 0, 0]]}
SOURCE = """<source id="{0}"><float_array>{1}</float_array><technique_common>
<accessor {2}/></technique_common></source>
<vertices id="v{0}"><input semantic="NORMAL" source="#none"/><input semantic="POSITION"
source="#{0}"/></vertices>"""


@SEEDS
def test_collada(tmp_path, seed):
    rng = np.random.default_rng(seed)
    mapped = [placed(rng) for _ in range(2)]
    points = rng.normal(size=(8, 3))
    polygons = [rng.permutation(8)[:count].tolist() for count in (3, 4, 6)]
    corners = points[fans(polygons)]
    triangles = rng.integers(0, 8, (4, 3))

    def indices(rows, offset, stride):
        whole = rng.integers(0, 5, (np.size(rows), stride))
        whole[:, offset] = np.ravel(rows)
        return text(whole)

    inputs = (
        '<input semantic="{}" source="#n" offset="{}"/><input semantic="VERTEX" source="#v{}" '
        'offset="{}"/>'
    )
    flat = [index for face in polygons for index in face]
    primitives = {
        "a": '<lines><p>0 1</p></lines><triangles><input semantic="VERTEX" '
        'source="#va"/></triangles>'
        "<polylist>{}<vcount>3 4 6</vcount><p>{}</p></polylist>".format(
            inputs.format("NORMAL", 0, "a", 1), indices(flat, 1, 2)
        ),
        "b": "<polygons>{}{}</polygons><triangles>{}<p>{}</p></triangles>".format(
            inputs.format("TEXCOORD", 2, "b", 1),
            "".join("<p>{}</p>".format(indices(face, 1, 3)) for face in polygons),
            '<input semantic="VERTEX" source="#vb"/>',
            text(triangles),
        ),
    }
    wide = np.concatenate([points, rng.normal(size=(8, 2))], axis=1)
    arrays = {"a": (text(points) + " 7", ""), "b": (text(wide), 'stride="5"')}
    geometries = "".join(
        '<geometry id="g{0}"><mesh>{1}{2}</mesh></geometry><geometry id="e{0}"/>'.format(
            name, SOURCE.format(name, *arrays[name]), primitives[name]
        )
        for name in "ab"
    )
    (first, axis, angle, move, scales), (second, *_) = mapped
    steps = "<translate>{}</translate><rotate>{} {!r}</rotate><scale>{}</scale>".format(
        text(move), text(axis * 3), float(np.degrees(angle)), text(scales)
    )
    meter = [1.0, 0.01, 2.0][seed % 3]
    content = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"><asset>{}<up_axis>
{} </up_axis></asset>
    <library_geometries>{}</library_geometries><library_nodes><node id="n"><matrix>{}</matrix>
    <instance_geometry url="#gb"/></node></library_nodes><library_visual_scenes>
<visual_scene id="s">
    <node>{}<instance_geometry url="#ga"/><instance_geometry url="#ea"/><node>
<instance_node url="#n"/></node></node>
    <node><instance_geometry url="#ga"/></node></visual_scene></library_visual_scenes>{}</COLLADA>
"""
    unit = '<unit meter="{!r}"/>'.format(meter) if seed % 3 else ""
    scene = '<scene><instance_visual_scene url="#s"/></scene>'
    up = ["Z_UP", "Y_UP", "X_UP"][seed % 3]
    path = tmp_path / "a.dae"
    path.write_text(content.format(unit, up, geometries, text(second), steps, scene))
    expected = [*facing(corners, first), *facing(corners, first @ second)]
    expected += [*facing(points[triangles], first @ second), *corners]
    upright = check(path, meter * np.array(expected))
    if up == "Z_UP":
        assert upright is None
    else:
        assert upright.tolist() == UPRIGHT[up]
    path.write_text(content.format(unit, "Z_UP", geometries, text(second), steps, ""))
    # as it is, where there is no scene
    everything = np.concatenate([corners, corners, points[triangles]])
    assert check(path, meter * everything) is None
    path.write_text(
        "<COLLADA>"
        + content.partition("</asset>")[2].format(geometries, text(second), steps, scene)
    )
    assert check(path, np.array(expected)).tolist() == UPRIGHT["Y_UP"]
    for wrong in (
        content.format(unit, up, geometries.replace("3 4 6", "3 4 5"), text(second), steps, scene),
        content.format(
            unit, up, geometries.replace("<vcount>3 4 6</vcount>", ""), text(second), steps, scene
        ),
        content.format(unit, up, geometries, text(second), steps, scene).replace("#ga", "#gc"),
        content.format(unit, up, geometries, "1 2 3", steps, scene),
    ):
        assert refusal(path, wrong.encode()) == "mesh_unreadable"


def test_collada_sources_without_numbers_have_no_points(tmp_path):
    geometry = (
        '<COLLADA><library_geometries><geometry><mesh><source id="a"/><vertices id="v"><input '
    )
    geometry += 'semantic="POSITION" source="#a"/></vertices><triangles>'
    geometry += '<input semantic="VERTEX" source="#v"/>'
    geometry += "<p>{}</p></triangles></mesh></geometry></library_geometries></COLLADA>"
    assert refusal(tmp_path / "a.dae", geometry.format("0 1 2").encode()) == "mesh_unreadable"
    assert refusal(tmp_path / "a.dae", geometry.format("").encode()) == "mesh_unreadable"


def test_collada_nodes_in_a_circle_are_refused(tmp_path):
    geometry = (
        '<library_geometries><geometry id="g"><mesh>{}<triangles><input semantic="VERTEX" '
        'source="#va"/><p>0 1 2'
    )
    geometry += "</p></triangles></mesh></geometry></library_geometries>"
    deep = (
        "<library_visual_scenes><visual_scene id='s'>{}{}{}</visual_scene></library_visual_scenes>"
    )
    end = '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
    source = SOURCE.format("a", "0 0 0 1 0 0 0 1 0", "")
    path = tmp_path / "a.dae"
    nodes = "<COLLADA>" + geometry.format(source) + deep
    circle = '<node id="c"><instance_node url="#c"/></node>'
    assert refusal(path, (nodes.format("", circle, "") + end).encode()) == "mesh_unreadable"
