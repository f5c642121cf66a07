# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other origins and axes of single objects: data of each kind in float64, refusals, what is put back."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import reframe
from body_moments.blender.scene.reframe_meshes import Plan, data_change, reframe_own_meshes, shows_own_mesh
from mathutils import Matrix

from tests.blender.findings import refused
from tests.blender.objects import POINTS, add, mesh_body, place, seen
from tests.blender.spline_bodies import surface

pytestmark = pytest.mark.usefixtures("scene")
CHANGE = np.array([[0.0, -1.5, 0.25, 1.0], [1.5, 0.0, 0.0, -2.0], [0.0, 0.25, 1.5, 3.0], [0.0, 0.0, 0.0, 1.0]])


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
    assert (turned == faces) != mirrored and [set(face) for face in turned] == [set(face) for face in faces]


def test_data_of_each_kind_is_transformed():
    patch = surface(np.random.default_rng(1).normal(size=(4, 4, 3)))
    patch.shape_key_add(name="Basis")
    bpy.ops.object.metaball_add()
    ball = bpy.context.object
    for obj, points in ((patch, lambda: patch.data.splines[0].points), (ball, lambda: ball.data.elements)):
        before = np.array([tuple(point.co)[:3] for point in points()])
        reframe.transform_data(obj.data, CHANGE)
        now = np.array([tuple(point.co)[:3] for point in points()])
        assert np.abs(now - before @ CHANGE[:3, :3].T - CHANGE[:3, 3]).max() < 1e-5
    key = np.array([tuple(point.co)[:3] for point in patch.data.shape_keys.key_blocks[0].data])
    assert np.abs(key - [tuple(point.co)[:3] for point in patch.data.splines[0].points]).max() < 1e-5


def test_texts_move_in_their_plane_alone():
    text = bpy.data.curves.new("Text", "FONT")
    change = np.eye(4)
    change[:2, 3] = 0.5, -0.25
    text.offset_x = 1.0
    reframe.transform_data(text, change)
    assert (text.offset_x, text.offset_y) == (1.5, -0.25)
    for entry, limit in (((2, 3), 1e-6), ((0, 1), 1e-6), ((2, 2), 1e-6)):
        for factor, is_refused in ((0.9, False), (1.2, True)):
            other = change.copy()
            other[entry] += factor * limit
            if is_refused:
                with refused("text_off_plane"):
                    reframe.transform_data(text, other)
            else:
                reframe.transform_data(text, other)
    text.size, change[2, 3] = 100.0, 0.9e-4
    reframe.transform_data(text, change)


def modified(kind, **options):
    obj = add(mesh_body())
    made = obj.modifiers.new("Mod", kind)
    for name, value in options.items():
        setattr(made, name, value)
    return obj


def test_what_cannot_be_reframed_is_refused():
    def refuses(obj, code, **values):
        with refused(code, **values):
            reframe.check(obj)

    reframe.check(add(mesh_body()))
    refuses(add(None), "collection_instance")
    refuses(add(bpy.data.volumes.new("Volume")), "volume_not_reframed")
    refuses(add(bpy.data.cameras.new("Camera")), "data_without_transform")
    for instance_type in ("VERTS", "FACES"):
        obj, child = add(mesh_body()), add(None)
        obj.instance_type = instance_type
        reframe.check(obj)
        child.parent = obj
        refuses(obj, "instances_on_own_geometry")
        obj.instance_type = "NONE"
        reframe.check(obj)
    for kind, seen_, rendered, is_refused in (
        ("CAST", True, True, False),
        ("CAST", False, True, True),
        ("CAST", False, False, False),
        ("SUBSURF", False, True, False),
    ):
        obj = modified(kind, show_viewport=seen_, show_render=rendered)
        if is_refused:
            refuses(obj, "render_only_modifier", modifier="Mod")
        else:
            reframe.check(obj)
    obj = add(mesh_body(), scale=(1.0, 0.0, 1.0))
    refuses(obj, "scale_zero_axis")
    obj = add(mesh_body())
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "1000 + x"
    refuses(obj, "density_in_object_coordinates")
    reframe.check_movable(obj)
    obj.body_moments.density_frame = "WORLD"
    reframe.check(obj)
    with refused("density_in_world_coordinates"):
        reframe.check_movable(obj)


def test_what_is_bound_to_an_armature_moves_with_it_alone():
    armature, obj = add(bpy.data.armatures.new("Rig"), "Rig"), add(mesh_body())
    made = obj.modifiers.new("Armature", "ARMATURE")
    reframe.check_movable(obj)
    made.object = armature
    with refused("bound_to_armature", armature="Rig"):
        reframe.check_movable(obj)
    made.show_viewport = False
    reframe.check_movable(obj)
    made.show_viewport, armature.parent = True, obj
    reframe.check_movable(obj)
    obj.modifiers.clear()
    armature.parent, obj.parent, obj.parent_type = None, armature, "ARMATURE"
    with refused("bound_to_armature", armature="Rig"):
        reframe.check_movable(obj)
    obj.parent_type = "OBJECT"
    reframe.check_movable(obj)


def test_linked_data_is_refused(tmp_path):
    obj = add(mesh_body(), "Linked")
    bpy.data.libraries.write(str(tmp_path / "a.blend"), {obj})
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (_, names):
        names.objects = ["Linked"]
    own = add(names.objects[0].data, "Own")
    for linked in (names.objects[0], own):
        with refused("linked_object_data"):
            reframe.check(linked)
    reframe.check_movable(own)
    with refused("linked_object"):
        reframe.check_movable(names.objects[0])


def test_matrices_of_points_keep_what_is_seen():
    rng = np.random.default_rng(2)
    was, now = rng.normal(size=(2, 7, 4, 4))
    was[:, 3] = now[:, 3] = (0.0, 0.0, 0.0, 1.0)
    points = np.append(rng.normal(size=3), 1.0)
    change = data_change(was, now, False)
    assert np.abs(now @ change @ points - was @ points).max() < 1e-9
    now[:, :3, :3] = was[:, :3, :3]
    change = data_change(was, now, True)
    assert (change[:, :3, :3] == np.eye(3)).all() and (change[:, 3] == (0, 0, 0, 1)).all()
    assert np.abs(now @ change @ points - was @ points).max() < 1e-9


def target_of(obj, turn=0.5, shift=(1.0, 2.0, 3.0)):
    matrix = np.array(Matrix.Rotation(turn, 4, "Z") @ obj.matrix_world, np.float64)
    matrix[:3, 3] += shift
    return matrix


def carry_out(*plans):
    return reframe.reframe(bpy.context, list(plans))


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
    done, refusals = carry_out(Plan(obj, target, 3.0, False))
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
    with refused("parent_scale_zero"):
        reframe.run_change(bpy.context, reframe.set_world_matrix(Plan(obj, target, 3.0, False)))


@pytest.mark.parametrize("kind", ["LIMIT_LOCATION", "LIMIT_ROTATION"])
def test_a_constraint_that_holds_it_is_named(kind):
    obj = add(mesh_body())
    made = obj.constraints.new(kind)
    for name in ("use_max_x", "use_min_x") if kind == "LIMIT_LOCATION" else ("use_limit_z",):
        setattr(made, name, True)
    before = seen(obj)
    done, ((left, reason),) = carry_out(Plan(obj, target_of(obj), 3.0, False))
    assert not done and left == obj and np.abs(seen(obj) - before).max() == 0.0
    assert reason.code == ("location_constrained" if kind == "LIMIT_LOCATION" else "rotation_constrained")


def test_users_of_other_data_keep_it():
    """Of data that others use a copy is made, also where that is a user who only keeps it in the file."""
    for others, is_copied in ((0, False), (1, True)):
        obj = add(mesh_body())
        obj.modifiers.new("Triangulate", "TRIANGULATE")
        obj.data.use_fake_user = not others
        mesh, count = obj.data, len(bpy.data.meshes)
        if others:
            add(mesh, "Other")
        plan = Plan(obj, target_of(obj), 3.0, False)
        before = seen(obj)
        assert carry_out(plan) == ([plan], [])
        assert np.abs(seen(obj) - before).max() < 1e-5
        assert (obj.data != mesh) == is_copied and len(bpy.data.meshes) == count + is_copied
        assert [one.code for one in plan.findings] == ["data_copied"] * is_copied


def test_the_same_change_of_shared_data_is_made_once():
    """Of three that share a mesh and want the same, and one that wants something else."""
    mesh = mesh_body()
    objects = [add(mesh, "Body {:d}".format(i), (10.0 * i, 0, 0), select=False) for i in range(4)]
    for obj in objects:
        obj.modifiers.new("Triangulate", "TRIANGULATE")
    bpy.context.view_layer.update()
    shifts = [(float(obj == objects[3]), 2, 3) for obj in objects]
    plans = [Plan(obj, target_of(obj, 0.0, shift), 3.0, True) for obj, shift in zip(objects, shifts)]
    before = [seen(obj) for obj in objects]
    progress = []
    done, refusals = reframe.reframe(bpy.context, plans, progress.append)
    assert done == plans and not refusals and progress == [0, 3, 4]
    assert objects[0].data == objects[1].data == objects[2].data != objects[3].data
    assert max(np.abs(seen(obj) - was).max() for obj, was in zip(objects, before)) < 1e-5


def test_an_error_of_ours_leaves_the_object_and_is_reported(monkeypatch):
    obj = add(mesh_body())
    obj.modifiers.new("Triangulate", "TRIANGULATE")
    child = add(None, "Child")
    child.parent = obj
    bpy.context.view_layer.update()
    mesh, was, inverse = obj.data, place(obj), np.array(child.matrix_parent_inverse)
    monkeypatch.setattr(reframe, "same_shape", lambda *_: 1 / 0)
    done, ((left, reason),) = carry_out(Plan(obj, target_of(obj), 3.0, False))
    assert not done and left == obj and reason.code == "internal_error"
    assert obj.data == mesh and np.array_equal(place(obj), was) and len(bpy.data.meshes) == 1
    assert np.array_equal(inverse, child.matrix_parent_inverse)
    assert reframe.reframe(bpy.context, []) == ([], [])


def test_what_shows_its_own_mesh_and_nothing_else():
    def shows(change, users=()):
        obj = add(mesh_body())
        change(obj)
        return shows_own_mesh(obj, {obj: set(users)})

    def keyed(owner):
        owner.animation_data_create()

    assert shows(lambda obj: None) and shows(lambda obj: setattr(obj, "rotation_mode", "ZYX"))
    assert not shows(lambda obj: None, [add(None, "User")])
    for change in (
        lambda obj: obj.modifiers.new("Triangulate", "TRIANGULATE"),
        lambda obj: obj.constraints.new("LIMIT_SCALE"),
        lambda obj: setattr(obj, "parent", bpy.data.objects["User"]),
        keyed,
        lambda obj: keyed(obj.data),
        lambda obj: setattr(obj, "instance_type", "VERTS"),
        lambda obj: obj.shape_key_add(name="Basis"),
        *(lambda obj, mode=mode: setattr(obj, "rotation_mode", mode) for mode in ("QUATERNION", "AXIS_ANGLE")),
        *(
            lambda obj, name=name, value=value: setattr(obj, name, value)
            for name, value in (
                ("delta_location", (0, 0, 0.1)),
                ("delta_rotation_euler", (0, 0.1, 0)),
                ("delta_scale", (1, 2, 1)),
                ("lock_location", (False, False, True)),
                ("lock_rotation", (False, True, False)),
                ("lock_scale", (True, False, False)),
            )
        ),
    ):
        assert not shows(change)
    curve = add(bpy.data.curves.new("Curve", "CURVE"))
    assert not shows_own_mesh(curve, {})
    edited = add(mesh_body())
    bpy.ops.object.mode_set(mode="EDIT")
    assert not shows_own_mesh(edited, {})
    bpy.ops.object.mode_set(mode="OBJECT")


def test_points_that_come_to_lie_far_from_their_origin_are_left():
    """To a hundred-thousandth of the size, which float32 steps reach at 84 sizes; each of several by itself."""
    plans, before, is_done = [], [], []
    for own, scale, away, size, fits in (
        *((0.0, 1.0, away, 1.0, abs(away) < 100.0) for away in (10.0, 60.0, -60.0, 110.0, -250.0)),
        (0.0, 1.0, 250.0, 9.0, True),
        (0.0, 1.0, 60.0, 0.1, False),
        (60.0, 1.0, 60.0, 1.0, True),  # from far away back to it
        (60.0, 1.0, -60.0, 1.0, False),
        (0.0, 50.0, 0.0, 50.0, True),
    ):
        obj = add(mesh_body(points=[(x + own, y, z) for x, y, z in POINTS]), location=(1, 2, 3), scale=(scale,) * 3)
        plans.append(Plan(obj, place(obj), size, True))
        plans[-1].target[0, 3] += away
        before.append(seen(obj))
        is_done.append(fits)
    done = reframe_own_meshes(bpy.context, plans)
    assert [plan.obj in done for plan in plans] == is_done
    assert max(np.abs(seen(plan.obj) - was).max() for plan, was in zip(plans, before)) < 1e-4


@pytest.mark.parametrize(("factor", "is_done"), [(0.85, True), (1.15, False)])
def test_what_something_else_holds_a_little_elsewhere_or_turned_is_left(factor, is_done):
    """To some float32 steps, beside one that is larger and farther away."""
    other = add(mesh_body(), location=(4000.0, 0.0, 0.0), scale=(100.0,) * 3)
    limit = 4e-7 * 1000.0 + 4.0 * 2.0**-23 * 1000.0
    for moved, scaled in ((limit, 0.0), (0.0, 2e-6)):
        obj, held = add(mesh_body(), location=(1.0, 2.0, 3.0)), [factor * moved]

        def update(obj=obj, held=held):
            if held:  # as a script does on each update
                obj.location.x += held.pop()
            bpy.context.view_layer.update()

        plans = [Plan(one, place(one), size, True) for one, size in ((obj, 1000.0), (other, 1e6))]
        plans[0].target[0, 3], plans[0].target[0, 0] = 1000.0, 1.0 + factor * scaled
        context = SimpleNamespace(view_layer=SimpleNamespace(update=update))
        assert reframe_own_meshes(context, plans) == ([obj, other] if is_done else [other])
        assert (tuple(obj.location) == (1.0, 2.0, 3.0)) != is_done


def test_free_normals_turn_with_the_points():
    mesh = add(mesh_body()).data
    normals = np.random.default_rng(1).normal(size=(len(mesh.loops), 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", normals.ravel())
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    change = np.eye(4)
    change[:3, :3] = turn
    reframe.transform_data(mesh, change)
    found = np.array([tuple(corner.vector) for corner in mesh.corner_normals])
    assert np.abs(found - normals @ turn.T).max() < 1e-5
