# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability follows the place, the scene's gravity and the stored numbers."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import faults, stability
from body_moments.blender.session.tracking import handlers, staleness

from tests.blender.objects import add, only
from tests.close import close
from tests.operators.setup.test_remedy_buttons import boxes
from tests.operators.test_stability import box

pytestmark = pytest.mark.usefixtures("scene")


def update():
    bpy.context.view_layer.update()


def test_down_is_gravity_of_scene_or_minus_z(scene):
    for gravity, use, wanted in (
        ((0, 0, -9.81), True, (0, 0, -1)),
        ((3, 0, -4), True, (0.6, 0, -0.8)),
        ((3, 0, -4), False, (0, 0, -1)),
        ((0, 0, 0), True, (0, 0, -1)),
        ((0, 0.125, 0), True, (0, 1, 0)),
    ):
        scene.gravity, scene.use_gravity = gravity, use
        assert np.abs(stability.down(scene) - wanted).max() < 1e-7


def test_support_follows_place_scene_and_results(scene):
    obj = add(box((4.0, 2.0, 6.0)), location=(1, 2, 3))
    assert (
        stability.support(obj) is None
        and not staleness.stale_reason(obj, bpy.context.scene, stability.stamp_of)
        and not stability.is_known(obj)
    )
    bpy.ops.object.body_moments_stability()
    assert stability.is_known(obj)
    for change, margin in (
        (lambda: None, 1.0),
        (lambda: setattr(obj, "location", (-5, 7, 0)), 1.0),
        (lambda: setattr(obj, "rotation_euler", (np.pi / 2, 0, 0)), 2.0),
        (lambda: setattr(scene, "gravity", (0, -9.81, 0)), 1.0),
    ):
        change()
        update()
        handlers.count_change()
        assert close(stability.support(obj, scene).margin, margin, 1e-5)
    other = bpy.data.scenes.new("Other")
    for asked, margin in ((other, 2.0), (scene, 1.0), (None, 1.0), (other, 2.0)):
        assert close(stability.support(obj, asked).margin, margin, 1e-5)


def test_object_without_results_has_no_support(scene):
    obj = add(box((4.0, 2.0, 6.0)))
    bpy.ops.object.body_moments_stability()
    update()
    assert stability.support(obj).stands and stability.poses(obj) is not None
    del obj["body_mass"]
    handlers.count_change()
    assert stability.support(obj) is None and stability.poses(obj) is None and stability.is_known(obj)


def test_faults_are_drawn_in_place_for_instances_too():
    member = add(boxes(2.0, reverse=[0]), "Member", location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    shown = bpy.data.collections.new("Shown")
    bpy.context.scene.collection.children.link(shown)
    shown.objects.link(member)
    empty = add(None, "Empty", location=(10, 0, 0), rotation=(0, 0, 1.0), scale=(2, 2, 2))
    empty.instance_type, empty.instance_collection = "COLLECTION", shown
    only(member, empty)
    bpy.ops.object.body_moments_measure()
    own, others = faults.of_object(member), faults.of_object(empty)
    assert len(own.triangles) == len(others.triangles) > 0 and len(own.edges) == len(others.edges) > 0
    place = np.array(member.matrix_world, np.float64)
    for name in ("triangles", "edges"):
        of_member, of_empty = getattr(own, name), getattr(others, name)
        corners = {tuple(vertex.co) for vertex in member.data.vertices}
        assert {tuple(point) for point in of_member.reshape(-1, 3).tolist()} <= corners
        assert np.abs(of_empty - (of_member @ place[:3, :3].T + place[:3, 3])).max() < 1e-5
    member.data.vertices[0].co.x -= 0.5
    member.data.update()
    update()
    assert faults.of_object(member) is None
