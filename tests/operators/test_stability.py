# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Stability and Rest on Ground: margins and angles through Blender's matrices, poses, one
undo step, refusals.
"""

from math import atan2, degrees

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import stability
from body_moments.blender.session.tracking.staleness import stale_reason
from body_moments.blender.session.tracking.stamps import Kind

from tests.blender import objects
from tests.close import close
from tests.operators.standing import box, wedge
from tests.panels.drawing import shown

BLENDER = 1e-6  # of the size, through float32 matrices


def support(obj):
    bpy.context.view_layer.update()
    return stability.support(obj, bpy.context.scene)


def lowest(obj):
    return objects.seen(obj)[:, 2].min()


@pytest.mark.parametrize("scale", [1.0, 0.001])
def test_a_box_stands_by_its_narrow_side_wherever_it_is(scene, scale):
    scene.unit_settings.scale_length = scale
    obj = objects.add(
        box((4.0, 2.0, 6.0)),
        location=(30.0, -20.0, 5.0),
        rotation=(0, 0, 0.7),
        scale=(1.0, 1.0, 0.5),
    )
    assert bpy.ops.object.body_moments_stability() == {"FINISHED"}
    found = support(obj)
    assert found.stands
    assert close(found.margin, 1.0, BLENDER * 4.0)
    assert close(found.height, 1.5, BLENDER * 4.0)
    assert close(found.tipping_angle, atan2(1.0, 1.5), BLENDER * 4.0)
    assert np.abs(found.polygon[:, 2] - 5.0).max() <= BLENDER * 30.0
    assert obj["body_mass"] > 0.0


def test_balance_beside_tips_over_makes_it_stand(scene):
    corners = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    # 0.05 beyond the base
    points = [(x + 0.275 * layer, y, 0.5 * layer) for layer in range(5) for x, y in corners]
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    sides = [tuple(4 * layer + corner for corner in side) for layer in range(4) for side in sides]
    obj = objects.add(
        objects.mesh_of(points, [(3, 2, 1, 0), (16, 17, 18, 19), *sides], "Tower"),
        location=(3.0, -2.0, 1.0),
        rotation=(0.0, 0.0, 0.4),
    )
    obj.vertex_groups.new(name="Above").add(list(range(4, 20)), 1.0, "REPLACE")
    bpy.ops.object.body_moments_stability()
    assert not support(obj).stands
    name = "object.body_moments_sculpt_balance"
    buttons = [entry[2] for entry in shown() if entry[:2] == ("operator", name)]
    (button,) = [button for button in buttons if hasattr(button, "target")]
    options = {"target": button.target, "point": list(button.point)}
    assert bpy.ops.object.body_moments_sculpt_balance(**options) == {"FINISHED"}
    bpy.ops.object.body_moments_stability()
    assert support(obj).stands and close(support(obj).margin, 0.25, 1e-4)


def test_support_follows_a_turn_without_measuring_again(scene):
    obj = objects.add(box((2.0, 2.0, 6.0), (-1.0, -1.0, 0.0)))
    bpy.ops.object.body_moments_stability()
    mark = obj["body_fingerprint"]
    assert support(obj).stands
    obj.rotation_euler.x = np.radians(30.0)  # beyond atan(1 / 3)
    found = support(obj)
    assert not found.stands and len(found.polygon) == 2
    assert close(
        found.margin, -(3.0 * np.sin(np.radians(30.0)) - np.cos(np.radians(30.0))), BLENDER * 10.0
    )
    obj.rotation_euler.x = 0.0
    assert support(obj).stands
    assert obj["body_fingerprint"] == mark


def test_down_is_direction_of_scene_gravity(scene):
    obj = objects.add(box((4.0, 2.0, 6.0)))
    bpy.ops.object.body_moments_stability()
    scene.gravity = (0.0, 3.0, 0.0)
    found = support(obj)
    assert close(found.height, 1.0, BLENDER) and close(found.margin, 2.0, BLENDER)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_a_wedge_tips_over_its_edge(scene, size):
    obj = objects.add(wedge(), rotation=(0.0, 0.0, 0.9), scale=(size, size, size))
    bpy.ops.object.body_moments_stability()
    found = support(obj)
    assert not found.stands
    assert close(found.margin, -0.25 * size, BLENDER * 10.0)
    assert close(found.tipping_angle, -atan2(0.25, 1.0), BLENDER * 10.0)
    assert close(found.direction[:2], (np.cos(0.9), np.sin(0.9)), BLENDER * 10.0)


def test_balance_makes_a_wedge_stand(scene):
    obj = objects.add(wedge(), rotation=(0.0, 0.0, 0.9))
    bpy.ops.object.body_moments_stability()
    bpy.ops.object.body_moments_sculpt_balance(
        target="POINT", point=support(obj).polygon.mean(axis=0)
    )
    found = support(obj)
    assert found.stands and close(found.margin, 0.5, BLENDER * 10.0)


def test_an_edit_puts_it_out_of_date(scene):
    obj = objects.add(box((4.0, 2.0, 6.0)))
    bpy.ops.object.body_moments_stability()
    for vertex in obj.data.vertices[:4]:
        vertex.co.x -= 1.0
    obj.data.update()
    assert support(obj) is None and stale_reason(obj, scene, Kind.HULL)
    bpy.ops.object.body_moments_stability()
    assert close(obj["body_volume"], 60.0, BLENDER) and support(obj).stands


@pytest.mark.parametrize("rotation", [(0.3, 1.1, -0.4), (2.0, 0.2, 3.0)])
@pytest.mark.parametrize("pose", [1, 3, 6])
def test_a_box_is_laid_on_the_chosen_face(scene, rotation, pose):
    sides = np.array([4.0, 2.0, 6.0])
    obj = objects.add(box(sides, (5.0, 0.0, 0.0)), location=(3.0, 4.0, 9.0), rotation=rotation)
    bpy.ops.object.body_moments_measure()
    center = objects.measured(obj).mass_properties.center
    assert bpy.ops.object.body_moments_rest_on_ground(pose=pose) == {"FINISHED"}
    after = objects.measured(obj).mass_properties.center
    assert np.abs(after[:2] - center[:2]).max() <= BLENDER * 10.0
    assert abs(lowest(obj)) <= BLENDER * 10.0
    height = {1: 1.0, 3: 2.0, 6: 3.0}[pose]
    assert close(after[2], height, BLENDER * 10.0)
    found = support(obj)
    assert found.stands and len(found.polygon) == 4
    assert obj["body_center_of_mass"] is not None and close(obj["body_mass"], 48000.0, 1e-5)


@pytest.mark.parametrize("size", [1.0, 1e-3])
@pytest.mark.parametrize("angle", [5e-4, 1e-5])
def test_slightly_turned_box_is_laid_flat(scene, size, angle):
    place = {
        "location": (0.0, 0.0, 0.5 * size),
        "rotation": (angle, 0.0, 0.0),
        "scale": (size,) * 3,
    }
    obj = objects.add(box((3.0, 3.0, 1.0), (-1.5, -1.5, -0.5)), **place)
    assert bpy.ops.object.body_moments_rest_on_ground(pose=0) == {"FINISHED"}
    assert np.abs(objects.place(obj)[:3, :3] / size - np.eye(3)).max() < 2e-6
    assert bpy.ops.object.body_moments_rest_on_ground(pose=0) == {"CANCELLED"}


@pytest.mark.parametrize(
    ("angle", "height", "is_laid"), [(0, 1e-4, False), (0, 1e-3, True), (5e-4, 0, True)]
)
def test_distance_limits_height_and_not_turn_of_resting(scene, angle, height, is_laid):
    """Of a location of 1000, single precision holds 6e-5."""
    place = {"location": (1000.0, 0.0, 0.5 + height), "rotation": (angle, 0.0, 0.0)}
    obj = objects.add(box((3.0, 3.0, 1.0), (-1.5, -1.5, -0.5)), **place)
    assert bpy.ops.object.body_moments_rest_on_ground(pose=0) == (
        {"FINISHED"} if is_laid else {"CANCELLED"}
    )
    found = objects.place(obj)
    assert np.abs(found[:3, :3] - np.eye(3)).max() < 2e-6
    assert close(found[2, 3], 0.5 if is_laid else 0.5 + height, 1e-6)


def test_pose_0_is_the_nearest(scene):
    obj = objects.add(box((4.0, 2.0, 6.0)), rotation=(0.1, 0.05, 0.0), location=(0.0, 0.0, 2.0))
    bpy.ops.object.body_moments_rest_on_ground(pose=0)
    assert close(support(obj).height, 3.0, BLENDER * 10.0)
    assert degrees(obj.matrix_world.to_3x3().col[2].angle((0.0, 0.0, 1.0))) < 0.01


@pytest.mark.parametrize("ground, level", [("CURSOR", 2.5), ("LOWEST", 7.0)])
def test_object_rests_on_chosen_ground(scene, ground, level):
    scene.cursor.location = (9.0, 9.0, 2.5)
    obj = objects.add(box((4.0, 2.0, 6.0)), location=(0.0, 0.0, 7.0))
    bpy.ops.object.body_moments_rest_on_ground(pose=1, ground=ground)
    assert abs(lowest(obj) - level) <= BLENDER * 10.0


def test_a_mirrored_sheared_child_is_laid_too(scene):
    parent = objects.add(None, "Parent", rotation=(0.3, 0.2, 0.1), scale=(2.0, 2.0, 2.0))
    obj = objects.add(
        objects.mesh_body(), rotation=(1.0, 0.4, 2.0), scale=(-1.0, 1.5, 1.0), parent=parent
    )
    bpy.context.view_layer.update()
    objects.only(obj)
    assert bpy.ops.object.body_moments_rest_on_ground(pose=1) == {"FINISHED"}
    assert abs(lowest(obj)) <= BLENDER * 20.0
    assert support(obj).stands and len(support(obj).polygon) >= 3


def test_instances_stand_on_all_their_bodies(scene):
    part = objects.add(box((1.0, 1.0, 1.0), (-0.5, -0.5, 0.0)), "Leg")
    array = part.modifiers.new("Array", "ARRAY")
    array.use_relative_offset, array.use_constant_offset = False, True
    array.constant_offset_displace = (5.0, 0.0, 0.0)
    bpy.ops.object.body_moments_stability()
    found = support(part)
    assert close(np.ptp(found.polygon[:, 0]), 6.0, BLENDER)
