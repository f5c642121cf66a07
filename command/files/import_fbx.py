# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""FBX files as objects of the open scene, corrected by the file's models.

Blender's importer scales models twice that do not inherit a scale, and shows all levels of detail.
"""

import re

import bpy
import numpy as np
from bpy.types import Object

from ...core.files import MALFORMED, fbx_tree, map_file
from ...core.numerics import Array
from ...core.verdict import Finding, finding
from ..findings import FILE_HIDES, PLACES_UNCHECKED
from .fbx_animation import RARE
from .fbx_models import FbxModel, fbx_models, fbx_to_scene
from .placing import MOST_WEIGHT, is_at, measure_at, place_objects, show_points, shown_seconds
from .references import Opened

# What the importer adds to the name of a model: for a mesh that others share, or a name is taken.
_ADDED = re.compile(r"(_GeomAdjust)?(\.\d{3,})?$")
_SHORT = 50  # letters of a name that Blender does not cut
# Chosen, relative to the largest coordinate: larger than the rounding of float32, 6e-8.
_SAME_POINT = 1e-6


def import_fbx(path: str, frame: float | None) -> Opened:
    """Import an .fbx file at a frame, by default its first: each object at the place that the file
    states; hidden objects and coarser levels of detail are reported.

    Raise RuntimeError, and AttributeError without an importer.
    """
    bpy.ops.wm.fbx_import(filepath=path)
    unseen = {obj.name for obj in bpy.context.scene.objects if obj.hide_viewport}
    for name in unseen:  # Blender would not evaluate them.
        bpy.data.objects[name].hide_viewport = False
    notes = measure_at(frame)
    findings: dict[str, tuple[Finding, ...]] = {}
    coarse: set[str] = set()
    try:
        root = fbx_tree(map_file(path))
        # The importer shows the file's first moment in frame 1.
        models = fbx_models(root, shown_seconds(first=1.0))
        groups = _groups(models)
        pairs = [(obj, model) for group in groups for obj, model in zip(*group)]
        unseen |= {obj.name for obj, model in pairs if model.is_hidden}
        levels = {level for model in models for level in model.coarse_levels()}
        coarse = {obj.name for obj, model in pairs if model in levels}
        unweighted = [obj.name for obj, model in pairs if not _set_weights(obj, model)]
        doubts = _correct(groups, fbx_to_scene(root))
        doubts |= dict.fromkeys(unweighted, "the weight of a shape key exceeds ±10, or is unclear")
        findings = {
            name: (finding(PLACES_UNCHECKED, cause=cause),) for name, cause in doubts.items()
        }
    except MALFORMED:
        cause = "its nodes are of an old version, or unreadable"
        notes = (*notes, finding(PLACES_UNCHECKED, cause=cause))
    hidden = dict.fromkeys(unseen, finding(FILE_HIDES, cause="it is invisible"))
    hidden |= dict.fromkeys(coarse, finding(FILE_HIDES, cause="it is a coarser level of detail"))
    return Opened(notes=notes, by_object=findings, hidden=hidden)


def _groups(models: list[FbxModel]) -> list[tuple[list[Object], list[FbxModel]]]:
    """Return groups of mesh objects and of the models with a mesh that have the same name, both in
    the order of Blender's numbers: of one pair if the name is unique.
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


def _set_weights(obj: Object, model: FbxModel) -> bool:
    """Give shape keys the weights that a file states. Return False if a weight is NaN or too large,
    or the keys are not those of the file.
    """
    if obj.data.shape_keys is None:
        return True
    obj.data.shape_keys.animation_data_clear()
    blocks = obj.data.shape_keys.key_blocks[1:]
    if len(blocks) != len(model.shapes):
        return False
    for block, (_, weight) in zip(blocks, model.shapes):
        if abs(weight) <= MOST_WEIGHT:
            block.slider_min = -MOST_WEIGHT  # The importer's 0 to 1 would clamp the weight.
            block.slider_max = MOST_WEIGHT
            block.value = weight
    return all(
        block.name.startswith(name[:_SHORT])
        and abs(block.value - weight) <= _SAME_POINT * abs(weight)
        for block, (name, weight) in zip(blocks, model.shapes)
    )


def _correct(groups: list[tuple[list[Object], list[FbxModel]]], to_scene: Array) -> dict[str, str]:
    """Bring objects to the places that a file states, and return the reasons to doubt the places of
    other objects, by their names.
    """
    doubts: dict[str, str] = {}
    places: dict[str, Array] = {}
    skinned: list[tuple[Object, Array]] = []
    for objects, models in groups:
        if len(objects) != len(models):
            doubts |= dict.fromkeys([obj.name for obj in objects], "names are not unique")
            continue
        for obj, model in zip(objects, models):
            bones = [bone for _, bone in model.clusters]
            if any(related_model.moves_rarely for related_model in (model, *bones)):
                doubts[obj.name] = RARE
                continue
            points_and_place = _place(obj, model, to_scene, is_mixed=bool(bones))
            if points_and_place is None:
                doubts[obj.name] = "its points are not those of the file"
                continue
            points, place = points_and_place
            reasons = [
                related_model.place.doubt
                for related_model in (model, *bones)
                if related_model.place.doubt is not None
            ]
            # An object where the file says is right, whichever of its models it is.
            if not bones and is_at(obj, place) or len(models) == 1 and not reasons:
                places[obj.name] = place
                if bones:
                    skinned.append((obj, model.skinned(points) @ to_scene[:3, :3].T))
            else:
                doubts[obj.name] = "".join(reasons[:1]) or "names are not unique"
    place_objects(places)
    for obj, points in skinned:
        show_points(obj, points, np.eye(4))
    return doubts


def _place(
    obj: Object, model: FbxModel, to_scene: Array, is_mixed: bool
) -> tuple[Array, Array] | None:
    """Return the (n, 3) points of a model's mesh, with the shape keys of the object if they are
    mixed, and the (4, 4) place of the object; None if its points are not the file's.
    """
    assert model.geometry is not None
    points = model.geometry.child("Vertices").numbers()
    object_points = np.empty(3 * len(obj.data.vertices))
    obj.data.vertices.foreach_get("co", object_points)
    if object_points.shape != points.shape:
        return None
    object_points = object_points.reshape(-1, 3)
    homogeneous = np.column_stack([points.reshape(-1, 3), np.ones(len(object_points))])
    world = to_scene @ model.place.matrix
    to_pivot = model.to_pivot
    # Blender's importer moves the points by the matrix of the mesh, and their origin to the pivot,
    # if no other model shares the mesh. So `inner` moves the file's points to the object's, and
    # `outer` those to the world; the first pair whose points agree is the importer's.
    for inner, outer in (
        (np.linalg.inv(to_pivot) @ model.geometric, world @ to_pivot),
        (model.geometric, world),
        (np.eye(4), world @ model.geometric),
    ):
        local_points = (homogeneous @ inner.T)[:, :3]
        size = max(np.abs(local_points).max(initial=0.0), np.abs(inner[:3, 3]).max())
        if np.abs(local_points - object_points).max(initial=0.0) <= _SAME_POINT * size:
            if is_mixed and obj.data.shape_keys is not None:
                mixed = np.empty_like(object_points)
                key = obj.shape_key_add(from_mix=True)
                key.data.foreach_get("co", mixed.ravel())
                obj.shape_key_remove(key)  # Blender 5.2 gives it the weight 1.
                homogeneous[:, :3] += (mixed - object_points) @ np.linalg.inv(inner[:3, :3]).T
            return homogeneous[:, :3], outer
    return None
