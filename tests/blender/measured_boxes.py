# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes, added and measured."""

import bpy
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.settings.options import MeasureOptions

CUBE = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def corners(low, high):
    return [
        (x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])
    ]


def box(low=(0, 0, 0), high=(1, 2, 3), name="Box", turned=False):
    return {
        "points": corners(low, high),
        "faces": [face[::-1] for face in CUBE] if turned else CUBE,
        "name": name,
    }


def add(*shells, name="Box", **transform):
    points, faces = [], []
    for shell in shells:
        faces += [tuple(i + len(points) for i in face) for face in shell["faces"]]
        points += shell["points"]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    for key, value in transform.items():
        setattr(obj, key, value)
    bpy.context.view_layer.update()
    return obj


def measure(obj, **options):
    return measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(**options))


def collection_of(*objects):
    """An empty that shows a collection with these objects."""
    members = bpy.data.collections.new("Members")
    for obj in objects:
        bpy.context.scene.collection.objects.unlink(obj)
        members.objects.link(obj)
    empty = bpy.data.objects.new("Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", members
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.update()
    return empty
