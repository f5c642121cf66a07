# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies of boxes."""

import bpy

from tests.blender.boxes import box, collection

BOXES = [(7850, (1, 2, 4), (8, 0, -2)), (1000, (2, 2, 2), (-4, 6, 1))]


def activate(made):
    """Make a collection the active one."""

    def found(layer):
        if layer.collection == made:
            return layer
        return next(filter(None, map(found, layer.children)), None)

    bpy.context.view_layer.active_layer_collection = found(bpy.context.view_layer.layer_collection)


def assembly_of_boxes():
    root = collection("Robot")
    inner = collection("Arm", root)
    for number, (density, size, at) in enumerate(BOXES):
        box(inner if number else root, size, at, density, f"b{number}")
    activate(root)
    return root


def linked_assembly():
    """A collection of a library in the scene, the active one."""
    root = assembly_of_boxes()
    path = bpy.app.tempdir + "assembly.blend"
    name = root.name
    bpy.data.libraries.write(path, {root})
    bpy.data.batch_remove([*bpy.data.objects, *bpy.data.meshes, *bpy.data.collections])
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.collections = [name]
    bpy.context.scene.collection.children.link(names.collections[0])
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children[name]
