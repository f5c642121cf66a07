# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other origins and axes of single objects: data of each kind in float64, refusals, what is put
back.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import reframe
from body_moments.blender.scene.reframe_meshes import Plan
from mathutils import Matrix

from tests.blender.findings import refused
from tests.blender.objects import add, mesh_body, place, seen
from tests.blender.spline_bodies import surface

pytestmark = pytest.mark.usefixtures("scene")
CHANGE = np.array(
    [[0.0, -1.5, 0.25, 1.0], [1.5, 0.0, 0.0, -2.0], [0.0, 0.25, 1.5, 3.0], [0.0, 0.0, 0.0, 1.0]]
)


def points_of(collection, name):
    row = np.empty(3 * len(collection), np.float32)
    collection.foreach_get(name, row)
    return row.reshape(-1, 3).astype(float)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("far", [0.0, 1e4])
def test_points_and_shape_keys_are_rounded_once(mirrored, far):
    obj = add(mesh_body())
    for name in ("Basis", "Tall"):
        obj.shape_key_add(name=name)
    keys = obj.data.shape_keys.key_blocks
    for key in keys:
        for vertex, point in enumerate(key.data):
            point.co = np.array(point.co) * (1.0 + 0.1 * vertex) + far
    obj.data.vertices.foreach_set("co", points_of(keys[0].data, "co").astype(np.float32).ravel())
    change = CHANGE * ((-1.0,), (1.0,), (1.0,), (1.0,)) if mirrored else CHANGE
    wanted = [
        (points_of(one, "co") @ change[:3, :3].T + change[:3, 3]).astype(np.float32)
        for one in (obj.data.vertices, *(key.data for key in keys))
    ]
    faces = [tuple(face.vertices) for face in obj.data.polygons]
    reframe.transform_data(obj.data, change)
    for one, points in zip((obj.data.vertices, *(key.data for key in keys)), wanted):
        assert np.array_equal(points_of(one, "co"), points)
    turned = [tuple(face.vertices) for face in obj.data.polygons]
    assert (turned == faces) != mirrored and [set(face) for face in turned] == [
        set(face) for face in faces
    ]


def test_data_of_each_kind_is_transformed():
    patch = surface(np.random.default_rng(1).normal(size=(4, 4, 3)))
    patch.shape_key_add(name="Basis")
    bpy.ops.object.metaball_add()
    ball = bpy.context.object
    for obj, points in (
        (patch, lambda: patch.data.splines[0].points),
        (ball, lambda: ball.data.elements),
    ):
        before = np.array([tuple(point.co)[:3] for point in points()])
        reframe.transform_data(obj.data, CHANGE)
        now = np.array([tuple(point.co)[:3] for point in points()])
        assert np.abs(now - before @ CHANGE[:3, :3].T - CHANGE[:3, 3]).max() < 1e-5
    key = np.array([tuple(point.co)[:3] for point in patch.data.shape_keys.key_blocks[0].data])
    assert (
        np.abs(key - [tuple(point.co)[:3] for point in patch.data.splines[0].points]).max() < 1e-5
    )


def target_of(obj, turn=0.5, shift=(1.0, 2.0, 3.0)):
    matrix = np.array(Matrix.Rotation(turn, 4, "Z") @ obj.matrix_world, np.float64)
    matrix[:3, 3] += shift
    return matrix


def parented(parent_type):
    parent = add(mesh_body("Parent"), "Parent", (0.5, 1, 2), (0.2, 0.1, 0.4), (2, 2, 2))
    obj = add(mesh_body(), location=(3, 0, 0))
    obj.parent = parent
    if parent_type == "BONE":
        rig = add(bpy.data.armatures.new("Rig"), "Rig", (1, 1, 1), (0.1, 0.2, 0.3))
        bpy.ops.object.mode_set(mode="EDIT")
        bone = rig.data.edit_bones.new("Bone")
        bone.head, bone.tail = (0, 0, 0), (0, 1, 1)
        bpy.ops.object.mode_set(mode="OBJECT")
        obj.parent, obj.parent_bone = rig, "Bone"
    obj.parent_type = parent_type
    if parent_type == "VERTEX":
        obj.parent_vertices = (1, 0, 0)
    bpy.context.view_layer.update()
    return obj


@pytest.mark.parametrize("parent_type", ["OBJECT", "BONE", "VERTEX"])
def test_below_a_parent_of_each_kind_the_body_stays(parent_type):
    obj = parented(parent_type)
    before, target = seen(obj), target_of(obj)
    done, refusals = reframe.reframe(bpy.context, [Plan(obj, target, 3.0, False)])
    assert [plan.obj for plan in done] == [obj] and refusals == []
    assert np.abs(place(obj) - target).max() < 1e-5 and np.abs(seen(obj) - before).max() < 2e-5


def test_a_scale_of_zero_below_a_bone_and_above_is_refused():
    obj = parented("BONE")
    target = target_of(obj)
    obj.scale.x = 0.0
    bpy.context.view_layer.update()
    with refused("scale_zero_axis"):
        reframe.run_change(bpy.context, reframe.set_world_matrix(Plan(obj, target, 3.0, False)))
    obj = parented("OBJECT")
    target = target_of(obj)
    obj.parent.scale.y = 0.0
    bpy.context.view_layer.update()
    with refused("scale_zero_axis"):
        reframe.run_change(bpy.context, reframe.set_world_matrix(Plan(obj, target, 3.0, False)))


def test_the_same_change_of_shared_data_is_made_once():
    """Of three that share a mesh and want the same, and one that wants something else."""
    mesh = mesh_body()
    objects = [add(mesh, "Body {:d}".format(i), (10.0 * i, 0, 0), select=False) for i in range(4)]
    for obj in objects:
        obj.modifiers.new("Triangulate", "TRIANGULATE")
    bpy.context.view_layer.update()
    shifts = [(float(obj == objects[3]), 2, 3) for obj in objects]
    plans = [
        Plan(obj, target_of(obj, 0.0, shift), 3.0, True) for obj, shift in zip(objects, shifts)
    ]
    before = [seen(obj) for obj in objects]
    progress = []
    done, refusals = reframe.reframe(bpy.context, plans, progress.append)
    assert done == plans and not refusals and progress == [0, 3, 4]
    assert objects[0].data == objects[1].data == objects[2].data != objects[3].data
    assert max(np.abs(seen(obj) - was).max() for obj, was in zip(objects, before)) < 1e-5


def test_free_normals_turn_with_the_points():
    mesh = add(mesh_body()).data
    normals = np.random.default_rng(1).normal(size=(len(mesh.loops), 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set(
        "vector", normals.ravel()
    )
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    change = np.eye(4)
    change[:3, :3] = turn
    reframe.transform_data(mesh, change)
    found = np.array([tuple(corner.vector) for corner in mesh.corner_normals])
    assert np.abs(found - normals @ turn.T).max() < 1e-5
