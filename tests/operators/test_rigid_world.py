# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies and joints where the scene has no rigid body world, or one whose collections are
linked; and where the collection of what was made for an armature is not shown.
"""

import bpy
import pytest

from tests.blender.objects import add, mesh_body, only
from tests.operators.characters import character

pytestmark = pytest.mark.usefixtures("scene")
OPERATORS = {  # and whether they add joints
    "physics_rig": ({}, True),
    "rigid_bodies": ({}, False),
    "set_rigid_body_mass": ({"add": True}, False),
    "equal_inertia": ({"rigid_body": True}, False),
}


def state():
    """Return the place of each object, whether it has a rigid body or a joint, and the members of
    collections.
    """
    return {
        obj.name: (
            obj.matrix_world.copy(),
            obj.rigid_body is None,
            obj.rigid_body_constraint is None,
        )
        for obj in bpy.data.objects
    }, {one.name: sorted(obj.name for obj in one.objects) for one in bpy.data.collections}


def run(name):
    """What comes of it; an error counts as canceled."""
    try:
        return getattr(bpy.ops.object, "body_moments_" + name)(**OPERATORS.get(name, ({},))[0])
    except RuntimeError as error:
        assert "Traceback" not in str(error)
        return {"CANCELLED"}


@pytest.fixture
def linked(tmp_path):
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {bpy.data.collections.new("Linked")})
    bpy.data.collections.remove(bpy.data.collections["Linked"])
    with bpy.data.libraries.load(path, link=True) as (_, chosen):
        chosen.collections = ["Linked"]
    return bpy.data.collections["Linked"]


@pytest.mark.parametrize("overridden", [False, True])
@pytest.mark.parametrize("of", ["collection", "constraints"])
@pytest.mark.parametrize("name", OPERATORS)
def test_nothing_is_added_to_a_collection_of_a_library(name, of, overridden, linked, reported):
    if overridden:
        bpy.context.scene.collection.children.link(linked)
        linked = linked.override_create(remap_local_usages=True)
        assert linked.override_library
    obj = character()[0] if name == "physics_rig" else add(mesh_body())
    only(obj)
    bpy.ops.rigidbody.world_add()
    setattr(bpy.context.scene.rigidbody_world, of, linked)
    before = state()
    is_refused = of == "collection" or OPERATORS[name][1]
    assert run(name) == ({"CANCELLED"} if is_refused else {"FINISHED"})
    if is_refused:
        assert reported.values("rigid_world_linked") == {"collection": "Linked"}
        assert state() == before
    else:
        assert "rigid_world_linked" not in reported.codes


@pytest.mark.parametrize("name", OPERATORS)
def test_a_world_without_collections_gets_them(name):
    only(character()[0] if name == "physics_rig" else add(mesh_body()))
    bpy.ops.rigidbody.world_add()
    assert (
        bpy.context.scene.rigidbody_world.collection
        is bpy.context.scene.rigidbody_world.constraints
        is None
    )
    assert run(name) == {"FINISHED"}
    assert len(bpy.context.scene.rigidbody_world.collection.objects) > 0


def test_existing_rigid_body_is_set_in_linked_world(linked):
    obj = add(mesh_body())
    bpy.ops.rigidbody.object_add()
    bpy.context.scene.rigidbody_world.collection = linked
    assert (
        obj.rigid_body
        and run("set_rigid_body_mass") == {"FINISHED"}
        and obj.rigid_body.mass > 100.0
    )


def test_joint_is_moved_or_object_is_unchanged(linked, reported):
    obj = add(mesh_body())
    bpy.ops.rigidbody.world_add()
    bpy.ops.rigidbody.constraint_add(type="HINGE")
    bpy.context.scene.rigidbody_world.constraints = linked
    before = state()
    assert run("rigid_bodies") == {"CANCELLED"} and state() == before
    assert reported.values("rigid_world_linked") == {"collection": "Linked"}
    bpy.ops.rigidbody.world_remove()
    assert bpy.context.scene.rigidbody_world is None
    assert run("rigid_bodies") == {"FINISHED"}
    assert (
        bpy.data.objects["Body Joint"].rigid_body_constraint.type == "HINGE"
        and obj.rigid_body_constraint is None
    )


HIDDEN = {
    "excluded": lambda layer: setattr(layer, "exclude", True),
    "hidden": lambda layer: setattr(layer, "hide_viewport", True),
    "switched off": lambda layer: setattr(layer.collection, "hide_viewport", True),
}


def layer_of(collection):
    return next(
        one
        for parent in (
            bpy.context.view_layer.layer_collection,
            *bpy.context.view_layer.layer_collection.children,
        )
        for one in parent.children
        if one.collection == collection
    )


@pytest.mark.parametrize("how", HIDDEN)
@pytest.mark.parametrize("is_nested", [False, True])
@pytest.mark.parametrize(
    ("name", "key"), [("physics_rig", "physics_rig_of"), ("rig_center", "center_of_mass_of")]
)
def test_rig_objects_in_hidden_collection_are_replaced(name, key, is_nested, how):
    armature, _ = character()
    assert run(name) == {"FINISHED"}
    (collection,) = [one for one in bpy.data.collections if one.get(key) == armature]
    if is_nested:
        bpy.context.scene.collection.children.unlink(collection)
        bpy.context.scene.collection.children.link(outer := bpy.data.collections.new("Outer"))
        outer.children.link(collection)
    mine = bpy.data.objects.new("Mine", bpy.data.meshes.new("Mine"))
    collection.objects.link(mine)
    before = sorted(obj.name for obj in bpy.data.objects)
    meshes = len(bpy.data.meshes)
    HIDDEN[how](layer_of(collection))
    only(armature)
    assert run(name) == {"FINISHED"}
    assert sorted(obj.name for obj in bpy.data.objects) == before and len(bpy.data.meshes) == meshes
    assert [one for one in bpy.data.collections if one.get(key) == armature] == [collection]
    assert layer_of(collection).exclude is False and mine.name in collection.objects
    assert layer_of(collection).hide_viewport == (how == "hidden")


@pytest.mark.parametrize(
    ("name", "key"), [("physics_rig", "physics_rig_of"), ("rig_center", "center_of_mass_of")]
)
def test_rig_objects_of_another_scene_stay(name, key):
    armature, _ = character()
    assert run(name) == {"FINISHED"}
    (collection,) = [one for one in bpy.data.collections if one.get(key) == armature]
    count = len(collection.objects)
    bpy.context.scene.collection.children.unlink(collection)
    bpy.data.scenes.new("Other").collection.children.link(collection)
    only(armature)
    assert run(name) == {"FINISHED"}
    first, second = [one for one in bpy.data.collections if one.get(key) == armature]
    assert len(first.objects) == len(second.objects) == count and not {*first.objects} & {
        *second.objects
    }
