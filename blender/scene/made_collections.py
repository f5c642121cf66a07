# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Collections of objects made for an armature.

Objects made before are replaced; all else in them stays.
"""

from __future__ import annotations

import bpy
from bpy.types import Collection, Context, Object


class MadeCollection:
    """The collection of a scene for an armature, with nothing made in it yet, in the view layer.

    key: ID property of it and of the objects made in it: the armature object.
    """

    def __init__(self, context: Context, armature: Object, key: str, name: str):
        self._armature, self._key = armature, key
        for collection in context.scene.collection.children_recursive:
            if collection.get(key) == armature and collection.is_editable:
                self._collection = collection
                self._clear()
                _include(context, collection)
                return
        self._collection = bpy.data.collections.new("{:s} {:s}".format(armature.name, name))
        self._collection[key] = armature
        context.scene.collection.children.link(self._collection)

    def _clear(self) -> None:
        made = [obj for obj in self._collection.objects if obj.get(self._key) == self._armature]
        meshes = {obj.data for obj in made if obj.data is not None}
        bpy.data.batch_remove(made)
        bpy.data.batch_remove([mesh for mesh in meshes if not mesh.users])  # else an object of the user's has it

    def link(self, obj: Object) -> None:
        obj[self._key] = self._armature
        self._collection.objects.link(obj)


def _include(context: Context, collection: Collection) -> None:
    """Include a collection in the view layer: Blender adds rigid bodies and joints to objects there alone."""
    layers, found = [context.view_layer.layer_collection], []
    for layer in layers:
        layers += layer.children
        if layer.collection == collection:
            found.append(layer)
    if all(layer.exclude for layer in found):
        found[0].exclude = False
