# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies: exact mass, origin and axes in one step; compounds, joints; nothing visible
moves.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.tracking.staleness import stale_reason
from body_moments.blender.session.tracking.stamps import Kind
from mathutils import Matrix, Vector

from tests.blender.boxes import box, boxes_inertia
from tests.blender.objects import add, measured, mesh_body, mesh_of, only, place, seen
from tests.close import close

pytestmark = pytest.mark.usefixtures("registered", "scene")


def slanted(name="Body", **settings):
    obj = add(mesh_body(), name, (1, 2, 3), (0.3, 0.2, 0.1), (1, 2, 0.5))
    obj.body_moments.density = 1000.0
    return obj


def make(**options):
    return bpy.ops.object.body_moments_rigid_bodies(**({"frame": "AXES"} | options))


def is_what_bullet_takes_it_for(obj):
    local = measured(obj).in_object_frame()
    off = local.inertia - np.diag(np.diag(local.inertia))
    size = local.radii_of_gyration.max()
    return np.abs(local.center).max() < 1e-5 * size and np.abs(off).max() < 1e-6 * np.trace(
        local.inertia
    )


@pytest.mark.parametrize("unit", [1.0, 0.01, 100.0])
def test_mass_origin_and_axes_are_right_and_nothing_moves(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    obj = slanted()
    before, mass = seen(obj), measured(obj).mass_properties.mass
    assert make() == {"FINISHED"}
    assert np.abs(seen(obj) - before).max() < 1e-5
    assert close(obj["body_mass"], mass, 1e-6) and not stale_reason(obj, bpy.context.scene)
    assert (
        close(obj.rigid_body.mass, mass, 1e-6) and obj.rigid_body.collision_shape == "CONVEX_HULL"
    )
    assert is_what_bullet_takes_it_for(obj) and np.abs(np.array(obj.scale) - 1).max() < 1e-6
    for _ in range(2):  # again: nothing is left to do
        matrix = place(obj)
        assert make() == {"FINISHED"} and (place(obj) == matrix).all()
    for frame in ("AXES", "ORIGIN"):  # where little is left to do, it is done
        obj.data.transform(Matrix.Translation((1e-3, 0.0, 0.0)))
        obj.data.update()
        assert not is_what_bullet_takes_it_for(obj)
        assert make(frame=frame) == {"FINISHED"} and is_what_bullet_takes_it_for(obj)


def test_one_density_for_all_and_types_and_shapes():
    first, second = slanted("a"), slanted("b")
    only(first, second)
    assert make(use_density=True, density=2700.0, type="PASSIVE", shape="BOX", frame="ORIGIN") == {
        "FINISHED"
    }
    for obj in (first, second):
        assert obj.rigid_body.type == "PASSIVE" and obj.rigid_body.collision_shape == "BOX"
        assert close(obj.rigid_body.mass, 2700.0 * measured(obj).volume, 1e-6)
        assert np.abs(measured(obj).in_object_frame().center).max() < 1e-5
        assert np.abs(np.array(obj.scale) - (1, 2, 0.5)).max() < 1e-6


def test_a_parent_with_its_children_is_one_compound():
    scene = bpy.context.scene.collection
    root = box(scene, (1, 2, 4), (8, 0, -2), 7850, "root")
    child, grandchild = (
        box(scene, (2, 2, 2), (-4, 6, 1), 1000, "child"),
        box(scene, (1, 1, 1), (0, 0, 9), 500, "leaf"),
    )
    for lower, upper in ((child, root), (grandchild, child)):
        lower.parent, lower.matrix_parent_inverse = upper, upper.matrix_world.inverted()
    alone = box(scene, (1, 1, 1), (20, 0, 0), 1000, "alone")
    bpy.context.view_layer.update()
    only(root, child, grandchild, alone)
    before = [seen(obj) for obj in (root, child, grandchild)]
    assert make() == {"FINISHED"}
    after = [seen(obj) for obj in (root, child, grandchild)]
    assert all(np.abs(a - b).max() < 1e-5 for a, b in zip(before, after))
    mass, center, tensor = boxes_inertia(
        [(7850, (1, 2, 4), (8, 0, -2)), (1000, (2, 2, 2), (-4, 6, 1)), (500, (1, 1, 1), (0, 0, 9))]
    )
    assert close(root.rigid_body.mass, mass, 1e-6) and close(alone.rigid_body.mass, 1000.0, 1e-6)
    assert [obj.rigid_body.collision_shape for obj in (root, child, grandchild)] == [
        "COMPOUND", "COMPOUND", "CONVEX_HULL",
    ]  # fmt: skip
    frame = place(root)
    assert np.abs(frame[:3, 3] - center).max() < 1e-5
    turned = frame[:3, :3].T @ tensor @ frame[:3, :3]
    assert np.abs(turned - np.diag(np.diag(turned))).max() < 1e-6 * np.trace(tensor)
    assert make(compounds=False) == {"FINISHED"}
    assert close(root.rigid_body.mass, 7850 * 8, 1e-6)


def test_compound_of_free_axes_keeps_axes_of_its_parent():
    scene = bpy.context.scene.collection
    root, child = (
        box(scene, (2, 2, 2), (0, 0, 0), 1000, "root"),
        box(scene, (1, 1, 1), (0, 0, 0), 500, "child"),
    )
    child.parent, root.rotation_euler, root.location = root, (0.1, 0.2, 0.3), (1, 2, 3)
    child.rotation_euler = (0.5, 0.0, 0.4)
    bpy.context.view_layer.update()
    only(root, child)
    turn = place(root)[:3, :3]
    assert make() == {"FINISHED"} and root.rigid_body.collision_shape == "COMPOUND"
    assert np.abs(place(root)[:3, :3] - turn).max() < 1e-6


def test_joints_keep_their_places():
    first, second = slanted("a"), slanted("b")
    hinge = add(None, "Hinge", (4, 4, 4), select=False, parent=first)
    only(second)
    bpy.ops.rigidbody.world_add()
    bpy.ops.rigidbody.constraint_add(type="HINGE")
    second.rigid_body_constraint.object1, second.rigid_body_constraint.object2 = first, second
    second.rigid_body_constraint.use_limit_ang_z = True
    bpy.context.view_layer.update()
    empty_place, joint_place = place(hinge), place(second)
    only(first, second)
    assert make() == {"FINISHED"}
    assert np.abs(place(hinge) - empty_place).max() < 1e-5
    joint = bpy.data.objects["b Joint"]
    assert second.rigid_body_constraint is None
    constraint = joint.rigid_body_constraint
    assert constraint.type == "HINGE" and constraint.use_limit_ang_z
    assert (constraint.object1, constraint.object2) == (first, second)
    found = place(joint)
    assert np.abs(found[:3, 3] - joint_place[:3, 3]).max() < 1e-5
    turn = joint_place[:3, :3] / np.linalg.norm(joint_place[:3, :3], axis=0)
    assert np.abs(found[:3, :3] - turn).max() < 1e-5


def test_correct_and_refused_bodies_leave_the_rest_to_be_made():
    right = box(bpy.context.scene.collection, (4, 2, 1), (0, 0, 0), 1000, "a")
    instancer, last = slanted("b"), slanted("c")
    instancer.instance_type, slanted("Child").parent = "VERTS", instancer
    bpy.context.view_layer.update()
    only(right, instancer, last)
    before = place(right), place(instancer)
    assert make() == {"FINISHED"} and is_what_bullet_takes_it_for(last)
    assert right.rigid_body is not None and instancer.rigid_body is None
    assert (place(right) == before[0]).all() and (place(instancer) == before[1]).all()


def test_scaled_body_of_bent_faces_gets_principal_axes():
    """Blender cuts such faces into other triangles then."""
    obj = slanted()
    obj.data.vertices[3].co += Vector((0.3, -0.2, 0.6))
    obj.data.update()
    assert make() == {"FINISHED"} and is_what_bullet_takes_it_for(obj)


def test_body_of_local_modifier_stays_and_next_is_made(reported):
    held, good = slanted("held"), slanted("good")
    cast = held.modifiers.new("Cast", "CAST")
    cast.show_viewport, cast.factor = False, 0.8
    only(held)
    bpy.ops.rigidbody.world_add()
    bpy.ops.rigidbody.constraint_add(type="HINGE")
    only(held, good)
    before = place(held)
    assert make(frame="ORIGIN") == {"FINISHED"} and good.rigid_body is not None
    assert np.abs(measured(good).in_object_frame().center).max() < 1e-5
    assert (
        (place(held) == before).all()
        and held.rigid_body is None
        and held.rigid_body_constraint.type == "HINGE"
    )
    assert len(bpy.data.objects) == 2
    assert reported.values("failure")["object"] == "held" and reported.codes[-1] == "own_axes_used"


def test_refused_rigid_body_keeps_its_mass():
    good, held, empty = slanted("good"), slanted("held"), add(None, "Empty")
    only(held)
    bpy.ops.rigidbody.object_add()
    held.rigid_body.mass, held.lock_location = 5.0, (True, True, True)
    only(good, held)
    bpy.context.view_layer.objects.active = empty
    assert make() == {"FINISHED"}
    assert held.rigid_body.mass == 5.0 and empty.rigid_body is None
    assert close(good.rigid_body.mass, measured(good).mass_properties.mass, 1e-6)


def test_text_and_too_light_body_stay_with_a_reason(reported):
    good, text = slanted("good"), add(bpy.data.curves.new("T", "FONT"), "Text")
    text.data.body, text.data.extrude = "A", 0.5
    tiny = slanted("tiny")
    tiny.body_moments.density = 1e-9
    bpy.context.view_layer.update()
    only(good, text, tiny)
    was = place(tiny)
    assert make() == {"FINISHED"}
    assert (
        good.rigid_body
        and not text.rigid_body
        and not tiny.rigid_body
        and (place(tiny) == was).all()
    )
    assert {"rigid_body_unfit", "rigid_body_mass_too_small"} <= set(reported.codes)


TURN = 0.2, 0.1, 0.3


@pytest.mark.parametrize("frame", ["AXES", "ORIGIN", "KEEP"])
@pytest.mark.parametrize("shape", ["HULL", "BOX", "PIECES", None])
def test_six_props_fall_and_rest_on_a_flat_floor(frame, shape, reported):
    scales = ((1, 1, 1), (3, 3, 3), (3, 2, 1), (-2, 2, 2), (1, 2, -1.5), (0.5, 0.5, 0.5))
    bodies = [
        add(mesh_body(), "Body {:d}".format(i), (20 * i, 0, 5), TURN, scale)
        for i, scale in enumerate(scales)
    ]
    if shape == "PIECES":  # acute corners
        bpy.ops.mesh.primitive_monkey_add(size=1.5, location=(0, 20, 5), rotation=TURN)
        bodies = [bpy.context.object]
    only(*bodies)
    if frame == "KEEP":
        bpy.ops.object.body_moments_origin_to_center()
    if shape is not None:
        bpy.ops.object.body_moments_make_colliders(shape=shape)
    assert make(frame=frame) == {"FINISHED"}
    scene = bpy.context.scene
    assert "rigid_body_center_elsewhere" not in reported.codes
    assert all(stale_reason(obj, scene, Kind.COLLIDERS) is None for obj in bodies)
    if frame == "ORIGIN":  # also of mirrored objects
        assert np.abs(np.subtract([obj.rotation_euler for obj in bodies], TURN)).max() < 1e-5
    bpy.ops.mesh.primitive_plane_add(size=400)
    floor = bpy.context.object
    only(floor)
    assert make(type="PASSIVE") == {"FINISHED"} and floor.rigid_body.collision_shape != "MESH"
    touching = [obj.children[0] if shape == "BOX" else obj for obj in bodies]
    heights = []
    for frame_number in range(1, 251):
        scene.frame_set(frame_number)
        if frame_number in {230, 250}:
            heights.append([float(seen(obj)[:, 2].min()) for obj in touching])
    assert np.abs(heights).max() < 0.01 and np.ptp(heights, axis=0).max() < 1e-3, heights


@pytest.mark.parametrize(
    ("points", "shape"),
    [
        ([(0, 0, 0), (4, 0, 0), (4, 3, 1), (0, 3, 1)], "CONVEX_HULL"),
        ([(0, 0, 0), (4, 0, 0), (1, 1, 0), (0, 4, 0)], "MESH"),
    ],
)
def test_passive_floor_has_hull_if_flat_and_convex(points, shape, reported):
    floor = add(mesh_of(points, [(0, 1, 2, 3)], "Floor"), "Floor")
    only(floor)
    assert make(type="PASSIVE") == {"FINISHED"}
    assert floor.rigid_body.collision_shape == shape and floor.rigid_body.mesh_source == "FINAL"
    assert "1 passive body without volume" in reported.texts


def test_kept_origin_beside_the_center_is_a_warning(reported):
    only(slanted())
    assert make(frame="KEEP") == {"FINISHED"}
    assert "rigid_body_center_elsewhere" in reported.codes
