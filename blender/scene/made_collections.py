# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Collections of objects that the add-on makes."""

from __future__ import annotations

import bpy
from bpy.types import Collection, Context, Object


def made_collection(context: Context, key: str, owner: object, name: str) -> Collection:
    """Return the scene's collection whose ID property `key` is the owner, included in the view layer, or a new one."""
    for collection in context.scene.collection.children_recursive:
        if collection.get(key) == owner and collection.is_editable:
            _include(context, collection)
            return collection
    collection = bpy.data.collections.new(name)
    collection[key] = owner
    context.scene.collection.children.link(collection)
    return collection


class MadeCollection:
    """A scene's collection of objects made for an armature, cleared of earlier ones; everything else in it stays.

    key: name of the ID property, of the collection and the objects made in it, that holds the armature object.
    """

    def __init__(self, context: Context, armature: Object, key: str, name: str):
        self._armature, self._key = armature, key
        self._collection = made_collection(context, key, armature, "{:s} {:s}".format(armature.name, name))
        self._clear()

    def _clear(self) -> None:
        made = [obj for obj in self._collection.objects if obj.get(self._key) == self._armature]
        meshes = {obj.data for obj in made if obj.data is not None}
        bpy.data.batch_remove(made)
        bpy.data.batch_remove([mesh for mesh in meshes if not mesh.users])  # other meshes have users of their own

    def link(self, obj: Object) -> None:
        obj[self._key] = self._armature
        self._collection.objects.link(obj)


def _include(context: Context, collection: Collection) -> None:
    """Include a collection in the view layer, as Blender adds rigid bodies and joints only to objects in it."""
    layers, found = [context.view_layer.layer_collection], []
    for layer in layers:
        layers += layer.children
        if layer.collection == collection:
            found.append(layer)
    if all(layer.exclude for layer in found):
        found[0].exclude = False
