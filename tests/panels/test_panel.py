# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel shows of numbers, findings and why they no longer hold, beside what is stored."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.displayed import displayed
from body_moments.blender.session.stored import outcome

from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, arrays, dent, measure, measured, mesh_body, only
from tests.panels.drawing import copied, findings_of, labels, shown, shows

pytestmark = pytest.mark.usefixtures("scene")


def test_a_refusal_goes_with_undo_selection_and_success():
    obj, other = add(mesh_body()), add(mesh_body(), "Other", select=False)
    only(obj)
    settings = obj.body_moments
    for end in ("success", "selection", "dismissal"):
        settings.density_from, settings.density_polynomial = "POLYNOMIAL", "1000+"
        bpy.ops.object.body_moments_measure()
        (group,) = outcome.last().groups
        assert group.finding.code == "polynomial_part" and group.objects == (obj.name,)
        assert "Write products" in " ".join(labels(shown())) and "Not Measured" in labels(shown())
        if end == "success":
            settings.density_from = "VALUE"
            bpy.ops.object.body_moments_measure()
            bpy.ops.object.body_moments_clear()
        elif end == "selection":
            only(other)
            assert outcome.last() is None
            only(obj)
        else:
            outcome.forget()
        assert outcome.last() is None and "Write products" not in " ".join(labels(shown()))


def test_equal_findings_of_objects_are_one_line():
    closed, mesh = mesh_body(), bpy.data.meshes.new("Open")
    mesh.from_pydata(
        [v.co for v in closed.vertices], [], [tuple(f.vertices) for f in closed.polygons][1:]
    )
    objects = [add(mesh if i < 3 else closed, str(i), location=(10 * i, 0, 0)) for i in range(5)]
    measure(*objects)
    assert "5 Objects" in labels(shown()) and "Repaired" in labels(shown())
    # in the row of the main panel, and among the findings
    assert sum("3 objects: holes capped" in label for label in labels(shown())) == 2
    only(objects[0])
    objects[0].scale = 50, 50, 50
    bpy.ops.object.body_moments_measure()
    assert "Is a unit of this scene a millimeter?" in labels(shown())
    only(*objects)
    assert bpy.ops.object.body_moments_select_refused(code="holes_capped") == {"FINISHED"}
    assert [obj.name for obj in bpy.context.selected_objects] == ["0", "1", "2"]


def test_values_are_shown_with_units_and_copied_with_all_digits():
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    bpy.ops.object.body_moments_measure()
    found = measured(obj)
    record = shown(without=("selection",))
    assert "3.15 m³" in labels(record)
    assert float(copied(record, "m³")[0]) == obj["body_volume"]
    assert float(copied(record, "kg")[0]) == obj["body_mass"]
    center = [float(text) for text in copied(record, "m")[1:4]]
    assert np.abs(np.array(center) - found.mass_properties.center).max() < 1e-12


def test_absent_label_is_refused_beside_its_field(tmp_path):
    values = np.zeros((8, 8, 8), np.float32)
    values[1:3, 1:3, 1:3], values[4:7, 4:7, 4:7] = 1.0, 3.0
    obj = volume_object(tmp_path / "map.vdb", vdb_grid(values))
    only(obj)
    assert ("prop", "grid_as") in shown() and ("prop", "label") not in shown()
    for name, value, voxels in (("grid_as", "LABEL", 35), ("label", 3, 27), ("label", 7, 27)):
        setattr(obj.body_moments, name, value)
        bpy.ops.object.body_moments_measure()
        assert ("prop", "label") in shown()
        assert obj["body_volume"] == pytest.approx(voxels, rel=1e-9)
    assert shows(shown(), "label_absent", file="density", labels=[7], others=[1, 3], remedy="Label")


@pytest.mark.parametrize("frame", ["WORLD", "OBJECT"])
@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_the_frame_shown_is_the_frame_chosen(frame, unit):
    scene = bpy.context.scene
    scene.unit_settings.scale_length = unit
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1), scale=(1, 2, -1))
    bpy.ops.object.body_moments_measure()
    scene.body_moments.frame = frame
    found = displayed(obj, scene).in_frame(frame)
    shown, truth = arrays(found), measured(obj)
    truth = truth.mass_properties if frame == "WORLD" else truth.in_object_frame()
    assert np.abs(shown.center - truth.center).max() < 1e-12 * max(1.0, np.abs(truth.center).max())
    assert np.abs(shown.inertia - truth.inertia).max() < 1e-12 * np.trace(truth.inertia)
    assert np.abs(shown.axes - truth.principal.axes).max() < 1e-9
    assert np.abs(found.gyration / truth.radii_of_gyration - 1.0).max() < 1e-12


def test_total_names_boolean_operands(capfd):
    """Without a window there is no clipboard: the whole report goes to the standard output."""
    from body_moments.blender.session import displayed

    body, cutter = add(mesh_body(), "Body"), add(mesh_body(), "Cutter", location=(1, 1, 1))
    cutter.display_type = "WIRE"
    body.modifiers.new("Cut", "BOOLEAN").object = cutter
    measure(body, cutter)
    (caveat,) = displayed.total(bpy.context).findings
    assert caveat.code == "total_doubtful_parts" and "“Cutter” of “Body”" in str(caveat)
    assert shows(shown(), caveat.code, **caveat.values)
    bpy.ops.object.body_moments_copy(what="REPORT")
    assert str(caveat) in capfd.readouterr().out
    body.modifiers.clear()
    bpy.context.view_layer.update()
    assert [one.code for one in displayed.total(bpy.context).findings] == ["total_doubtful_parts"]
    only(cutter)
    bpy.context.view_layer.update()
    assert displayed.total(bpy.context).findings == ()


def test_rounding_in_total_center_is_shown_as_zero():
    for turn in ((0.3, 0.2, 0.1), (0.1, 0.5, 0.7)):
        bpy.ops.mesh.primitive_cylinder_add(vertices=7, rotation=turn)
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.body_moments_measure()
    told = labels(shown())
    assert told[told.index("Center of Mass (World)") :][1:6:2] == ["X", "Y", "Z"]
    assert told[told.index("Center of Mass (World)") :][2:7:2] == ["0 m", "0 m", "0 m"]


def test_total_counts_measured_objects_and_names_others():
    objects = [
        add(mesh_body(), str(i), location=(10 * i, 2 * i, -i), rotation=(i, 0, 0)) for i in range(3)
    ]
    measure(*objects)
    add(mesh_body(), "Not Measured")
    for obj in objects:
        obj.select_set(True)
    found = labels(shown())
    assert "4 Objects" in found
    assert "Not measured: “Not Measured”" in " ".join(found)
    objects[1].body_moments.kind = "SHELL"
    bpy.context.view_layer.update()
    assert "Out of date: “1”" in " ".join(labels(shown()))


def test_objects_without_a_shape_are_passed_over():
    obj, light = add(mesh_body()), bpy.data.lights.new("Light", "POINT")
    others = [bpy.data.objects.new("Empty", None), bpy.data.objects.new("Light", light)]
    for other in others:
        bpy.context.scene.collection.objects.link(other)
    only(*others, obj)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"} and outcome.last() is None
    assert {"Body", "Exact"} <= {*labels(shown())}
    only(*others)
    with pytest.raises(RuntimeError, match="Nothing selected can be measured"):
        bpy.ops.object.body_moments_measure()


def test_damaged_results_are_not_shown():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    obj["body_center_of_mass"] = 5.0
    assert "Not Measured" in labels(shown())
    obj["body_center_of_mass"] = [1.0, 2.0]
    assert "Not Measured" in labels(shown())


def test_damaged_findings_leave_panel_drawn():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    for text in (
        "",
        "[",
        "{}",
        '[{"code": "of_the_future", "values": {}}]',
        '[{"code": "holes_capped"}]',
        "[1]",
    ):
        obj["body_findings"] = text
        assert "Exact" in labels(shown())
    obj["body_method"] = "guess"
    assert "Guess" in labels(shown())


@pytest.mark.parametrize("kind", ["FONT", "META", "CURVE"])
def test_curve_polygons_are_a_note(kind, capfd):
    if kind == "META":
        bpy.ops.object.metaball_add()
        bpy.context.object.data.render_resolution = bpy.context.object.data.resolution
    elif kind == "FONT":
        bpy.ops.object.text_add()
        bpy.context.object.data.body, bpy.context.object.data.extrude = "o", 0.1
    else:
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.context.object.data.bevel_depth = 0.2
    bpy.ops.object.body_moments_measure()
    obj = bpy.context.object
    out = capfd.readouterr().out
    assert {"drawn_as_polygons"} & {*findings_of(obj, "note")}
    assert not findings_of(obj, "warning") and obj["body_warnings"] == ""
    assert "Info: Measured {:s}\n".format(obj.name) in out and "Warning" not in out
    found = labels(shown())
    assert any(label.startswith("Notes (") for label in found)
    assert not any(label.startswith("Warnings (") for label in found)


def outdated():
    """Whether the numbers are shown as out of date."""
    return "Out of date: " in " ".join(labels(shown(without=("selection",))))


def test_undo_of_renaming_keeps_results_current():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="measured")
    obj.select_set(False)
    obj.select_set(True)
    obj.name = "Renamed"
    bpy.context.view_layer.update()
    assert not outdated()
    bpy.ops.ed.undo_push(message="renamed")
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    assert bpy.context.object.name == "Body" and not outdated()


def test_opened_file_is_as_current_as_it_was_saved(tmp_path):
    add(mesh_body())
    bpy.ops.object.body_moments_measure()
    path = str(tmp_path / "a.blend")
    for is_edited in (False, True):
        if is_edited:
            dent(bpy.context.object, -1.0)
        bpy.ops.wm.save_as_mainfile(filepath=path)
        assert outdated() == is_edited
        bpy.ops.wm.open_mainfile(filepath=path)
        assert outdated() == is_edited
    bpy.ops.object.body_moments_measure()
    assert not outdated()
