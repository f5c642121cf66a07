# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping: exact, nothing else moves, twice is once, one undo brings all back, refusals leave
nothing behind.
"""

from itertools import product

import bpy
import numpy as np
import pytest
from body_moments.blender.session.tracking import staleness
from mathutils import Matrix

from tests.blender.objects import (
    HEIGHT,
    POINTS,
    add,
    measured,
    mesh_body,
    mesh_of,
    only,
    place,
    seen,
)
from tests.operators.standing import QUADS

SIZE = 4.0  # of the test body
TOLERANCE = 1e-6 * SIZE
ORIGIN = "body_moments_origin_to_center"
AXES = "body_moments_axes_to_principal"
ALIGN = "body_moments_align_to_world"
REFRAMING = (ORIGIN, AXES)

pytestmark = pytest.mark.usefixtures("scene")


def run(name, **options):
    return getattr(bpy.ops.object, name)(**options)


def assert_origin_is_center(obj):
    assert np.abs(place(obj)[:3, 3] - measured(obj).mass_properties.center).max() < TOLERANCE


def assert_axes_are_principal(obj):
    body = measured(obj).mass_properties
    linear = place(obj)[:3, :3]
    assert np.abs(linear.T @ linear - np.eye(3)).max() < 2e-6
    assert np.linalg.det(linear) > 0.0
    tensor = linear.T @ body.inertia @ linear
    assert np.abs(tensor - np.diag(np.diag(tensor))).max() < 1e-6 * np.trace(tensor)
    assert (np.diff(np.diag(tensor)) > 0.0).all()
    assert_origin_is_center(obj)


def assert_reframed(name, obj):
    (assert_origin_is_center if name == ORIGIN else assert_axes_are_principal)(obj)


def assert_stays(name, obj, tolerance=TOLERANCE):
    """Run an operator that leaves an object's shape where it is."""
    before = seen(obj)
    assert run(name) == {"FINISHED"}
    assert np.abs(seen(obj) - before).max() < tolerance


def assert_refused(name, obj, other=None):
    """Run an operator that changes nothing about an object, nor what is seen of it or another."""
    before, points = state(obj), seen(other or obj)
    assert run(name) == {"CANCELLED"}
    assert state(obj) == before and (seen(other or obj) == points).all()


def state(obj):
    """Everything about an object that a refused operator must leave as it was."""
    return (
        obj.data,
        [tuple(v.co) for v in obj.data.vertices],
        tuple(obj.location),
        tuple(obj.rotation_euler),
        tuple(obj.scale),
        len(bpy.data.meshes),
        [tuple(map(tuple, c.matrix_parent_inverse)) for c in obj.children],
    )


@pytest.mark.parametrize("name", REFRAMING)
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 3), (-1, 2, 1), (-1, -1, -1)])
def test_reframed_body_stays_in_place_and_is_final(name, scale):
    obj = add(mesh_body(), location=(3, -4, 5), rotation=(0.3, -1.2, 2.0), scale=scale)
    data, volume = obj.data, measured(obj).volume
    assert_stays(name, obj)
    assert_reframed(name, obj)
    assert obj.data is data and len(bpy.data.meshes) == 1
    assert str(measured(obj).method) == "exact"
    assert abs(measured(obj).volume / volume - 1.0) < 1e-6
    after, matrix = seen(obj), place(obj)
    assert run(name) == {"CANCELLED"}
    assert (seen(obj) == after).all() and (place(obj) == matrix).all()


@pytest.mark.parametrize("name", REFRAMING)
@pytest.mark.parametrize(
    "mode", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "QUATERNION", "AXIS_ANGLE"]
)
def test_every_rotation_mode_and_deltas(name, mode):
    obj = add(mesh_body())
    obj.rotation_mode = mode
    obj.matrix_world = Matrix.LocRotScale((1, 2, 3), Matrix.Rotation(0.7, 3, (1, 2, -1)), (1, 2, 1))
    obj.delta_location = (5, -6, 7)
    obj.delta_scale = (2, 1, 0.5)
    obj.delta_rotation_euler = (0.4, 0.2, -0.3)
    obj.delta_rotation_quaternion = (0.9, 0.1, -0.4, 0.2)
    bpy.context.view_layer.update()
    assert_stays(name, obj, 3.0 * TOLERANCE)
    assert_reframed(name, obj)


@pytest.mark.parametrize("name", REFRAMING)
def test_children_do_not_move(name):
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.2, 0.3, 0.4), scale=(1, 2, 3))
    child = add(None, "Child", location=(4, 5, 6), rotation=(1, 0, 0), parent=obj)
    child.matrix_parent_inverse = Matrix.Translation((1, 1, 1))
    grandchild = add(None, "Grandchild", location=(1, 0, 0), parent=child)
    only(obj)
    before = place(child), place(grandchild)
    assert run(name) == {"FINISHED"}
    for old, new in zip(before, (place(child), place(grandchild))):
        assert np.abs(old - new).max() < 1e-5


@pytest.mark.parametrize("name", REFRAMING)
def test_parents_are_respected(name):
    parent = add(None, "Parent", location=(10, 20, 30), rotation=(0.5, 0.6, 0.7), scale=(2, 2, 2))
    obj = add(mesh_body(), location=(1, 0, 0), rotation=(0.1, 0.9, 0), parent=parent)
    obj.matrix_parent_inverse = Matrix.LocRotScale(
        (3, 2, 1), Matrix.Rotation(0.4, 3, "Y"), (0.5, 0.5, 0.5)
    )
    assert_stays(name, obj, 40 * 1e-6)
    assert np.abs(place(obj)[:3, 3] - measured(obj).mass_properties.center).max() < 40 * 1e-6
    assert run(name) == {"CANCELLED"}


def test_axes_below_shearing_parent_are_refused():
    parent = add(None, "Parent", scale=(1, 2, 5))
    obj = add(mesh_body(), rotation=(0.3, 0.4, 0.5), parent=parent)
    assert_refused(AXES, obj)
    assert run(ORIGIN) == {"FINISHED"}
    assert_origin_is_center(obj)


@pytest.mark.parametrize("name", REFRAMING)
def test_other_users_of_the_data_do_not_move(name):
    mesh = mesh_body()
    obj = add(mesh, location=(1, 2, 3), scale=(1, 2, 1))
    other = add(mesh, "Other", location=(7, 8, 9), rotation=(1, 1, 1))
    only(obj)
    before, matrix = seen(other), place(other)
    assert_stays(name, obj)
    assert (seen(other) == before).all() and (place(other) == matrix).all()
    assert other.data is mesh
    assert_reframed(name, obj)


@pytest.mark.parametrize("name", REFRAMING)
def test_all_shape_keys_follow(name):
    obj = add(mesh_body(), location=(1, 1, 1), rotation=(0.5, 0, 0))
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Tall", from_mix=False)
    for point in key.data:
        point.co.z *= 3.0
    hidden = obj.shape_key_add(name="Hidden", from_mix=False)
    for point in hidden.data:
        point.co.x += 10.0
    hidden.value, key.value = 0.0, 0.5
    bpy.context.view_layer.update()
    before = seen(obj)
    assert_stays(name, obj)
    assert_reframed(name, obj)
    obj.data.shape_keys.key_blocks["Hidden"].value = 1.0
    bpy.context.view_layer.update()
    assert abs(np.linalg.norm((seen(obj) - before).mean(axis=0)) - 10.0) < 1e-4


@pytest.mark.parametrize("name", REFRAMING)
@pytest.mark.parametrize("kind", ["SUBSURF", "TRIANGULATE"])
def test_the_center_is_that_of_the_body_with_its_modifiers(name, kind):
    obj = add(mesh_body(), rotation=(0.1, 0.2, 0.3))
    bare = measured(obj).mass_properties.center
    obj.modifiers.new("M", kind)
    assert kind != "SUBSURF" or np.abs(measured(obj).mass_properties.center - bare).max() > 1e-3
    assert_stays(name, obj, 4.0 * TOLERANCE)
    assert_reframed(name, obj)


@pytest.mark.parametrize("name", REFRAMING)
@pytest.mark.parametrize(
    "kind, options",
    [
        ("SIMPLE_DEFORM", {"deform_method": "TAPER", "factor": 0.5}),
        ("CAST", {"factor": 0.5}),
        ("MIRROR", {"use_axis": (True, True, True), "use_bisect_axis": (True, True, True)}),
    ],
)
def test_local_space_modifier_is_refused_unchanged(name, kind, options):
    obj = add(mesh_body(), location=(1, 2, 3))
    modifier = obj.modifiers.new("Local One", kind)
    for key, value in options.items():
        setattr(modifier, key, value)
    add(None, "Child", parent=obj, select=False)
    assert_refused(name, obj)


@pytest.mark.parametrize("name", [ALIGN, "body_moments_match_pose"])
@pytest.mark.parametrize("kind", ["LATTICE", "ARRAY", "MIRROR"])
def test_modifier_bound_to_place_refuses_motion_unchanged(name, kind, reported):
    target = add(mesh_body(), "Target")
    cage = add(bpy.data.lattices.new("Cage"), "Cage", rotation=(0.5, 0.4, 0.3), scale=(9, 9, 9))
    cage.data.points[1].co_deform.x += 0.3
    obj = add(mesh_body(), location=(1, 2, 1), rotation=(0.3, 0.2, 0.1))
    if kind == "LATTICE":
        obj.modifiers.new("Bent", "LATTICE").object = cage
    elif kind == "MIRROR":
        obj.modifiers.new("Bent", "MIRROR").mirror_object = cage
    else:
        array = obj.modifiers.new("Bent", "ARRAY")
        array.use_relative_offset, array.use_object_offset, array.offset_object = False, True, cage
    only(target, obj)
    bpy.context.view_layer.update()
    target.select_set(name != ALIGN)
    assert_refused(name, obj)
    assert reported.values("modifiers_change_shape") == {"modifiers": ["Bent"]}


def test_body_bent_by_its_child_is_aligned():
    obj = add(mesh_body(), location=(1, 2, 1), rotation=(0.3, 0.2, 0.1))
    cage = add(bpy.data.lattices.new("Cage"), "Cage", scale=(9, 9, 9))
    cage.data.points[1].co_deform.x += 0.3
    cage.parent, cage.matrix_parent_inverse = obj, obj.matrix_world.inverted()
    obj.modifiers.new("Bent", "LATTICE").object = cage
    only(obj)
    bpy.context.view_layer.update()
    assert run(ALIGN) == {"FINISHED"}
    assert run(ALIGN) == {"CANCELLED"}


def test_a_mirror_about_another_object_is_handled():
    mirror = add(None, "Mirror", location=(-1, 0, 0))
    obj = add(mesh_body(), location=(1, 2, 3))
    obj.modifiers.new("Mirror", "MIRROR").mirror_object = mirror
    assert_stays(ORIGIN, obj, 2.0 * TOLERANCE)
    assert_origin_is_center(obj)


def test_an_object_that_others_mirror_about_is_refused():
    obj = add(mesh_body(), location=(1, 2, 3))
    other = add(mesh_body("Other"), "Other", location=(9, 0, 0))
    other.modifiers.new("Mirror", "MIRROR").mirror_object = obj
    only(obj)
    bpy.context.view_layer.update()
    assert_refused(ORIGIN, obj, other)


def test_child_of_constraints_are_held():
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    follower = add(None, "Follower", location=(5, 5, 5))
    constraint = follower.constraints.new("CHILD_OF")
    constraint.target = obj
    only(obj)
    before = place(follower)
    assert run(AXES) == {"FINISHED"}
    assert np.abs(place(follower) - before).max() < 1e-5


@pytest.mark.parametrize(
    "channel, lock",
    [("location", "lock_location"), ("rotation_euler", "lock_rotation"), ("scale", "lock_scale")],
)
def test_locked_and_driven_channels_are_refused(channel, lock):
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.4, 0.5, 0.6), scale=(1, 2, 3))
    setattr(obj, lock, (True, True, True))
    assert_refused(AXES, obj)
    setattr(obj, lock, (False, False, False))
    obj.keyframe_insert(channel, frame=1)
    assert_refused(AXES, obj)
    obj.animation_data_clear()
    assert run(AXES) == {"FINISHED"}


def test_an_open_body_has_no_center_of_its_own():
    obj = add(mesh_of([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], "Open"))
    assert_refused(ORIGIN, obj)
    obj.body_moments.kind = "SHELL"
    assert run(ORIGIN) == {"FINISHED"}
    assert np.abs(place(obj)[:3, 3] - [1 / 3, 1 / 3, 0]).max() < 1e-6


def test_curves_and_text():
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = 0.2
    curve.use_fill_caps = True
    spline = curve.splines.new("POLY")
    spline.points.add(2)
    for point, co in zip(spline.points, ((0, 0, 0, 1), (2, 0, 0, 1), (2, 3, 1, 1))):
        point.co = co
    assert_stays(ORIGIN, add(curve, location=(1, 2, 3)), 1e-5)
    text = bpy.data.curves.new("Text", "FONT")
    text.body = "Mass"
    text.extrude = 0.1
    obj = add(text, location=(4, 5, 6))
    assert_stays(ORIGIN, obj, 1e-5)
    assert_origin_is_center(obj)


@pytest.mark.parametrize("name", REFRAMING)
@pytest.mark.parametrize("size", [1e-5, 1e4])
def test_a_tiny_part_and_a_huge_one_are_the_same_problem(name, size):
    points = [tuple(size * c for c in point) for point in POINTS]
    obj = add(mesh_body("Body", points, size * HEIGHT), rotation=(0.3, 0.4, 0.5))
    obj.lock_location = (True, False, False)
    assert_refused(name, obj)
    obj.lock_location = (False, False, False)
    assert_stays(name, obj, TOLERANCE * size)
    assert np.abs(place(obj)[:3, 3] - measured(obj).mass_properties.center).max() < TOLERANCE * size
    assert run(name) == {"CANCELLED"}


@pytest.mark.parametrize("order", ["XYZ", "YZX", "ZXY", "XZY", "YXZ", "ZYX"])
def test_align_lays_the_principal_axes_along_the_worlds(order):
    obj = add(mesh_body(), location=(3, 2, 1), rotation=(0.5, 0.6, 0.7), scale=(1, 2, -1))
    before = measured(obj).mass_properties
    assert run(ALIGN, order=order) == {"FINISHED"}
    after = measured(obj).mass_properties
    assert np.abs(after.center - before.center).max() < TOLERANCE
    wanted = np.zeros(3)
    for moment, axis in zip(before.principal.moments, order):
        wanted["XYZ".index(axis)] = moment
    assert np.abs(after.inertia - np.diag(wanted)).max() < 1e-6 * np.trace(before.inertia)
    for i, axis in enumerate(order[:2]):
        assert after.principal.axes["XYZ".index(axis), i] > 0.999
    matrix = place(obj)
    assert run(ALIGN, order=order) == {"CANCELLED"}
    assert (place(obj) == matrix).all()


def test_align_to_the_world_origin_below_a_parent_with_a_child():
    parent = add(None, "Parent", location=(1, 2, 3), rotation=(0.4, 0, 0.2), scale=(2, 2, 2))
    obj = add(mesh_body(), location=(3, 2, 1), parent=parent)
    child = add(mesh_body("Child"), "Child", location=(0, 0, 4), parent=obj)
    only(obj)
    relative = np.linalg.solve(place(obj), place(child))
    assert run(ALIGN, pivot="ORIGIN") == {"FINISHED"}
    assert np.abs(measured(obj).mass_properties.center).max() < 1e-5
    assert np.abs(np.linalg.solve(place(obj), place(child)) - relative).max() < 1e-5
    assert run(ALIGN, pivot="ORIGIN") == {"CANCELLED"}


def test_stored_results_are_kept_up_to_date(reported):
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.1, 0.2, 0.3))
    bpy.ops.object.body_moments_measure()
    assert run(AXES) == {"FINISHED"}
    assert not staleness.stale_reason(obj, bpy.context.scene)
    assert np.abs(np.array(obj["body_center_of_mass"])).max() < TOLERANCE
    assert np.abs(np.abs(obj["body_principal_axes"][0]) - 1.0) < 1e-6
    assert run(AXES) == {"CANCELLED"} and "Nothing to do" in reported.texts[-1]


def turned_within(obj, angle=0.4):
    """Turn the geometry within the object about its local z, as applying a rotation does."""
    c, s = np.cos(angle), np.sin(angle)
    for vertex in obj.data.vertices:
        x, y, z = vertex.co
        vertex.co = (c * x - s * y, s * x + c * y, z)
    obj.data.update()
    bpy.context.view_layer.update()


@pytest.mark.parametrize("vertices, fold", [(3, 3), (4, 4), (5, 5), (6, 6)])
def test_a_prism_turned_within_its_object_gets_its_own_axes(vertices, fold):
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=vertices, depth=5, location=(1, 2, 3), rotation=(0.3, 0.4, 0.5)
    )
    obj = bpy.context.object
    turned_within(obj)
    assert_stays(AXES, obj, 1e-5)
    points = np.array([vertex.co for vertex in obj.data.vertices])
    # the long axis is x now
    angles = np.degrees(np.arctan2(points[:, 2], points[:, 1])) % (360 / fold)
    step = 180 / fold
    # corners or the middles of sides on the axes
    assert np.abs((angles + step / 2) % step - step / 2).max() < 0.01
    assert run(AXES) == {"CANCELLED"}


@pytest.mark.parametrize(
    "name, options", [(AXES, {}), ("body_moments_rigid_bodies", {"frame": "AXES"})]
)
def test_a_cube_turned_within_its_object_gets_its_own_axes(name, options):
    bpy.ops.mesh.primitive_cube_add(location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
    obj = bpy.context.object
    turned_within(obj)
    assert run(name, **options) == {"FINISHED"}
    points = np.array([vertex.co for vertex in obj.data.vertices])
    assert np.abs(np.abs(points) - 1.0).max() < 1e-5
    assert run(AXES) == {"CANCELLED"}


@pytest.mark.parametrize("name", [AXES, ALIGN])
def test_strict_rule_poses_prism_and_refuses_cube(name):
    add(
        mesh_body(points=[(0, 0, 0), (3, 0, 0), (3.5, 1, 0), (1, 1, 0), (1, 2.5, 0), (0, 2, 0)]),
        location=(1, 2, 3),
        rotation=(0.3, 0.4, 0.5),
    )
    assert run(name, strict=True) == {"FINISHED"}
    assert run(name, strict=True) == {"CANCELLED"}
    bpy.ops.mesh.primitive_cube_add()
    assert run(name, strict=True) == {"CANCELLED"}


@pytest.mark.parametrize("name", [AXES, ALIGN])
@pytest.mark.parametrize(("side", "answer"), [(0.0228, "CANCELLED"), (0.028, "FINISHED")])
def test_strict_rule_needs_third_moments_beyond_rounding(name, side, answer, reported):
    """Of a box with a small one aside, whose third moments are hardly more than rounding may
    leave.
    """
    corners = np.array(list(product((-0.5, 0.5), repeat=3)))
    faces = np.array(QUADS)
    points = np.concatenate([corners * (1, 2, 4), corners * side + (0, 1.5, 3)])
    add(
        mesh_of(points, np.concatenate([faces, faces + 8]).tolist(), "Boxes"),
        rotation=(0.3, 0.4, 0.5),
    )
    assert run(name, strict=True) == {answer}
    assert ("strict_rule_undefined" in reported.codes) == (answer == "CANCELLED")


@pytest.mark.parametrize("parent", [True, False])
def test_empty_of_zero_scaled_object_is_refused(parent, reported):
    obj = add(mesh_body(), scale=(1, 1, 0))
    assert run("body_moments_add_empty", parent=parent) == {"CANCELLED"}
    assert list(bpy.data.objects) == [obj]
    assert ("scale_zero_axis" in reported.codes) == parent


@pytest.mark.parametrize("how", ["modifier", "parent"])
def test_armature_bound_body_is_not_turned(how, reported):
    bpy.ops.object.armature_add()
    armature = bpy.context.object
    obj = add(mesh_body(), rotation=(0.3, 0.4, 0.5))
    obj.vertex_groups.new(name="Bone").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
    if how == "modifier":
        obj.modifiers.new("Armature", "ARMATURE").object = armature
    else:
        obj.parent, obj.parent_type = armature, "ARMATURE"
    target = add(mesh_body(), "Target", location=(9, 0, 0))
    bpy.context.view_layer.update()
    for name, chosen in (("body_moments_match_pose", (target, obj)), (ALIGN, (obj,))):
        only(*chosen)
        reported.clear()
        assert_refused(name, obj)
        assert reported.values("bound_to_armature") == {"armature": armature.name}
    for name in REFRAMING:  # these leave it where it is
        assert run(name) == {"FINISHED"}
    obj.modifiers.clear()
    obj.parent = None
    assert run(ALIGN) == {"FINISHED"}
