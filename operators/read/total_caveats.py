# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What counts in a total and may be no part of it: cutters and helpers are objects like any other."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from bpy.types import LayerCollection, Object, ViewLayer

from ...core.verdict.finding import Finding, finding
from ...core.verdict.method import Method, Verdict


def total_caveats(objects: Collection[Object], view_layer: ViewLayer) -> list[Finding]:
    """A finding for each reason why some of the objects may be no parts of the body that they are summed to."""
    if len(objects) < 2:
        return []
    objects = sorted(objects, key=lambda obj: obj.name)
    operands: dict[Object, Object] = {}
    for user in objects:
        for operand in _operands(user):
            operands.setdefault(operand, user)
    cutters = [[obj.name, operands[obj].name] for obj in objects if obj in operands]
    rendered = set(_rendered(view_layer.layer_collection))
    unseen = [
        obj.name
        for obj in objects
        if obj not in operands
        and (
            obj.hide_render
            or obj not in rendered
            or obj.display_type in {"WIRE", "BOUNDS"}
            or not obj.visible_get(view_layer=view_layer)
        )
    ]
    findings = []
    if cutters:
        findings.append(finding("total_boolean_operands", operands=cutters))
    if unseen:
        findings.append(finding("total_hidden_objects", objects=unseen))
    return findings


def open_body_caveats(methods: Iterable[tuple[str, Method | None]]) -> list[Finding]:
    """The same of bodies, given as names and methods, whose own numbers depend on a reference point."""
    methods = list(methods)
    names = sorted(name for name, method in methods if method is not None and method.verdict == Verdict.OPEN)
    return [finding("total_of_open_objects", objects=names)] if names and len(methods) > 1 else []


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
