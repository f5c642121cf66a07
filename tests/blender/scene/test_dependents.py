# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""When shapes are the same, and what holds objects that refer to changed ones, from both sides of each limit."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.robots.model import Pose
from body_moments.core.verdict.finding import EditRefusedError
from body_moments.operators.read.links import link_surface, sheared_objects
from body_moments.operators.scene import dependents
from mathutils import Matrix

from tests.blender.characters import armature_of
from tests.blender.findings import refused
from tests.blender.objects import add, mesh_body, place

pytestmark = pytest.mark.usefixtures("scene")
LIMIT = 1e-5  # of the size


def some(count=5, places=3, seed=1):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(count, 3)), rng.normal(size=(places, min(count, dependents.SAMPLES), 3))


def test_shapes_are_the_same_to_a_limit():
    before = [some(), some(70, 0, 2)]
    assert dependents.same_shape(None, None, 1.0)
    assert not dependents.same_shape(None, before, 1.0) and not dependents.same_shape(before, None, 1.0)
    for part, where in ((0, 0), (0, 1), (1, 0)):
        rounding = 16.0 * dependents.FLOAT32 * np.abs(before[part][where]).max()
        for size in (0.5, 20.0):
            for factor, is_same in ((0.9, True), (1.1, False)):
                after = [(first.copy(), rest.copy()) for first, rest in before]
                after[part][where].reshape(-1)[4] += factor * (LIMIT * size + rounding)
                assert dependents.same_shape(before, after, size) == is_same
    far = [(first + 1e6, rest + 1e6) for first, rest in before]
    step = 16.0 * dependents.FLOAT32 * 1e6
    for off, is_same in ((0.9 * step, True), (1.1 * step, False)):
        moved = [(first + off, rest) for first, rest in far]
        assert dependents.same_shape(far, moved, 1e-3) == is_same
    assert not dependents.same_shape(before, before[:1], 1.0) and not dependents.same_shape(before[:1], before, 1.0)
    (points, rest), _ = before
    assert not dependents.same_shape([(points, rest)], [(points[:4], rest)], 1.0)
    assert not dependents.same_shape([(points, rest)], [(points, rest[:2])], 1.0)
    empty = np.zeros((0, 3)), np.zeros((2, 0, 3))
    assert dependents.same_shape([empty], [empty], 1.0)


def test_places_of_one_part_are_those_of_several():
    """In any order; a place more, or one elsewhere, is another shape."""
    points, _ = some(5)
    rng = np.random.default_rng(3)
    offsets = rng.normal(size=(6, 1, 3))
    joined = [(points + offsets[0], points + offsets[1:])]
    none = np.zeros((0, 5, 3))
    split = [(points + offset[0], none) for offset in offsets[[3, 0, 5, 1, 4, 2], None]]
    assert dependents.same_shape(joined, split, 1.0) and dependents.same_shape(split, joined, 1.0)
    assert not dependents.same_shape(joined, split[:-1], 1.0)
    moved = [*split[:-1], (split[-1][0] + (0.0, 2e-4, 0.0), none)]
    assert not dependents.same_shape(joined, moved, 1.0) and dependents.same_shape(joined, moved, 100.0)
    assert not dependents.same_shape(joined, [*split, (points[:4], none[:, :4])], 1.0)


def test_a_shape_goes_with_its_object():
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.1, 0.2, 0.3), scale=(1, 2, 0.5))
    obj.modifiers.new("Array", "ARRAY").count = 2
    depsgraph = bpy.context.evaluated_depsgraph_get()
    before, was = dependents.shape(obj, depsgraph), place(obj)
    obj.matrix_world = Matrix.LocRotScale((-4, 0, 5), Matrix.Rotation(1.0, 3, "Y"), (2, 1, 3))
    now = place(obj)
    after = dependents.transform_shape(before, was, now)
    assert dependents.same_shape(after, dependents.shape(obj, bpy.context.evaluated_depsgraph_get()), 10.0)
    assert not dependents.same_shape(before, after, 10.0)
    assert dependents.transform_shape(None, was, now) is None
    nothing = add(bpy.data.meshes.new("Nothing"))
    assert dependents.shape(nothing, bpy.context.evaluated_depsgraph_get()) is None


def test_all_places_of_an_instancer_are_looked_at():
    parts = bpy.data.collections.new("Parts")
    mesh = mesh_body()
    for at in ((0, 0, 0), (5, 0, 0), (0, 7, 0)):
        part = add(mesh, "Part", at)
        bpy.context.scene.collection.objects.unlink(part)
        parts.objects.link(part)
    obj = add(None, "Instancer", (1, 1, 1))
    obj.instance_type, obj.instance_collection = "COLLECTION", parts
    bpy.context.view_layer.update()
    ((first, rest),) = dependents.shape(obj, bpy.context.evaluated_depsgraph_get())
    own = np.array([vertex.co for vertex in mesh.vertices], float)
    every = {tuple(np.round(np.ptp([*points], axis=0), 5)) for points in (first, *rest)}
    assert first.shape == own.shape and rest.shape == (2, *own.shape) and len(every) == 1
    starts = sorted(tuple(np.round(points[0] - own[0], 5).tolist()) for points in (first, *rest))
    assert starts == [(1.0, 1.0, 1.0), (1.0, 8.0, 1.0), (6.0, 1.0, 1.0)]


def family():
    """Changed, its child, a follower by constraint, one that is held by Child Of, one that shows it in a modifier."""
    changed, child, follower, held, shower = (
        add(mesh_body(), name, (2.0 * place, 0, 0))
        for place, name in enumerate(("Changed", "Child", "Follower", "Held", "Shower"))
    )
    child.parent = changed
    follower.constraints.new("COPY_LOCATION").target = changed
    held.constraints.new("CHILD_OF").target = changed
    shower.modifiers.new("Array", "ARRAY").use_object_offset = True
    shower.modifiers["Array"].offset_object = changed
    bpy.context.view_layer.update()
    return changed, child, follower, held, shower


def guard(*changed):
    users = dependents.referring(set(changed))
    return dependents.DependentsGuard(list(changed), users, bpy.context.evaluated_depsgraph_get())


def test_who_refers_to_an_object():
    changed, *others = family()
    through = add(None, "Instancer")
    through.instance_type, through.instance_collection = "COLLECTION", bpy.data.collections.new("Parts")
    through.instance_collection.objects.link(changed)
    assert dependents.referring({changed, others[0]}) == {changed: {*others, through}, others[0]: set()}


def test_children_are_held_and_followers_noted():
    changed, child, follower, held, _ = family()
    around = guard(changed)
    was = [place(obj) for obj in (child, held)]
    inverses = [np.array(child.matrix_parent_inverse), np.array(held.constraints[0].inverse_matrix)]
    changed.location, changed.rotation_euler = (0.5, -3.0, 1.0), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    around.compensate()
    now = [place(obj) for obj in (child, held)]
    assert max(np.abs(one - other).max() for one, other in zip(was, now)) < 1e-5
    shown = around.shapes.pop(bpy.data.objects["Shower"])
    assert shown is not None and not around.findings
    around.verify(bpy.context.evaluated_depsgraph_get(), 1.0)
    assert [(one.code, one.values) for one in around.findings] == [("follower_moved", {"object": follower.name})]
    around.restore()
    assert np.array_equal(inverses[0], child.matrix_parent_inverse)
    assert np.array_equal(inverses[1], held.constraints[0].inverse_matrix)
    with refused("child_not_held", object="Child"):
        around.verify(bpy.context.evaluated_depsgraph_get(), 1.0)


def test_a_shape_that_changes_is_refused():
    changed, *_ = family()
    around = guard(changed)
    around.verify(bpy.context.evaluated_depsgraph_get(), 1.0)
    around.places.pop(bpy.data.objects["Follower"])
    changed.location.z = 2.0
    bpy.context.view_layer.update()
    around.compensate()
    with refused("dependent_shape_changes", object="Shower"):
        around.verify(bpy.context.evaluated_depsgraph_get(), 1.0)


def test_how_far_is_moved():
    around = guard(add(mesh_body(), location=(1000.0, 0, 0)))
    before = np.diag([2.0, 2.0, 2.0, 1.0])
    reach = 16.0 * dependents.FLOAT32 * 1000.0
    for size in (0.1, 50.0):
        for entry, limit in (((0, 3), LIMIT * size + reach), ((2, 1), 2e-5)):
            for factor, is_moved in ((0.9, False), (1.1, True)):
                now = before.copy()
                now[entry] += factor * limit
                assert around._moved(before, now, size) == is_moved


def test_a_linked_child_is_refused(tmp_path):
    parent, child = add(mesh_body(), "Parent"), add(None, "Child")
    child.parent = parent
    bpy.data.libraries.write(str(tmp_path / "a.blend"), {child})
    bpy.data.objects.remove(child)
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (_, names):
        names.objects = ["Child"]
    (child,) = names.objects
    with pytest.raises(EditRefusedError) as error:
        dependents.DependentsGuard([child.parent], {child.parent: {child}}, bpy.context.evaluated_depsgraph_get())
    assert error.value.finding.code == "child_linked" and error.value.finding.values == {"object": "Child"}


def test_a_bone_that_child_of_holds_is_held_with_its_object():
    changed = add(mesh_body(), "Changed")
    rig = armature_of(SimpleNamespace(names=("bone",), bones=np.array([[[0, 0, 0], [0, 0, 1]]])))
    constraint = rig.pose.bones["bone"].constraints.new("CHILD_OF")
    constraint.target = changed
    bpy.context.view_layer.update()
    around = guard(changed)
    assert [one for one, _ in around.anchors] == [constraint]
    before = np.array(rig.matrix_world @ rig.pose.bones["bone"].matrix)
    changed.location, changed.rotation_euler = (0.5, -3.0, 1.0), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    around.compensate()
    bpy.context.view_layer.update()
    assert np.abs(np.array(rig.matrix_world @ rig.pose.bones["bone"].matrix) - before).max() < 1e-5
    around.verify(bpy.context.evaluated_depsgraph_get(), 3.0)
    assert not around.findings


def test_the_shape_of_a_follower_that_moved_is_not_looked_at():
    """That it moved is said, and where it is now its shape is another one."""
    changed, _, follower, _, _ = family()
    follower.modifiers.new("Array", "ARRAY").use_object_offset = True
    follower.modifiers["Array"].offset_object = changed
    bpy.context.view_layer.update()
    around = guard(changed)
    del around.shapes[bpy.data.objects["Shower"]]
    changed.location = (0.5, -3.0, 1.0)
    bpy.context.view_layer.update()
    around.compensate()
    bpy.context.view_layer.update()
    around.verify(bpy.context.evaluated_depsgraph_get(), 3.0)
    assert [(one.code, one.values["object"]) for one in around.findings] == [("follower_moved", "Follower")]


def test_a_link_has_the_surfaces_of_those_of_its_objects_that_have_some():
    cube, nothing = add(mesh_body()), add(None, "Nothing")
    twice = add(mesh_body(), location=(5, 0, 0))
    bpy.context.view_layer.update()
    depsgraph, pose = bpy.context.evaluated_depsgraph_get(), Pose(np.array([1.0, 2.0, 3.0]))
    own = np.array([vertex.co for vertex in cube.data.vertices], float)
    assert link_surface([nothing], depsgraph, pose, 1.0) is None
    alone = link_surface([nothing, cube], depsgraph, pose, 0.5)
    assert np.abs(alone.points - (0.5 * own - pose.position)).max() < 1e-6
    both = link_surface([cube, nothing, twice], depsgraph, pose, 0.5)
    assert np.abs(both.points - np.concatenate([alone.points, alone.points + (2.5, 0, 0)])).max() < 1e-6
    assert sheared_objects([]) == [] and sheared_objects([cube, twice]) == []
