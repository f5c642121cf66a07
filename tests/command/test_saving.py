# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line's --write: results stored in the .blend file, whole or not at all."""

import os
import signal
import subprocess
import sys

import pytest

bpy = pytest.importorskip("bpy")
import numpy as np
from body_moments.command.findings import NEEDS_BLEND
from body_moments.command.measure import measuring

from tests.blender import batch_files as files
from tests.blender.batch_files import document, measured, run
from tests.command.processes import SCRIPT

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


def test_written_results_are_current_after_opening(tmp_path):
    """The options that the numbers came from are written as settings with them."""
    from body_moments.blender.session.tracking import staleness

    path = files.box_file(tmp_path / "part.blend")
    measured(path, "--write", "--density", "5.123456789")
    box = reopened(path)[files.BOX_NAME]
    assert box["body_density"] == 5.123456789 and box.body_moments.density == np.float32(
        5.123456789
    )
    assert staleness.stale_reason(box, bpy.context.scene) is None
    measured(
        path,
        "--write",
        "--kind",
        "shell",
        "--thickness",
        "0.002",
        "--wall",
        "inward",
        "--mass",
        "3",
    )
    box = reopened(path)[files.BOX_NAME]
    assert (box.body_moments.kind, box.body_moments.wall, box.body_moments.mass_from) == (
        "SHELL",
        "INWARD",
        "MASS",
    )
    assert staleness.stale_reason(box, bpy.context.scene) is None


@pytest.mark.parametrize("by_link", [False, True])
def test_relative_paths_stay_as_they_are(tmp_path, by_link):
    """Also where the file is opened by way of a link in another folder; and it stays the one that
    is open.
    """
    path, opened = tmp_path / "part.blend", tmp_path / "links" / "linked.blend"
    files.add_box()
    image = bpy.data.images.new("Picture", 1, 1)
    image.source, image.use_fake_user, image.filepath = "FILE", True, "//textures/picture.png"
    files.save(path)
    if by_link:
        opened.parent.mkdir()
        try:
            opened.symlink_to(path)
        except OSError:
            pytest.skip("not on this system: links")
    else:
        opened = path
    measured(opened, "--write")
    assert bpy.data.filepath == str(opened)
    reopened(path)
    assert bpy.data.images["Picture"].filepath == "//textures/picture.png"


def test_a_file_that_cannot_be_replaced_is_left_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "part.blend"
    files.box_file(path)
    before = path.read_bytes()

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("body_moments.command.files.opening.os.replace", refuse)
    found = document(path, "--write")
    assert [entry["name"] for entry in found["objects"]] == [files.BOX_NAME]
    (error,) = found["errors"]
    assert error == {
        "name": None,
        "reason": files.sentence(
            "file_not_written", file="part.blend", error="No space left on device"
        ),
    }
    assert path.read_bytes() == before and [file.name for file in tmp_path.iterdir()] == [
        "part.blend"
    ]


def test_a_link_to_a_file_stays_a_link(tmp_path):
    path = tmp_path / "real.blend"
    files.box_file(path)
    link = tmp_path / "link.blend"
    try:
        link.symlink_to(path)
    except OSError:
        pytest.skip("not on this system: links")
    measured(link, "--write")
    assert link.is_symlink() and "body_mass" in reopened(path)[files.BOX_NAME]


def test_only_a_blend_file_can_be_written(tmp_path):
    path = tmp_path / "part.stl"
    files.box_file(path)
    before = path.read_bytes()
    found = document(path, "--write", "--unit-scale", "1")
    assert len(found["objects"]) == 1 and path.read_bytes() == before
    (error,) = found["errors"]
    assert error["name"] is None and error["reason"] == files.sentence(
        "results_not_stored", cause=NEEDS_BLEND
    )


def test_a_scene_that_was_never_saved_cannot_be_written():
    files.add_box()
    line = run("--write")
    (found,) = line.documents
    assert len(found["objects"]) == 1 and line.errors == 1 and not line.has_saved
    assert found["errors"] == [
        {"name": None, "reason": files.sentence("results_not_stored", cause=NEEDS_BLEND)}
    ]
    assert "body_mass" not in bpy.data.objects[files.BOX_NAME]


def test_open_file_is_saved_in_place(tmp_path):
    path = files.box_file(tmp_path / "part.blend")
    bpy.ops.wm.open_mainfile(filepath=path)
    measured("--write")
    assert bpy.data.filepath == path
    assert "body_mass" in reopened(path)[files.BOX_NAME]


def test_stored_results_do_not_influence_measurement(tmp_path):
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


def test_linked_object_keeps_its_record_but_is_not_written(tmp_path):
    library = files.box_file(tmp_path / "library.blend")
    files.empty_scene()
    files.add_box("Local")
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    path = files.save(tmp_path / "part.blend")
    found = document(path, "--write")
    assert sorted(entry["name"] for entry in found["objects"]) == ["Local", files.BOX_NAME]
    assert found["errors"] == [{"name": files.BOX_NAME, "reason": files.sentence("linked_object")}]
    assert "body_mass" in reopened(path)["Local"]


def meanwhile(monkeypatch, action):
    """Do something once while the object is measured."""
    real, waiting = measuring.measure_object, [action]

    def measure(*rest):
        while waiting:
            waiting.pop()()
        return real(*rest)

    files.measure_with(monkeypatch, measure)


def replaced(path):
    other = path.with_name("other")
    other.write_bytes(path.read_bytes() + b"more")
    os.replace(other, path)


def edited(path):
    """One byte is another; the size and the times are as before."""
    status = path.stat()
    with open(path, "r+b") as file:
        file.seek(-1, os.SEEK_END)
        last = file.read(1)
        file.seek(-1, os.SEEK_END)
        file.write(bytes([last[0] ^ 1]))
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


@pytest.mark.parametrize("opened", [False, True], ids=["named", "open"])
@pytest.mark.parametrize("change", [replaced, edited])
def test_changes_saved_meanwhile_are_kept(tmp_path, monkeypatch, change, opened):
    path = tmp_path / "part.blend"
    files.box_file(path)
    if opened:
        bpy.ops.wm.open_mainfile(filepath=str(path))
    saved = []
    meanwhile(monkeypatch, lambda: (change(path), saved.append(path.read_bytes())))
    line = run("--write", *(() if opened else (path,)))
    (found,) = line.documents
    assert [entry["name"] for entry in found["objects"]] == [files.BOX_NAME]
    (error,) = found["errors"]
    assert "Measure it again" in error["reason"] and line.internal_errors == 0
    assert [path.read_bytes()] == saved and [file.name for file in tmp_path.iterdir()] == [
        "part.blend"
    ]


def test_a_file_that_is_gone_does_not_come_back(tmp_path, monkeypatch):
    path = tmp_path / "part.blend"
    files.box_file(path)
    meanwhile(monkeypatch, path.unlink)
    (error,) = document(path, "--write")["errors"]
    assert "it is gone" in error["reason"] and list(tmp_path.iterdir()) == []


# A process that is in the midst of saving the file behind --write, and does not get any further.
_SAVING = """
import os, runpy, sys, time
def stop(descriptor):
    print("saving", file=sys.stderr, flush=True)
    time.sleep(600)
os.fsync = stop
sys.argv = sys.argv[1:]
sys.path[0] = sys.argv[0]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.mark.skipif(os.name == "nt", reason="not on this system: signals")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL] if os.name != "nt" else [])
def test_process_ended_while_saving_leaves_the_file(tmp_path, number):
    path = tmp_path / "part.blend"
    files.box_file(path)
    kept = path.read_bytes()
    words = [
        sys.executable,
        "-c",
        _SAVING,
        SCRIPT,
        "measure",
        "--no-supervisor",
        str(path),
        "--write",
    ]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as saving:
        while b"saving" not in (line := saving.stderr.readline()):
            assert line
        assert len(list(tmp_path.iterdir())) == 2
        saving.send_signal(number)
        assert saving.wait(120) == (3 if number == signal.SIGTERM else -number)
    assert path.read_bytes() == kept
    assert len(list(tmp_path.iterdir())) == (1 if number == signal.SIGTERM else 2)
    measured(path, "--write")
    assert "body_mass" in reopened(path)[files.BOX_NAME]


@pytest.mark.skipif(os.name == "nt", reason="not on this system: modes")
def test_saved_file_keeps_its_mode(tmp_path):
    path = tmp_path / "part.blend"
    files.box_file(path)
    path.chmod(0o640)
    before = path.stat()
    measured(path, "--write")
    assert path.stat().st_mode == before.st_mode and path.stat().st_ino != before.st_ino


def error_of(found):
    """The reason of the one error, of a file whose object has a record all the same."""
    assert [entry["name"] for entry in found["objects"]] == [files.BOX_NAME]
    (error,) = found["errors"]
    assert error["name"] is None
    return error["reason"]


def test_failed_copy_is_an_error_and_the_file_stays(tmp_path, monkeypatch):
    path = tmp_path / "part.blend"
    files.empty_scene()
    files.add_box().asset_mark()
    files.save(path)
    before = path.read_bytes()

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    for where, name in (("copy", "part.body_moments.blend"), ("file", "part.blend")):
        expected = files.sentence("file_not_written", file=name, error="No space left on device")
        assert error_of(document(path, "--asset-metadata", where)) == expected
        assert path.read_bytes() == before and [*tmp_path.iterdir()] == [path]
