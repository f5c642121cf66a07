# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that an object can be read and that Blender has evaluated it.

Blender returns an object that is disabled in viewports, excluded from the view layer or in another
scene without its modifiers, as if nothing were wrong; `evaluated_geometry()` refuses it. Merely
hidden objects are read and reported.
"""

from collections.abc import Iterator
from itertools import islice

from ...core.verdict import Finding, ReadError, finding
from ..settings.given import GEOMETRY_TYPES, SURFACE_TYPES, is_point_mass, shows_collection
from .findings import (
    HIDDEN_IN_VIEWPORT,
    NO_INSTANCES,
    NOT_IN_SCENE,
    NOT_SHOWN,
    OBJECT_UNREADABLE,
    OBJECT_WITHOUT_GEOMETRY,
    SCULPTED_MESH,
    SHAPE_KEYS_OF_OTHER_POINTS,
)

SECTION_TYPES = {"MESH", "CURVE", "FONT"}  # objects with faces or curves that may be flat
MAX_DEPTH = 7  # levels of instances within instances, Blender's own limit (MAX_DUPLI_RECUR - 1)


def measurable(obj) -> bool:
    """Return whether the object's kind may show a surface, fast enough for a poll."""
    if shows_collection(obj):
        return True
    if obj.type == "EMPTY":
        return is_point_mass(obj)
    if obj.type == "CURVE":
        curve = obj.data
        is_filled = curve.dimensions == "2D" and curve.fill_mode != "NONE"
        is_beveled = curve.bevel_depth or (curve.bevel_mode == "OBJECT" and curve.bevel_object)
        if is_filled or is_beveled or curve.extrude or obj.modifiers:
            return True
        # A wire needs no surface, and closed curves bound one for a shell.
        settings = getattr(obj, "body_moments", None)
        return settings is not None and settings.kind != "SOLID"
    return obj.type in {*SURFACE_TYPES, "VOLUME"} or any(
        modifier.type == "NODES" for modifier in obj.modifiers
    )


def has_shape(obj) -> bool:
    """Return whether an object may have a shape or a given mass; lights, cameras and plain empties
    never have one.
    """
    return obj.type in GEOMETRY_TYPES or obj.instance_type == "COLLECTION" or is_point_mass(obj)


def shows_flat_region(obj) -> bool:
    """Return whether a curve object shows only the flat region inside its curves."""
    curve = obj.data
    return not (
        curve.extrude
        or curve.bevel_depth
        or curve.offset
        or curve.bevel_object
        or any(modifier.show_viewport for modifier in obj.modifiers)
    )


def measurable_objects(view_layer) -> list:
    """Return the measurable objects of a view layer by name, hidden ones included, objects measured
    with others not.
    """
    # A view layer that has not been updated knows neither its new objects nor their visibility.
    view_layer.update()
    objects = [
        obj for obj in view_layer.objects if measurable(obj) and not instanced_by_parent(obj)
    ]
    mothers = {family[0] for family in metaball_families(view_layer)}
    objects = [obj for obj in objects if obj.type != "META" or obj in mothers]
    hidden = {obj for obj in objects if not obj.visible_get(view_layer=view_layer)}
    if hidden:
        instanced = {obj.instance_collection for obj in view_layer.objects if shows_collection(obj)}
        hidden &= {member for collection in instanced for member in collection.all_objects}
        objects = [obj for obj in objects if obj not in hidden]
    return sorted(objects, key=lambda obj: (obj.name, obj.library.filepath if obj.library else ""))


def instanced_by_parent(obj) -> bool:
    """Return whether the viewport shows the object only as the instances of its parent."""
    return obj.parent is not None and obj.parent.instance_type in {"VERTS", "FACES"}


def metaball_families(view_layer) -> list[list]:
    """Return the metaballs by family (the name before a number); the lowest number first, which
    holds all polygons.
    """
    families: dict[str, list] = {}
    for obj in view_layer.objects:
        if obj.type == "META":
            families.setdefault(_split_name(obj.name)[0], []).append(obj)
    return [
        sorted(family, key=lambda obj: _split_name(obj.name)[1]) for family in families.values()
    ]


def require_kind(obj) -> None:
    """Raise ReadError for an object of a kind that shows no surface."""
    if obj.type in GEOMETRY_TYPES or obj.instance_type == "COLLECTION":
        return
    if obj.type == "EMPTY":
        raise ReadError(NOT_SHOWN, cause=NO_INSTANCES, subject=obj.name)
    kind = obj.bl_rna.properties["type"].enum_items[obj.type].name
    raise ReadError(OBJECT_WITHOUT_GEOMETRY, subject=obj.name, type=kind)


def evaluated_geometry(obj, depsgraph, reader):
    """Return the object's `GeometrySet`, which owns its meshes, or raise ReadError that names the
    object `reader`.
    """
    reason = None
    if obj.mode == "SCULPT":
        has_sculpted_levels = any(
            modifier.sculpt_levels
            for modifier in obj.modifiers
            if modifier.type == "MULTIRES" and modifier.show_viewport
        )
        if has_sculpted_levels or obj.use_dynamic_topology_sculpting:
            reason = finding(SCULPTED_MESH)  # the viewport shows something else
    if obj.type in {"CURVE", "SURFACE"} and obj.data.shape_keys and not obj.data.is_editmode:
        splines = obj.data.splines
        count = sum(len(spline.bezier_points) + len(spline.points) for spline in splines)
        # joining curves can leave other counts
        if any(len(key.data) != count for key in obj.data.shape_keys.key_blocks):
            reason = finding(SHAPE_KEYS_OF_OTHER_POINTS)
    if reason is None:
        try:
            return obj.evaluated_get(depsgraph).evaluated_geometry()
        except (TypeError, RuntimeError):
            reason = why_not_evaluated(obj, depsgraph)
    if obj != reader:
        reason = finding(OBJECT_UNREADABLE, object=obj.name, cause=reason.as_record())
    raise ReadError(reason, subject=reader.name)


def why_not_evaluated(obj, depsgraph) -> Finding:
    """Return the reason why Blender has not evaluated the object."""
    return hidden_reason(obj, depsgraph) or finding(
        NOT_SHOWN, cause="Blender has not evaluated the object. Update the view layer"
    )


def hidden_reason(obj, depsgraph) -> Finding | None:
    """Return the reason why the view layer hides the object; None if it is visible or not updated
    yet.
    """
    if obj.visible_get(view_layer=depsgraph.view_layer):
        return None
    homes = set(obj.users_collection)  # the collections that the object is in
    branches = [
        path
        for path in _branches(depsgraph.view_layer.layer_collection)
        if path[-1].collection in homes
    ]
    if not branches:
        return finding(NOT_IN_SCENE, scene=depsgraph.scene.name)
    if obj.hide_viewport:
        return finding(HIDDEN_IN_VIEWPORT, name=obj.name, switch="monitor icon")
    reasons = []
    hidden_branches: set[int] = set()
    for is_off, switch in (
        (lambda layer: layer.exclude, "check box"),
        (lambda layer: layer.collection.hide_viewport, "monitor icon"),
        (lambda layer: layer.hide_viewport, "eye icon"),
    ):
        # the outermost collection of each branch that this switch hides
        hiding = {
            number: layer
            for number, branch in enumerate(branches)
            for layer in islice(filter(is_off, branch), 1)
        }
        switch_reasons = [
            finding(HIDDEN_IN_VIEWPORT, name=layer.collection.name, switch=switch)
            for layer in hiding.values()
        ]
        if len(hiding) == len(branches):
            return switch_reasons[0]
        reasons += switch_reasons
        hidden_branches |= hiding.keys()
    if len(hidden_branches) == len(branches):
        return reasons[-1]  # its collections are hidden by several switches; the mildest one
    is_hidden = obj.hide_get(view_layer=depsgraph.view_layer)
    return finding(HIDDEN_IN_VIEWPORT, name=obj.name, switch="eye icon") if is_hidden else None


def blends_keys(obj) -> bool:
    """Return whether Edit Mode shows the object's mesh with all of its shape keys, not just the
    edited one.
    """
    return obj.data.shape_keys is not None and obj.use_shape_key_edit_mode


def _split_name(name: str) -> tuple[str, int]:
    """Return a name without its number, and the number, 0 if there is none."""
    stem, dot, tail = name.rpartition(".")
    return (stem, int(tail)) if dot and tail.isdecimal() else (name, 0)


def _branches(layer, path: tuple = ()) -> Iterator[tuple]:
    """Yield every layer collection with its parents, the outermost first."""
    path += (layer,)
    yield path
    for child in layer.children:
        yield from _branches(child, path)
