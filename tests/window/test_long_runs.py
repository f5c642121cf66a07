# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that takes long: the window lives on and shows how far it is, Esc leaves nothing
half-written, and results come.

Measure Library from the menu, by mouse, then a thousand parts, then a Fourier transform.
"""

import json
import os

import numpy as np
import pytest

from tests.close import close
from tools.soak import commands

RUNNING = (
    "[op.bl_idname for op in window.modal_operators if 'body_moments' in op.bl_idname.lower()]"
)
SCANS = 3


def library(folder, slow):
    """Scans that take no time, and, where that is asked for, one that would take minutes."""
    for number in range(SCANS):
        np.save(folder / "{}.npy".format(number), np.full((3, 4, 5), number + 1, "u2"))
    if slow:
        path = folder / "z_2048x2048x2048_uint8.raw"
        path.touch()
        os.truncate(path, 1 << 33)


def start(window, folder):
    """Choose the entry of the menu and the folder in the file browser."""
    window.ask("bpy.context.preferences.view.filebrowser_display_type = 'SCREEN'")
    window.choose("VIEW3D_MT_body_moments_advanced", "object.body_moments_measure_library")
    window.wait("area.type == 'FILE_BROWSER' and area.spaces.active.params is not None")
    window.ask(f"area.spaces.active.params.directory = {str(folder).encode()!r}")
    window.picture("library browser")
    window.move(500, 400)
    window.key("Return")
    window.wait("area.type == 'VIEW_3D'")


def test_esc_keeps_measured_library_files_for_resuming(window, tmp_path):
    library(tmp_path, slow=True)
    start(window, tmp_path)
    journal = tmp_path / "body_moments.jsonl.journal"
    assert commands.wait_until(
        lambda: journal.exists() and journal.read_bytes().count(b"\n") == SCANS, 240.0
    )
    assert window.get(RUNNING)
    window.picture("library running")
    window.point_at_view()
    window.key("Escape")
    window.wait("not " + RUNNING)
    assert sorted(
        path.name for path in tmp_path.iterdir() if path.suffix not in (".npy", ".raw")
    ) == [journal.name]


def test_library_left_alone_leaves_results_and_a_report(window, tmp_path):
    library(tmp_path, slow=False)
    start(window, tmp_path)
    assert commands.wait_until((tmp_path / "body_moments.html").exists, 240.0)
    window.wait("not " + RUNNING)
    lines = (tmp_path / "body_moments.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["objects"][0]["mass"] for line in lines] == [
        60.0 * (1 + one) for one in range(SCANS)
    ]
    window.picture("library done")


PART_COUNT = 1000
PARTS = f"""
import random
random.seed(1)
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
for number in range({PART_COUNT}):
    mesh = bpy.data.meshes.new("Part")
    a, b, c = (random.uniform(0.5, 1.5) for _ in range(3))
    corners = [
        (x * a, y * b, z * c + 0.1 * x * y) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)
    ]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], sides)
    obj = bpy.data.objects.new("Part", mesh)
    obj.location = (3 * (number % 60), 3 * (number // 60), 0)
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
bpy.context.view_layer.objects.active = obj
bpy.context.view_layer.update()
bpy.ops.ed.undo_push(message="Parts")
"""
MEASURED = "sum('body_mass' in obj for obj in bpy.data.objects)"
MASS = "sum(obj['body_mass'] for obj in bpy.data.objects)"


@pytest.fixture(scope="module")
def parts(window):
    window.ask(PARTS, limit=200.0)
    window.open_tab("Moments")
    window.redraw()
    return window


def test_esc_during_measure_leaves_nothing(parts):
    window = parts
    window.point_at_view()
    window.ask("bpy.ops.object.body_moments_measure('INVOKE_DEFAULT')")
    window.key("Escape")
    window.wait("not " + RUNNING, limit=200.0)
    assert window.get(MEASURED) == 0
    window.ask("bpy.ops.object.body_moments_measure('INVOKE_DEFAULT', True)")
    window.wait("not " + RUNNING, limit=200.0)
    assert window.get(MEASURED) == PART_COUNT
    window.picture("many-measured")
    mass = window.get(MASS)
    window.ask(
        "for obj in bpy.context.selected_objects:\n    obj.body_moments.density = 2000.0",
        limit=200.0,
    )
    window.redraw()
    assert close(window.get(MASS), 2.0 * mass, 1e-12)


def test_esc_during_rigid_body_masses_changes_no_object(parts):
    window = parts
    window.point_at_view()
    window.ask(
        "bpy.ops.object.body_moments_set_rigid_body_mass('INVOKE_DEFAULT', True, add=True, "
        "axes=True)"
    )
    window.key("Escape")
    window.wait("not " + RUNNING, limit=200.0)
    assert window.get("sum(obj.rigid_body is not None for obj in bpy.data.objects)") == 0
    assert (
        window.get(
            "[tuple(obj.rotation_euler) for obj in bpy.data.objects if any(obj.rotation_euler)]"
        )
        == []
    )


RING = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.ops.mesh.primitive_torus_add(major_segments=160, minor_segments=64)
bpy.context.object.name = "Ring"
"""
TRANSFORM = "bpy.ops.object.body_moments_fourier('EXEC_DEFAULT', filepath={!r}, count={})"
IMAGES = "[list(image.size) for image in bpy.data.images if image.get('body_fourier')]"


def test_esc_during_a_transform_leaves_nothing(window, tmp_path):
    path = tmp_path / "ring.npz"
    window.ask(RING)
    window.ask(TRANSFORM.format(str(path), 64))
    window.point_at_view()
    window.key("Escape")
    window.wait("not " + RUNNING)
    assert window.get(IMAGES) == [] and list(tmp_path.iterdir()) == []


def test_transform_writes_a_file_and_shows_slices(window, tmp_path):
    path = tmp_path / "ring.npz"
    window.ask(
        "[a for a in window.screen.areas if a.type == 'PROPERTIES'][0].type = 'IMAGE_EDITOR'"
    )
    window.ask(TRANSFORM.format(str(path), 16))
    window.wait("not " + RUNNING)
    assert window.get(IMAGES) == [[3 * 16 + 4, 16]]
    shown = (
        "[a for a in window.screen.areas if a.type == 'IMAGE_EDITOR'][0].spaces.active.image.name"
    )
    assert window.get(shown) == "Fourier Transform of Ring"
    window.picture("fourier")
    with np.load(path) as found:
        assert found["q"].shape == (16**3, 3) and found["F"].shape == (16**3,)
    window.undo()
    window.wait("not " + IMAGES)
