# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Digests of a mesh object's surface, fast enough for every evaluation by Blender; and keys of many transforms."""

from __future__ import annotations

import hashlib

import numpy as np
from bpy.types import Depsgraph, Object
from numpy.typing import NDArray

from ...core.measurement.settings import digest
from ...core.mesh.surface import Surface
from ...core.verdict.finding import ReadError
from .fingerprint import SAME_SCALE_RTOL
from .mesh import mesh_surface
from .visibility import evaluated_geometry

MAX_DIGESTED_FACES = 50_000  # faces: reading and digesting them takes 2 ms


def shape_digest(obj: Object, depsgraph: Depsgraph) -> bytes | None:
    """Return a digest of a mesh object's faces; None for other types, modes, large meshes, instancers, node trees."""
    if (
        obj.type != "MESH"
        or obj.mode != "OBJECT"
        or obj.data.is_editmode
        or obj.instance_type != "NONE"
        or len(obj.particle_systems)
        or "NODES" in [modifier.type for modifier in obj.modifiers]
    ):
        return None
    try:
        geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    except ReadError:
        return None
    mesh = geometry.mesh
    if mesh is None or len(mesh.polygons) > MAX_DIGESTED_FACES:
        return None
    return surface_digest(mesh_surface(mesh, edges=False), len(mesh.polygons))


def surface_digest(surface: Surface, face_count: int) -> bytes | None:
    """Return a digest of the faces of a surface, or None if there are more than MAX_DIGESTED_FACES."""
    if face_count > MAX_DIGESTED_FACES:
        return None
    shape = hashlib.blake2b(digest_size=16)
    for array in (surface.points, surface.triangles, surface.quads):
        shape.update(np.ascontiguousarray(array).data)
        shape.update(repr(array.shape).encode())
    return shape.digest()


def transform_keys(matrices: NDArray[np.float64]) -> list[str]:
    """Return the `transform_key` of each (n, 4, 4) `matrix_world`, for objects whose bodies move along."""
    columns = matrices[:, :3, :3].astype(np.float64)
    lengths = np.sqrt(np.add.reduce(columns * columns, axis=1))
    with np.errstate(invalid="ignore"):  # axes of zero or infinite length become NaN, so they are not at right angles
        axes = columns / lengths[:, None]
    cosines = np.abs(np.einsum("nai,naj->nij", axes, axes))[:, [0, 1, 2], [1, 2, 0]]
    has_scale = (cosines <= SAME_SCALE_RTOL).all(axis=1)
    signs = np.where(np.linalg.det(np.where(has_scale[:, None, None], axes, np.eye(3))) < 0.0, "-", "+")
    single, whole = lengths.astype(np.float32), matrices.astype(np.float32)
    return [
        sign + key.tobytes().hex() if is_scale else digest(matrix.tobytes())
        for is_scale, sign, key, matrix in zip(has_scale.tolist(), signs.tolist(), single, whole)
    ]
