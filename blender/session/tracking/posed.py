# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""In Pose Mode an armature stands for the meshes that it deforms: they are posed, but not selected."""

from __future__ import annotations

from collections.abc import Iterable

import bpy
from bpy.types import Object

from ... import read
from . import handlers
from .cache import SessionCache, current_value

# by armature: the number of the last change, and its meshes
_meshes: SessionCache[tuple[int, tuple[Object, ...]]] = SessionCache()


def stands_for_meshes(obj: Object) -> bool:
    """Return whether an original object is an armature that is being posed."""
    return obj.type == "ARMATURE" and obj.mode == "POSE"


def deformed_meshes(armature: Object) -> tuple[Object, ...]:
    """Return the meshes of the window's view layer that an original armature deforms, in the layer's order."""
    objects = bpy.context.view_layer.objects
    return current_value(
        _meshes,
        armature,
        handlers.generation(),
        lambda: tuple(obj for obj in objects if obj.type == "MESH" and read.rig.is_skin_of(obj, armature)),
    )


def subjects(objects: Iterable[Object]) -> list[Object]:
    """Return original objects with the meshes that they stand for in their place, each once."""
    found: dict[Object, None] = {}
    for obj in objects:
        found.update(dict.fromkeys(deformed_meshes(obj) if stands_for_meshes(obj) else (obj,)))
    return list(found)
