# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear, copy, empties, cursor, orientation, rigid bodies, faults, materials and settings."""

import bpy
import numpy as np
import pytest

from tests.blender.actions.snap.test_balance import told_of
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, measured, mesh_body, only, place
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def body_keys(obj):
    return [key for key in obj.keys() if key.startswith("body_") and key != "body_moments"]  # noqa: SIM118


def test_clear_removes_all_results_of_the_selected_objects_only():
    one, other = add(mesh_body(), "One"), add(mesh_body(), "Other")
    only(one, other)
    bpy.ops.object.body_moments_measure()
    one["mine"] = 5
    only(one)
    assert bpy.ops.object.body_moments_clear() == {"FINISHED"}
    assert not body_keys(one) and one["mine"] == 5 and one.body_moments.density == 1000.0
    assert body_keys(other)
    assert bpy.ops.object.body_moments_clear() == {"CANCELLED"}


def test_a_document_of_the_selection_names_the_file_once_there_is_one(tmp_path):
    from body_moments.operators.actions.measure import copy

    add(mesh_body())
    bpy.ops.object.body_moments_measure()
    assert copy.selected_document(bpy.context)["file"] is None
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert copy.selected_document(bpy.context)["file"] == path


def test_copy_report_needs_results_and_then_works(tmp_path, capfd):
    add(mesh_body())
    assert not bpy.ops.object.body_moments_copy_report.poll()
    bpy.ops.object.body_moments_measure()
    for path in (None, tmp_path / "saved.blend"):
        if path is not None:
            bpy.ops.wm.save_as_mainfile(filepath=str(path))
        capfd.readouterr()
        assert bpy.ops.object.body_moments_copy_report() == {"FINISHED"}
        lines = capfd.readouterr().out.splitlines()
        assert [line for line in lines if line.startswith("File")] == ["File: {}".format(path)] * (path is not None)
    assert bpy.ops.object.body_moments_copy_value(value="3.15", unit="m³") == {"FINISHED"}
    assert bpy.ops.object.body_moments_copy_value() == {"CANCELLED"}


@pytest.mark.parametrize("parent", [True, False])
def test_the_empty_is_the_principal_frame_and_there_is_one(parent):
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.4, 0.5), scale=(1, 2, 3))
    assert bpy.ops.object.body_moments_add_empty(parent=parent) == {"FINISHED"}
    (empty,) = [one for one in bpy.data.objects if one.type == "EMPTY"]
    body = measured(obj).mass_properties
    assert np.abs(place(empty)[:3, 3] - body.center).max() < 1e-5
    assert np.abs(place(empty)[:3, :3] - body.principal.axes).max() < 1e-5
    assert empty.parent == (obj if parent else None)
    assert empty.empty_display_type == "ARROWS"
    assert abs(empty.empty_display_size / body.radii_of_gyration.max() - 1.0) < 1e-6
    only(obj)
    assert bpy.ops.object.body_moments_add_empty(parent=parent) == {"CANCELLED"}
    obj.location.x += 5.0
    assert bpy.ops.object.body_moments_add_empty(parent=parent) == ({"CANCELLED"} if parent else {"FINISHED"})
    assert np.abs(place(empty)[:3, 3] - measured(obj).mass_properties.center).max() < 1e-5
    assert len([one for one in bpy.data.objects if one.type == "EMPTY"]) == 1


def test_the_empty_of_a_curve_is_at_its_center_though_curves_lay_children_along_their_path():
    bpy.ops.curve.primitive_bezier_circle_add(location=(8, -8, 0), rotation=(0.3, 0.4, 0.5))
    obj = bpy.context.object
    obj.data.bevel_depth = 0.2
    assert obj.data.use_path
    assert bpy.ops.object.body_moments_add_empty() == {"FINISHED"}
    empty = next(one for one in bpy.data.objects if one.type == "EMPTY")
    bpy.context.view_layer.update()
    assert empty.parent == obj
    assert np.abs(place(empty)[:3, 3] - measured(obj).mass_properties.center).max() < 1e-5
    only(obj)
    assert bpy.ops.object.body_moments_add_empty() == {"CANCELLED"}


@pytest.mark.parametrize("how", ["parent", "constraint", "driver"])
def test_an_empty_that_its_object_follows_is_left_where_it_is(how, reported):
    obj = add(mesh_body())
    bpy.ops.object.body_moments_add_empty(parent=False)
    empty = next(one for one in bpy.data.objects if one.type == "EMPTY")
    if how == "parent":
        obj.parent = empty
    elif how == "constraint":
        obj.constraints.new("CHILD_OF").target = empty
    else:
        driver = obj.driver_add("location", 1).driver
        driver.type, variable = "SUM", driver.variables.new()
        variable.type, variable.targets[0].id = "TRANSFORMS", empty
        variable.targets[0].transform_type = "LOC_X"
    obj.location.x += 5.0
    bpy.context.view_layer.update()
    before = place(obj), place(empty)
    for parent in (True, False):
        assert bpy.ops.object.body_moments_add_empty(parent=parent) == {"CANCELLED"}
        bpy.context.view_layer.update()
        assert (place(obj) == before[0]).all() and (place(empty) == before[1]).all()
        assert empty.parent is None
    assert reported.codes.count("empty_followed") == 2


def test_an_empty_that_a_constraint_holds_is_not_called_placed(reported):
    obj = add(mesh_body())
    bpy.ops.object.body_moments_add_empty(parent=False)
    empty = next(one for one in bpy.data.objects if one.type == "EMPTY")
    limit = empty.constraints.new("LIMIT_LOCATION")
    limit.use_max_x, limit.max_x = True, 0.0
    obj.location.x += 5.0
    bpy.context.view_layer.update()
    before = empty.matrix_basis.copy()
    assert bpy.ops.object.body_moments_add_empty(parent=False) == {"CANCELLED"}
    assert empty.matrix_basis == before
    assert reported.values("empty_constrained") == {"empty": empty.name}


def test_no_empty_is_a_child_of_what_has_no_thickness():
    obj = add(mesh_body(), scale=(1, 1, 0))
    obj.body_moments.kind = "SHELL"
    assert bpy.ops.object.body_moments_add_empty() == {"CANCELLED"}
    assert not [one for one in bpy.data.objects if one.type == "EMPTY"]
    assert bpy.ops.object.body_moments_add_empty(parent=False) == {"FINISHED"}


def test_an_empty_is_added_to_the_scene_that_it_is_asked_for_in():
    obj = add(mesh_body())
    bpy.data.collections.new("Elsewhere").objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    bpy.data.scenes.new("Elsewhere").collection.children.link(bpy.data.collections["Elsewhere"])
    bpy.context.scene.collection.children.link(shown := bpy.data.collections.new("Shown"))
    shown.objects.link(obj)
    only(obj)
    assert bpy.ops.object.body_moments_add_empty() == {"FINISHED"}
    (empty,) = [one for one in bpy.data.objects if one.type == "EMPTY"]
    assert list(empty.users_collection) == [shown]
    assert bpy.ops.object.body_moments_add_empty() == {"CANCELLED"}


def test_the_cursor_goes_to_the_center_of_all_selected():
    one = add(mesh_body(), "One", location=(1, 2, 3))
    other = add(mesh_body(), "Other", location=(-7, 0, 0), scale=(2, 2, 2))
    only(one, other)
    assert bpy.ops.view3d.body_moments_cursor_to_center() == {"FINISHED"}
    bodies = [measured(obj).mass_properties for obj in (one, other)]
    center = sum(body.mass * body.center for body in bodies) / sum(body.mass for body in bodies)
    assert np.abs(np.array(bpy.context.scene.cursor.location) - center).max() < 1e-5


@pytest.mark.parametrize("mode", ["XYZ", "ZYX", "QUATERNION", "AXIS_ANGLE"])
def test_the_cursor_turns_to_the_axes_on_request(mode):
    obj = add(mesh_body(), rotation=(0.3, 0.4, 0.5))
    cursor = bpy.context.scene.cursor
    cursor.rotation_mode = mode
    assert bpy.ops.view3d.body_moments_cursor_to_center(rotate=True) == {"FINISHED"}
    axes = measured(obj).mass_properties.principal.axes
    assert np.abs(np.array(cursor.matrix)[:3, :3] - axes).max() < 1e-5


def test_an_orientation_is_created_or_its_absence_is_explained():
    obj = add(mesh_body(), rotation=(0.3, 0.4, 0.5))
    outcome = bpy.ops.object.body_moments_create_orientation(name="Mine")
    slot = bpy.context.scene.transform_orientation_slots[0]
    if any(area.type == "VIEW_3D" for window in bpy.context.window_manager.windows for area in window.screen.areas):
        assert outcome == {"FINISHED"}
        assert slot.custom_orientation.name == "Mine"
        axes = measured(obj).mass_properties.principal.axes
        assert np.abs(np.array(slot.custom_orientation.matrix) - axes).max() < 1e-5
    else:
        assert outcome == {"CANCELLED"}


def test_rigid_body_mass_is_the_mass_in_kilograms_whatever_the_unit():
    bpy.context.scene.unit_settings.scale_length = 0.01
    obj = add(mesh_body())
    set_mass = bpy.ops.object.body_moments_set_rigid_body_mass
    assert set_mass() == {"CANCELLED"} and obj.rigid_body is None
    assert set_mass(add=True) == {"FINISHED"}
    assert abs(obj.rigid_body.mass / measured(obj).mass_properties.mass - 1.0) < 1e-6
    assert abs(obj.rigid_body.mass - 3.15e-3) < 1e-6
    assert set_mass() == {"CANCELLED"}
    obj.body_moments.density = 2000.0
    assert set_mass() == {"FINISHED"}


def test_no_faults_stays_in_object_mode_and_says_so():
    obj = add(mesh_body())
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    assert obj.mode == "OBJECT" and "body_mass" in obj


def test_no_faults_in_edit_mode_leaves_mode_and_selection_as_they_were():
    import bmesh
    from body_moments.operators.session import staleness

    obj = add(mesh_body())
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bmesh.from_edit_mesh(obj.data).verts[:][2].select_set(True)
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH" and "body_volume" in obj
    assert [vertex.index for vertex in bmesh.from_edit_mesh(obj.data).verts if vertex.select] == [2]
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    bpy.ops.object.mode_set(mode="OBJECT")


def test_boundary_edges_and_flipped_faces_are_selected(reported):
    mesh = mesh_body()
    obj = add(mesh)
    import bmesh

    bm = bmesh.new()
    bm.from_mesh(mesh)
    bm.faces.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.faces[0]], context="FACES_ONLY")
    bm.faces.ensure_lookup_table()
    bm.faces[3].normal_flip()
    bm.to_mesh(mesh)
    bm.free()
    mesh.update()
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    boundary = {i for i, edge in enumerate(mesh.edges) if edge.select}
    uses = np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))
    assert set(np.flatnonzero(uses == 1)) <= boundary
    assert mesh.polygons[3].select
    assert sum(face.select for face in mesh.polygons) == 1
    assert reported.values("object_defects")["object"] == obj.name
    assert {"defect_flipped_faces", "defect_boundary_edges"} <= set(reported.codes)


@pytest.mark.parametrize(("face", "kinds"), [("flipped", {"flipped_faces"}), ("missing", {"boundary_edges"})])
def test_defects_that_are_hidden_are_shown(face, kinds):
    mesh = box_mesh(1, 2, 4)
    if face == "flipped":
        mesh.polygons[2].flip()
    else:
        corners = [tuple(polygon.vertices) for polygon in mesh.polygons][:-1]
        mesh = bpy.data.meshes.new("Open")
        mesh.from_pydata([vertex.co for vertex in box_mesh(1, 2, 4).vertices], [], corners)
    obj = add(mesh)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.hide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.object.body_moments_select_faults(kinds=kinds) == {"FINISHED"} and obj.mode == "EDIT"
    assert list(bpy.context.tool_settings.mesh_select_mode) == [False, face == "missing", face == "flipped"]
    bpy.ops.object.mode_set(mode="OBJECT")
    uses = np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))
    if face == "flipped":
        assert [polygon.index for polygon in mesh.polygons if polygon.select and not polygon.hide] == [2]
    else:
        assert [edge.select and not edge.hide for edge in mesh.edges] == (uses == 1).tolist()


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_undo_leads_back_from_the_faults_to_the_measurement_and_from_there_to_the_start(mode):
    good, bad = add(mesh_body(), "Good"), add(mesh_body(), "Bad")
    bad.data.polygons[3].flip()
    bad.data.update()
    only(good, bad)

    def state():
        objects = bpy.context.view_layer.objects
        return (
            bpy.context.mode,
            sorted(obj.name for obj in objects.selected),
            objects.active.name,
            "body_volume" in bpy.data.objects["Bad"],
        )

    bpy.ops.ed.undo_push(message="start")
    if mode == "EDIT":
        bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    before = state()
    assert bpy.ops.object.body_moments_select_faults("EXEC_DEFAULT", True) == {"FINISHED"}
    after = state()
    assert after == ("EDIT_MESH", ["Bad"], "Bad", True)
    bpy.ops.ed.undo()
    assert state() == ("OBJECT", *after[1:])
    bpy.ops.ed.undo()
    assert state() == before
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert state() == after


def test_only_faulty_objects_go_to_edit_mode():
    good, bad = add(mesh_body(), "Good"), add(mesh_body(), "Bad")
    import bmesh

    bm = bmesh.new()
    bm.from_mesh(bad.data)
    bm.faces.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.faces[0]], context="FACES_ONLY")
    bm.to_mesh(bad.data)
    bm.free()
    only(good, bad)
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    assert (good.mode, bad.mode) == ("OBJECT", "EDIT")
    assert not good.select_get() and bpy.context.object == bad
    bpy.ops.object.mode_set(mode="OBJECT")
    assert sum(edge.select for edge in bad.data.edges) == 6


def test_faults_of_a_result_of_modifiers_are_not_selected_in_the_mesh():
    obj = add(mesh_body())
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    assert bpy.ops.object.body_moments_select_faults() == {"CANCELLED"}
    assert obj.mode == "OBJECT"
    modifier.show_viewport = False
    obj.modifiers.new("Smooth", "SMOOTH")  # moves vertices only
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}


def test_what_cannot_be_live_says_why_and_others_say_nothing(reported):
    only(add(bpy.data.meshes.new("Nothing"), "Nothing"), add(mesh_body(), "Good"))
    assert bpy.ops.object.body_moments_live() == {"FINISHED"}
    assert reported.values("failure")["object"] == "Nothing" and reported.codes.count("failure") == 1


def test_the_active_object_decides_whether_live_numbers_begin_or_end_and_need_not_be_selected(reported):
    from body_moments.operators.session import live

    active, other = add(mesh_body(), "Active"), add(mesh_body(), "Other")
    camera = add(bpy.data.cameras.new("Camera"), "Camera")
    assert not bpy.ops.object.body_moments_live.poll()
    only(other, camera)
    bpy.ops.object.body_moments_live()
    bpy.context.view_layer.objects.active = active
    for expected in ([True, True], [False, False]):
        assert bpy.ops.object.body_moments_live() == {"FINISHED"}
        assert [live.is_live(obj) for obj in (active, other)] == expected
    other.select_set(False)
    bpy.ops.object.body_moments_live()
    assert [live.is_live(obj) for obj in (active, other)] == [True, False] and not reported.codes
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.object.body_moments_live.poll()


def test_of_many_that_cannot_be_live_the_first_are_named(reported):
    only(*[add(bpy.data.meshes.new("Nothing"), f"Nothing {number}") for number in range(5)])
    assert bpy.ops.object.body_moments_live() == {"FINISHED"}
    assert reported.codes.count("failure") == 3 and reported.values("and_more") == {"count": 2}


def test_the_step_before_edit_mode_has_a_name_in_the_undo_history(capfd):
    mesh = box_mesh(1, 2, 4)
    mesh.polygons[2].flip()
    add(mesh)
    bpy.ops.ed.undo_push(message="start")
    assert bpy.ops.object.body_moments_select_faults("EXEC_DEFAULT", True) == {"FINISHED"}
    bpy.context.window_manager.print_undo_steps()
    assert "name='Measure'" in capfd.readouterr().out
    bpy.ops.object.mode_set(mode="OBJECT")


def test_views_of_the_mesh_are_told_what_is_selected():
    from body_moments.operators.actions.measure import select_faults

    obj = add(mesh_body())
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.update()
    with told_of(obj.data) as changes:
        select_faults._select_elements(obj, {"flipped_faces": np.array([2])})
        bpy.context.view_layer.update()
    assert changes


def test_a_material_sets_the_density_of_all_selected_and_a_typed_density_forgets_it(reported):
    from body_moments.core.density.materials import BY_NAME
    from body_moments.core.numerics.float32 import shortest_decimal

    one, other = add(mesh_body(), "One"), add(mesh_body(), "Other")
    only(one, other)
    other.body_moments.mass_from = "MASS"
    assert bpy.ops.object.body_moments_set_material(material="Water") == {"FINISHED"}
    for obj in (one, other):
        assert obj.body_moments.material == "Water" and obj.body_moments.mass_from == "DENSITY"
        assert shortest_decimal(obj.body_moments.density) == BY_NAME["Water"].density
    assert bpy.ops.object.body_moments_set_material(material="Water") == {"CANCELLED"}
    assert reported.codes == ["material_set", "nothing_to_do", "material_set_already"]
    assert reported.values("material_set") == {"count": 2, "material": "Water"}
    one.body_moments.density = 500.0
    assert one.body_moments.material == ""


@pytest.mark.parametrize(
    ("operator", "options"),
    [
        ("object.measure", {}),
        ("object.origin_to_center", {}),
        ("object.balance_group", {"use_scene_range": False, "frame_end": 2}),
        ("object.set_material", {}),
        ("scene.set_millimeters", {}),
    ],
)
def test_a_scene_gets_the_preferences_with_the_first_press(operator, options, monkeypatch, scene):
    from types import SimpleNamespace

    from body_moments.operators.settings import preferences

    source = SimpleNamespace(**{name: getattr(scene.body_moments, name) for name in preferences.COPIED})
    monkeypatch.setattr(preferences, "preferences", lambda: SimpleNamespace(**(vars(source) | {"show_overlay": True})))
    add(mesh_body(), location=(1, 2, 3))
    assert not scene.body_moments.has_defaults
    category, name = operator.split(".")
    assert getattr(getattr(bpy.ops, category), "body_moments_" + name)(**options) == {"FINISHED"}
    assert scene.body_moments.has_defaults


def test_settings_are_copied_to_the_other_selected_objects(reported):
    one, other = add(mesh_body(), "One"), add(mesh_body(), "Other")
    assert not bpy.ops.object.body_moments_copy_settings.poll()
    only(one, other)
    one.body_moments.kind = "SHELL"
    one.body_moments.thickness = 0.02
    assert bpy.ops.object.body_moments_copy_settings() == {"FINISHED"}
    assert other.body_moments.kind == "SHELL" and other.body_moments.thickness == one.body_moments.thickness
    assert bpy.ops.object.body_moments_copy_settings() == {"CANCELLED"}
    assert reported.codes == ["settings_copied", "nothing_to_do", "settings_equal"]


def test_ones_own_presets_are_kept_loaded_and_removed():
    obj = add(mesh_body())
    obj.body_moments.density = 321.0
    assert bpy.ops.object.body_moments_preset_add(name="My Foam") == {"FINISHED"}
    (path,) = [f"{folder}/My_Foam.py" for folder in bpy.utils.preset_paths("body_moments")]
    obj.body_moments.density = 1.0
    bpy.ops.script.execute_preset(filepath=path, menu_idname="OBJECT_PT_body_moments_presets")
    assert obj.body_moments.density == 321.0
    assert bpy.ops.object.body_moments_preset_add(name="My Foam", remove_name=True) == {"FINISHED"}


def test_presets_keep_every_setting_that_is_no_object():
    from body_moments.core.density.materials import MATERIALS
    from body_moments.operators.settings.properties import COPIED_PROPERTIES

    changed = {
        "kind": "WIRE",
        "wall": "INWARD",
        "thickness": 0.25,
        "mass_from": "MASS",
        "density": MATERIALS[0].density,
        "linear_density": 0.5,
        "material": MATERIALS[0].name,
        "mass": 3.0,
        "overlap": "UNION",
        "density_from": "POLYNOMIAL",
        "density_polynomial": "1 + x",
        "density_frame": "WORLD",
        "density_attribute": "rho",
        "grid": "density",
        "grid_as": "SOLID",
        "threshold": 0.25,
        "threshold_fill": "GRID",
        "use_center": True,
        "given_center": (1.0, 2.0, 3.0),
        "use_inertia": True,
        "given_inertia_diagonal": (1.0, 2.0, 2.5),
        "given_inertia_products": (0.125, 0.25, 0.5),
        "values_from": "TABLE",
        "value_density": 2.0,
        "transfer_table": "0, 1, 2, 3",
        "spline_order": 4,
    }
    assert {*changed, "density_volume"} == {*COPIED_PROPERTIES}
    one = add(mesh_body())
    for name, value in changed.items():
        setattr(one.body_moments, name, value)
    bpy.ops.object.body_moments_preset_add(name="All of It")
    (path,) = [f"{folder}/All_of_It.py" for folder in bpy.utils.preset_paths("body_moments")]
    other = add(mesh_body(), "Other")
    bpy.ops.script.execute_preset(filepath=path, menu_idname="OBJECT_PT_body_moments_presets")
    for name in changed:
        kept, given = getattr(other.body_moments, name), getattr(one.body_moments, name)
        assert (kept if isinstance(kept, (str, float, int)) else [*kept]) == (
            given if isinstance(given, (str, float, int)) else [*given]
        ), name
    with open(path, encoding="utf-8") as file:
        assert "density_volume" not in file.read()  # it is an object of this file
    bpy.ops.object.body_moments_preset_add(name="All of It", remove_name=True)


def test_materials_are_many_sourced_and_plausible():
    from body_moments.core.density.materials import BY_NAME, MATERIALS

    assert len(MATERIALS) >= 40 and len(BY_NAME) == len(MATERIALS)
    for material in MATERIALS:
        assert 1.0 < material.density < 23000.0 and material.source and material.category


@pytest.mark.parametrize(
    "system, length, mass, expected",
    [
        (
            "METRIC",
            "ADAPTIVE",
            "ADAPTIVE",
            ("1.5 m", "2 cm²", "8 m³", "250 g", "7850 kg/m³", "2 kg·cm²"),
        ),
        (
            "METRIC",
            "MILLIMETERS",
            "GRAMS",
            ("1500 mm", "200 mm²", "8\u2009000\u2009000\u2009000 mm³", "250 g", "7850 kg/m³", "200\u2009000 g·mm²"),
        ),
        (
            "IMPERIAL",
            "INCHES",
            "POUNDS",
            (
                "59.0551 in",
                "0.310001 in²",
                "488\u2009190 in³",
                "0.551156 lb",
                "490.059 lb/ft³",
                "0.683434 lb·in²",
            ),
        ),
        ("NONE", "ADAPTIVE", "ADAPTIVE", ("1.5", "0.0002", "8", "0.25 kg", "7850 kg/m³", "0.0002 kg·m²")),
    ],
)
def test_numbers_are_shown_in_the_scenes_units(system, length, mass, expected):
    from body_moments.operators.write.units import Units

    units = Units(system, length, mass, 1.0)
    values = (
        ("length", 1.5),
        ("area", 2e-4),
        ("volume", 8.0),
        ("mass", 0.25),
        ("density", 7850.0),
        ("inertia", 2e-4),
    )
    assert tuple(units.text(*value) for value in values) == expected


def test_without_a_unit_system_lengths_are_the_scenes_and_masses_are_kilograms():
    """Else a density beside a volume in the scene's units would seem to give another mass than the one shown."""
    from body_moments.operators.write.units import Units

    units = Units("NONE", "ADAPTIVE", "ADAPTIVE", 0.001)
    values = (("length", 0.002), ("volume", 8e-9), ("mass", 8e-6), ("density", 1000.0), ("inertia", 5e-12))
    assert [units.text(*value) for value in values] == ["2", "8", "8e−6 kg", "1000 kg/m³", "5e−12 kg·m²"]


@pytest.mark.parametrize(
    ("system", "scale", "scaled"),
    [("METRIC", 0.01, True), ("IMPERIAL", 0.3048, True), ("METRIC", 1.0, False), ("NONE", 0.01, False)],
)
def test_what_blender_shows_of_a_rigid_bodys_mass_is_reported_where_it_is_scaled(system, scale, scaled, reported):
    settings = bpy.context.scene.unit_settings
    settings.system, settings.scale_length = system, scale
    obj = add(mesh_body())
    obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.0
    assert bpy.ops.object.body_moments_set_rigid_body_mass(add=True) == {"FINISHED"}
    assert obj.rigid_body.mass == 3.0
    assert ("rigid_body_display_scaled" in reported.codes) == scaled
    if scaled:
        assert close(reported.values("rigid_body_display_scaled")["factor"], scale**3, rel=1e-6)
    assert "rigid_body_center_elsewhere" in reported.codes
    reported.clear()
    assert bpy.ops.object.body_moments_set_rigid_body_mass(add=True) == {"CANCELLED"}
    assert reported.codes == ["nothing_to_do", "rigid_body_masses_equal"]


def test_numbers_keep_six_digits_and_tiny_ones_are_not_zero():
    from body_moments.operators.write.units import Units, number

    assert [number(value) for value in (0.0, 1e-9, 123456789.0, -0.5, 1.23456789e-3, 1e12)] == [
        "0",
        "1e−9",
        "123\u2009457\u2009000",
        "−0.5",
        "0.00123457",
        "1e12",
    ]
    assert Units("METRIC", "ADAPTIVE", "ADAPTIVE", 1.0).text("mass", 1e-9) == "0.001 mg"
    texts = Units("METRIC", "METERS", "KILOGRAMS", 1.0).texts("inertia", (5.0, 1e-17))
    assert texts == ["5 kg·m²", "0 kg·m²"]
    adaptive = Units("METRIC", "ADAPTIVE", "ADAPTIVE", 1.0)  # noise is 0 in the unit of 0
    assert adaptive.texts("length", (1e-16, 0.0), size=1.0) == adaptive.texts("length", (0.0, 0.0)) == ["0 m", "0 m"]


def test_a_column_shares_unit_decimals_and_power_and_groups_digits_as_the_scene_says():
    from body_moments.operators.write.units import Units

    units = Units("METRIC", "METERS", "KILOGRAMS", 1.0)
    assert units.texts("length", (1.0 / 3.0, -2.25, 0.0)) == ["0.33333 m", "−2.25000 m", "0.00000 m"]
    assert units.texts("length", (1.5, -2.25, 0.0)) == ["1.50 m", "−2.25 m", "0.00 m"]
    assert units.texts("inertia", (2.5e12, 1e10)) == ["2.50e12 kg·m²", "0.01e12 kg·m²"]
    assert units.texts("mass", (20000.04, 0.1)) == ["20\u2009000.0 kg", "0.1 kg"]
    assert units.texts("mass", (99999.97, 5.0)) == ["100\u2009000 kg", "5 kg"]  # rounded up: a digit less behind it
    assert units.texts("mass", (-1e-9, 5.0)) == ["0 kg", "5 kg"]  # no negative zero
    settings = bpy.context.scene.unit_settings
    shown = bpy.context.scene.body_moments
    settings.length_unit = "METERS"
    for digits, grouping, expected in ((3, "COMMA", "12,300 m"), (15, "NONE", "12345.6789 m"), (2, "NONE", "12000 m")):
        shown.digits, shown.digit_grouping = digits, grouping
        assert Units.of(settings).text("length", 12345.6789) == expected


@pytest.mark.parametrize(
    ("unit", "system", "text", "entered"),
    [
        ("AUTO", "METRIC", "7850 kg/m³", 7850.0),
        ("AUTO", "IMPERIAL", "490.059 lb/ft³", 490.0594),
        ("G_CM3", "IMPERIAL", "7.85 g/cm³", 7.85),
        ("LB_IN3", "METRIC", "0.2836 lb/in³", 0.2836),
        ("KG_M3", "NONE", "7850 kg/m³", 7850.0),
    ],
)
def test_densities_are_shown_and_entered_in_the_chosen_unit(unit, system, text, entered):
    from body_moments.operators.settings.properties import density_field_name
    from body_moments.operators.write.units import Units

    scene = bpy.context.scene
    scene.unit_settings.system, scene.body_moments.density_unit = system, unit
    settings = add(mesh_body()).body_moments
    for owner in (settings, bpy.data.materials.new("Steel").body_moments):
        setattr(owner, density_field_name(scene), entered)
        assert close(owner.density, 7850.0, rel=2e-4)
        assert close(getattr(owner, density_field_name(scene)), entered, rel=1e-6)
    assert Units.of(scene.unit_settings).text("density", 7850.0).startswith(text[:5])
    assert Units.of(scene.unit_settings).text("density", 7850.0).endswith(text.split()[1])


def test_a_scenes_default_material_is_the_density_of_objects_without_one_here_and_in_batch():
    from body_moments.operators.session import staleness

    scene, obj = bpy.context.scene, add(mesh_body())
    scene.body_moments.default_material = "PLA"
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    assert obj["body_density"] == 1240.0 and staleness.stale_reason(obj, scene) is None
    assert "density_default_kept" not in obj["body_findings"]
    assert obj.body_moments.density_kg_m3 == 1240.0 and not obj.body_moments.is_property_set("density")
    scene.body_moments.default_material, scene.body_moments.default_density = "CUSTOM", 1300.5
    assert obj["body_density"] == 1300.5 and staleness.stale_reason(obj, scene) is None
    bpy.ops.object.body_moments_measure()
    assert obj["body_density"] == 1300.5
    obj.body_moments.density = 5.0
    bpy.ops.object.body_moments_measure()
    assert obj["body_density"] == 5.0


@pytest.mark.parametrize("operator", ["measure", "measure_section", "find_similar", "origin_to_center"])
def test_a_report_of_many_failures_names_the_first_and_counts_the_others(operator, reported):
    bodies = [add(mesh_body(), "Good")]
    bodies += [add(bpy.data.meshes.new("Nothing"), "Bad {:d}".format(i)) for i in range(6)]
    only(*bodies)
    getattr(bpy.ops.object, "body_moments_" + operator)()
    failed = 7 if operator == "measure_section" else 6
    assert reported.codes.count("failure") == 3
    assert reported.values("and_more") == {"count": failed - 3}


def test_where_no_object_can_have_a_symmetry_it_is_reported(reported):
    add(None, "Empty")
    assert bpy.ops.object.body_moments_find_symmetry() == {"CANCELLED"}
    assert reported.codes == ["nothing_measurable"]


def test_a_report_is_as_severe_as_its_worst_finding_and_reads_as_sentences():
    from types import SimpleNamespace

    from body_moments.core.verdict.finding import finding
    from body_moments.operators.write import reports

    calls = []
    operator = SimpleNamespace(report=lambda *call: calls.append(call))
    bpy.context.scene.unit_settings.length_unit = "MILLIMETERS"
    wall = finding("wall_measured", thickness=0.25, side="inward")
    reports.report(
        operator, finding("measured_several", count=2, total=3), finding("with_warnings", count=1, objects=["A"]), wall
    )
    reports.report(operator, wall, finding("measured_one", object="A"))
    reports.report(
        operator,
        finding("no_faces"),
        finding("measured_one", object="{B}"),
        finding("with_warnings", count=1, objects=["A"]),
    )
    with_wall = "The wall was measured with real thickness: 250 mm, inward, mitered corners."
    assert calls == [
        ({"WARNING"}, "Measured 2 of 3 objects; 1 with warnings: “A”. " + with_wall),
        ({"INFO"}, with_wall + " Measured A"),
        ({"ERROR"}, "No faces. Add faces, or select another object. Measured {B}; 1 with warnings: “A”"),
    ]


def test_the_most_severe_findings_are_reported_first_and_the_others_counted():
    from body_moments.core.verdict.finding import finding
    from body_moments.operators.write import reports

    found = [finding("measured_one", object=name) for name in "ABC"] + [finding("flat_surface"), finding("no_faces")]
    assert reports.first(found) == [found[4], found[3], found[0], finding("and_more", count=2)]
    assert reports.first(found[:3]) == found[:3]


def test_reports_are_translated_before_they_are_filled(monkeypatch):
    from types import SimpleNamespace

    from body_moments.core.verdict.finding import finding
    from body_moments.operators.write import reports

    words = {"Measured {object}": "{object} gemessen", "{object}: {cause}": "{object} - {cause}"}
    translations = SimpleNamespace(pgettext_rpt=lambda text: words.get(text, text))
    app = SimpleNamespace(translations=translations)
    monkeypatch.setattr(reports, "bpy", SimpleNamespace(app=app, context=bpy.context))
    assert reports.text(finding("measured_one", object="Measured {object}")) == "Measured {object} gemessen"
    cause = finding("measured_one", object="A").as_record()
    assert reports.text(finding("failure", object="B", cause=cause)) == "B - A gemessen"


def test_faults_of_many_objects_are_looked_for_in_one_evaluation_of_the_scene():
    bodies = [add(mesh_body(), "Body", location=(4 * i, 0, 0)) for i in range(4)]
    only(*bodies)
    evaluations = []
    bpy.app.handlers.depsgraph_update_post.append(lambda *_: evaluations.append(1))
    try:
        assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    finally:
        bpy.app.handlers.depsgraph_update_post.pop()
    assert all(body["body_mass"] > 0.0 for body in bodies) and len(evaluations) < 4
