# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts that Blender may have run in the file that it had open before the command line was called."""

import sys

import pytest

pytest.importorskip("bpy")
import bpy

from tests.blender import batch_files as files
from tests.blender.batch_files import run

pytestmark = pytest.mark.usefixtures("scene")


def text(name, use_module=True):
    bpy.data.texts.new(name).use_module = use_module


def drive(owner, path, expression, index=-1, kind="SCRIPTED"):
    driver = owner.driver_add(path, index).driver if index >= 0 else owner.driver_add(path).driver
    driver.type, driver.expression = kind, expression


def scripted(path):
    """A file with scripts of every kind, and with what is none."""
    files.empty_scene()
    text("rig.py"), text("Both.py"), text("notes.txt"), text("loose.py", use_module=False)
    for name in ("Both.py", "Moved", "Sum", "Simple", "Free"):
        files.add_box(name)
    boxes = bpy.data.objects
    drive(boxes["Both.py"], "location", "len('ab')", 0)
    drive(boxes["Moved"], "location", "1 + sin(2)", 0)  # which is arithmetic
    drive(boxes["Moved"], "location", "len('ab')", 1)
    drive(boxes["Moved"], "location", "len('abc')", 2)
    drive(boxes["Sum"], "location", "len('ab')", 0, "SUM")
    drive(boxes["Simple"], "location", "1 + sin(2)", 0)
    boxes["Free"].keyframe_insert("location")
    boxes["Free"].shape_key_add(name="Basis")
    drive(boxes["Free"].shape_key_add(name="Key").id_data.key_blocks["Key"], "value", "len('')")
    material = bpy.data.materials.new("Steel")
    if material.node_tree is None:  # in Blender 4.5
        material.use_nodes = True
    drive(material.node_tree.nodes["Principled BSDF"].inputs["Roughness"], "default_value", "len('')")
    material.use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)


ALL = ["rig.py", "Both.py", "Moved", "Key", "Steel"]


@pytest.fixture
def told(tmp_path, monkeypatch):
    """The names in the finding about an open file, where Blender has been started with these words."""
    path = tmp_path / "part.blend"
    scripted(path)

    def answer(*switches, named=False):
        bpy.ops.wm.open_mainfile(filepath=str(path), use_scripts=False)
        monkeypatch.setattr(sys, "argv", ["blender", "-b", *switches])
        (found,) = run(*((path,) if named else ())).documents
        assert sorted(one["name"] for one in found["objects"]) == ["Both.py", "Free", "Moved", "Simple", "Sum"]
        return [one["values"]["names"] for one in found["total"]["findings"] if one["code"] == "scripts_allowed"]

    return answer


def test_all_scripts_that_may_have_run_are_named_once(told):
    ((*texts, moved, key, steel),) = told("-y")
    assert sorted([*texts, moved, key, steel]) == sorted(ALL) and {*texts[:2]} == {"rig.py", "Both.py"}
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    text("rig.py"), files.add_box()
    assert "scripts_allowed" not in files.codes(run().documents[0]["total"])  # no file was opened


@pytest.mark.parametrize(
    ("words", "allowed"),
    [
        ((), False),
        (("-y",), True),
        (("--enable-autoexec",), True),
        (("-y", "-Y"), False),
        (("-y", "--disable-autoexec"), False),
        (("-Y", "-y"), True),
        (("--disable-autoexec", "--enable-autoexec", "-y"), True),
        (("-Y", "-y", "part.blend", "--python", "x.py", "--", "measure", "-Y"), True),
        (("part.blend", "--", "-y"), False),
    ],
)
def test_the_last_of_blenders_own_words_counts(told, words, allowed):
    assert len(told(*words)) == allowed


def test_without_a_word_the_preferences_count(told):
    paths = bpy.context.preferences.filepaths
    paths.use_scripts_auto_execute = True
    try:
        assert len(told()) == 1 and told("-Y") == told("--", "-y", named=True) == []
        assert told("-y", named=True) == []  # what is opened here runs none
    finally:
        paths.use_scripts_auto_execute = False


def test_a_file_without_scripts_has_no_finding(tmp_path, monkeypatch):
    path = files.box_file(tmp_path / "part.blend")
    bpy.ops.wm.open_mainfile(filepath=path)
    monkeypatch.setattr(sys, "argv", ["blender", "-b", "-y"])
    assert "scripts_allowed" not in files.codes(run().documents[0]["total"])
