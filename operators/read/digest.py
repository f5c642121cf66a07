# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A digest of the shape that a mesh object shows, cheap enough to be taken whenever Blender re-evaluates it."""

from __future__ import annotations

import hashlib

import numpy as np

from ...core.verdict.finding import ReadError
from .mesh import mesh_surface
from .visibility import evaluated_geometry

MAX_DIGESTED_FACES = 50_000  # faces: reading and digesting them takes 2 ms


def shape_digest(obj, depsgraph) -> bytes | None:
    """Of the faces of a mesh object in Object Mode, wherever it stands; None of others, large ones, those that show
    instances, and those whose mesh is edited by way of another object."""
    if (
        obj.type != "MESH"
        or obj.mode != "OBJECT"
        or obj.data.is_editmode
        or obj.instance_type != "NONE"
        or len(obj.particle_systems)
        or any(modifier.type == "NODES" for modifier in obj.modifiers)
    ):
        return None
    try:
        geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    except ReadError:
        return None
    if geometry.mesh is None or len(geometry.mesh.polygons) > MAX_DIGESTED_FACES:
        return None
    surface = mesh_surface(geometry.mesh, edges=False)
    digest = hashlib.blake2b(digest_size=16)
    for array in (surface.points, surface.triangles, surface.quads):
        digest.update(np.ascontiguousarray(array).data)
        digest.update(repr(array.shape).encode())
    return digest.digest()
