# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files measured in a Python without Blender: the records of a Python with it, to the last bit."""

import json
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest
from body_moments.core.streams.file_mesh import tessellate

from tests.core.bodies import inverted, rotation, soup, torus, without
from tests.core.mesh_files import ply, stl, stl_text
from tests.records import valid

SCRIPT = Path(__file__).resolve().parent.parent.parent / "operators" / "batch.py"
# Blender's modules cannot be imported, as if they were not installed.
BLOCKED = """\
import runpy, sys
sys.modules.update(dict.fromkeys(("bpy", "bmesh", "mathutils")))
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
PENTAGONS = """\
# two prisms, the second concave
o First
v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv -1 1 0\nv 0 0 2\nv 2 0 2.1\nv 3 1 2\nv 1 3 1.9\nv -1 1 2
g caps
f 5 4 3 2 1\nf 6 7 8 9 10
g sides
usemtl none
f 1 2 7 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\nf 5 1 6 10
o Second
v 5 0 0\nv 8 0 0\nv 8 1 0\nv 6 1 0\nv 6 2 0\nv 5 2 0
v 5 0 1\nv 8 0 1\nv 8 1 1\nv 6 1 1\nv 6 2 1\nv 5 2 1
f -7 -8 -9 -10 -11 -12\nf -6 -5 -4 -3 -2 -1
f -12 -11 -5 -6\nf -11 -10 -4 -5\nf -10 -9 -3 -4\nf -9 -8 -2 -3\nf -8 -7 -1 -2\nf -7 -12 -6 -1
"""
OPTIONS = (
    [],
    ["--kind", "shell", "--thickness", "0.01", "--wall", "inward", "--mass", "3"],
    [
        "--order",
        "4",
        "--surface-moments",
        "--about",
        "center",
        "--frame",
        "object",
        "--unit-scale",
        "0.001",
    ]
    + ["--material", "Steel, Carbon", "--thumbnails"],
)


def write_files(folder):
    points, triangles = torus(11, 7)
    part = (points @ rotation(4).T + [3.0, -2.0, 5.0]).astype(np.float32), triangles
    files = {
        "closed.stl": stl(part),
        "text.stl": stl_text(part),
        "open.ply": ply(*without(part, 4)),
        "inverted.ply": ply(*inverted(part), "<"),
        "soup.stl": stl(soup(part)),
        "groups.obj": PENTAGONS.encode(),
        "points.obj": b"v 0 0 0\nv 1 1 1\n",
        "wrong.obj": b"v 0 0 0\nv 1 0 0\nv 0 1x 0\nf 1 2 3\n",
        "lost.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
        "cut.stl": stl(part)[:-9],
        "empty.ply": b"",
        "none.stl": bytes(84),
    }
    for name, data in files.items():
        (folder / name).write_bytes(data)
    np.save(folder / "grid.npy", np.arange(24.0).reshape(2, 3, 4))
    return sorted([*files, "grid.npy"])


def run(folder, *words, blocked=False):
    start = ["-c", BLOCKED, SCRIPT] if blocked else [SCRIPT]
    return subprocess.run(
        [sys.executable, "-P", *map(str, start), "measure", "--no-supervisor", *map(str, words)],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
    )


@pytest.mark.parametrize("options", OPTIONS)
def test_records_without_blender_equal_those_with_it(tmp_path, options):
    names = write_files(tmp_path)
    alone, beside = (
        json.loads(run(tmp_path, *names, *options, blocked=way).stdout) for way in (True, False)
    )
    assert [document["file"] for document in alone] == names and sum(
        len(one["objects"]) for one in alone
    ) >= 7
    for one, other in zip(alone, beside):
        assert (
            valid(one)
            and one.pop("blender") is None
            and other.pop("blender") == bpy.app.version_string.split()[0]
        )
        assert one == other


@pytest.mark.parametrize(
    "words",
    [
        ["closed.stl", "scene.blend"],
        ["closed.stl", "--flat"],
        ["grid.npy", "--format", "urdf"],
        ["open.ply", "--kind=wire"],
    ],
)
def test_needed_blender_is_named_before_measuring(tmp_path, words):
    write_files(tmp_path)
    ended = run(tmp_path, *words, blocked=True)
    assert ended.returncode == 2 and ended.stdout == "" and "--blender PATH" in ended.stderr
    assert words[1].partition("=")[0] in ended.stderr


def test_polygons_are_cut_as_blender_draws_them():
    rng = np.random.default_rng(5)
    for trial in range(90):
        sides = int(rng.integers(5, 20))
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, sides))
        radius = 1.0 if trial % 3 == 0 else rng.uniform(0.2, 1.0, sides)
        height = rng.normal(0.0, 0.1, sides) if trial % 3 == 2 else np.zeros(sides)
        points = (
            np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
            @ rotation(trial).T
        )
        mesh = bpy.data.meshes.new("")
        mesh.from_pydata(points.tolist(), [], [range(sides)])
        mesh.calc_loop_triangles()
        drawn = {frozenset(triangle.vertices) for triangle in mesh.loop_triangles}
        bpy.data.meshes.remove(mesh)
        assert {
            frozenset(each) for each in tessellate(points, np.arange(sides)[None])[0].tolist()
        } == drawn
