# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line's --write: results stored in the .blend file, whole or not at all."""

import pytest

pytest.importorskip("bpy")
import bpy
import numpy as np

from tests.blender import batch_files as files
from tests.blender.batch_files import document, measured, run

pytestmark = pytest.mark.usefixtures("scene")


def reopened(path):
    files.empty_scene()
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.data.objects


def test_results_are_in_the_file_when_it_is_opened_again(tmp_path):
    path = tmp_path / "part.blend"
    entry = measured(files.box_file(path), "--write")
    box = reopened(path)[files.BOX_NAME]
    assert box["body_mass"] == entry["mass"] and box["body_volume"] == entry["volume"]
    assert list(box["body_principal_moments"]) == entry["principal_moments"]
    assert list(box["body_center_of_mass"]) == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    assert box["body_method"] == "exact"
    assert [file.name for file in tmp_path.iterdir()] == ["part.blend"]


def test_writing_twice_gives_the_same_numbers(tmp_path):
    path = files.box_file(tmp_path / "part.blend")
    first, second = measured(path, "--write"), measured(path, "--write")
    assert first == second


@pytest.mark.parametrize("compress", [False, True])
def test_the_file_stays_compressed_or_not(tmp_path, compress):
    path = tmp_path / "part.blend"
    files.add_box()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=compress)
    head = path.read_bytes()[:4]
    measured(path, "--write")
    assert path.read_bytes()[:4] == head


def test_settings_workspaces_and_other_scenes_are_still_there(tmp_path):
    path = tmp_path / "part.blend"
    bpy.context.workspace.name = "My Workspace"
    box = files.add_box()
    box.body_moments.density = 2500.0
    bpy.data.scenes.new("Second")
    files.save(path)
    measured(path, "--write")
    objects = reopened(path)
    assert objects[files.BOX_NAME].body_moments.density == 2500.0
    assert "My Workspace" in bpy.data.workspaces and "Second" in bpy.data.scenes


def test_what_is_written_is_not_out_of_date_when_the_file_is_opened(tmp_path):
    """The options that the numbers came from are written as settings with them."""
    from body_moments.operators.session import staleness

    path = files.box_file(tmp_path / "part.blend")
    measured(path, "--write", "--density", "5.123456789")
    box = reopened(path)[files.BOX_NAME]
    assert box["body_density"] == 5.123456789 and box.body_moments.density == np.float32(5.123456789)
    assert staleness.reason(box, bpy.context.scene) is None
    measured(path, "--write", "--kind", "shell", "--thickness", "0.002", "--mass", "3")
    box = reopened(path)[files.BOX_NAME]
    assert box.body_moments.kind == "SHELL" and box.body_moments.mass_from == "MASS"
    assert staleness.reason(box, bpy.context.scene) is None


def test_relative_paths_stay_as_they_are(tmp_path):
    path = tmp_path / "part.blend"
    files.add_box()
    image = bpy.data.images.new("Picture", 1, 1)
    image.use_fake_user, image.filepath = True, "//textures/picture.png"
    files.save(path)
    measured(path, "--write")
    reopened(path)
    assert bpy.data.images["Picture"].filepath == "//textures/picture.png"


def test_a_file_that_cannot_be_replaced_is_left_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "part.blend"
    files.box_file(path)
    before = path.read_bytes()

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("body_moments.operators.command.files.os.replace", refuse)
    found = document(path, "--write")
    assert [entry["name"] for entry in found["objects"]] == [files.BOX_NAME]
    (error,) = found["errors"]
    assert error["name"] is None and "No space left" in error["reason"]
    assert path.read_bytes() == before and [file.name for file in tmp_path.iterdir()] == ["part.blend"]


def test_a_link_to_a_file_stays_a_link(tmp_path):
    path = tmp_path / "real.blend"
    files.box_file(path)
    link = tmp_path / "link.blend"
    try:
        link.symlink_to(path)
    except OSError:
        pytest.skip("links are not allowed here")
    measured(link, "--write")
    assert link.is_symlink() and "body_mass" in reopened(path)[files.BOX_NAME]


def test_only_a_blend_file_can_be_written(tmp_path):
    path = tmp_path / "part.stl"
    files.box_file(path)
    before = path.read_bytes()
    found = document(path, "--write", "--unit-scale", "1")
    assert len(found["objects"]) == 1 and path.read_bytes() == before
    (error,) = found["errors"]
    assert error["name"] is None and error["reason"] == files.sentence("results_need_blend")


def test_a_scene_that_was_never_saved_cannot_be_written():
    files.add_box()
    line = run("--write")
    assert len(line.documents[0]["objects"]) == 1 and line.errors == 1


def test_the_open_file_is_saved_where_it_is(tmp_path):
    path = files.box_file(tmp_path / "part.blend")
    bpy.ops.wm.open_mainfile(filepath=path)
    measured("--write")
    assert bpy.data.filepath == path
    assert "body_mass" in reopened(path)[files.BOX_NAME]


def test_what_is_measured_does_not_depend_on_what_was_stored_before_it(tmp_path):
    path = tmp_path / "driven.blend"
    files.add_box("A", (0, 0, 0), (1, 1, 1))
    driven = files.add_box("B", (0, 0, 0), (1, 1, 1))
    driver = driven.driver_add("scale", 0).driver
    driver.expression = "1 + mass"
    variable = driver.variables.new()
    variable.name = "mass"
    bpy.data.objects["A"]["body_mass"] = 0.0
    variable.targets[0].id = bpy.data.objects["A"]
    variable.targets[0].data_path = '["body_mass"]'
    found = document(files.save(path), "--write")
    assert [entry["volume"] for entry in found["objects"]] == pytest.approx([1.0, 1.0])


def test_a_linked_object_keeps_its_record_and_its_refusal_is_an_error(tmp_path):
    library = files.box_file(tmp_path / "library.blend")
    files.empty_scene()
    files.add_box("Local")
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    path = files.save(tmp_path / "part.blend")
    found = document(path, "--write")
    assert sorted(entry["name"] for entry in found["objects"]) == ["Local", files.BOX_NAME]
    assert found["errors"] == [{"name": files.BOX_NAME, "reason": files.sentence("linked_results")}]
    assert "body_mass" in reopened(path)["Local"]


def test_a_refusal_to_store_names_the_object_as_its_record_does(tmp_path):
    library = files.box_file(tmp_path / "library.blend")
    files.empty_scene()
    files.add_box(files.BOX_NAME)
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    found = document(files.save(tmp_path / "part.blend"), "--write")
    names = {entry["name"] for entry in found["objects"]}
    assert len(names) == 2 and [entry["name"] for entry in found["errors"]] == [*(names - {files.BOX_NAME})]
