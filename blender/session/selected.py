# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of several selected objects as one group, whose properties read and set them all.

Only the panel writes through it: a script that sets a property of one object changes that object.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Object, PropertyGroup, Scene, ViewLayer

from ...core.density import DENSITY_UNITS
from ..settings import given, prints, properties
from ..settings.chosen import chosen_objects, pinned_object
from . import memory, tracking

NAMES = (*properties.COPIED_PROPERTIES, *("density_" + unit.lower() for unit in DENSITY_UNITS))
SHAPE = {"kind", "wall", "thickness", "overlap", "density_from"}  # settings without use for volumes


def subject(context: Context) -> Object | None:
    """Return the object whose details a panel shows: the active one if it is among the shown ones
    or edited, else the only shown one.
    """
    active = context.object
    if active is not None and (active.mode != "OBJECT" or pinned_object(context) is not None):
        return active
    candidates = tracking.armatures.subjects(chosen_objects(context))
    if active in candidates:
        return active
    return candidates[0] if len(candidates) == 1 else None


def armature_of(context: Context) -> Object | None:
    """Return the armature whose bones are shown and measured: the active one if it is chosen or
    edited, else the only chosen one.
    """
    active = context.object
    armatures = [obj for obj in chosen_objects(context) if obj.type == "ARMATURE"]
    if active in armatures or active is not None and tracking.armatures.stands_for_meshes(active):
        return active
    return armatures[0] if len(armatures) == 1 else None


def require_subject(context: Context) -> Object:
    """Return the subject, which the poll of an operator has seen."""
    obj = subject(context)
    assert obj is not None
    return obj


def objects_with_settings(objects: Iterable[Object]) -> list[Object]:
    """Return the objects that have a density, colliders only if nothing else does, else empties."""
    objects = list(objects)
    bodies = [obj for obj in objects if given.has_density(obj)]
    return (
        [obj for obj in bodies if given.COLLIDER not in obj]
        or bodies
        or [obj for obj in objects if obj.type == "EMPTY"]
    )


def owners(context: Context) -> list[Object]:
    """Return the chosen objects whose settings the panel shows and sets."""
    return _owners(*_selection(context))


def _selection(context: Context) -> tuple[ViewLayer, int, Object | None]:
    """Return the key of `_owners` and `_is_mixed`, which tells selections apart between two changes
    that Blender reports.
    """
    layer = context.view_layer
    return layer, len(layer.objects.selected), pinned_object(context)


@memory.until_change
def _owners(_layer: ViewLayer, _count: int, _pinned: Object | None) -> list[Object]:
    """Return `owners` of the context; the arguments are the key of the cache alone."""
    return objects_with_settings(chosen_objects(bpy.context))


def chosen_settings(context: Context) -> PropertyGroup | None:
    """Return the settings of the one chosen object, or the group of several; None without any."""
    objects = owners(context)
    if len(objects) == 1:
        return objects[0].body_moments
    return context.scene.body_moments_selection if objects else None


def is_mixed(settings: PropertyGroup, name: str) -> bool:
    """Return whether a setting differs among the chosen objects; never for those of one object."""
    return isinstance(settings, BodyMomentsSelectionSettings) and _is_mixed(
        name, *_selection(bpy.context)
    )


@memory.until_change
def _is_mixed(name: str, layer: ViewLayer, count: int, pinned: Object | None) -> bool:
    values = {
        properties.comparable(getattr(obj.body_moments, name))
        for obj in _owners(layer, count, pinned)
    }
    return len(values) > 1


def common(settings: PropertyGroup, name: str) -> Any:
    """Return a setting, or None if it differs among the chosen objects."""
    return None if is_mixed(settings, name) else getattr(settings, name)


def _set_all(name: str, value: Any) -> None:
    """Set a setting of all chosen objects that are editable and have a use for it."""
    for obj in objects_with_settings(chosen_objects(bpy.context)):
        if obj.is_editable and (obj.type != "VOLUME" or name not in SHAPE):
            setattr(obj.body_moments, name, value)


def _shared_property(name: str, function: Any, keywords: dict[str, Any]) -> Any:
    """Return the property that shows the first object's setting and sets that of all objects.

    function, keywords: a constructor of `bpy.props` and its arguments, as for one object.
    """
    # Getters and setters of enums exchange the index of an item, not its identifier.
    items = [item[0] for item in keywords.get("items", ())]

    def read(_settings: PropertyGroup) -> Any:
        value = getattr(owners(bpy.context)[0].body_moments, name)
        return items.index(value) if items else value

    def write(_settings: PropertyGroup, new: Any) -> None:
        _set_all(name, items[new] if items else new)

    # The objects' own properties call `update`, and `override` concerns stored values.
    own_keywords = {
        key: argument for key, argument in keywords.items() if key not in ("update", "override")
    }
    return function(**(own_keywords | {"options": set(), "get": read, "set": write}))


class BodyMomentsSelectionSettings(PropertyGroup):
    """Settings of the selected objects: each shows the first object's, and sets that of all."""


ANNOTATIONS = (
    given.GivenPartProperties.__annotations__
    | prints.PrintProperties.__annotations__
    | properties.BodyMomentsObjectSettings.__annotations__
)
BodyMomentsSelectionSettings.__annotations__ = {
    name: _shared_property(name, ANNOTATIONS[name].function, ANNOTATIONS[name].keywords)
    for name in NAMES
    if name != "density_volume"
}
BodyMomentsSelectionSettings.__annotations__["density_volume"] = StringProperty(
    name="Volume",
    description="Volume object whose grid is the density inside the solids",
    get=lambda _settings: getattr(owners(bpy.context)[0].body_moments.density_volume, "name", ""),
    set=lambda _settings, name: _set_all("density_volume", bpy.data.objects.get(name)),
    search=lambda _settings, _context, _text: [
        obj.name for obj in bpy.data.objects if obj.type == "VOLUME"
    ],
)
POINTERS = {(Scene, "body_moments_selection"): BodyMomentsSelectionSettings}
