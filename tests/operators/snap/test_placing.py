# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping: orders of axes, empties that stay as they were, libraries, free axes and rounding of
scales.
"""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import empties
from body_moments.core.inertia.findings import DIRECTIONS_OF_SHAPE

from tests.blender.boxes import box_mesh
from tests.blender.objects import add, measured, mesh_body, only, place
from tests.operators.assemblies import linked_assembly

pytestmark = pytest.mark.usefixtures("scene")


def test_refused_empty_keeps_parent_place_and_size(reported):
    obj, other = add(mesh_body()), add(mesh_body("Other"), "Other", (9, 0, 0))
    only(obj)
    assert bpy.ops.object.body_moments_add_empty(parent=False) == {"FINISHED"}
    made = next(one for one in bpy.data.objects if one.type == "EMPTY")
    made.parent, made.matrix_parent_inverse = other, other.matrix_world.inverted()
    limit = made.constraints.new("LIMIT_LOCATION")
    limit.use_max_x, limit.max_x = True, 0.0
    obj.location.x += 5.0
    bpy.context.view_layer.update()
    names = (
        *empties.RESTORED_PROPERTIES,
        "matrix_parent_inverse",
        "location",
        "rotation_quaternion",
        "scale",
    )
    before = {name: getattr(made, name) for name in names}
    before = {
        name: value.copy() if hasattr(value, "copy") and name != "parent" else value
        for name, value in before.items()
    }
    assert bpy.ops.object.body_moments_add_empty(parent=True, size=3.0) == {"CANCELLED"}
    assert "transform_constrained" in reported.codes
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
    (made,) = [
        one
        for one in bpy.data.objects
        if one.type == "EMPTY" and one.get(empties.OBJECT_KEY) == obj
    ]
    assert [*made.users_collection] == [scene.collection]


@pytest.mark.parametrize(
    ("operator", "options"),
    [
        ("object.body_moments_add_empty", {"parent": False}),
        ("object.body_moments_create_orientation", {}),
        ("view3d.body_moments_cursor_to_center", {"rotate": True}),
    ],
)
def test_axes_of_a_cube_are_its_sides(operator, options, reported):
    obj = add(box_mesh(2, 2, 2), "Cube", (1, 2, 3), (0.3, 0.4, 0.5))
    for vertex in obj.data.vertices:
        vertex.co.x += 1.0
    sides, free = place(obj)[:3, :3], measured(obj).mass_properties.principal.finding
    scene = bpy.context.scene
    category, name = operator.split(".")
    assert getattr(getattr(bpy.ops, category), name)(**options) == {"FINISHED"}
    frames = {
        "add_empty": lambda: bpy.data.objects["Cube Principal Frame"].matrix_world,
        "create_orientation": lambda: (
            scene.transform_orientation_slots[0].custom_orientation.matrix
        ),
        "cursor_to_center": lambda: scene.cursor.matrix,
    }
    axes = np.array(frames[name.removeprefix("body_moments_")]())[:3, :3]
    cosines = np.abs(sides.T @ axes)
    assert np.abs(cosines - np.round(cosines)).max() < 1e-5
    if "cursor" not in name:  # these search by higher moments, the cursor takes the stored axes
        free = replace(free, values={**free.values, "choice": DIRECTIONS_OF_SHAPE})
    assert reported.codes == [free.code]
    assert reported[0] == (free.of_sources(["Cube"]) if "empty" in name else free)
    if "cursor" in name:
        reported.clear()
        assert (
            bpy.ops.view3d.body_moments_cursor_to_center() == {"FINISHED"} and reported.codes == []
        )
