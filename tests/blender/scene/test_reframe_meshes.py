# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many meshes that get other frames at once: each as by itself, and nothing visible moves."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.blender.scene import reframe, reframe_meshes

from tests.corpus import shapes as s

pytestmark = pytest.mark.usefixtures("scene")
OPERATORS = "body_moments_origin_to_center", "body_moments_axes_to_principal"


def parts(count=6):
    """Objects of all kinds that may be reframed together, and some that may not."""
    rng, made = np.random.default_rng(5), []
    for i in range(count):
        points, faces = s.box(-rng.uniform(0.5, 2, 3), rng.uniform(0.5, 2, 3)) if i % 2 else s.random_hull(i)
        mesh = bpy.data.meshes.new("Part")
        mesh.from_pydata(
            (np.asarray(points) + rng.normal(size=3)).tolist(), [], [list(map(int, face)) for face in faces]
        )
        for twin in range(3):
            obj = bpy.data.objects.new("Part {} {}".format(i, twin), mesh)
            bpy.context.scene.collection.objects.link(obj)
            obj.rotation_mode = ("XYZ", "ZYX", "QUATERNION", "YZX", "XZY", "XYZ")[i]
            obj.rotation_euler, obj.location = rng.uniform(-3, 3, 3), rng.normal(size=3) * 10.0 ** rng.uniform(-1, 3)
            obj.scale = (1.0, 1.0, 1.0) if twin else np.full(3, rng.uniform(0.5, 2.0)) * (1, 1, -1 if i % 2 else 1)
            made.append(obj)
    if count > 1:
        made[1].delta_location.x, made[4].lock_location[1] = 0.5, True
        made[7].modifiers.new("Mirror", "MIRROR")
        follower = bpy.data.objects.new("Follower", None)
        bpy.context.scene.collection.objects.link(follower)
        follower.parent = made[2]
        other = bpy.data.objects.new("Not selected", made[9].data)
        bpy.context.scene.collection.objects.link(other)
    for obj in made:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = made[0]
    bpy.context.view_layer.update()
    return made


def seen(objects):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = {}
    for obj in objects:
        evaluated = obj.evaluated_get(depsgraph)
        matrix = np.array(evaluated.matrix_world)
        points = np.array([vertex.co[:] for vertex in evaluated.data.vertices])
        normals = np.array([face.normal[:] for face in evaluated.data.polygons])
        normals = normals @ np.linalg.inv(matrix[:3, :3])  # outward stays outward
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        found[obj.name] = (points @ matrix[:3, :3].T + matrix[:3, 3], normals, matrix)
    return found


@pytest.mark.parametrize("operator", OPERATORS)
def test_nothing_visible_moves_and_each_is_as_by_itself(operator, monkeypatch):
    together = []
    carried_out = reframe_meshes.reframe_own_meshes
    monkeypatch.setattr(
        reframe, "reframe_own_meshes", lambda *args: together.extend(done := carried_out(*args)) or done
    )
    results = []
    for alone in (False, True):
        if alone:
            monkeypatch.setattr(reframe, "shows_own_mesh", lambda *_: False)
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        objects = parts()
        before = seen(objects)
        assert getattr(bpy.ops.object, operator)() == {"FINISHED"}
        bpy.context.view_layer.update()
        after = seen(objects)
        for name in before:
            size = np.ptp(before[name][0], axis=0).max() + 1e-3 * np.abs(before[name][0]).max()
            assert np.abs(before[name][0] - after[name][0]).max() < 1e-5 * size, name
            assert np.abs(before[name][1] - after[name][1]).max() < 1e-3, name
        results.append((after, len({obj.data for obj in objects})))
    assert len(together) >= 4
    (first, meshes), (second, expected) = results
    assert meshes == expected
    for name in first:
        scale = np.abs(second[name][2]).max()
        assert np.abs(first[name][2] - second[name][2]).max() < 3e-6 * scale, name


def test_what_does_not_come_to_stand_where_it_should_is_left_as_it_was():
    """A location that float32 cannot hold beside a body so small."""
    objects = parts(1)[:3]
    users = reframe.referring(set(objects))
    objects = [obj for obj in objects if reframe_meshes.shows_own_mesh(obj, users)]
    before = seen(objects)
    plans = []
    for obj in objects:
        target = np.array(obj.matrix_world, np.float64)
        target[:3, 3] = 123456.789
        plans.append(reframe_meshes.Plan(obj, target, 1e-6, move_only=True))
    assert plans and reframe_meshes.reframe_own_meshes(bpy.context, plans) == []
    bpy.context.view_layer.update()
    after = seen(objects)
    for name in before:
        assert all(np.array_equal(first, second) for first, second in zip(before[name], after[name]))


def test_linked_meshes_are_copied_where_they_have_to_be():
    objects = parts(1)
    first, second, third = objects
    first.scale = second.scale = third.scale = (1.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    users = {obj: set() for obj in objects}
    assert all(reframe_meshes.shows_own_mesh(obj, users) for obj in objects)

    def plan(obj, shift):
        target = np.array(obj.matrix_world, np.float64)
        target[:3, 3] += target[:3, :3] @ shift
        return reframe_meshes.Plan(obj, target, 1.0, move_only=True)

    shift = np.array([0.5, 0.25, 0.125])
    plans = [plan(first, shift), plan(second, shift), plan(third, 2.0 * shift)]
    assert len(reframe_meshes.reframe_own_meshes(bpy.context, plans)) == 3
    assert first.data == second.data != third.data
    assert [bool(each.findings) for each in plans] == [False, False, True]
    only = plan(first, shift)  # the second one keeps the mesh
    reframe_meshes.reframe_own_meshes(bpy.context, [only])
    assert first.data != second.data and only.findings[0].code == "data_copied"


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize(
    ("where", "after", "late"),
    [
        ("data_change", 0, False),
        ("data_change", 1, False),
        ("_transform_meshes", 0, False),
        ("_change_mesh", 2, False),
        *[("_change_mesh", after, True) for after in range(3)],
        ("_set_points", 1, True),
    ],
)
def test_an_error_halfway_puts_all_back_and_each_is_tried_by_itself(operator, where, after, late, monkeypatch):
    """late: after what was called has done its work."""
    objects, states, calls = parts(), [], []
    real, together = getattr(reframe_meshes, where), reframe_meshes.reframe_own_meshes

    def failing(*args):
        calls.append(args)
        planted = len(calls) == after + 1
        if not planted or late:
            done = real(*args)
        if planted:
            raise TypeError("planted")
        return done

    def state():
        bpy.context.view_layer.update()
        return [
            (obj.data, *obj.location, *obj.rotation_euler, *obj.scale)
            + tuple(value for vertex in obj.data.vertices for value in vertex.co)
            + tuple(index for face in obj.data.polygons for index in face.vertices)
            for obj in objects
        ], len(bpy.data.meshes)

    def looked_at(context, plans):
        if states:  # once more, whether all are right
            return together(context, plans)
        states.append(state())
        done = together(context, plans)
        states.append(state())
        assert not done and not any(plan.findings for plan in plans)
        return done

    monkeypatch.setattr(reframe_meshes, where, failing)
    monkeypatch.setattr(reframe, "reframe_own_meshes", looked_at)
    before = seen(objects)
    assert getattr(bpy.ops.object, operator)() == {"FINISHED"}
    assert len(calls) > after and states[0] == states[1]
    after_all = seen(objects)
    for obj in objects:
        assert np.abs(after_all[obj.name][0] - before[obj.name][0]).max() < 1e-3


@pytest.mark.parametrize("seed", range(40))
def test_changes_are_alike_as_all_pairs_say(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 60))
    kinds = rng.normal(size=(rng.integers(1, 8), 4, 4)) * 10.0 ** rng.uniform(-6, 6)
    kinds[:, :3, 3] *= 10.0 ** rng.uniform(-3, 8)
    reach, within = np.exp(rng.normal(size=(2, count)))
    within *= 10.0 ** rng.uniform(-11, 1)
    changes = kinds[rng.integers(len(kinds), size=count)]
    if seed % 2:
        changes += rng.normal(size=changes.shape) * within.mean() * 10.0 ** rng.uniform(-3, 1)
    else:  # one entry, about as far as is allowed
        changes[:, 0, 0] += rng.uniform(-1, 1, count) * within / reach
    groups, left = [], list(range(count))
    while left:
        off = np.abs(changes[left] - changes[left[0]])
        far = off[:, :3, :3].sum(axis=(1, 2)) * reach[left[0]] + off[:, :3, 3].max(axis=1)
        groups.append([i for i, distance in zip(left, far) if distance <= within[left[0]] or i == left[0]])
        left = [i for i in left if i not in groups[-1]]
    assert reframe_meshes._alike(changes, reach, within.tolist()) == groups


@pytest.mark.parametrize("kept", [False, True])
def test_a_mesh_that_is_also_kept_in_the_file_goes_on_being_its_object_s(kept):
    obj = parts(1)[0]
    twins, mesh = [one for one in bpy.data.objects if one != obj], obj.data
    bpy.data.batch_remove(twins)
    mesh.use_fake_user = kept
    target = reframe.world(obj)
    target[:3, 3] += 1.0
    plan = reframe.Plan(obj, target, 3.0, True)
    assert reframe_meshes.reframe_own_meshes(bpy.context, [plan]) == [obj]
    assert obj.data == mesh and not plan.findings and len(bpy.data.meshes) == 1
