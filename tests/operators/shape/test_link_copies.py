# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Link Copies: equal meshes become one mesh, and no vertex moves."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, only

pytestmark = pytest.mark.usefixtures("scene")


def blob(seed):
    """A closed mesh without symmetry, with UVs of its corners."""
    import bmesh

    built, random = bmesh.new(), np.random.default_rng(seed)
    bmesh.ops.create_icosphere(built, subdivisions=2, radius=1.0)
    for vertex in built.verts:
        vertex.co *= 1.0 + 0.2 * random.random()
    mesh = bpy.data.meshes.new("Blob")
    built.to_mesh(mesh)
    built.free()
    uv = mesh.uv_layers.new(name="UVMap")
    uv.data.foreach_set("uv", random.random(2 * len(mesh.loops)).astype(np.float32))
    return mesh


def turn(seed, scale=1.0, mirrored=False):
    rotation = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation)) * (-1.0 if mirrored else 1.0)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * rotation, (1.0, -2.0, 0.5)
    return Matrix(matrix)


def moved_copy(mesh, matrix, name="Copy"):
    """An object that shows the mesh in place, with the matrix in its vertices and undone by its transform."""
    copy = mesh.copy()
    copy.transform(matrix)
    if matrix.determinant() < 0.0:
        copy.flip_normals()
    obj = add(copy, name)
    obj.matrix_world = Matrix.Translation((5, 0, 0)) @ matrix.inverted() if matrix.determinant() > 0 else Matrix()
    bpy.context.view_layer.update()
    return obj


def corners(obj):
    """World points sorted by place."""
    matrix = np.array(obj.matrix_world)
    points = np.array([vertex.co for vertex in obj.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]
    return points[np.lexsort(np.round(points, 3).T)]


def link(*objects, **options):
    only(*objects)
    before = [corners(obj) for obj in objects]
    result = bpy.ops.object.body_moments_link_copies(**options)
    for obj, points in zip(objects, before):
        assert np.abs(corners(obj) - points).max() < 1e-4
    return result


@pytest.mark.parametrize("scale", [1.0, 3.0])
@pytest.mark.parametrize("mirrored", [False, True])
def test_moved_copies_share_a_mesh_and_stay(scale, mirrored):
    mesh = blob(1)
    objects = [add(mesh, "First"), *(moved_copy(mesh, turn(seed, scale, mirrored)) for seed in range(3))]
    assert link(*objects) == {"FINISHED"}
    assert {obj.data for obj in objects} == {mesh} and len(bpy.data.meshes) == 1


def test_other_uvs_are_left_unless_they_may_differ():
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2))
    second.data.uv_layers[0].data[7].uv.x += 0.1
    assert link(first, second) == {"CANCELLED"}
    assert first.data != second.data
    assert link(first, second, may_differ={"UV"}) == {"FINISHED"}
    assert first.data == second.data


def test_cube_keeps_its_uvs_in_place():
    mesh = box_mesh(2, 2, 2)
    uv = mesh.uv_layers.new(name="UVMap")
    uv.data.foreach_set("uv", np.random.default_rng(4).random(2 * len(mesh.loops)).astype(np.float32))
    first, second = add(mesh, "First"), moved_copy(mesh, Matrix.Rotation(np.pi / 2, 4, "X"))
    assert link(first, second) == {"FINISHED"} and first.data == second.data


def test_children_of_copies_stay_in_place():
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2, 2.0))
    child = add(box_mesh(1, 2, 3), "Child", (1, 1, 1))
    child.parent = second
    bpy.context.view_layer.update()
    place = np.array(child.matrix_world)
    assert link(first, second) == {"FINISHED"} and first.data == second.data
    assert np.abs(np.array(child.matrix_world) - place).max() < 1e-5


@pytest.mark.parametrize("cause", ["modifier", "constraint", "animation", "rigid body", "shear"])
def test_objects_whose_look_would_change_are_left(cause):
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2))
    if cause == "modifier":
        second.modifiers.new("Array", "ARRAY")
    elif cause == "constraint":
        second.constraints.new("LIMIT_LOCATION")
    elif cause == "animation":
        second.keyframe_insert("rotation_euler")
    elif cause == "rigid body":
        only(second)
        bpy.ops.rigidbody.object_add()
    else:
        second.scale = (1.0, 2.0, 3.0)
    bpy.context.view_layer.update()
    assert link(first, second) == {"CANCELLED"}
    assert first.data != second.data
