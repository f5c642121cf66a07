# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""FBX files as objects of the open scene, corrected by the file's models.

Blender's importer scales models twice that do not inherit a scale, and shows all levels of detail.
"""

from __future__ import annotations

import re

import bpy
import numpy as np
from bpy.types import Object

from ...core.files import MALFORMED, fbx_tree, map_file
from ...core.numerics import Array
from ...core.verdict.finding import Finding, finding
from ..findings import FILE_HIDES, PLACES_UNCHECKED
from . import placing, references
from .fbx_models import FbxModel, fbx_models, fbx_to_scene

# What the importer adds to the name of a model: for a mesh that others share, or a name is taken.
_ADDED = re.compile(r"(_GeomAdjust)?(\.\d{3,})?$")
_SAME_POINT = 1e-6  # relative to the largest coordinate; larger than the rounding of float32


def import_fbx(path: str, frame: float | None) -> references.Opened:
    """Import an .fbx file at a frame, by default its first: each object at the place that the file
    states; hidden objects and coarser levels of detail are not rendered.

    Raise RuntimeError, and AttributeError without an importer.
    """
    bpy.ops.wm.fbx_import(filepath=path)
    unseen = {obj.name for obj in bpy.context.scene.objects if obj.hide_viewport}
    for name in unseen:  # Blender would not evaluate them.
        bpy.data.objects[name].hide_viewport = False
    moving = [shapes for shapes in bpy.data.shape_keys if shapes.animation_data is not None]
    for block in (block for shapes in moving for block in shapes.key_blocks):
        block.slider_min = (
            -placing.MOST_WEIGHT
        )  # The importer's 0 to 1 would clamp animated weights.
        block.slider_max = placing.MOST_WEIGHT
    notes = placing.measure_at(frame)
    findings: dict[str, tuple[Finding, ...]] = {}
    coarse: set[str] = set()
    try:
        root = fbx_tree(map_file(path))
        models = fbx_models(root)
        groups = _groups(models)
        pairs = [(obj, model) for group in groups for obj, model in zip(*group)]
        unseen |= {obj.name for obj, model in pairs if model.is_hidden}
        levels = {level for model in models for level in model.coarse_levels()}
        coarse = {obj.name for obj, model in pairs if model in levels}
        doubts = _correct(groups, fbx_to_scene(root), any(model.is_apart for model in models))
        for obj in (obj for obj, _ in pairs if obj.data.shape_keys in moving):
            if any(abs(one.value) >= placing.MOST_WEIGHT for one in obj.data.shape_keys.key_blocks):
                doubts[obj.name] = "the weight of a shape key exceeds ±10"
        findings = {
            name: (finding(PLACES_UNCHECKED, cause=cause),) for name, cause in doubts.items()
        }
    except MALFORMED:
        cause = "its nodes are of an old version, or unreadable"
        notes = (*notes, finding(PLACES_UNCHECKED, cause=cause))
    hidden = dict.fromkeys(unseen, finding(FILE_HIDES, cause="it is invisible"))
    hidden |= dict.fromkeys(coarse, finding(FILE_HIDES, cause="it is a coarser level of detail"))
    for name in hidden:
        bpy.data.objects[name].hide_render = True
    return references.Opened(notes=notes, by_object=findings, hidden=hidden)


def _groups(models: list[FbxModel]) -> list[tuple[list[Object], list[FbxModel]]]:
    """Return mesh objects and the models with their names, in the same order: one pair for a name
    that is unique.
    """
    by_name: dict[str, list[FbxModel]] = {}
    for model in models:
        if model.geometry is not None:
            by_name.setdefault(model.name, []).append(model)
    groups: dict[str, tuple[list[Object], list[FbxModel]]] = {}
    for obj in sorted(bpy.context.scene.objects, key=lambda obj: obj.name):
        if obj.type == "MESH":
            name = obj.name if obj.name in by_name else _ADDED.sub("", obj.name)
            groups.setdefault(name, ([], by_name.get(name, [])))[0].append(obj)
    return [*groups.values()]


def _correct(
    groups: list[tuple[list[Object], list[FbxModel]]], to_scene: Array, are_apart: bool
) -> dict[str, str]:
    """Bring objects to the places that a file states, and return the reasons to doubt those of
    others. are_apart: some models of the file do not inherit the scale of their parents.
    """
    doubts: dict[str, str] = {}
    places: dict[str, Array] = {}
    for objects, models in groups:
        if len(objects) != len(models):
            doubts |= dict.fromkeys([obj.name for obj in objects], "names are not unique")
            continue
        for obj, model in zip(objects, models):
            if model.is_skinned or model.is_animated:
                if are_apart:
                    doubts[obj.name] = "nodes do not inherit the scale of their parents"
                continue
            place = _place(obj, model, to_scene)
            if place is not None and (
                placing.is_at(obj, place) or len(models) == 1 and model.place.doubt is None
            ):
                places[obj.name] = place
            elif place is None:
                doubts[obj.name] = "its points are not those of the file"
            else:
                doubts[obj.name] = model.place.doubt or "names are not unique"
    placing.place_objects(places)
    return doubts


def _place(obj: Object, model: FbxModel, to_scene: Array) -> Array | None:
    """Return the (4, 4) place of an object by its model; None if its points are not the file's."""
    vertices = None if model.geometry is None else model.geometry.child("Vertices")
    points = np.empty(0) if vertices is None else vertices.numbers()
    own = np.empty(3 * len(obj.data.vertices))
    obj.data.vertices.foreach_get("co", own)
    if own.shape != points.shape:
        return None
    own = own.reshape(-1, 3)
    whole = np.column_stack([points.reshape(-1, 3), np.ones(len(own))])
    world = to_scene @ model.place.matrix
    to_pivot = model.to_pivot
    # Blender's importer moves the points by the matrix of the mesh, and their origin to the pivot,
    # if no other model shares the mesh.
    for inner, outer in (
        (np.linalg.inv(to_pivot) @ model.geometric, world @ to_pivot),
        (model.geometric, world),
        (np.eye(4), world @ model.geometric),
    ):
        moved = (whole @ inner.T)[:, :3]
        size = max(np.abs(moved).max(initial=0.0), np.abs(inner[:3, 3]).max())
        if np.abs(moved - own).max(initial=0.0) <= _SAME_POINT * size:
            return outer
    return None
