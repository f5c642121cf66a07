# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes of the scene that have to see their own results, many at a time; collections of objects
that are made.

To evaluate the scene costs as much for one changed object as for a thousand. So a change is a
generator: it yields whenever it needs the scene evaluated, and gets the evaluated depsgraph back.
Unrelated changes go forward side by side, with one evaluation for all of them.
"""

from collections.abc import Generator, Iterable, Iterator
from typing import TypeVar

import bpy
from bpy.types import ID, Collection, Context, Depsgraph, Object

from ...core.verdict import LINKED_OBJECT, EditRefusedError

Planned = TypeVar("Planned")
SceneChange = Generator[None, Depsgraph, None]  # yields once before it does anything
# Types through which objects refer to each other: a curve by its bevel, shape keys by drivers,
# particles by objects.
LINKING_TYPES = {
    "ARMATURE",
    "COLLECTION",
    "CURVE",
    "KEY",
    "LATTICE",
    "MESH",
    "META",
    "NODETREE",
    "PARTICLE",
    "TEXTURE",
}


def require_editable(data: ID) -> None:
    """Raise EditRefusedError for a linked object or collection."""
    if not data.is_editable:
        raise EditRefusedError(LINKED_OBJECT)


def require_storable_data(obj: Object) -> None:
    """Raise EditRefusedError for a linked object, and for a library override, of which a file keeps
    only the overridable properties.
    """
    if not obj.is_editable or obj.override_library is not None:
        raise EditRefusedError(LINKED_OBJECT)


def ancestors(obj: Object | None) -> Iterator[Object]:
    """Yield the object, its parent, its grandparent and so on."""
    while obj is not None:
        yield obj
        obj = obj.parent


def run_change(context: Context, change: SceneChange) -> None:
    """Run a change to its end, or to the exception that it raises, and evaluate the scene."""
    try:
        next(change)
        while True:
            context.view_layer.update()
            change.send(context.evaluated_depsgraph_get())
    except StopIteration:
        pass
    finally:
        change.close()
        context.view_layer.update()


def run_together(changes: Iterable[SceneChange]) -> SceneChange:
    """Return one change that runs several changes side by side; if one fails, the others are put
    back.
    """
    waiting = list(changes)
    try:
        for change in waiting:
            next(change)
        while waiting:
            depsgraph = yield
            for change in [*waiting]:
                try:
                    change.send(depsgraph)
                except StopIteration:
                    waiting.remove(change)
    finally:
        for change in waiting:  # after an error; `GeneratorExit` lets each put back its changes
            change.close()


def independent_rounds(changes: Iterable[tuple[Planned, set[ID]]]) -> list[list[Planned]]:
    """Group changes, given with the data that they may touch, into rounds: changes of the same data
    follow in order.
    """
    last_round: dict[ID, int] = {}  # last round of the changes that touch the data
    by_round: dict[int, list[Planned]] = {}
    for change, touched in changes:
        index = 1 + max((last_round.get(data, -1) for data in touched), default=-1)
        last_round.update(dict.fromkeys(touched, index))
        by_round.setdefault(index, []).append(change)
    return list(by_round.values())


def dependents(objects: Iterable[Object]) -> dict[Object, set[Object]]:
    """Return, for each object, itself and its direct and indirect users, whose look its change may
    affect.
    """
    users = users_of(objects, {"OBJECT", *LINKING_TYPES})

    def reached(obj: Object) -> set[Object]:
        reachable: set[ID] = {obj}
        front: set[ID] = {obj}
        while front:
            front = {user for data in front for user in users[data]} - reachable
            reachable |= front
        # A collection leads on to the objects that show it as instances, not to its other members.
        return {data for data in reachable if isinstance(data, Object)}

    return {obj: reached(obj) for obj in objects}


def users_of(objects: Iterable[Object], through: set[str]) -> dict[ID, set[ID]]:
    """Return the users of each object, and of each user, direct or indirect, whose type is in
    `through`.
    """
    users: dict[ID, set[ID]] = {}
    new: set[ID] = set(objects)
    while new:
        users |= bpy.data.user_map(subset=new, value_types={"OBJECT", *LINKING_TYPES})
        new = {
            user for data in new for user in users[data] if user.id_type in through
        } - users.keys()
    return users


def made_collection(context: Context, key: str, owner: object, name: str) -> Collection:
    """Return the scene's collection whose ID property `key` is the owner, included in the view
    layer, or a new one.
    """
    for collection in context.scene.collection.children_recursive:
        if collection.get(key) == owner and collection.is_editable:
            _include(context, collection)
            return collection
    collection = bpy.data.collections.new(name)
    collection[key] = owner
    context.scene.collection.children.link(collection)
    return collection


class MadeCollection:
    """A scene's collection of objects made for an armature. The constructor removes the objects
    made earlier, with their meshes; everything else in the collection stays.

    key: name of the ID property that holds the armature object, on the collection and the objects
    made in it.
    """

    def __init__(self, context: Context, armature: Object, key: str, name: str):
        self._armature, self._key = armature, key
        self._collection = made_collection(
            context, key, armature, "{:s} {:s}".format(armature.name, name)
        )
        made = [obj for obj in self._collection.objects if obj.get(self._key) == self._armature]
        meshes = {obj.data for obj in made if obj.data is not None}
        bpy.data.batch_remove(made)
        # A mesh with users left belongs to other objects, too.
        bpy.data.batch_remove([mesh for mesh in meshes if not mesh.users])

    def link(self, obj: Object) -> None:
        obj[self._key] = self._armature
        self._collection.objects.link(obj)


def _include(context: Context, collection: Collection) -> None:
    """Include a collection in the view layer, as Blender adds rigid bodies and joints only to
    objects in it.
    """
    waiting = [context.view_layer.layer_collection]
    layers = []  # a collection that is linked in several places has several
    while waiting:
        layer = waiting.pop(0)
        waiting += layer.children
        if layer.collection == collection:
            layers.append(layer)
    if all(layer.exclude for layer in layers):
        layers[0].exclude = False
