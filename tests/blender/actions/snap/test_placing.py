# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What snapping operators share: what counts as being there, what is stored again, and from where orientations are
made."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.verdict.finding import EditRefusedError
from body_moments.operators.actions.snap import align, base, empty, orientation
from body_moments.operators.session import staleness

from tests.blender.actions.test_refusals import linked_assembly
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, measured, mesh_body, only, place

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("center", [(0.0, 0.0, 0.0), (3.0, -40.0, 5.0)])
@pytest.mark.parametrize("size", [0.01, 20.0])
@pytest.mark.parametrize("share", [0.99, 1.01])
def test_an_empty_is_there_within_a_millionth_of_size_and_distance_and_along_principal_axes(center, size, share):
    frames = []
    body = SimpleNamespace(size=size, center=np.array(center), is_principal=lambda frame: frames.append(frame) or right)
    matrix = np.eye(4)
    matrix[:3, :3] = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    matrix[:3, 3] = center
    matrix[0, 3] -= share * 1e-6 * (size + np.abs(center).max())
    for right in (True, False):
        there = empty._is_there(SimpleNamespace(matrix_world=matrix.tolist()), body)
        assert there is (right and share < 1.0)
    assert all(np.array_equal(frame, matrix[:3, :3]) for frame in frames) and bool(frames) == (share < 1.0)


@pytest.mark.parametrize("order", align.ORDERS)
def test_an_order_names_the_axes_that_the_principal_ones_go_to_and_mirrors_nothing(order):
    frame = align.directions(order)
    assert np.linalg.det(frame) == 1.0
    signs = [1.0, 1.0, 1.0 if order in ("XYZ", "YZX", "ZXY") else -1.0]
    for column, letter, sign in zip(frame.T, order, signs, strict=True):
        assert np.array_equal(column, sign * np.eye(3)["XYZ".index(letter)])


def test_what_cannot_be_measured_or_stored_again_keeps_its_numbers_and_the_others_get_theirs(monkeypatch, capfd):
    names = ("Good", "Fails", "Refused", "Held")
    objects = [add(mesh_body(name), name, (4 * place, 0, 0)) for place, name in enumerate(names)]
    plain = add(mesh_body("Plain"), "Plain", (20, 0, 0))
    only(*objects)
    bpy.ops.object.body_moments_measure()
    mass = objects[0]["body_mass"]
    for obj in objects:
        obj.scale.z = 2.0
    measure_many, store_many = base.measure_many, base.results.store_many

    def measured(unknown, *more):
        errors = {"Fails": ZeroDivisionError("planted failure"), "Refused": EditRefusedError("open_object")}
        for together in measure_many(unknown, *more):
            yield [(obj, errors.get(obj.name, found)) for obj, found in together]

    def stored(found, *more):
        yield from store_many([item for item in found if item[0].name != "Held"], *more)
        yield objects[3], TypeError("planted refusal")

    monkeypatch.setattr(base, "measure_many", measured)
    monkeypatch.setattr(base.results, "store_many", stored)
    base.remeasure(bpy.context, [*objects, plain])
    bpy.context.view_layer.update()
    assert [obj["body_mass"] / mass for obj in objects] == pytest.approx([2.0, 1.0, 1.0, 1.0])
    assert "body_mass" not in plain
    reasons = [staleness.stale_reason(obj, bpy.context.scene) for obj in objects]
    assert reasons == [None, *["stale_transform"] * 3]
    objects[0].data.update_tag()  # which Blender reports as a change of the shape, without one
    bpy.context.view_layer.update()
    assert staleness.stale_reason(objects[0], bpy.context.scene) is None
    said = capfd.readouterr().err
    assert "planted failure" in said and "planted refusal" in said and "open_object" not in said


@pytest.mark.parametrize("known", [False, True])
def test_what_is_known_of_an_object_is_stored_without_measuring_it(known, monkeypatch):
    obj, other = (add(mesh_body(name), name, (place, 0, 0)) for name, place in (("a", 0), ("b", 5)))
    only(obj, other)
    bpy.ops.object.body_moments_measure()
    obj["body_mass"] = other["body_mass"] = 1.0
    asked, measure_many = [], base.measure_many
    monkeypatch.setattr(base, "measure_many", lambda found, *more: asked.extend(found) or measure_many(found, *more))
    found = base.measure_body(obj, bpy.context.evaluated_depsgraph_get(), base.POSE)
    base.remeasure(bpy.context, [obj, other], {obj: found} if known else {})
    assert obj["body_mass"] == other["body_mass"] > 1.0 and asked == ([other] if known else [obj, other])


def test_nothing_is_evaluated_where_nothing_is_stored(monkeypatch):
    obj = add(box_mesh(2, 2, 2))
    monkeypatch.setattr(base, "measure_many", None)
    base.remeasure(bpy.context, [obj])
    assert "body_mass" not in obj


def window(*kinds):
    areas = [
        SimpleNamespace(type=kind, regions=[SimpleNamespace(type="HEADER"), SimpleNamespace(type="WINDOW", of=kind)])
        for kind in kinds
    ]
    return SimpleNamespace(screen=SimpleNamespace(areas=areas))


def test_an_orientation_is_made_in_the_view_of_its_window_before_others():
    own, other, without = window("IMAGE_EDITOR", "VIEW_3D"), window("VIEW_3D"), window("IMAGE_EDITOR")
    manager = SimpleNamespace(windows=[other, own, without])
    for current, expected in ((own, own), (other, other), (without, other), (None, other)):
        place = orientation._view_3d(SimpleNamespace(window=current, window_manager=manager))
        assert place["window"] is expected and place["area"] in expected.screen.areas
        assert place["area"].type == place["region"].of == "VIEW_3D" and place["region"].type == "WINDOW"
    alone = SimpleNamespace(windows=[without])
    assert orientation._view_3d(SimpleNamespace(window=without, window_manager=alone)) is None


def test_without_a_view_it_is_said_that_an_orientation_needs_one(reported, monkeypatch):
    add(mesh_body())
    monkeypatch.setattr(orientation, "_view_3d", lambda context: None)
    assert bpy.ops.object.body_moments_create_orientation() == {"CANCELLED"}
    assert reported.codes == ["orientation_needs_viewport"]


def about_z(angle):
    return np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])


def target(moments, shape_axes=(), is_unique=False):
    inertia = np.diag(np.array(moments, float))
    return base.SnapTarget(
        None, np.zeros(3), np.eye(3), inertia, np.array([1.0, 5.0, 2.0]), 1.0, None, shape_axes, is_unique
    )


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_axes_are_principal_as_long_as_products_and_order_hold_to_rounding(share):
    assert target((1, 2, 3)).size == 5.0
    limit = 6.0 * base.DIAGONAL_RTOL
    assert target((1, 2, 3)).is_principal(about_z(share * limit)) is (share < 1.0)
    limit = 5.0 * base.DIAGONAL_RTOL  # the larger of two moments comes first by this
    assert target((1, 1 + share * limit, 3)).is_principal(about_z(np.pi / 2)) is (share < 1.0)
    assert not target((1, 2, 3)).is_principal(about_z(np.pi / 2))


def test_axes_that_nothing_fixes_may_turn_by_less_than_a_third_and_others_as_the_shape_allows():
    free = target((1, 1, 3))
    assert free.is_principal(about_z(np.radians(119.0))) and not free.is_principal(about_z(np.radians(121.0)))
    assert not target((1, 2, 3)).is_principal(np.diag([-1.0, -1.0, 1.0]))
    cube, unique = (target((1, 1, 1), (0, 1, 2), is_unique) for is_unique in (False, True))
    for turn in (np.diag([-1.0, -1.0, 1.0]), about_z(np.pi / 2)):
        assert cube.is_principal(turn) and not unique.is_principal(turn)
    assert not cube.is_principal(about_z(np.pi / 4))
    for one in (cube, unique):
        assert one.is_principal(about_z(0.99 * base.MAX_DIRECTION_NOISE))
        assert not one.is_principal(about_z(1.01 * base.MAX_DIRECTION_NOISE))


def test_an_empty_that_cannot_be_placed_is_as_it_was_parent_and_size_and_all(reported):
    obj, other = add(mesh_body()), add(mesh_body("Other"), "Other", (9, 0, 0))
    only(obj)
    assert bpy.ops.object.body_moments_add_empty(parent=False) == {"FINISHED"}
    made = next(one for one in bpy.data.objects if one.type == "EMPTY")
    made.parent, made.matrix_parent_inverse = other, other.matrix_world.inverted()
    limit = made.constraints.new("LIMIT_LOCATION")
    limit.use_max_x, limit.max_x = True, 0.0
    obj.location.x += 5.0
    bpy.context.view_layer.update()
    names = (*empty.RESTORED_PROPERTIES, "matrix_parent_inverse", "location", "rotation_quaternion", "scale")
    before = {name: getattr(made, name) for name in names}
    before = {
        name: value.copy() if hasattr(value, "copy") and name != "parent" else value for name, value in before.items()
    }
    assert bpy.ops.object.body_moments_add_empty(parent=True, size=3.0) == {"CANCELLED"}
    assert "empty_constrained" in reported.codes
    assert {name: getattr(made, name) for name in names} == before


def test_a_mesh_with_the_mark_of_an_empty_is_not_moved():
    obj, other = add(mesh_body()), add(mesh_body("Other"), "Other", (9, 0, 0))
    other[empty.OBJECT_KEY] = obj
    only(obj)
    assert bpy.ops.object.body_moments_add_empty() == {"FINISHED"}
    assert tuple(other.location) == (9.0, 0.0, 0.0) and other.parent is None
    assert [one.parent for one in bpy.data.objects if one.type == "EMPTY"] == [obj]


@pytest.mark.parametrize("overridden", [False, True])
def test_an_empty_is_not_put_into_a_collection_of_a_library(overridden):
    linked_assembly()
    scene = bpy.context.scene
    (collection,) = scene.collection.children
    if overridden:
        collection = collection.override_hierarchy_create(scene, bpy.context.view_layer)
    obj = next(one for one in collection.objects if one.name == "b0")
    only(obj)
    assert bpy.ops.object.body_moments_add_empty(parent=False) == {"FINISHED"}
    (made,) = [one for one in bpy.data.objects if one.type == "EMPTY" and one.get(empty.OBJECT_KEY) == obj]
    assert [*made.users_collection] == [scene.collection]


@pytest.mark.parametrize(
    ("operator", "options"),
    [
        ("object.body_moments_add_empty", {"parent": False}),
        ("object.body_moments_create_orientation", {}),
        ("view3d.body_moments_cursor_to_center", {"rotate": True}),
    ],
)
def test_the_axes_of_a_cube_are_its_sides_and_it_is_said_that_they_were_free(operator, options, reported):
    obj = add(box_mesh(2, 2, 2), "Cube", (1, 2, 3), (0.3, 0.4, 0.5))
    for vertex in obj.data.vertices:
        vertex.co.x += 1.0
    sides, free = place(obj)[:3, :3], measured(obj).mass_properties.principal.finding
    scene = bpy.context.scene
    category, name = operator.split(".")
    assert getattr(getattr(bpy.ops, category), name)(**options) == {"FINISHED"}
    frames = {
        "add_empty": lambda: bpy.data.objects["Cube Principal Frame"].matrix_world,
        "create_orientation": lambda: scene.transform_orientation_slots[0].custom_orientation.matrix,
        "cursor_to_center": lambda: scene.cursor.matrix,
    }
    axes = np.array(frames[name.removeprefix("body_moments_")]())[:3, :3]
    cosines = np.abs(sides.T @ axes)
    assert np.abs(cosines - np.round(cosines)).max() < 1e-5
    assert reported.codes[1:] == [free.code]
    assert reported[1] == (free.of_sources(["Cube"]) if "empty" in name else free)
    if "cursor" in name:
        reported.clear()
        assert bpy.ops.view3d.body_moments_cursor_to_center() == {"FINISHED"} and reported.codes == ["cursor_moved"]


def test_the_cursor_has_nowhere_to_go_where_nothing_has_mass(reported):
    only(add(None, "Empty"))
    assert bpy.ops.view3d.body_moments_cursor_to_center() == {"CANCELLED"}
    assert reported.codes == ["nothing_measurable"]


def test_an_orientation_of_the_same_name_is_replaced():
    slot = bpy.context.scene.transform_orientation_slots[0]
    for number in range(2):
        obj = add(mesh_body(), rotation=(0.3, 0.4, number))
        assert bpy.ops.object.body_moments_create_orientation(name="Mine") == {"FINISHED"}
        axes = measured(obj).mass_properties.principal.axes
        assert slot.custom_orientation.name == "Mine"
        assert np.abs(np.array(slot.custom_orientation.matrix) - axes).max() < 1e-6


def test_orders_are_named_by_where_each_axis_points():
    prop = bpy.ops.object.body_moments_align_to_world.get_rna_type().properties["order"]
    assert [item.identifier for item in prop.enum_items] == [*align.ORDERS]
    for item in prop.enum_items:
        first, second, third = item.identifier
        sign = "−" if align.directions(item.identifier)[:, 2].min() < 0.0 else ""
        assert item.name == f"1 → {first}, 2 → {second}, 3 → {sign}{third}"


@pytest.mark.parametrize("operator", ["axes_to_principal", "rigid_bodies"])
@pytest.mark.parametrize(
    ("rotation", "scale", "is_kept"),
    [
        ((0, 0, 0), (4, 4, 4), True),
        ((0, 0, 0), (5, 5, 5), False),
        ((-np.arcsin(3.0**-0.5), np.pi / 4, 0), (0, 0, 2), True),
        ((-np.arcsin(3.0**-0.5), np.pi / 4, 0), (0, 0, 8), False),
    ],
)
def test_a_scale_that_is_one_but_for_rounding_stays(rotation, scale, is_kept, operator):
    """By so many last places; by twice as many products of axes differ from one."""
    wanted = 1.0 + np.array(scale) * 2.0**-23
    obj = add(box_mesh(4, 2, 1), "Box", rotation=rotation, scale=wanted)
    getattr(bpy.ops.object, "body_moments_" + operator)()
    assert (np.array(obj.scale, np.float64) == (wanted if is_kept else 1.0)).all()


def test_a_cube_that_is_mirrored_gets_axes_that_are_not():
    obj = add(box_mesh(2, 2, 2), "Cube", scale=(-1, 1, 1))
    assert bpy.ops.object.body_moments_axes_to_principal() == {"FINISHED"}
    assert np.linalg.det(place(obj)[:3, :3]) > 0.0
