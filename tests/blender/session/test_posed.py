# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which meshes an armature stands for while it is posed."""

import bpy
import pytest
from body_moments.blender.session.live import following
from body_moments.blender.session.tracking import armatures

from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


def test_armature_stands_for_its_deformed_meshes():
    rig, other = add(bpy.data.armatures.new("Rig"), "Rig"), add(bpy.data.armatures.new("Other"), "Other")

    def mesh(name, parent=None, parent_type="OBJECT", armature=None):
        obj = add(mesh_body(), name)
        obj.parent, obj.parent_type = parent, parent_type
        if armature is not None:
            obj.modifiers.new("Armature", "ARMATURE").object = armature
        return obj

    free, below = mesh("Free"), mesh("Below", rig)
    bound, skinned = mesh("Bound", rig, "ARMATURE"), mesh("Skinned", None, "OBJECT", rig)
    mesh("Bound to Other", other, "ARMATURE")
    mesh("Skinned by Other", rig, "OBJECT", other)
    hooked = mesh("Hooked")
    hooked.modifiers.new("Hook", "HOOK").object = rig
    hidden = mesh("Skinned, not shown", None, "OBJECT", rig)
    hidden.modifiers["Armature"].show_viewport = False
    curve = add(bpy.data.curves.new("Curve", "CURVE"), "Curve")
    curve.parent, curve.parent_type = rig, "ARMATURE"
    bpy.context.view_layer.update()
    assert armatures.deformed_meshes(rig) == (bound, skinned)
    assert armatures.subjects([rig, free, free]) == [rig, free]
    only(rig)
    bpy.ops.object.mode_set(mode="POSE")
    assert (
        armatures.stands_for_meshes(rig)
        and not armatures.stands_for_meshes(other)
        and not armatures.stands_for_meshes(free)
    )
    assert armatures.subjects([free, rig, bound, other]) == [free, bound, skinned, other]
    bpy.ops.object.mode_set(mode="OBJECT")
    hidden.modifiers["Armature"].show_viewport = True
    bpy.data.objects.remove(skinned)
    bpy.context.view_layer.update()
    assert armatures.deformed_meshes(rig) == (bound, hidden)
    assert not following.is_live(below) and following.current_numbers(below) is None
