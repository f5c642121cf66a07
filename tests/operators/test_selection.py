# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects in order, parents first, and joints in another context."""

import bpy
import pytest
from body_moments.blender.scene import rigid_world
from body_moments.operators import selection

from tests.blender.objects import add, mesh_body, only
from tests.operators.test_refusals import linked_armature

pytestmark = pytest.mark.usefixtures("scene")


def test_parents_come_before_their_children_however_they_are_named():
    objects = [add(mesh_body(), name) for name in "abcd"]
    for child, parent in zip(objects, objects[1:], strict=False):
        child.parent = parent
    only(*objects)
    add(None, "Point", select=False).select_set(True)
    assert [obj.name for obj in selection.selected_measurable(bpy.context)] == ["d", "c", "b", "a"]


def test_a_joint_is_added_where_the_context_is_about_an_object_that_cannot_be_edited():
    linked_armature()
    rig = bpy.context.object
    joint = add(None, "Joint", select=False)
    bodies = [add(mesh_body(), name, select=False) for name in ("One", "Two")]
    with bpy.context.temp_override(object=rig, active_object=rig, selected_objects=[rig]):
        made = rigid_world.add_joint(bpy.context, joint, "HINGE")
        rigid_world.add_rigid_bodies(bpy.context, bodies, "PASSIVE")
        assert made == joint.rigid_body_constraint and made.type == "HINGE"
        assert [body.rigid_body.type for body in bodies] == ["PASSIVE"] * 2
        rigid_world.remove_joint(bpy.context, joint)
    assert joint.rigid_body_constraint is None and bpy.context.view_layer.objects.active == rig
