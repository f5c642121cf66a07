# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What counts in a total and may be no part of it: cutters and helpers are objects like any other."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from bpy.types import LayerCollection, Object, ViewLayer

from ..write.text import listed

LISTED = 8  # names in a sentence before it only counts


def doubts(objects: Collection[Object], view_layer: ViewLayer) -> list[str]:
    """A sentence for each reason why some of the objects may be no parts of the body that they are summed to."""
    if len(objects) < 2:
        return []
    objects = sorted(objects, key=lambda obj: obj.name)
    operands: dict[Object, Object] = {}
    for user in objects:
        for operand in _operands(user):
            operands.setdefault(operand, user)
    cutters = [obj for obj in objects if obj in operands]
    rendered = set(_rendered(view_layer.layer_collection))
    unseen = [
        obj
        for obj in objects
        if obj not in operands
        and (
            obj.hide_render
            or obj not in rendered
            or obj.display_type in {"WIRE", "BOUNDS"}
            or not obj.visible_get(view_layer=view_layer)
        )
    ]
    found = []
    if cutters:
        names = listed(("“{:s}” of “{:s}”".format(obj.name, operands[obj].name) for obj in cutters), LISTED)
        found.append(
            "Operands of Boolean modifiers count as bodies of their own: {:s}; leave out what is no part.".format(
                ", ".join(names)
            )
        )
    if unseen:
        names = listed(("“{:s}”".format(obj.name) for obj in unseen), LISTED)
        found.append(
            "What is hidden, not rendered, or displayed as wire or bounds counts: {:s}; leave out what is no "
            "part.".format(", ".join(names))
        )
    return found


def unfounded(methods: Iterable[tuple[str, str]]) -> list[str]:
    """The same of bodies, as names and methods, whose own numbers stand on nothing."""
    names, count = [], 0
    for name, method in methods:
        count += 1
        if method.endswith("open"):
            names.append("“{:s}”".format(name))
    if not names or count < 2:
        return []
    return [
        "The total depends on a reference point, as the numbers of open bodies do: {:s}; close them, or leave them "
        "out.".format(", ".join(listed(sorted(names), LISTED)))
    ]


def _operands(obj: Object) -> Iterator[Object]:
    """The objects that the Boolean modifiers of another one work with."""
    for modifier in obj.modifiers:
        if modifier.type != "BOOLEAN" or not modifier.show_viewport:
            continue
        if modifier.operand_type == "OBJECT" and modifier.object is not None:
            yield modifier.object
        elif modifier.operand_type == "COLLECTION" and modifier.collection is not None:
            yield from modifier.collection.all_objects


def _rendered(layer: LayerCollection) -> Iterator[Object]:
    """The objects of the collections that are rendered."""
    if not layer.collection.hide_render:
        yield from layer.collection.objects
        for child in layer.children:
            yield from _rendered(child)
