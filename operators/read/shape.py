# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A digest of the shape that a mesh object shows, cheap enough to be taken whenever Blender re-evaluates it."""

from __future__ import annotations

import hashlib

import numpy as np

from .objects import read_object
from .reading import Unreadable

MOST = 50_000  # faces: reading and digesting them takes 2 ms


def shape_digest(obj, depsgraph) -> bytes | None:
    """Of the faces of a mesh object in Object Mode, wherever it stands; None of others, large ones and those that show
    instances."""
    if (obj.type != "MESH" or obj.mode != "OBJECT" or obj.instance_type != "NONE" or len(obj.particle_systems)
            or any(modifier.type == "NODES" for modifier in obj.modifiers)):
        return None
    evaluated = obj.evaluated_get(depsgraph)
    if not evaluated.is_evaluated or len(evaluated.data.polygons) > MOST:
        return None
    try:
        parts = read_object(obj, depsgraph, edges=False).parts
    except Unreadable:
        return None
    digest = hashlib.blake2b(digest_size=16)
    for part in parts:
        for array in (part.surface.points, part.surface.triangles, part.surface.quads):
            digest.update(np.ascontiguousarray(array))
            digest.update(repr(array.shape).encode())
    return digest.digest()
