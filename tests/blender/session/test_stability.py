# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability follows the place, the scene's gravity and the stored numbers."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import faults

from tests.blender.objects import add, dent, measure
from tests.operators.overlapping_boxes import boxes

pytestmark = pytest.mark.usefixtures("scene")


def update():
    bpy.context.view_layer.update()


def test_faults_are_drawn_in_place_for_instances_too():
    member = add(boxes(2.0, reverse=[0]), "Member", location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    shown = bpy.data.collections.new("Shown")
    bpy.context.scene.collection.children.link(shown)
    shown.objects.link(member)
    empty = add(None, "Empty", location=(10, 0, 0), rotation=(0, 0, 1.0), scale=(2, 2, 2))
    empty.instance_type, empty.instance_collection = "COLLECTION", shown
    measure(member, empty)
    own, others = faults.of_object(member), faults.of_object(empty)
    assert (
        len(own.triangles) == len(others.triangles) > 0 and len(own.edges) == len(others.edges) > 0
    )
    place = np.array(member.matrix_world, np.float64)
    for name in ("triangles", "edges"):
        of_member, of_empty = getattr(own, name), getattr(others, name)
        corners = {tuple(vertex.co) for vertex in member.data.vertices}
        assert {tuple(point) for point in of_member.reshape(-1, 3).round(12).tolist()} <= corners
        assert np.abs(of_empty - (of_member @ place[:3, :3].T + place[:3, 3])).max() < 1e-5
    dent(member, -0.5)
    assert faults.of_object(member) is None
