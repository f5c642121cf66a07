# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report that a person reads: from a document, and from what is stored on objects."""

import re

import bpy
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.read.places import place_error
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
    return text_report.text(
        text_report.stored_document(
            bpy.context, list(bpy.context.scene.objects), place_error=place_error
        )
    )


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
    kept(
        "report.txt",
        "\n".join(line for line in lines if "at most" not in line and "float32" not in line),
    )


@pytest.mark.parametrize("frame", ["WORLD", "OBJECT"])
def test_stored_results_are_told_as_a_document_tells_them(frame):
    """Health and symmetry are not stored; the rest is the same text."""
    box = turned_box()
    bpy.context.scene.body_moments.frame = frame
    expected = text_report.text(document("--frame", frame.lower())).splitlines()
    text = stored(box).splitlines()
    expected = [row for row in expected if not row.startswith("  Found")]
    assert [row.removesuffix(", asymmetric") for row in expected] == text


def test_the_total_of_stored_results_is_that_of_a_document():
    first, second = turned_box("A"), files.add_box("B", size=(1, 1, 4))
    second.body_moments.density = 50.0
    bpy.context.scene.unit_settings.scale_length = 0.5
    text, expected = stored(first, second), text_report.text(document())
    for label in ("Mass", "Volume", "Surface area", "Center of mass", "Radii of gyration"):
        assert line(text, label, 2) == line(expected, label, 2)
    for label in ("  I1", "  I2", "  I3"):
        assert line(text, label, 2) == line(expected, label, 2).partition("  along")[0]


def test_objects_without_or_with_damaged_results_are_named():
    objects = {name: files.add_box(name) for name in "ABCDE"}
    stored(*(objects[name] for name in "ABCD"))
    objects["B"]["body_inertia"] = "gone"
    objects["C"]["body_center_of_mass"] = [1.0, 2.0]
    objects["D"]["body_mass"] = "heavy"
    text = text_report.text(text_report.stored_document(bpy.context, list(objects.values())))
    for name in "BCDE":
        assert f"  {name}: {sentence('no_stored_results')}" in text
    assert "\nA\n" in text and "Total" not in text
