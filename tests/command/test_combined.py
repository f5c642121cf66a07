# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies and bones on the command line: in the document where a file has them, and stored with
--write.
"""

import csv
import io

import bpy
import mathutils
import pytest
from body_moments.core.measurement import documents

from tests.blender import batch_files as files
from tests.blender.boxes import collection
from tests.close import close
from tests.operators.assemblies import assembly_of_boxes
from tests.operators.characters import character

pytestmark = pytest.mark.usefixtures("registered", "scene")


def saved(tmp_path):
    path = tmp_path / "file.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def document(*arguments):
    (found,) = files.run(*map(str, arguments)).documents
    return found


def test_document_holds_assemblies_and_bones(tmp_path):
    assembly_of_boxes()
    character()
    plain = document(saved(tmp_path))
    assert "assemblies" not in plain and "bones" not in plain
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "file.blend"))
    bpy.context.view_layer.objects.active = bpy.data.objects["Rig"]
    bpy.ops.object.body_moments_measure_bones()
    bpy.data.collections["Robot"].body_moments.mass_from = "MASS"
    bpy.data.collections["Robot"].body_moments.mass = 100.0
    found = document(saved(tmp_path))
    (robot,) = found["assemblies"]
    assert (
        robot["name"] == "Robot"
        and robot["kind"] == "assembly"
        and close(robot["mass"], 100.0, 1e-14)
    )
    assert len(found["bones"]) == 7 and {bone["armature"] for bone in found["bones"]} == {"Rig"}
    bones = {bone["name"]: bone for bone in found["bones"]}
    assert close(bones["head"]["mass"], 8000.0, 1e-6) and bones["head"]["kind"] == "bone"
    rows = [*csv.DictReader(io.StringIO("".join(documents.to_csv([found]))))]
    assert [(row["name"], float(row["mass"])) for row in rows if row["kind"] == "assembly"] == [
        ("Robot", 100.0)
    ]
    of_bones = {row["name"]: row for row in rows if row["kind"] == "bone"}
    assert of_bones.keys() == bones.keys() and {row["armature"] for row in of_bones.values()} == {
        "Rig"
    }
    assert float(of_bones["head"]["inertia_xx"]) == bones["head"]["inertia"][0][0]


def test_results_are_stored_on_collections_and_pose_bones(tmp_path):
    assembly_of_boxes()
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    bpy.data.collections["Robot"].body_moments.mass_from = "MASS"
    path = saved(tmp_path)
    document("--write", "--density", "2", path)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert close(bpy.data.collections["Robot"]["body_mass"], 1.0, 1e-14)
    assert "body_mass" in bpy.data.objects["Rig"].pose.bones["head"]


def test_assembly_without_mass_is_an_error(tmp_path):
    assembly_of_boxes()
    nothing = collection("Nothing")
    nothing.body_moments.mass_from, nothing.body_moments.mass = "MASS", 0.0
    found = document(saved(tmp_path))
    assert [error["name"] for error in found["errors"]] == ["Nothing"] and len(
        found["objects"]
    ) == 2


def test_asset_assemblies_are_measured_once_for_metadata(tmp_path):
    assembly_of_boxes()
    robot, lamps = bpy.data.collections["Robot"], collection("Lamps")
    lamps.objects.link(bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    for asset in (robot, lamps):
        asset.asset_mark()
    path = saved(tmp_path)
    assert "assemblies" not in document(path)
    for given in (False, True):  # with a given mass it is measured anyway
        bpy.ops.wm.open_mainfile(filepath=str(path))
        if given:
            bpy.data.collections["Robot"].body_moments.mass_from = "MASS"
            path = saved(tmp_path)
        found = document(path, "--force", "--asset-metadata", "copy")
        (entry,) = found["assemblies"]
        assert entry["name"] == "Robot" and not found["errors"] and len(found["objects"]) == 2
        (made,) = tmp_path.glob("*.body_moments.blend")
        bpy.ops.wm.open_mainfile(filepath=str(made))
        assert close(bpy.data.collections["Robot"].asset_data["body_mass"], entry["mass"], 1e-14)


def test_asset_metadata_is_in_the_asset_frame(tmp_path):
    """And the file itself is saved where that is asked for, and where there is something to
    save.
    """
    box = files.add_box("Box", center=(0, 0, 0))
    box.location, box.rotation_euler = (1.0, 2.0, 3.0), (0.3, 0.2, 0.1)
    box.data.transform(mathutils.Matrix.Translation((0.5, 0.25, 0.125)))
    plain = saved(tmp_path)
    kept = plain.read_bytes()
    for where in ("file", "copy"):
        line = files.run("--asset-metadata", where, plain)
        assert (
            not line.has_saved
            and not line.errors
            and [*tmp_path.iterdir()] == [plain]
            and plain.read_bytes() == kept
        )
    box = bpy.data.objects["Box"]
    box.asset_mark()
    path = saved(tmp_path)
    for where, target in (("copy", tmp_path / "file.body_moments.blend"), ("file", path)):
        line = files.run("--asset-metadata", where, path)
        assert line.has_saved == (target == path) and not line.errors
        (entry,) = line.documents[0]["objects"]
        bpy.ops.wm.open_mainfile(filepath=str(target))
        data = bpy.data.objects["Box"].asset_data
        for name in ("mass", "volume", "area"):
            assert data["body_" + name] == entry[name]
        assert close([*data["body_principal_moments"]], entry["principal_moments"], 1e-14)
        assert (
            close([*data["body_center_of_mass"]], (0.5, 0.25, 0.125), 1e-6)
            and data["body_method"] == "exact"
        )
        assert "body_mass" not in bpy.data.objects["Box"]
    bpy.data.objects["Box"].asset_data.pop("body_mass")
    path = saved(tmp_path)
    assert files.run("--asset-metadata", "copy").errors == 0  # The open file gets no copy.
    for words, has_mass in (((), False), (("--asset-metadata", "copy"), True)):
        assert files.run("--write", *words, path).has_saved
        bpy.ops.wm.open_mainfile(filepath=str(path))
        box = bpy.data.objects["Box"]
        assert "body_mass" in box and ("body_mass" in box.asset_data) == has_mass
