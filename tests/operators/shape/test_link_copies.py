# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Link Copies: equal meshes become one mesh, and no vertex moves."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import outcome
from body_moments.blender.session.tracking import staleness
from mathutils import Matrix

from tests.blender.boxes import box_mesh
from tests.blender.objects import add, editing, measure, mesh_of, only

pytestmark = pytest.mark.usefixtures("scene")


def blob(seed):
    """A closed mesh without symmetry, with UVs of its corners."""
    import bmesh

    random = np.random.default_rng(seed)
    mesh = bpy.data.meshes.new("Blob")
    with editing(mesh) as built:
        bmesh.ops.create_icosphere(built, subdivisions=2, radius=1.0)
        for vertex in built.verts:
            vertex.co *= 1.0 + 0.2 * random.random()
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
    """An object that shows the mesh in place, with the matrix in its vertices and undone by its
    transform.
    """
    copy = mesh.copy()
    copy.transform(matrix)
    if matrix.determinant() < 0.0:
        copy.flip_normals()
    obj = add(copy, name)
    obj.matrix_world = (
        Matrix.Translation((5, 0, 0)) @ matrix.inverted() if matrix.determinant() > 0 else Matrix()
    )
    bpy.context.view_layer.update()
    return obj


def corners(obj):
    """World points sorted by place."""
    matrix = np.array(obj.matrix_world)
    points = (
        np.array([vertex.co for vertex in obj.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]
    )
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
    objects = [
        add(mesh, "First"),
        *(moved_copy(mesh, turn(seed, scale, mirrored)) for seed in range(3)),
    ]
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
    uv.data.foreach_set(
        "uv", np.random.default_rng(4).random(2 * len(mesh.loops)).astype(np.float32)
    )
    first, second = add(mesh, "First"), moved_copy(mesh, Matrix.Rotation(np.pi / 2, 4, "X"))
    assert link(first, second) == {"FINISHED"} and first.data == second.data


def test_children_of_copies_stay_in_place():
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2, 2.0))
    child = add(box_mesh(1, 2, 3), "Child", (1, 1, 1), parent=second)
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


def parented(obj, matrix):
    parent = add(None, "Parent", select=False)
    parent.matrix_world = matrix
    obj.parent = parent
    bpy.context.view_layer.update()
    return parent


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (1.0, 2.0, 3.0)])
def test_copies_below_mirrored_and_shearing_parents_stay(scale):
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2))
    second.matrix_world = Matrix.Rotation(0.7, 4, "X") @ Matrix.Scale(2.0, 4)
    parented(second, Matrix.Diagonal((*scale, 1.0)))
    assert link(first, second) == {"FINISHED"} and first.data == second.data


def scrambled(mesh, seed):
    """A copy with its vertices and faces numbered in another order, with one layer of UVs."""
    random = np.random.default_rng(seed)
    order, faces = random.permutation(len(mesh.vertices)), random.permutation(len(mesh.polygons))
    number, points = np.argsort(order), [mesh.vertices[i].co for i in order]
    made = mesh_of(
        points, [number[list(mesh.polygons[i].vertices)].tolist() for i in faces], "Scrambled"
    )
    corners = [corner for i in faces for corner in mesh.polygons[i].loop_indices]
    uv = np.array([mesh.uv_layers[0].data[corner].uv for corner in corners], np.float32)
    made.uv_layers.new(name="UVMap").data.foreach_set("uv", uv.ravel())
    return made


def test_scrambled_copies_share_unless_a_modifier_shows_it():
    mesh = blob(1)
    first, second, third = (
        add(data, "A") for data in (mesh, scrambled(mesh, 1), scrambled(mesh, 2))
    )
    third.modifiers.new("Wave", "WAVE")
    assert link(first, second, third) == {"FINISHED"}
    assert first.data == second.data != third.data
    assert outcome.last().groups[0].finding.code == "modifiers_change_shape"


@pytest.mark.parametrize(
    "aspect", ["material", "shape key", "group", "property", "attribute", "animation"]
)
def test_meshes_that_differ_otherwise_are_left(aspect):
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2))
    if aspect == "material":
        second.data.materials.append(bpy.data.materials.new("Other"))
    elif aspect == "shape key":
        second.shape_key_add(name="Basis")
        second.shape_key_add(name="Key").data[0].co.x += 0.5
    elif aspect == "group":
        second.vertex_groups.new(name="Group").add([1], 0.5, "REPLACE")
    elif aspect == "property":
        second.data["number"] = 5
    elif aspect == "attribute":
        second.data.attributes.new("extra", "FLOAT", "POINT").data[3].value = 1.0
    else:
        second.data.animation_data_create()
    assert link(first, second) == {"CANCELLED"} and first.data != second.data
    (group,) = outcome.last().groups
    assert group.finding.code == "copy_differs" and group.objects == ("Copy",)


def test_equal_shape_keys_and_groups_are_shared():
    mesh = blob(1)
    first = add(mesh, "First")
    first.vertex_groups.new(name="Group").add([1, 5], 0.5, "REPLACE")
    first.shape_key_add(name="Basis")
    first.shape_key_add(name="Key").data[0].co.x += 0.5
    second = moved_copy(mesh, Matrix.Identity(4))
    for block in second.data.shape_keys.key_blocks:
        for point in block.data:
            point.co = turn(3) @ point.co
    second.data.transform(turn(3), shape_keys=False)
    second.matrix_world = turn(3).inverted()
    bpy.context.view_layer.update()
    assert link(first, second) == {"FINISHED"} and first.data == second.data


@pytest.mark.parametrize(
    "cause",
    ["driver", "mesh driver", "scene driver", "path driver", "context driver", "constraint"]
    + ["bone", "bone shape", "modifier", "material", "linked"],
)
def test_objects_that_others_follow_or_shade_are_left(cause, tmp_path):
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2))
    other = add(box_mesh(1, 1, 1), "Other", (9, 9, 9))
    if "driver" in cause:
        owner = bpy.context.scene if cause == "scene driver" else other
        owner["value"] = 0.0
        variable = owner.driver_add('["value"]').driver.variables.new()
        variable.type = "CONTEXT_PROP" if cause == "context driver" else "SINGLE_PROP"
        target = variable.targets[0]
        if cause == "context driver":
            target.data_path = 'objects["Copy"].location.x'
        elif cause == "path driver":
            middle = add(None, "Middle", parent=second)
            target.id, target.data_path = middle, "parent.location.x"
        elif cause == "mesh driver":
            target.id_type = "MESH"
            target.id, target.data_path = second.data, "vertices[0].co[0]"
        else:
            target.id, target.data_path = second, "location.x"
    elif "bone" in cause:
        rig = add(bpy.data.armatures.new("Rig"), "Rig")
        bpy.context.view_layer.objects.active = rig
        bpy.ops.object.mode_set(mode="EDIT")
        rig.data.edit_bones.new("Bone").tail = 0, 0, 1
        bpy.ops.object.mode_set(mode="OBJECT")
        if cause == "bone":
            rig.pose.bones[0].constraints.new("COPY_ROTATION").target = second
        else:
            rig.pose.bones[0].custom_shape = second
    elif cause == "modifier":
        mirror = other.modifiers.new("Mirror", "MIRROR")
        mirror.mirror_object = second
        mirror.show_viewport = False
    elif cause == "constraint":
        other.constraints.new("TRACK_TO").target = second
        other.constraints[0].influence = 0.0
    elif cause == "material":
        material = bpy.data.materials.new("Wood")
        material.use_nodes = True
        noise = material.node_tree.nodes.new("ShaderNodeTexNoise")
        material.node_tree.links.new(
            noise.outputs[0], material.node_tree.nodes["Principled BSDF"].inputs[0]
        )
        for obj in (first, second):
            obj.data.materials.append(material)
    else:
        path = str(tmp_path / "library.blend")
        bpy.data.libraries.write(path, {second})
        bpy.data.objects.remove(second)
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.objects = ["Copy"]
        (second,) = target.objects
        bpy.context.scene.collection.objects.link(second)
    bpy.context.view_layer.update()
    assert link(first, second) == {"CANCELLED"} and first.data != second.data


def test_instances_and_stored_numbers_stay():
    mesh = blob(1)
    first, second = add(mesh, "First"), moved_copy(mesh, turn(2, 2.0))
    group = bpy.data.collections.new("Group")
    group.objects.link(second)
    shown = add(None, "Shown", (0, 20, 0))
    shown.instance_type, shown.instance_collection = "COLLECTION", group
    measure(first, second)
    mass, scene = second["body_mass"], bpy.context.scene
    assert link(first, second) == {"FINISHED"} and first.data == second.data
    assert (
        abs(second["body_mass"] / mass - 1.0) < 1e-5
        and staleness.stale_reason(second, scene) is None
    )
    matrices = [
        item.matrix_world.copy() for item in bpy.context.evaluated_depsgraph_get().object_instances
    ]
    assert any(
        (matrix.translation - second.matrix_world.translation).length > 19.9 for matrix in matrices
    )
