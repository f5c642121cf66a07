# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects in a total that are, or may be, no part of the body, such as cutters and helpers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from bpy.types import LayerCollection, Object, Scene, ViewLayer

from ...core.verdict.finding import Finding, finding
from .findings import BOOLEAN_OPERAND, NOT_RENDERED, TOTAL_DOUBTFUL_PARTS


def left_out_reasons(scene: Scene, view_layer: ViewLayer) -> dict[Object, Finding]:
    """Return the objects that are no parts of the body, each with the reason: it is an operand, or not rendered."""
    # A layer that is switched off renders nothing; if all are switched off, the open layer counts.
    layers = [layer for layer in scene.view_layers if layer.use] or [view_layer]
    rendered = {obj for layer in layers for obj in _rendered(layer.layer_collection) if not obj.hide_render}
    operands = operands_of(scene.objects)
    reasons = {}
    for obj in scene.objects:
        if obj in operands and obj.display_type in {"WIRE", "BOUNDS"}:
            reasons[obj] = finding(BOOLEAN_OPERAND)
        elif obj not in rendered:
            reasons[obj] = finding(NOT_RENDERED)
    return reasons


def operands_of(objects: Iterable[Object]) -> dict[Object, Object]:
    """Return the operands of objects' Boolean modifiers, each with the first object by name that uses it."""
    operands: dict[Object, Object] = {}
    for user in sorted(objects, key=lambda obj: obj.name):
        for operand in _operands(user):
            operands.setdefault(operand, user)
    return operands


def total_caveats(objects: Collection[Object], view_layer: ViewLayer) -> list[Finding]:
    """Return a finding for each reason why some of the summed objects may be no parts of the body."""
    if len(objects) < 2:
        return []
    objects = sorted(objects, key=lambda obj: obj.name)
    operands = operands_of(objects)
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
        findings.append(finding(TOTAL_DOUBTFUL_PARTS, kind="Boolean operands", objects=cutters))
    if unseen:
        findings.append(
            finding(
                TOTAL_DOUBTFUL_PARTS,
                kind="Objects that are hidden, not rendered or displayed as wire or bounds",
                objects=unseen,
            )
        )
    return findings


def _operands(obj: Object) -> Iterator[Object]:
    """Yield the operands of an object's Boolean modifiers."""
    for modifier in obj.modifiers:
        if modifier.type != "BOOLEAN" or not (modifier.show_viewport or modifier.show_render):
            continue
        if modifier.operand_type == "OBJECT" and modifier.object is not None:
            yield modifier.object
        elif modifier.operand_type == "COLLECTION" and modifier.collection is not None:
            yield from modifier.collection.all_objects


def _rendered(layer: LayerCollection) -> Iterator[Object]:
    """Yield the objects of rendered collections, also if a parent collection is excluded."""
    if not layer.collection.hide_render:
        if not layer.exclude:
            yield from layer.collection.objects
        for child in layer.children:
            yield from _rendered(child)
