# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, collections and armatures of small scenes."""

from fractions import Fraction

import bpy
import numpy as np

from tests.blender.objects import add, only


def box_mesh(x, y, z, center=(0.0, 0.0, 0.0)):
    corners = (
        np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        * (x / 2, y / 2, z / 2)
        + center
    )
    mesh = bpy.data.meshes.new("Box")
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners.tolist(), [], faces)
    mesh.update()
    return mesh


def collection(name="Assembly", parent=None):
    made = bpy.data.collections.new(name)
    (parent or bpy.context.scene.collection).children.link(made)
    return made


def box(into, size, at=(0, 0, 0), density=1000.0, name="Box", **place):
    obj = add(box_mesh(*size), name, at, **place)
    obj.body_moments.density = density
    for other in obj.users_collection:
        other.objects.unlink(obj)
    into.objects.link(obj)
    bpy.context.view_layer.update()
    return obj


def empty(into, name="Empty", at=(0, 0, 0), mass=None):
    obj = bpy.data.objects.new(name, None)
    into.objects.link(obj)
    obj.location = at
    if mass is not None:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", mass
    return obj


def boxes_inertia(boxes):
    """(mass, center, tensor about the center) of axis-parallel boxes (density, size, center), in
    exact fractions.
    """
    exact = [
        (Fraction(density), [Fraction(value) for value in size], [Fraction(value) for value in at])
        for density, size, at in boxes
    ]
    masses = [density * size[0] * size[1] * size[2] for density, size, _ in exact]
    total = sum(masses)
    center = [
        sum(mass * at[i] for mass, (_, _, at) in zip(masses, exact)) / total for i in range(3)
    ]
    second = [[Fraction(0)] * 3 for _ in range(3)]
    for mass, (_, size, at) in zip(masses, exact):
        for i in range(3):
            second[i][i] += mass * size[i] ** 2 / 12
            for j in range(3):
                second[i][j] += mass * (at[i] - center[i]) * (at[j] - center[j])
    trace = sum(second[i][i] for i in range(3))
    tensor = [[(trace if i == j else 0) - second[i][j] for j in range(3)] for i in range(3)]
    return float(total), np.array(center, float), np.array(tensor, float)


def update():
    bpy.context.view_layer.update()


def armature_with(*meshes):
    data = bpy.data.armatures.new("Armature")
    armature = add(data, "Armature")
    only(armature)
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    for mesh in meshes:
        mesh.parent = armature
        mesh.modifiers.new("Armature", "ARMATURE").object = armature
        mesh.vertex_groups.new(name="Bone").add(list(range(6, 12)), 1.0, "REPLACE")
    update()
    return armature
