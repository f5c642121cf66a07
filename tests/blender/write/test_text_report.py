# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report that a person reads: from a document, and from what is stored on objects."""

import re

import pytest

pytest.importorskip("bpy")
import bpy
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.write import text_report
from body_moments.blender.write.properties import store
from mathutils import Euler, Matrix

from tests.blender import batch_files as files
from tests.blender.batch_files import document, sentence

pytestmark = pytest.mark.usefixtures("scene")


def stored(*objects):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for obj in objects:
        store(obj, measure_object(obj, depsgraph))
    return text_report.report_text(bpy.context, list(bpy.context.scene.objects))


def line(text, label, number=0):
    """What stands behind a label, for the first object that has it, or the one of that number."""
    found = re.findall(rf"^  {re.escape(label)} +(.*)$", text, re.MULTILINE)
    return found[number]


def turned_box(name="Box", density=1000.0):
    box = files.add_box(name, (0, 0, 0))
    box.body_moments.density = density
    turn = Euler((0, 0, 1.5707963267948966)).to_matrix().to_4x4()
    box.matrix_world = Matrix.Translation((4, 5, 6)) @ turn
    bpy.context.view_layer.update()
    return box


def test_report_of_typical_file_is_as_reviewed(kept):
    files.add_box("Box").body_moments.density = 500.0
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    lines = text_report.text(document()).splitlines()
    kept("report.txt", "\n".join(line for line in lines if "at most" not in line and "float32" not in line))


def test_a_document_is_told_in_the_order_of_cad_dialogs():
    files.add_box("Würfel")
    text = text_report.text(document())
    labels = ["Verdict", "Kind", "Mass", "Density", "Volume", "Surface area", "Center of mass"]
    labels += ["Principal moments", "  I1", "  I2", "  I3", "Radii of gyration", "Inertia tensor"]
    places = [text.index("\n  " + label) for label in labels]
    assert places == sorted(places)
    assert text.startswith("Mass properties, SI units, world frame\n\nWürfel\n")
    assert line(text, "Verdict").startswith("exact")
    assert line(text, "Mass") == "6000 kg" and line(text, "Density") == "1000 kg/m³"
    assert line(text, "Volume") == "6 m³" and line(text, "Surface area") == "22 m²"
    assert line(text, "Center of mass") == "(10, 20, 30) m, world frame"
    assert line(text, "  I1") == "2500  along (0, 0, 1)"
    assert "Ixy = −∫ρxy" in line(text, "Inertia tensor")
    assert re.search(r"Ixx 6500 +Iyy 5000 +Izz 2500\n +Ixy 0 +Ixz 0 +Iyz 0\n", text)
    assert "volume" in line(text, "Rounding, at most")
    assert "Total" not in text and "Not measured" not in text


def test_several_objects_have_a_total_and_errors_their_reasons():
    files.add_box("A", (0, 0, 0), (2, 2, 2))
    files.add_box("B", (4, 0, 0), (2, 2, 2))
    text = text_report.text(document("--object", "A", "--object", "B", "--object", "C"))
    assert "Total of 2 objects, world frame" in text
    assert line(text, "Mass", 2) == "16000 kg"
    assert line(text, "Center of mass", 2) == "(2, 0, 0) m, world frame"
    assert "Not measured\n  C: " + sentence("object_not_in_scene") in text


def test_what_is_wrong_with_a_body_is_told():
    box = files.add_box()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    box.data.polygons[0].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.object.mode_set(mode="OBJECT")
    text = text_report.text(document())
    assert line(text, "Verdict").startswith("capped: The surface is open")
    assert "4 boundary edges" in line(text, "Found")
    assert line(text, "Warning")


@pytest.mark.parametrize("frame", ["WORLD", "OBJECT"])
def test_stored_results_are_told_as_a_document_tells_them(frame):
    """Health and symmetry are not stored; the rest is the same text."""
    box = turned_box()
    bpy.context.scene.body_moments.frame = frame
    expected = text_report.text(document("--frame", frame.lower())).splitlines()
    text = stored(box).splitlines()
    expected = [row for row in expected if not row.startswith("  Found")]
    assert [row.removesuffix(", asymmetric") for row in expected] == text


def test_the_stored_frame_is_the_one_that_the_scene_shows():
    box = turned_box()
    text = stored(box)
    assert line(text, "Center of mass") == "(4, 5, 6) m, world frame"
    assert re.search(r"Ixx 5000 +Iyy 6500 +Izz 2500\n", text)
    bpy.context.scene.body_moments.frame = "OBJECT"
    text = stored(box)
    assert line(text, "Center of mass") == "(0, 0, 0) m, object frame"
    assert re.search(r"Ixx 6500 +Iyy 5000 +Izz 2500\n", text)


def test_the_total_of_stored_results_is_that_of_a_document():
    first, second = turned_box("A"), files.add_box("B", size=(1, 1, 4))
    second.body_moments.density = 50.0
    bpy.context.scene.unit_settings.scale_length = 0.5
    text, expected = stored(first, second), text_report.text(document())
    for label in ("Mass", "Volume", "Surface area", "Center of mass", "Radii of gyration"):
        assert line(text, label, 2) == line(expected, label, 2)
    for label in ("  I1", "  I2", "  I3"):
        assert line(text, label, 2) == line(expected, label, 2).partition("  along")[0]


def test_objects_without_results_are_named_and_so_are_damaged_ones():
    objects = {name: files.add_box(name) for name in "ABCDE"}
    stored(*(objects[name] for name in "ABCD"))
    objects["B"]["body_inertia"] = "gone"
    objects["C"]["body_center_of_mass"] = [1.0, 2.0]
    objects["D"]["body_mass"] = "heavy"
    text = text_report.report_text(bpy.context, list(objects.values()))
    for name in "BCDE":
        assert f"  {name}: {sentence('no_stored_results')}" in text
    assert "\nA\n" in text and "Total" not in text
