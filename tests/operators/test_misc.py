# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear, copy, empties, cursor, orientation, rigid bodies, faults, materials and settings."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.tracking import staleness
from body_moments.blender.write.units import Units
from body_moments.core.density.materials import BY_NAME
from body_moments.core.numerics.float32 import shortest_decimal

from tests.blender.boxes import box_mesh
from tests.blender.objects import add, editing, measure, measured, mesh_body, mesh_of, only, place

pytestmark = pytest.mark.usefixtures("scene")


def body_keys(obj):
    keys = list(obj.keys())
    return [key for key in keys if key.startswith("body_") and key != "body_moments"]


def test_clear_removes_all_results_of_the_selected_objects_only():
    one, other = add(mesh_body(), "One"), add(mesh_body(), "Other")
    measure(one, other)
    one["mine"] = 5
    only(one)
    assert bpy.ops.object.body_moments_clear() == {"FINISHED"}
    assert not body_keys(one) and one["mine"] == 5 and one.body_moments.density == 1000.0
    assert body_keys(other)
    assert bpy.ops.object.body_moments_clear() == {"CANCELLED"}


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
    assert bpy.ops.object.body_moments_add_empty(parent=parent) == (
        {"CANCELLED"} if parent else {"FINISHED"}
    )
    assert np.abs(place(empty)[:3, 3] - measured(obj).mass_properties.center).max() < 1e-5
    assert len([one for one in bpy.data.objects if one.type == "EMPTY"]) == 1


def test_empty_of_curve_is_at_its_center():
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
def test_follows_moved_by_its_object_stays(how, reported):
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
    assert reported.codes.count("follows_moved") == 2


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


def test_rigid_body_mass_is_in_kilograms_in_any_unit():
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


def test_faultless_object_keeps_mode_and_selection():
    import bmesh

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
    with editing(mesh) as edited:
        edited.faces[4].normal_flip()
        edited.faces.remove(edited.faces[0])
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    boundary = {i for i, edge in enumerate(mesh.edges) if edge.select}
    uses = np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))
    assert set(np.flatnonzero(uses == 1)) <= boundary
    assert mesh.polygons[3].select
    assert sum(face.select for face in mesh.polygons) == 1
    told = reported.values("object_warnings")
    assert told["object"] == obj.name
    assert {"Flipped Faces", "Boundary Edges"} <= {
        cause["values"]["kind"] for cause in told["causes"]
    }


@pytest.mark.parametrize(
    ("face", "kinds"), [("flipped", {"flipped_faces"}), ("missing", {"boundary_edges"})]
)
def test_defects_that_are_hidden_are_shown(face, kinds):
    mesh = box_mesh(1, 2, 4)
    if face == "flipped":
        mesh.polygons[2].flip()
    else:
        corners = [tuple(polygon.vertices) for polygon in mesh.polygons][:-1]
        mesh = mesh_of([vertex.co for vertex in box_mesh(1, 2, 4).vertices], corners, "Open")
    obj = add(mesh)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.hide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (
        bpy.ops.object.body_moments_select_faults(kinds=kinds) == {"FINISHED"}
        and obj.mode == "EDIT"
    )
    assert list(bpy.context.tool_settings.mesh_select_mode) == [
        False,
        face == "missing",
        face == "flipped",
    ]
    bpy.ops.object.mode_set(mode="OBJECT")
    uses = np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))
    if face == "flipped":
        assert [
            polygon.index for polygon in mesh.polygons if polygon.select and not polygon.hide
        ] == [2]
    else:
        assert [edge.select and not edge.hide for edge in mesh.edges] == (uses == 1).tolist()


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_undo_of_faults_restores_measurement_then_start(mode):
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
    with editing(bad.data) as edited:
        edited.faces.remove(edited.faces[0])
    only(good, bad)
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}
    assert (good.mode, bad.mode) == ("OBJECT", "EDIT")
    assert not good.select_get() and bpy.context.object == bad
    bpy.ops.object.mode_set(mode="OBJECT")
    assert sum(edge.select for edge in bad.data.edges) == 6


def test_faults_of_modifiers_are_not_selected():
    obj = add(mesh_body())
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    assert bpy.ops.object.body_moments_select_faults() == {"CANCELLED"}
    assert obj.mode == "OBJECT"
    modifier.show_viewport = False
    obj.modifiers.new("Smooth", "SMOOTH")  # moves vertices only
    assert bpy.ops.object.body_moments_select_faults() == {"FINISHED"}


def test_material_sets_density_of_selected_objects(reported):
    one, other = add(mesh_body(), "One"), add(mesh_body(), "Other")
    only(one, other)
    other.body_moments.mass_from = "MASS"
    assert bpy.ops.object.body_moments_set_material(material="Water") == {"FINISHED"}
    for obj in (one, other):
        assert obj.body_moments.material == "Water" and obj.body_moments.mass_from == "DENSITY"
        assert shortest_decimal(obj.body_moments.density) == BY_NAME["Water"].density
    assert bpy.ops.object.body_moments_set_material(material="Water") == {"CANCELLED"}
    assert "2 objects" in reported.texts[0] and "Nothing to do" in reported.texts[1]
    one.body_moments.density = 500.0
    assert one.body_moments.material == ""


def test_settings_are_copied_to_the_other_selected_objects(reported):
    one, other = add(mesh_body(), "One"), add(mesh_body(), "Other")
    assert not bpy.ops.object.body_moments_copy_settings.poll()
    only(one, other)
    one.body_moments.kind = "SHELL"
    one.body_moments.thickness = 0.02
    assert bpy.ops.object.body_moments_copy_settings() == {"FINISHED"}
    assert (
        other.body_moments.kind == "SHELL"
        and other.body_moments.thickness == one.body_moments.thickness
    )
    assert bpy.ops.object.body_moments_copy_settings() == {"CANCELLED"}
    assert "Nothing to do" in reported.texts[1]


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
    ],
)
def test_numbers_are_shown_in_the_scenes_units(system, length, mass, expected):
    values = {
        "length": 1.5,
        "area": 2e-4,
        "volume": 8.0,
        "mass": 0.25,
        "density": 7850.0,
        "inertia": 2e-4,
    }
    assert (
        tuple(Units(system, length, mass, 1.0).text(*value) for value in values.items()) == expected
    )


def test_without_unit_system_masses_are_kilograms():
    """Else a density beside a volume in the scene's units would seem to give another mass than the
    one shown.
    """
    units = Units("NONE", "ADAPTIVE", "ADAPTIVE", 0.001)
    values = (
        ("length", 0.002),
        ("volume", 8e-9),
        ("mass", 8e-6),
        ("density", 1000.0),
        ("inertia", 5e-12),
    )
    assert [units.text(*value) for value in values] == [
        "2",
        "8",
        "8e−6 kg",
        "1000 kg/m³",
        "5e−12 kg·m²",
    ]


def test_default_material_is_density_of_unset_objects():
    scene, obj = bpy.context.scene, add(mesh_body())
    scene.body_moments.default_material = "PLA"
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    assert obj["body_density"] == 1240.0 and staleness.stale_reason(obj, scene) is None
    assert "density_defaulted" not in obj["body_findings"]
    assert obj.body_moments.density_kg_m3 == 1240.0 and not obj.body_moments.is_property_set(
        "density"
    )
    scene.body_moments.default_material, scene.body_moments.default_density = "CUSTOM", 1300.5
    assert obj["body_density"] == 1300.5 and staleness.stale_reason(obj, scene) is None
    bpy.ops.object.body_moments_measure()
    assert obj["body_density"] == 1300.5
    obj.body_moments.density = 5.0
    bpy.ops.object.body_moments_measure()
    assert obj["body_density"] == 5.0
