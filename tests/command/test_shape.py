# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--pose, --signature, and `similar` over what they wrote."""

import json
import os

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.core.shape.library import read_library
from body_moments.operators import batch

from tests.blender.batch_files import add_box, codes, document
from tests.blender.objects import add, mesh_body, strip_mesh
from tests.close import close
from tests.command.running import ask

pytestmark = pytest.mark.usefixtures("scene")


def corners(obj):
    points = np.array([vertex.co for vertex in obj.data.vertices], float)
    matrix = np.array(obj.matrix_world, float)
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def shape_file(tmp_path, *flags):
    path = tmp_path / "library.jsonl"
    channel = os.open(os.devnull, os.O_WRONLY)
    code = batch.main(
        ["measure", "--signature", "--format", "jsonl", "--output", str(path), *flags],
        channel=channel,
    )
    os.close(channel)
    return path, code


def test_copies_have_one_pose_and_its_matrix_aligns_them():
    a = add(mesh_body(), "A", location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
    b = add(mesh_body(), "B", location=(-5, 2, 8), rotation=(1.3, 2.4, -0.5))
    poses = [entry["pose"] for entry in document("--pose")["objects"]]
    assert all(pose["unique"] and pose["symmetry"] == "Cs" for pose in poses)
    laid = [
        corners(obj) @ np.array(pose["matrix"])[:3, :3].T + np.array(pose["matrix"])[:3, 3]
        for obj, pose in zip((a, b), poses)
    ]
    assert np.abs(laid[0] - laid[1]).max() < 2e-6  # float32 matrices
    assert np.linalg.det(np.array(poses[0]["matrix"])) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "sides, group, order", [(6, "D6h", 6), (8, "D8h", 30), (12, "D12h", 30), (32, "D∞h", 30)]
)
def test_turned_prisms_have_one_pose_and_symmetry_group(sides, group, order):
    turns = (0.0, 0.0, 0.0), (0.0, 0.0, 0.2), (1.3, 2.4, -0.5)
    for turn in turns:
        bpy.ops.mesh.primitive_cylinder_add(
            vertices=sides, depth=3.0, location=(1, 2, 3), rotation=turn
        )
    prisms = bpy.context.scene.objects[-3:]
    entries = document("--pose")["objects"]
    poses = {entry["name"]: entry["pose"] for entry in entries}
    laid = []
    for prism in prisms:
        pose = poses[prism.name]
        assert (pose["symmetry"], pose["symmetry_order"], pose["unique"]) == (group, order, False)
        matrix = np.array(pose["matrix"])
        laid.append(corners(prism) @ matrix[:3, :3].T + matrix[:3, 3])
    apart = [
        np.linalg.norm(other[:, None] - laid[0], axis=2).min(axis=1).max() for other in laid[1:]
    ]
    assert max(apart) < 1e-5
    # Stored axes stay near the object's own axes.
    for entry in entries[:2] if group != "D6h" else ():
        assert abs(abs(entry["principal_axes"][2][0]) - 1.0) < 1e-5


@pytest.mark.parametrize("frame", ["world", "object"])
def test_world_pose_agrees_with_the_principal_axes(frame):
    add_box()
    entry = document("--pose", "--frame", frame)["objects"][0]
    assert entry["pose"]["symmetry"] == "D2h" and entry["pose"]["unique"] is False
    matrix = np.array(entry["pose"]["matrix"])
    assert np.allclose(matrix @ [10, 20, 30, 1], [0, 0, 0, 1], atol=1e-5)
    if frame == "world":
        assert np.allclose(matrix[:3, :3].T, entry["principal_axes"], atol=1e-12)


def test_an_open_surface_is_measured_but_has_no_pose():
    add(strip_mesh(), "Open")
    (entry,) = document("--pose", "--signature")["objects"]
    assert entry["method"] == "open" and entry["pose"] is None and entry["signature"] is None
    assert "shape_of_open_surface" in codes(entry)


def test_overflowing_pose_is_refused_and_the_mass_is_not():
    add_box().scale = (1e35, 1e35, 1e35)
    bpy.context.view_layer.update()
    for words in (["--pose"], ["--pose", "--order", "4"]):
        refused = document(*words)
        assert refused["objects"] == [] and [error["reason"] for error in refused["errors"]] == [
            "Too large to be measured. Scale the object down."
        ]
    (entry,) = document()["objects"]
    assert close(entry["mass"], 6000.0 * float(np.float32(1e35)) ** 3, 1e-6)


def test_similar_tells_copies_mirror_images_and_sizes(tmp_path):
    add(mesh_body(), "Part", location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
    add(mesh_body(), "Copy", location=(-5, 2, 8), rotation=(1.3, 2.4, -0.5))
    # An L is its own mirror image across its plane: a hand needs a third direction.
    for name, scale in (("Hand", (1, 1, 1)), ("Other hand", (-1, 1, 1)), ("Big hand", (2, 2, 2))):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(
            [(0, 0, 0), (1, 0.2, 0), (0.3, 2, 0.1), (0.2, 0.4, 3)],
            [],
            [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)],
        )
        add(mesh, name, location=(4, 5, 6), rotation=(1, 0, 2), scale=scale)
    add_box("Box")
    path, code = shape_file(tmp_path)
    assert code == 0
    code, text = ask(tmp_path, path, "--to", "Hand")
    assert code == 0
    rows = {
        line.split()[-1]
        if "Other" not in line and "Big" not in line
        else " ".join(line.split()[-2:]): line
        for line in text.splitlines()[1:]
    }
    assert " mirror image " in rows["Other hand"] and " scaled copy " in rows["Big hand"]
    assert "different" in rows["Box"]
    order = [line.split()[-1] for line in text.splitlines()[1:]]
    # Mirrored and enlarged bodies are nearer than other shapes.
    assert order[-1] in (
        "Box",
        "Copy",
        "Part",
    )
    code, text = ask(tmp_path, path, "--to", "Hand", "--any-hand", "--any-size")
    assert sum(float(line.split()[0]) < 1e-5 for line in text.splitlines()[1:]) == 2
    code, text = ask(tmp_path, path, "--to", "Part", "--count", 1)
    assert (
        text.splitlines()[1].split()[-1] == "Copy"
        and " copy " in text
        and len(text.splitlines()) == 2
    )


def test_a_name_may_hold_any_character(tmp_path):
    for name in ("Box", "a\u2028b", "c\x85d", "e\nf", 'g"h'):
        add_box(name)
    path, _ = shape_file(tmp_path)
    assert {entry.name for entry in read_library(path)[0]} == {
        obj.name for obj in bpy.context.scene.objects
    }


def test_a_wrong_question_is_wrong_usage(tmp_path, capsys):
    add_box("Box")
    path, _ = shape_file(tmp_path)
    assert ask(tmp_path, path, "--to", "Nobody")[0] == 2
    assert ask(tmp_path, tmp_path / "none.jsonl", "--to", "Box")[0] == 2
    assert ask(tmp_path, path)[0] == 2
    assert ask(tmp_path, path, path, "--to", "Box")[0] == 2
    text = tmp_path / "text.jsonl"
    text.write_text("no json\n", encoding="utf-8")
    assert ask(tmp_path, text, "--to", "Box")[0] == 2
    assert ask(tmp_path, "--help")[0] == 0
    printed = capsys.readouterr().err
    assert "Nobody" in printed and "Several bodies" in printed
    assert "--format jsonl" in printed


def test_bodies_of_one_name_are_told_apart_by_their_files(tmp_path):
    add_box("Box")
    path, _ = shape_file(tmp_path)
    library = json.loads(path.read_text(encoding="utf-8"))
    paths = [tmp_path / "first.jsonl", tmp_path / "second.jsonl"]
    for path, name in zip(paths, "ab"):
        path.write_text(json.dumps({**library, "file": name + ".blend"}) + "\n", encoding="utf-8")
    for asked, other in ("ab", "ba"):
        code, text = ask(tmp_path, *paths, "--to", asked + ".blend:Box")
        assert code == 0 and [line.split()[-1] for line in text.splitlines()[1:]] == [
            other + ".blend:Box"
        ]
    assert ask(tmp_path, *paths, "--to", "c.blend:Box")[0] == 2


def test_nurbs_signature_is_of_display_mesh_and_wire_has_none():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(location=(1, 2, 3))
    ball = document("--pose", "--signature")["objects"][0]
    assert (
        ball["method"].startswith("NURBS") and ball["pose"]["unique"] is False and ball["signature"]
    )
    assert "signature_of_display_mesh" in codes(ball)
    bpy.ops.curve.primitive_nurbs_path_add()
    wire = bpy.context.object
    wire.body_moments.kind = "WIRE"
    entry = document("--pose", "--object", wire.name)["objects"][0]
    assert entry["method"] == "wire" and entry["pose"] is None


def test_a_wall_of_curved_patches_has_a_pose_and_no_signature():
    """Its display mesh is not what was measured."""
    bpy.ops.surface.primitive_nurbs_surface_torus_add()
    torus = bpy.context.object.body_moments
    torus.kind, torus.thickness = "SHELL", 0.125
    (entry,) = document("--pose", "--signature")["objects"]
    assert (
        entry["method"] == "NURBS shell"
        and entry["pose"]["symmetry"] == "D∞h"
        and entry["signature"] is None
    )
    assert codes(entry).count(
        "shape_unavailable"
    ) == 1 and "signature_of_display_mesh" not in codes(entry)
    (entry,) = document("--pose")["objects"]
    assert "signature" not in entry and "shape_unavailable" not in codes(entry)


def test_a_picture_is_of_the_body_in_meters_whatever_its_unit():
    """Its center and axes are in meters, the display mesh is in units."""
    box = add_box("Box", (3.0, 4.0, 5.0))
    (first,) = document("--thumbnails")["objects"]
    bpy.context.scene.unit_settings.scale_length = 0.125
    box.location, box.scale = (24.0, 32.0, 40.0), (8.0, 8.0, 8.0)
    bpy.context.view_layer.update()
    (second,) = document("--thumbnails")["objects"]
    assert first["thumbnail"] == second["thumbnail"] and close(first["mass"], second["mass"], 1e-6)
