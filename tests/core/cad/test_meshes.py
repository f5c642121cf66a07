# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of files as arrays, without Blender."""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.cad.surface_file import read_meshes
from body_moments.core.files.text_fields import parse_decimals
from body_moments.core.streams.file_mesh import merge_equal

from tests.core.bodies import rotation, torus
from tests.core.findings import refused
from tests.core.mesh_files import ply, stl, stl_text

OBJ = """\ufeff# v 9 9 9
o  A 1\x20
v 0 0 0 # 5 5 5
v 1 0 0 0.5 0.5 0.5
v 0 1.0e0 0
v 0 \\
 0 1
vt 0 0
vn 0 0 1
f 1/1/1 2/1/1 3/1/1 # 4
f -4//-1 -3//1 -1//1
g x
o empty
o B
v 2 2 2
v 3 2 2
v 3 3 2
v .2e1 3 2
f -4 -3 -2 -1
l 1 2
f 6 6 7 8
f 1 1 2
"""


def read_upright(path):
    """The meshes of a file with their points z up."""
    meshes, upright = read_meshes(path)
    return [replace(mesh, points=mesh.points @ upright[:3, :3].T) for mesh in meshes]


def faces_of(mesh):
    return [
        mesh.points[part].tolist() for part in np.split(mesh.corners, np.cumsum(mesh.sides)[:-1])
    ]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_obj_objects_are_read_as_blender_shows_them(tmp_path, end):
    (tmp_path / "a.obj").write_bytes(OBJ.replace("\n", end).encode())
    first, second = read_upright(tmp_path / "a.obj")
    a, b, c, d = [0, 0, 0], [1, 0, 0], [0, 0, 1], [0, -1, 0]
    assert first.name == "A 1" and faces_of(first) == [[a, b, c], [a, b, d]]
    square = [[2, -2, 2], [3, -2, 2], [3, -2, 3], [2, -2, 3]]
    assert second.name == "B" and faces_of(second) == [square, square[1:]]
    (tmp_path / "b.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\ng x\nf 1 2 3\n", encoding="utf-8")
    (only,) = read_upright(tmp_path / "b.obj")
    assert only.name == "b" and only.points.tolist() == [a, b, d]


@pytest.mark.parametrize("name", ["a.b.stl", "text.STL", "a.ply", "big.ply", "text.ply", "a.obj"])
def test_one_mesh_is_the_same_in_every_format(tmp_path, name):
    points, triangles = torus(9, 5)
    points = (points @ rotation(3).T + [3.0, -2.0, 5.0]).astype(np.float32)
    orders = {"a.ply": "<", "big.ply": ">", "text.ply": ""}
    if name in orders:
        data = ply(points, triangles.tolist(), orders[name])
    elif name == "a.obj":
        data = "".join(
            "v {!r} {!r} {!r}\n".format(x, z, -y) for x, y, z in points.tolist()
        ).encode()
        data += "".join("f {} {} {}\n".format(*row) for row in (triangles + 1).tolist()).encode()
    else:
        data = (stl if name == "a.b.stl" else stl_text)((points, triangles))
    (tmp_path / name).write_bytes(data)
    (mesh,) = read_upright(tmp_path / name)
    assert mesh.name == name.rpartition(".")[0] and len(mesh.points) == len(points)
    assert np.array_equal(mesh.surface().triangles, mesh.corners.reshape(-1, 3))
    shown = mesh.points[mesh.corners].astype(np.float32)
    assert np.array_equal(shown, points[triangles.ravel()]) and (mesh.sides == 3).all()


def test_decimals_of_any_form_are_rounded_as_by_float():
    rng = np.random.default_rng(2)
    values = rng.normal(size=2000) * 10.0 ** rng.integers(-30, 30, 2000)
    words = [
        form % value
        for form in ("%g", "%e", "%.17g", "%.3f", "%.20f", "%.25e")
        for value in values.tolist()
    ]
    words += [
        ".5",
        "5.",
        "+1E+02",
        "-0.0",
        "1e-400",
        "00012",
        "12345678901234567890",
        "-9223372036854775808e05",
    ]
    text = "vertex " + " Vertex\t".join(words)
    numbers, places = parse_decimals(text.encode())
    assert numbers.tolist() == [float(word) for word in words]
    assert [text[place] for place in places] == [word[0] for word in words]


def test_equal_points_become_the_first_of_them():
    points = np.array([(1, 2, 3), (0.0, 0, 0), (1, 2, 3), (-0.0, 0, -0.0), (3, 2, 1)], np.float32)
    merged, index = merge_equal(points)
    assert merged.tolist() == [[1, 2, 3], [0, 0, 0], [3, 2, 1]] and index.tolist() == [
        0,
        1,
        0,
        1,
        2,
    ]


def test_ply_strips_edges_and_numbers_are_read(tmp_path):
    head = (
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty "
        "float z\n"
    )
    head += "property int label\nelement tristrips 1\nproperty list int int vertex_indices\n"
    head += "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    rows = "".join("{} {} 0 {}\n".format(n, n * n, 7 * n) for n in range(5))
    (tmp_path / "a.ply").write_text(head + rows + "8 0 1 2 3 -1 1 2 4\n0 4\n", encoding="utf-8")
    (mesh,), _ = read_meshes(tmp_path / "a.ply")
    assert mesh.corners.reshape(-1, 3).tolist() == [[0, 1, 2], [2, 1, 3], [1, 2, 4]]
    assert mesh.edges.tolist() == [[0, 4]] and mesh.values["label"].tolist() == [0, 7, 14, 21, 28]


def test_numbers_that_are_not_finite_and_empty_files_are_refused(tmp_path):
    points = np.array([(0, 0, 0), (1, 0, 0), (0, np.inf, 0)], np.float32)
    for name, data in (
        ("a.ply", ply(points, [[0, 1, 2]], "<")),
        ("a.stl", stl((points, np.array([[0, 1, 2]])))),
    ):
        (tmp_path / name).write_bytes(data)
        with refused("non_finite_coordinates", count=1):
            read_meshes(tmp_path / name)
    (tmp_path / "a.obj").write_bytes(b"")
    assert read_meshes(tmp_path / "a.obj")[0] == []
    with refused("file_missing"):
        read_meshes(tmp_path / "b.obj")
