# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of a file, brought to the frame to measure and to the places that the file states."""

import math
from collections.abc import Mapping

import bpy
import numpy as np
from mathutils import Matrix

from ...blender.read.places import set_places
from ...core.bodies import float64_matrix
from ...core.numerics import Array
from ...core.verdict import Finding, finding
from ..findings import FRAME_MEASURED

ANCHOR = "Imported Places"  # an empty at the world's origin
MOST_WEIGHT = 10.0  # Blender's limit of the value of a shape key
# Chosen, relative difference of an axis, and of a location: larger than the rounding of float32,
# 6e-8, along chains of parents.
_AGREEMENT = 1e-5


def set_frame(frame: float) -> None:
    """Evaluate the scene at a frame, which need not be whole."""
    whole_frame = math.floor(frame)
    bpy.context.scene.frame_set(whole_frame, subframe=frame - whole_frame)


def shown_seconds(first: float = 0.0) -> float:
    """Return the time of the evaluated frame, in seconds from frame `first`."""
    scene = bpy.context.scene
    return (scene.frame_current_final - first) * scene.render.fps_base / scene.render.fps


def measure_at(frame: float | None) -> tuple[Finding, ...]:
    """Evaluate the scene at a frame, or else the first one of its animations; return a note if
    there are any.
    """
    starts = [
        action.frame_range[0]
        for action in bpy.data.actions
        if action.users and action.frame_range[1] > action.frame_range[0]
    ]
    frame = min(starts, default=None) if frame is None else frame
    if frame is not None:
        set_frame(frame)
    return (finding(FRAME_MEASURED, frame=frame),) if starts else ()


def is_at(obj: bpy.types.Object, place: Array) -> bool:
    """Return whether Blender shows an object at a (4, 4) place.

    Axes are compared relative to the longest one, the location relative to its largest coordinate.
    """
    column_sizes = np.abs(place[:3]).max(axis=0)
    # 1e-30 is practically 0: a location at the origin must agree exactly.
    sizes = np.maximum(column_sizes, [*[column_sizes[:3].max()] * 3, 1e-30])
    apart = np.abs(float64_matrix(obj.matrix_world)[:3] - place[:3])
    return bool((apart <= _AGREEMENT * sizes).all())


def place_objects(places: Mapping[str, Array]) -> None:
    """Record the exact (4, 4) places of objects, and move the objects that Blender shows elsewhere,
    without constraints, animation and parent.
    """
    bpy.context.view_layer.update()
    objects = bpy.data.objects
    for name, place in places.items():
        set_places(objects[name], place)
    wrong = [objects[name] for name, place in places.items() if not is_at(objects[name], place)]
    if not wrong:
        return
    anchor = objects.new(ANCHOR, None)
    bpy.context.scene.collection.objects.link(anchor)
    # The objects below the wrong ones move with them.
    moved_objects = {*wrong, *(child for parent in wrong for child in parent.children_recursive)}
    for obj in (obj for obj in moved_objects if obj.name in places):
        obj.constraints.clear()
        obj.animation_data_clear()
        obj.parent = anchor
        obj.matrix_basis = Matrix()
        obj.matrix_parent_inverse = Matrix(places[obj.name])  # unlike channels, it holds shear
    bpy.context.view_layer.update()


def show_points(obj: bpy.types.Object, points: Array, place: Array) -> None:
    """Move the vertices of a mesh object to (n, 3) points in a (4, 4) place, without modifiers and
    keys.

    ValueError if their counts differ.
    """
    obj.data = obj.data.copy()
    if len(points) != len(obj.data.vertices):
        raise ValueError("points")
    obj.modifiers.clear()
    obj.shape_key_clear()
    # Around their mean, points have small coordinates, which float32 rounds less.
    middle = np.eye(4)
    middle[:3, 3] = points.mean(axis=0)
    local = (points - middle[:3, 3]).astype(np.float32)
    obj.data.attributes["position"].data.foreach_set("vector", local.ravel())
    place_objects({obj.name: place @ middle})
