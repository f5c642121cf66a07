# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters in Blender: a skin, an armature and weights, made of those of
tests/core/characters.py.
"""

import bpy
import numpy as np


def armature_of(character, name="Rig", parents=None):
    """An armature object with the character's bones. parents: name → name of the bone above."""
    data = bpy.data.armatures.new(name)
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    for bone_name, (head, tail) in zip(character.names, character.bones.tolist()):
        bone = data.edit_bones.new(bone_name)
        bone.head, bone.tail = head, tail
    for child, parent in (parents or {}).items():
        data.edit_bones[child].parent = data.edit_bones[parent]
    bpy.ops.object.mode_set(mode="OBJECT")
    return obj


def skin_of(character, armature, name="Skin", density=1000.0):
    """A mesh object with the character's surface and weights, deformed by the armature object."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(character.points.tolist(), [], character.quads.tolist())
    mesh.update()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    obj.parent = armature
    groups = [obj.vertex_groups.new(name=bone) for bone in character.names]
    weights = character.weights
    for vertex, bone, weight in zip(
        weights.vertex.tolist(), weights.bone.tolist(), weights.weight.tolist()
    ):
        groups[bone].add([vertex], weight, "REPLACE")
    obj.modifiers.new("Armature", "ARMATURE").object = armature
    obj.body_moments.density = density
    bpy.context.view_layer.update()
    return obj


PARENTS = {
    "chest": "hips",
    "head": "chest",
    "arm.L": "chest",
    "arm.R": "chest",
    "leg.L": "hips",
    "leg.R": "hips",
}


def pose(armature, seed=1):
    """Turn every bone."""
    rng = np.random.default_rng(seed)
    for bone in armature.pose.bones:
        bone.rotation_mode = "XYZ"
        bone.rotation_euler = rng.uniform(-0.5, 0.5, 3)
    bpy.context.view_layer.update()
