# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping: orders of axes, empties that stay as they were, libraries, free axes and rounding of scales."""

import bpy
import numpy as np
import pytest
from body_moments.operators.snap import align, empty

from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, measured, mesh_body, only, place
from tests.operators.test_refusals import linked_assembly

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("order", align.ORDERS)
def test_an_order_names_the_axes_that_the_principal_ones_go_to_and_mirrors_nothing(order):
    frame = align.directions(order)
    assert np.linalg.det(frame) == 1.0
    signs = [1.0, 1.0, 1.0 if order in ("XYZ", "YZX", "ZXY") else -1.0]
    for column, letter, sign in zip(frame.T, order, signs, strict=True):
        assert np.array_equal(column, sign * np.eye(3)["XYZ".index(letter)])


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


def test_an_orientation_of_the_same_name_is_replaced():
    slot = bpy.context.scene.transform_orientation_slots[0]
    for number in range(2):
        obj = add(mesh_body(), rotation=(0.3, 0.4, number))
        assert bpy.ops.object.body_moments_create_orientation(name="Mine") == {"FINISHED"}
        axes = measured(obj).mass_properties.principal.axes
        assert slot.custom_orientation.name == "Mine"
        assert np.abs(np.array(slot.custom_orientation.matrix) - axes).max() < 1e-6


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
