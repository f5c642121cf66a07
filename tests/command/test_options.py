# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line's options, on the scene that is open and on .blend files."""

import os

import pytest

bpy = pytest.importorskip("bpy")
import numpy as np
from body_moments.blender.read.findings import LINES_ONLY, NO_INSTANCES
from body_moments.command.findings import NO_SHAPES, NOTHING_RENDERED
from body_moments.operators import batch
from mathutils import Euler, Matrix

from tests.blender import batch_files as files
from tests.blender.batch_files import codes, document, measured, run, sentence, values

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def standard_output(capfd):
    """Given back after a test, because `main` takes it away for good."""
    kept = os.dup(1)
    yield
    os.dup2(kept, 1)
    os.close(kept)


def names(found):
    return [entry["name"] for entry in found["objects"]]


def errors(found):
    return {entry["name"]: entry["reason"] for entry in found["errors"]}


def test_without_a_file_the_open_scene_is_measured():
    files.add_box()
    found = document()
    assert names(found) == [files.BOX_NAME] and found["file"] is None
    assert found["blender"] == ".".join(map(str, bpy.app.version))


def test_objects_without_geometry_are_left_out():
    for name in ("b", "C", "a"):
        files.add_box(name)
    bpy.ops.object.camera_add()
    bpy.ops.object.light_add()
    bpy.ops.object.empty_add()
    found = document()
    assert names(found) == ["C", "a", "b"] and found["errors"] == []
    assert found["total"]["mass"] == pytest.approx(18000.0)


def test_object_without_surface_is_measured_only_by_name():
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.name = "Circle"
    bpy.ops.object.light_add()
    bpy.context.object.name = "Light"
    bpy.ops.object.empty_add()
    bpy.ops.object.text_add()
    bpy.context.object.data.extrude = 0.1
    found = document()
    assert names(found) == ["Text"] and found["errors"] == []
    assert errors(document("--object", "Circle", "--object", "Light", "--object", "Empty")) == {
        "Circle": sentence("nothing_to_measure", cause=LINES_ONLY),
        "Light": sentence("object_without_geometry", type="Light"),
        "Empty": sentence("not_shown", cause=NO_INSTANCES),
    }
    assert names(document("--object", "Circle", "--kind", "shell")) == ["Circle"]


def left_out(found):
    return {entry["name"]: entry["reason"] for entry in found["left_out"]}


def test_unrendered_objects_and_wire_operands_are_listed():
    body, cutter, joined, helper, blank = map(
        files.add_box, ("Body", "Cutter", "Joined", "Helper", "Blank")
    )
    for number, operand in enumerate((cutter, joined)):
        cut = body.modifiers.new("Cut", "BOOLEAN")
        cut.object, cut.solver = operand, "FLOAT" if bpy.app.version >= (5, 0) else "FAST"
        operand.location.x += 10.0 + 10.0 * number
    helper.location.y += 10.0  # no copy stays in place
    blank.location.y += 20.0
    for kind in ("OBJECT", "COLLECTION"):
        body.modifiers.new("Empty", "BOOLEAN").operand_type = kind
    cutter.display_type, joined.display_type, helper.display_type = "WIRE", "BOUNDS", "WIRE"
    blank.hide_render = joined.hide_render = True
    bpy.ops.object.light_add()
    bpy.context.object.hide_render = True  # Nobody would measure it.
    found = document()
    assert names(found) == ["Body", "Helper"] and found["errors"] == []
    operand = sentence("boolean_operand")
    assert left_out(found) == {
        "Cutter": operand,
        "Joined": operand,
        "Blank": sentence("not_rendered"),
    }
    assert [entry["name"] for entry in found["left_out"]] == ["Blank", "Cutter", "Joined"]
    assert found["total"]["mass"] == pytest.approx(12000.0)
    assert codes(found["total"]) == ["total_doubtful_parts", "density_defaulted"]
    assert values(found["total"], "total_doubtful_parts")["objects"] == ["Helper"]
    every = document("--all")
    assert (
        names(every) == ["Blank", "Body", "Cutter", "Helper", "Joined"] and every["left_out"] == []
    )
    assert codes(every["total"]) == ["total_doubtful_parts"] * 2 + ["density_defaulted"]
    assert every["total"]["findings"][0]["values"]["objects"] == [
        ["Cutter", "Body"],
        ["Joined", "Body"],
    ]
    named = document("--object", "Blank", "--object", "Cutter")
    assert names(named) == ["Blank", "Cutter"] and named["left_out"] == []
    assert codes(named["total"]) == ["density_defaulted"] and codes(named["objects"][0]) == []
    for modifier in body.modifiers:
        modifier.show_viewport = modifier.show_render = False
    assert left_out(document()) == {
        "Blank": sentence("not_rendered"),
        "Joined": sentence("not_rendered"),
    }


def test_an_operand_drawn_as_a_solid_is_a_part_with_a_warning():
    body, cutter = files.add_box("Body"), files.add_box("Cutter")
    body.modifiers.new("Cut", "BOOLEAN").object = cutter
    body.modifiers["Cut"].show_viewport = False  # the render cuts
    found = document()
    assert names(found) == ["Body", "Cutter"] and found["left_out"] == []
    cut = found["objects"][1]
    assert values(cut, "solid_operand_measured") == {"object": "Body"}
    assert sentence("solid_operand_measured", object="Body") in cut["warnings"]
    assert "solid_operand_measured" not in codes(found["objects"][0])
    assert codes(found["total"]) == ["total_doubtful_parts", "density_defaulted"]


def test_collection_operands_and_unrendered_ones_are_left_out():
    body, one, two, other, both = map(files.add_box, ("Body", "One", "Two", "Other", "Both"))
    cutters, hidden, inner = map(bpy.data.collections.new, ("Cutters", "Unrendered", "Inner"))
    top = bpy.context.scene.collection
    for parent, child in ((top, cutters), (top, hidden), (hidden, inner)):
        parent.children.link(child)
    for home, obj in ((cutters, one), (cutters, two), (inner, other), (inner, both)):
        home.objects.link(obj)
        if obj is not both:  # The scene's own collection renders it.
            top.objects.unlink(obj)
    hidden.hide_render = True
    one.display_type = "WIRE"
    cut = body.modifiers.new("Cut", "BOOLEAN")
    cut.operand_type, cut.collection, cut.operation = "COLLECTION", cutters, "UNION"
    found = document()
    assert names(found) == ["Body", "Both", "Two"]
    assert left_out(found) == {
        "One": sentence("boolean_operand"),
        "Other": sentence("not_rendered"),
    }
    assert values(found["total"], "total_doubtful_parts")["objects"] == [["Two", "Body"]]


def test_objects_rendered_by_another_view_layer_count():
    files.add_box("shown")
    collection = bpy.data.collections.new("Away")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects.new("hidden", bpy.data.meshes["shown"]))
    bpy.context.view_layer.layer_collection.children["Away"].exclude = True
    assert left_out(document()) == {"hidden": sentence("not_rendered")}
    second = bpy.context.scene.view_layers.new("Second")
    found = document()
    assert errors(found) == {
        "hidden": sentence("hidden_in_viewport", name="Away", switch="check box")
    }
    assert found["left_out"] == []
    second.use = False
    assert left_out(document()) == {"hidden": sentence("not_rendered")}
    bpy.context.view_layer.use = False  # none is rendered: the open one decides
    assert left_out(document()) == {"hidden": sentence("not_rendered")} and names(document()) == [
        "shown"
    ]


def test_file_without_measurable_objects_is_an_error(tmp_path):
    bpy.ops.object.light_add()
    path = files.save(tmp_path / "empty.blend")
    assert files.reason(path) == sentence("nothing_measured", cause=NO_SHAPES)
    for name in "ab":
        files.add_box(name).hide_render = True
    path = files.save(tmp_path / "hidden.blend")
    line = run(path)
    assert (
        errors(line.documents[0]) == {None: sentence("nothing_measured", cause=NOTHING_RENDERED)}
        and line.errors == 1
    )
    assert list(left_out(line.documents[0])) == ["a", "b"]
    assert document(path, "--all")["errors"] == []
    assert errors(document(path, "--object", "z")) == {
        "z": sentence("no_such_name", kind="object", name="z")
    }


def test_a_density_that_nobody_set_is_a_finding():
    box = files.add_box()
    entry = measured()
    assert codes(entry) == ["density_defaulted"] and entry["density"] == 1000.0
    files.add_box("Heavy", (9.0, 9.0, 9.0))
    whole = document()  # once a file in which nobody asked for a density
    assert [codes(one) for one in (*whole["objects"], whole["total"])] == [
        [],
        [],
        ["density_defaulted"],
    ]
    bpy.data.objects["Heavy"].body_moments.density = 7.0
    assert [codes(one) for one in document()["objects"]] == [[], ["density_defaulted"]]
    bpy.data.objects.remove(bpy.data.objects["Heavy"])
    for words in (("--density", "1000"), ("--mass", "3")):
        assert measured(*words)["findings"] == []
    box.body_moments.density_from = "MATERIALS"
    assert codes(measured()) == ["object_density_used", "density_defaulted"]
    material = bpy.data.materials.new("Steel")
    box.data.materials.append(material)
    assert codes(measured()) == ["object_density_used", "density_defaulted"]
    material.body_moments.density = 7850.0
    assert measured()["findings"] == []
    box.body_moments.density_from, box.body_moments.density = "VALUE", 1000.0
    assert measured()["findings"] == []
    box.body_moments.property_unset("density")
    box.body_moments.mass_from = "MASS"
    assert measured()["findings"] == []
    bpy.ops.curve.primitive_bezier_circle_add()
    wire = bpy.context.object
    wire.body_moments.kind = "WIRE"
    assert codes(measured("--object", wire.name)) == ["density_defaulted"]
    wire.body_moments.linear_density = 1.0
    assert measured("--object", wire.name)["findings"] == []


def test_a_driver_or_a_script_that_did_not_run_is_a_finding(tmp_path):
    box = files.add_box()
    box.driver_add("location", 0).driver.expression = "2 * frame"  # Blender itself computes it.
    simple = files.save(tmp_path / "simple.blend")
    script = bpy.data.texts.new("startup.py")
    script.use_module = True
    text = files.save(tmp_path / "text.blend")
    box.driver_add("location", 1).driver.expression = "bpy.data.filepath"
    summed = box.driver_add("location", 2).driver  # It is neither a script nor valid.
    summed.type, summed.variables.new().targets[0].data_path = "SUM", "nothing"
    summed.is_valid = False
    driver = files.save(tmp_path / "driver.blend")
    assert measured(simple, "--density", "1")["findings"] == []
    assert values(measured(text), "script_blocked") == {"script": "Text 'startup.py'"}
    assert "driver_blocked" in codes(measured(driver, "--object", files.BOX_NAME))
    entry = measured(driver)
    assert values(entry, "driver_blocked") == {"drivers": ["bpy.data.filepath"]}
    assert sentence("driver_blocked", drivers=["bpy.data.filepath"]) in entry["warnings"]
    assert measured(simple, "--density", "1")["findings"] == []


@pytest.mark.parametrize("how", ["hide_viewport", "collection"])
def test_unevaluated_object_is_an_error_with_a_reason(how):
    files.add_box("shown")
    hidden = files.add_box("hidden")
    if how == "hide_viewport":
        hidden.hide_viewport = True
    else:
        collection = bpy.data.collections.new("Away")
        bpy.context.scene.collection.children.link(collection)
        bpy.context.scene.collection.objects.unlink(hidden)
        collection.objects.link(hidden)
        collection.hide_viewport = True
    found = document()
    assert names(found) == ["shown"] and list(errors(found)) == ["hidden"]
    assert errors(found)["hidden"]


def test_excluded_instanced_members_are_in_the_instancer_record():
    member = files.add_box("member", (0, 0, 0))
    collection = bpy.data.collections.new("Parts")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.collection.objects.unlink(member)
    collection.objects.link(member)
    bpy.ops.object.empty_add(location=(5, 0, 0))
    empty = bpy.context.active_object
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    bpy.context.view_layer.layer_collection.children["Parts"].exclude = True
    found = document()
    assert names(found) == [empty.name] and found["errors"] == [] and found["left_out"] == []
    assert found["objects"][0]["center_of_mass"] == pytest.approx([5.0, 0.0, 0.0], abs=1e-12)
    empty.instance_type = "NONE"  # The object keeps its collection.
    assert left_out(document()) == {"member": sentence("not_rendered")}


def test_a_linked_object_of_the_same_name_has_a_name_of_its_own(tmp_path):
    path = files.box_file(tmp_path / "library.blend")
    files.empty_scene()
    files.add_box()
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    found = names(document())
    assert found == [files.BOX_NAME, files.BOX_NAME + " [library.blend]"]
    assert names(document("--object", found[0])) == found[:1]
    assert names(document("--object", found[1])) == found[1:]


def test_settings_stored_in_a_blend_file_are_used(tmp_path):
    box = files.add_box()
    box.body_moments.mass_from, box.body_moments.mass = "MASS", 7.0
    shell = files.add_box("Shell")
    shell.body_moments.kind, shell.body_moments.thickness = "SHELL", 0.5
    solid, sheet = sorted(
        document(files.save(tmp_path / "part.blend"))["objects"], key=lambda entry: entry["kind"]
    )[::-1]
    assert solid["kind"] == "solid" and solid["mass"] == pytest.approx(7.0)
    assert sheet["kind"] == "shell" and sheet["method"] == "shell"
    assert sheet["mass"] == pytest.approx(22.0 * 0.5 * 1000.0)


def test_the_frame_is_the_worlds_or_the_objects_own():
    box = files.add_box(center=(0, 0, 0))
    for vertex in box.data.vertices:
        vertex.co.x += 4.0
    turn = Euler((0.3, -0.4, 0.5)).to_matrix().to_4x4()
    box.matrix_world = Matrix.Translation((7, 8, 9)) @ turn @ Matrix.Scale(2.0, 4)
    found = document("--frame", "object")
    entry = found["objects"][0]
    assert found["frame"] == "object" and found["total"]["frame"] == "world"
    assert entry["center_of_mass"] == pytest.approx([8.0, 0.0, 0.0], abs=1e-5)
    expected = [32 * 6500.0, 32 * 5000.0, 32 * 2500.0]
    assert [entry["inertia"][i][i] for i in range(3)] == pytest.approx(expected, rel=1e-5)
    world = measured()
    center = turn @ Matrix.Translation((8, 0, 0)) @ Matrix.Identity(4)
    expected = [a + b for a, b in zip(center.translation, (7, 8, 9), strict=True)]
    assert world["center_of_mass"] == pytest.approx(expected, abs=1e-5)
    assert found["total"]["center_of_mass"] == pytest.approx(world["center_of_mass"])
    assert found["total"]["principal_moments"] == pytest.approx(entry["principal_moments"])


def test_no_result_is_written_over_the_wave_vectors(tmp_path, capfd, standard_output):
    files.add_box()
    waves, out = tmp_path / "q.npy", tmp_path / "out.npz"
    np.save(waves, np.ones((2, 3)))
    kept = waves.read_bytes()
    for words in (("--output", waves, "--fourier", out), ("--output", out, "--fourier", waves)):
        assert batch.main(["measure", "--q", str(waves), *map(str, words)]) == 2
    assert waves.read_bytes() == kept and not out.exists()
    assert "is used twice" in capfd.readouterr().err
