# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A character of boxes, and its weight."""

import bpy
import numpy as np
from body_moments.blender.session.character import weight as character

from tests.blender.objects import add, mesh_body

HEIGHT = 1.75


def weight(rig):
    bpy.context.view_layer.update()
    return character.weight(rig, bpy.context.evaluated_depsgraph_get())


def boxes():
    """An armature of three bones in a chain, and a mesh of three boxes, each on one of them
    alone.
    """
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for number in range(3):
        bone = rig.data.edit_bones.new("bone{:d}".format(number))
        bone.head, bone.tail = (0, 0, number), (0.2, 0.1, number + 0.8)
        bone.parent = rig.data.edit_bones[number - 1] if number else None
    bpy.ops.object.mode_set(mode="OBJECT")
    body = add(mesh_body())
    points = np.array([vertex.co for vertex in body.data.vertices])
    faces = [tuple(face.vertices) for face in body.data.polygons]
    mesh, count = bpy.data.meshes.new("Boxes"), len(points)
    places = np.concatenate([0.1 * points + (0, 0, number) for number in range(3)])
    mesh.from_pydata(
        places, [], [tuple(np.array(face) + count * k) for k in range(3) for face in faces]
    )
    bpy.data.objects.remove(body)
    body = add(mesh, "Boxes")
    for number in range(3):
        group = body.vertex_groups.new(name="bone{:d}".format(number))
        group.add(range(count * number, count * (number + 1)), 1.0, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = rig
    return rig, body
