# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Library: the files of a folder in other processes, a report, and the metadata of
assets.
"""

import json

import bpy
import pytest

from tests.blender import batch_files as files
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def library(tmp_path):
    """Two files with an asset each, and one that is damaged."""
    folder = tmp_path / "library"
    folder.mkdir()
    for name in "ab":
        files.empty_scene()
        files.add_box("Box").asset_mark()
        files.save(folder / "{}.blend".format(name))
    (folder / "c.blend").write_bytes(b"BLENDER garbage")
    files.empty_scene()
    return folder


def measure(folder, **more):
    return bpy.ops.object.body_moments_measure_library(
        "EXEC_DEFAULT", directory=str(folder), **more
    )


def statuses(folder):
    text = (folder / "body_moments.jsonl").read_text(encoding="utf-8")
    return [json.loads(line)["status"] for line in text.splitlines()]


def mass_in_metadata(path):
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.data.objects["Box"].asset_data.get("body_mass")


def test_a_folder_is_measured_and_reported(library, reported):
    before = (library / "a.blend").read_bytes()
    assert measure(library) == {"FINISHED"}
    assert statuses(library) == ["ok", "ok", "error"]
    assert "not or not fully: 1" in reported.texts[-1]
    page = (library / "body_moments.html").read_text(encoding="utf-8")
    assert "data:image/png" in page and "a.blend" in page
    assert (library / "a.blend").read_bytes() == before and mass_in_metadata(
        library / "a.blend"
    ) is None


def test_a_run_that_was_ended_goes_on(library):
    assert measure(library) == {"FINISHED"}
    journal = library / "body_moments.jsonl.journal"
    measured = journal.read_bytes()
    (library / "body_moments.jsonl").unlink()  # as after Esc
    journal.write_bytes(b"".join(measured.splitlines(keepends=True)[:2]))
    assert measure(library) == {"FINISHED"} and statuses(library) == ["ok", "ok", "error"]
    assert journal.read_bytes().startswith(b"".join(measured.splitlines(keepends=True)[:2]))
    assert measure(library) == {"FINISHED"}  # and one that was not begins anew
    assert (library / "body_moments.jsonl.journal.old").exists()


def test_metadata_goes_into_copies_unless_told_otherwise(library):
    before = (library / "a.blend").read_bytes()
    assert measure(library, asset_metadata=True) == {"FINISHED"}
    assert (library / "a.blend").read_bytes() == before
    assert close(mass_in_metadata(library / "a.body_moments.blend"), 6000.0, 1e-6)
    assert measure(library, asset_metadata=True, overwrite=True) == {"FINISHED"}
    assert statuses(library) == ["ok", "ok", "error"]  # the copies are not measured
    assert close(mass_in_metadata(library / "b.blend"), 6000.0, 1e-6)


def test_metadata_of_collections_and_a_word_about_assets_without(library, reported):
    """A collection is its members' sum, in the frame of the scene; lamps alone have no mass."""
    files.empty_scene()
    collections = {name: bpy.data.collections.new(name) for name in ("Pair", "Lamps", "Hidden")}
    for one in collections.values():
        bpy.context.scene.collection.children.link(one)
        one.asset_mark()
    for place in (0.0, 4.0):
        box = files.add_box("Box", center=(place, 0.0, 0.0))
        bpy.context.scene.collection.objects.unlink(box)
        collections["Pair"].objects.link(box)
    collections["Lamps"].objects.link(
        bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "SUN"))
    )
    hidden = bpy.data.objects.new("Hidden", box.data.copy())
    hidden.hide_render = True
    collections["Hidden"].objects.link(hidden)
    loose = bpy.data.objects.new("Loose", box.data)
    loose.asset_mark()
    files.save(library / "a.blend")
    assert measure(library, asset_metadata=True) == {"FINISHED"}
    document = json.loads(
        (library / "body_moments.jsonl").read_text(encoding="utf-8").splitlines()[0]
    )
    assert document["status"] == "ok" and [one["name"] for one in document["assemblies"]] == [
        "Pair"
    ]
    (told,) = (one for one in document["total"]["findings"] if one["code"] == "assets_not_measured")
    assert told["values"]["names"] == ["Hidden", "Loose"]
    bpy.ops.wm.open_mainfile(filepath=str(library / "a.body_moments.blend"))
    data = bpy.data.collections["Pair"].asset_data
    assert close(data["body_mass"], 12000.0, 1e-6) and close(
        data["body_center_of_mass"][0], 2.0, 1e-6
    )
    assert not any(
        "body_mass" in bpy.data.collections[name].asset_data for name in ("Lamps", "Hidden")
    )


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(RuntimeError, match="no file that can be measured"):
        measure(tmp_path)


def test_an_asset_library_of_the_preferences(library):
    libraries = bpy.context.preferences.filepaths.asset_libraries
    bpy.ops.preferences.asset_library_add(directory=str(library))
    try:
        assert measure("/", source="LIBRARY_{}".format(len(libraries) - 1)) == {"FINISHED"}
        assert statuses(library) == ["ok", "ok", "error"]
    finally:
        bpy.ops.preferences.asset_library_remove(index=len(libraries) - 1)
