# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of stored numbers, in a text short enough for a property: geometry, transform and settings.

The geometry's part is a digest of the moments themselves: no two shapes that a person would distinguish share twenty
moments to the last bit, and it costs nothing. Transform and settings can be digested without measuring, so a panel
may compare them while it draws. Beside them stands a digest of a mesh object's surface, cheap enough for every
evaluation by Blender.
"""

from __future__ import annotations

import hashlib
import math
import struct

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.measurement.settings import Settings
from ...core.mesh.surface import Surface
from ...core.verdict.finding import ReadError
from ..settings.digest import density_key
from ..settings.resolve import object_settings
from .mesh import mesh_surface
from .visibility import evaluated_geometry

VERSION = "v1"
SAME_SCALE_RTOL = 2e-6  # relative to an axis' length: float32 matrices change as much as the object turns
MAX_DIGESTED_FACES = 50_000  # faces: reading and digesting them takes 2 ms


def fingerprint(geometry: bytes, matrix: str, settings: str) -> str:
    """Return the text stored as `body_fingerprint`: version, then the three digests."""
    return ":".join([VERSION, digest(geometry), matrix, settings])


def matrix_hash(obj: bpy.types.Object) -> str:
    """Return a digest of the object's place, rotation, scale and shear."""
    return digest(np.array(obj.matrix_world, np.float32).tobytes())


def transform_key(obj: bpy.types.Object) -> str:
    """Return a key of the transform as far as the numbers of the object depend on it, for `has_transform` to compare.

    The key contains scale and mirroring, but neither location nor rotation. It is a digest of the whole transform if
    the object is sheared, or its body does not move along with it.
    """
    scale = _scale(obj) if _moves_along(obj) else None
    if scale is None:
        return matrix_hash(obj)
    sign, lengths = scale
    return sign + np.array(lengths, np.float32).tobytes().hex()


def transform_keys(matrices: NDArray[np.float64]) -> list[str]:
    """Return the `transform_key` of objects with bodies that move along, from their (n, 4, 4) `matrix_world`."""
    columns = matrices[:, :3, :3].astype(np.float64)
    lengths = np.sqrt(np.add.reduce(columns * columns, axis=1))
    with np.errstate(invalid="ignore"):  # axes of no length, or an endless one, are no numbers, and so no right angles
        axes = columns / lengths[:, None]
    cosines = np.abs(np.einsum("nai,naj->nij", axes, axes))[:, [0, 1, 2], [1, 2, 0]]
    has_scale = (cosines <= SAME_SCALE_RTOL).all(axis=1)
    signs = np.where(np.linalg.det(np.where(has_scale[:, None, None], axes, np.eye(3))) < 0.0, "-", "+")
    single, whole = lengths.astype(np.float32), matrices.astype(np.float32)
    return [
        sign + key.tobytes().hex() if is_scale else digest(matrix.tobytes())
        for is_scale, sign, key, matrix in zip(has_scale.tolist(), signs.tolist(), single, whole)
    ]


def has_transform(obj: bpy.types.Object, key: str) -> bool:
    """Return whether the object's transform matches a key, as far as its numbers depend on it."""
    if key[:1] not in {"+", "-"}:
        return key == matrix_hash(obj)
    scale = _scale(obj) if _moves_along(obj) else None
    if scale is None or key[0] != scale[0]:
        return False
    try:
        before = struct.unpack("<3f", bytes.fromhex(key[1:]))
    except (ValueError, struct.error):
        return False
    return all([abs(now - then) <= SAME_SCALE_RTOL * then for now, then in zip(scale[1], before)])


def _scale(obj: bpy.types.Object) -> tuple[str, list[float]] | None:
    """Return the sign of the determinant and the lengths of the axes.

    Return None if the object is sheared or flat, or a length is not finite.
    """
    axes = list(zip(*[row[:3] for row in obj.matrix_world[:3]]))  # in Python: a panel asks for many objects'
    lengths = [math.hypot(*axis) for axis in axes]
    if not all([0.0 < length < math.inf for length in lengths]):
        return None
    (a, b, c), (d, e, f), (g, h, i) = [[entry / length for entry in axis] for axis, length in zip(axes, lengths)]
    if max(abs(a * d + b * e + c * f), abs(d * g + e * h + f * i), abs(g * a + h * b + i * c)) > SAME_SCALE_RTOL:
        return None
    return "-" if a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g) < 0.0 else "+", lengths


def _moves_along(obj: bpy.types.Object) -> bool:
    """Return whether the body is the same in the object's frame at every place of the object."""
    if obj.type == "META" or len(obj.particle_systems):
        return False
    settings = obj.body_moments
    if settings.mass_from != "DENSITY" or settings.density_from not in {"POLYNOMIAL", "VOLUME"}:
        return True
    return settings.density_from == "POLYNOMIAL" and settings.density_frame == "OBJECT"


def scale_hash(obj: bpy.types.Object) -> str:
    """Return a digest of the object's scale and shear, independent of its place."""
    linear = np.array(obj.matrix_world, np.float64)[:3, :3]
    products = linear.T @ linear
    largest = np.abs(products).max() or 1.0
    return digest((np.round(products / largest, 5) + 0.0).tobytes())


def settings_hash(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Return a digest of the settings that the numbers of this object depend on."""
    return current_settings(obj, scene).digest


def current_settings(obj: bpy.types.Object, scene: bpy.types.Scene) -> Settings:
    """Return the object's settings as they are."""
    return object_settings(obj, scene, varying=density_key(obj, str(obj.get("body_materials", "")).splitlines(), scene))


def shape_digest(obj, depsgraph) -> bytes | None:
    """Return a digest of a mesh object's faces, independent of its transform.

    Return None for other types, outside Object Mode, for large meshes, for objects that show instances, and for meshes
    edited by way of another object.
    """
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
    """Return a digest of the faces of a mesh as they were read; None of many."""
    if face_count > MAX_DIGESTED_FACES:
        return None
    shape = hashlib.blake2b(digest_size=16)
    for array in (surface.points, surface.triangles, surface.quads):
        shape.update(np.ascontiguousarray(array).data)
        shape.update(repr(array.shape).encode())
    return shape.digest()


def digest(data: bytes | NDArray) -> str:
    """Return a short text that differs for different data."""
    return hashlib.blake2s(data if isinstance(data, bytes) else data.data, digest_size=6).hexdigest()
