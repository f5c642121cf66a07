# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies at work: what is stored and driven, when it is out of date, its tree, its table and
its snaps.
"""

import csv

import bpy
import numpy as np
import pytest
from body_moments.blender.session import displayed
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Stale
from body_moments.blender.write import properties
from body_moments.panels import overlay
from mathutils import Matrix

from tests.blender.boxes import box, boxes_inertia, empty
from tests.blender.objects import add, measure, only, place
from tests.close import close
from tests.operators.assemblies import BOXES, activate, assembly_of_boxes

pytestmark = pytest.mark.usefixtures("registered", "scene")


def test_the_total_is_stored_on_the_collection_and_drives(reported):
    root = assembly_of_boxes()
    obj = bpy.data.objects["b0"]
    assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"}
    mass, center, tensor = boxes_inertia(BOXES)
    assert close(root["body_mass"], mass, 1e-14)
    assert close(root["body_center_of_mass"].to_list(), center, 1e-14)
    entries = tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    assert np.abs(np.array(root["body_inertia"].to_list()) - entries).max() <= 1e-14 * entries.max()
    assert (
        root["body_method"] == "assembly"
        and root["body_inertia_products"].to_list() == root["body_inertia"].to_list()[3:]
    )
    assert close(bpy.data.collections["Arm"]["body_mass"], 8000.0, 1e-14) and close(
        obj["body_mass"], 62800.0, 1e-14
    )
    driver = add(None, "Driven", select=False).driver_add("location", 0).driver
    variable = driver.variables.new()
    variable.type, variable.name = "SINGLE_PROP", "mass"
    variable.targets[0].id_type, variable.targets[0].id = "COLLECTION", root
    variable.targets[0].data_path = '["body_mass"]'
    driver.expression = "mass + 0"
    obj.body_moments.density = 1.0
    bpy.ops.object.body_moments_measure_assembly()
    mass = 8008.0
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    assert close(bpy.data.objects["Driven"].evaluated_get(depsgraph).location[0], mass, 1e-6)
    assert set(properties.FIELDS) <= set(root.keys())
    assert bpy.ops.object.body_moments_clear_assembly() == {"FINISHED"}
    assert not any(key in root for key in properties.DESCRIPTIONS)
    assert bpy.ops.object.body_moments_clear_assembly() == {"CANCELLED"}


@pytest.mark.parametrize(
    "change, reason",
    [
        (lambda root: setattr(bpy.data.objects["b1"].body_moments, "kind", "SHELL"), Stale.MEMBER),
        (lambda root: setattr(bpy.data.objects["b1"], "location", (9, 9, 9)), Stale.MEMBER),
        (lambda root: box(root, (1, 1, 1), name="new"), Stale.MEMBERS),
        (lambda root: setattr(root.body_moments, "mass_from", "MASS"), Stale.MEMBERS),
        (
            lambda root: setattr(bpy.data.collections["Arm"].body_moments, "mass_from", "MASS"),
            Stale.MEMBERS,
        ),
        (lambda root: setattr(bpy.data.objects["b0"], "hide_render", True), Stale.MEMBERS),
        (lambda root: None, None),
    ],
)
def test_an_assembly_is_out_of_date_when_a_member_is(change, reason):
    root = assembly_of_boxes()
    bpy.ops.object.body_moments_measure_assembly()
    assert staleness.stale_reason(root, bpy.context.scene) is None
    change(root)
    bpy.context.view_layer.update()
    assert staleness.stale_reason(root, bpy.context.scene) == reason
    bpy.ops.object.body_moments_measure_assembly()
    assert staleness.stale_reason(root, bpy.context.scene) is None


@pytest.mark.parametrize(
    "settings, density",
    [
        ({"density": 2000.0}, 2000.0),
        ({"density_g_cm3": 1.24}, 1240.0),
        ({"mass_from": "MASS", "mass": 4.0}, 0.5),
    ],
)
def test_total_and_drawn_center_follow_a_density(settings, density):
    root, obj = assembly_of_boxes(), bpy.data.objects["b1"]
    obj.body_moments.property_unset("density")
    bpy.ops.object.body_moments_measure_assembly()
    assert "members_density_unset" in root["body_findings"]
    for name, value in settings.items():
        setattr(obj.body_moments, name, value)
    bpy.context.view_layer.update()
    mass, center, tensor = boxes_inertia([BOXES[0], (density, *BOXES[1][1:])])
    assert staleness.stale_reason(root, bpy.context.scene) is None
    assert "members_density_unset" not in root["body_findings"]
    assert close(root["body_mass"], mass, 1e-12) and close(
        root["body_center_of_mass"].to_list(), center, 1e-12
    )
    entries = tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    assert np.abs(np.array(root["body_inertia"].to_list()) - entries).max() <= 1e-12 * entries.max()
    only(bpy.data.objects["b0"])
    drawn, active = overlay.bodies.collect(bpy.context, [bpy.context.object])
    assert active == 0 and close(drawn[1].center, center, 1e-12)
    obj.location.x += 1.0
    bpy.context.view_layer.update()
    # the total is out of date
    assert len(overlay.bodies.collect(bpy.context, [bpy.context.object])[0]) == 1


@pytest.mark.parametrize(
    "operator, options",
    [
        ("rigid_bodies", {}),
        ("rigid_bodies", {"frame": "ORIGIN"}),
        ("rigid_bodies", {"use_density": True, "density": 5.0}),
        ("origin_to_center", {}),
        ("axes_to_principal", {}),
    ],
)
def test_new_member_frames_keep_assembly_current(operator, options):
    root = assembly_of_boxes()
    for obj in root.all_objects:
        obj.data.transform(Matrix.Translation((0.5, 0.25, 1.0)))
        obj.rotation_euler = (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    bpy.ops.object.body_moments_measure_assembly()
    before = [obj.matrix_world.copy() for obj in root.all_objects]
    for obj in root.all_objects:
        obj.select_set(True)
    assert getattr(bpy.ops.object, "body_moments_" + operator)(**options) == {"FINISHED"}
    assert all(obj.matrix_world != was for obj, was in zip(root.all_objects, before))
    arm, members = bpy.data.collections["Arm"], [obj["body_mass"] for obj in root.all_objects]
    assert [staleness.stale_reason(one, bpy.context.scene) for one in (root, arm)] == [None, None]
    assert close(root["body_mass"], sum(members), 1e-6) and (sum(members) < 80.1) == (
        "density" in options
    )
    bpy.data.objects["b1"].location.x += 1.0
    bpy.context.view_layer.update()
    assert staleness.stale_reason(root, bpy.context.scene) == Stale.MEMBER


def test_empty_with_children_carries_total_and_moves_to_center():
    root = empty(bpy.context.scene.collection, "Root", (1, 0, 0))
    root.rotation_euler.z = 0.5
    for number, (density, size, at) in enumerate(BOXES):
        child = box(bpy.context.scene.collection, size, at, density, f"b{number}")
        child.parent = root
    bpy.context.view_layer.update()
    only(root)
    before = {child: place(child) for child in root.children}
    assert bpy.ops.object.body_moments_measure_assembly(target="OBJECT") == {"FINISHED"}
    mass, center, _ = boxes_inertia(BOXES)
    assert close(root["body_center_of_mass"].to_list(), center, 1e-6)
    assert staleness.stale_reason(root, bpy.context.scene) is None
    assert bpy.ops.object.body_moments_assembly_origin(target="OBJECT") == {"FINISHED"}
    for child, was in before.items():
        assert np.abs(place(child) - was).max() < 1e-5
    assert np.abs(root["body_center_of_mass"].to_list()).max() < 1e-5
    root.select_set(True)
    for child in root.children:
        child.select_set(True)
    total = displayed.total(bpy.context)
    assert total.count == 2 and close(total.numbers.mass, mass, 1e-6)


@pytest.mark.parametrize("size", [1.0, 1e-3])
def test_children_stay_in_place_at_any_size(size):
    root = empty(bpy.context.scene.collection, "Root", np.array([0.3, 0.2, 0.1]) * size)
    root.rotation_euler = (0.1, 0.2, 0.3)
    for number in range(3):
        sides, at = np.array([1, 2, 1]) * size, np.array([number, 2 * number, -1]) * size
        child = box(bpy.context.scene.collection, sides, at, rotation=(0.3 * number, number, 2))
        child.parent, child.matrix_parent_inverse = root, Matrix.Rotation(0.7, 4, (1, 2, 3))
    bpy.context.view_layer.update()
    only(root)
    before = {child: place(child) for child in root.children}
    assert bpy.ops.object.body_moments_assembly_origin(target="OBJECT") == {"FINISHED"}
    assert np.abs(place(root)[:3, 3]).max() > size
    for child, was in before.items():
        off = np.abs(place(child) - was)
        assert off[:3, 3].max() < 1e-5 * size and off[:3, :3].max() < 1e-6


@pytest.mark.parametrize("share", [0.8, 1.25])
@pytest.mark.parametrize("at", [0.3, 10.0])
def test_children_that_would_move_keep_their_empty(at, share, reported):
    """Cubes a unit away from their center, one of which follows a little of the way of the empty,
    which is a unit.
    """
    root = empty(bpy.context.scene.collection, "Root", (at, 1, 0))
    children = [box(bpy.context.scene.collection, (0.5, 0.5, 0.5), (at + x, 0, 0)) for x in (-1, 1)]
    bpy.context.view_layer.update()
    for child in children:
        child.parent, child.matrix_parent_inverse = root, root.matrix_world.inverted()
    follow = children[0].constraints.new("COPY_LOCATION")
    follow.target, follow.use_x, follow.use_z = root, False, False
    follow.influence = share * 4e-6 * max(1.0, at)
    bpy.context.view_layer.update()
    only(root)
    before = [obj.matrix_world.copy() for obj in (root, *children)]
    if share < 1.0:
        assert bpy.ops.object.body_moments_assembly_origin(target="OBJECT") == {"FINISHED"}
        assert abs(root.matrix_world.translation.y) < 1e-4
        return
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_assembly_origin(target="OBJECT")
    assert reported.values("child_not_held")["object"] == children[0].name
    assert [obj.matrix_world for obj in (root, *children)] == before


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_cursor_empty_and_offset_go_to_the_center(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    root = assembly_of_boxes()
    _, center, _ = boxes_inertia(BOXES)
    assert bpy.ops.view3d.body_moments_cursor_to_assembly(rotate=True) == {"FINISHED"}
    assert close(bpy.context.scene.cursor.location, center, 1e-6)
    for _ in range(2):
        assert bpy.ops.object.body_moments_assembly_empty() == {"FINISHED"}
    (made,) = [obj for obj in bpy.context.scene.objects if obj.type == "EMPTY"]
    assert close(place(made)[:3, 3], center, 1e-6)
    assert bpy.ops.object.body_moments_assembly_origin() == {"FINISHED"}
    assert close(root.instance_offset, center, 1e-6)


def test_an_empty_of_a_library_is_not_moved(reported):
    root = assembly_of_boxes()
    bpy.ops.object.body_moments_assembly_empty()
    (made,) = [obj for obj in bpy.context.scene.objects if obj.type == "EMPTY"]
    path = bpy.app.tempdir + "frame.blend"
    bpy.data.libraries.write(path, {root, made})
    bpy.data.batch_remove([*bpy.data.objects, *bpy.data.meshes, *bpy.data.collections])
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.collections, names.objects = ["Robot"], ["Robot Principal Frame"]
    bpy.context.scene.collection.children.link(names.collections[0])
    bpy.context.scene.collection.objects.link(names.objects[0])
    bpy.context.view_layer.update()
    activate(names.collections[0])
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_assembly_empty()
    assert reported.codes[-1] == "linked_object"


def test_the_bill_of_masses_is_a_table_of_all_members(tmp_path):
    root = assembly_of_boxes()
    box(root, (1, 1, 1), name="=out").hide_render = True
    path = tmp_path / "bill.csv"
    assert bpy.ops.object.body_moments_export_bill(filepath=str(path)) == {"FINISHED"}
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["level"], row["name"]) for row in rows] == [
        ("0", "Robot"), ("1", "Arm"), ("2", "b1"), ("1", "'=out"), ("1", "b0"),
    ]  # fmt: skip
    mass, center, _ = boxes_inertia(BOXES)
    assert close(float(rows[0]["mass"]), mass, 1e-14) and close(
        float(rows[0]["center_of_mass_x"]), center[0], 1e-14
    )
    assert (
        close(float(rows[2]["inertia_xx"]), 8000 * 8 / 12, 1e-14) and rows[2]["method"] == "exact"
    )
    assert rows[3]["left_out"] and rows[3]["counted"] == "false" and not rows[3]["mass"]
    with pytest.raises(RuntimeError, match="No file is named"):
        bpy.ops.object.body_moments_export_bill()


def test_point_masses_are_measured_and_listed_as_objects_are():
    made = empty(bpy.context.scene.collection, "Point", (1, 2, 3), mass=5.0)
    plain = empty(bpy.context.scene.collection, "Plain")
    bpy.context.view_layer.update()
    measure(made, plain)
    assert (
        close(made["body_mass"], 5.0, 1e-15)
        and made["body_method"] == "given"
        and "body_mass" not in plain
    )
    assert staleness.stale_reason(made, bpy.context.scene) is None
    made.body_moments.mass = 6.0
    assert staleness.stale_reason(made, bpy.context.scene) == Stale.SETTINGS
