# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of stored numbers, in a text short enough for a property: geometry, transform and
settings.

Geometry is digested as the moments themselves; transform and settings can be digested by panels,
without numpy.
"""

from __future__ import annotations

import math
import struct
from array import array
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
from mathutils import Matrix

from ...core import measurement
from .. import settings
from ..settings.density import density_key
from ..settings.given import COLLIDER

if TYPE_CHECKING:
    from ...core.measurement import Settings

# Relative to an axis' length: float32 rounding, when the object turns, changes it by no more.
SAME_SCALE_RTOL = 2e-6
MAX_LENGTH = 3e38  # largest length of an axis that float32 can store


def matrix_hash(obj: bpy.types.Object) -> str:
    """Return a digest of the object's place, rotation, scale and shear."""
    return measurement.settings.digest(matrix_bytes(obj.matrix_world))


def matrix_bytes(matrix: Matrix) -> bytes:
    """Return the entries of a matrix of four rows as float32, row by row."""
    return struct.pack("<16f", *[entry for row in matrix for entry in row])


def transform_key(obj: bpy.types.Object) -> str:
    """Return a key of the transform for `has_transform`: scale and mirroring, and the direction of
    a print; or all if sheared or not movable.
    """
    scale = _scale(obj) if _moves_along(obj) else None
    if scale is None:
        return matrix_hash(obj)
    sign, lengths = scale
    up = _print_direction(obj, lengths)
    return sign + struct.pack("<{}f".format(3 + len(up)), *lengths, *up).hex()


def has_transform(obj: bpy.types.Object, key: str) -> bool:
    """Return whether the object's transform agrees with a key in all parts that affect its
    numbers.
    """
    if key[:1] not in {"+", "-"}:
        return key == matrix_hash(obj)
    scale = _scale(obj) if _moves_along(obj) else None
    if scale is None or key[0] != scale[0]:
        return False
    lengths = scale[1]
    up = _print_direction(obj, lengths)
    try:
        before = struct.unpack("<{}f".format(3 + len(up)), bytes.fromhex(key[1:]))
    except (ValueError, struct.error):
        return False
    is_scaled = any(
        abs(now - then) > SAME_SCALE_RTOL * then for now, then in zip(lengths, before[:3])
    )
    is_turned = any(abs(now - then) > SAME_SCALE_RTOL for now, then in zip(up, before[3:]))
    return not is_scaled and not is_turned


def _print_direction(obj: bpy.types.Object, lengths: list[float]) -> list[float]:
    """Return the world's z in the object's axes if it is measured as a print, else nothing."""
    if obj.body_moments.kind != "PRINTED":
        return []
    return [entry / length for entry, length in zip(obj.matrix_world[2], lengths)]


def _scale(obj: bpy.types.Object) -> tuple[str, list[float]] | None:
    """Return the sign of the determinant and the lengths of the axes; None if sheared, flat or not
    finite.
    """
    # pure Python: a panel asks for many objects
    axes = list(zip(*[row[:3] for row in obj.matrix_world[:3]]))
    lengths = [math.hypot(*axis) for axis in axes]
    if not all([0.0 < length < MAX_LENGTH for length in lengths]):
        return None
    (a, b, c), (d, e, f), (g, h, i) = [
        [entry / length for entry in axis] for axis, length in zip(axes, lengths)
    ]
    cosines = (a * d + b * e + c * f, d * g + e * h + f * i, g * a + h * b + i * c)
    if max(map(abs, cosines)) > SAME_SCALE_RTOL:
        return None
    determinant = a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)
    return "-" if determinant < 0.0 else "+", lengths


def _moves_along(obj: bpy.types.Object) -> bool:
    """Return whether the body in the object's frame is independent of the object's place."""
    if obj.type == "META" or len(obj.particle_systems):
        return False
    properties = obj.body_moments
    if properties.mass_from != "DENSITY":
        return True
    if properties.density_from == "POLYNOMIAL":
        return properties.density_frame == "OBJECT"
    return properties.density_from != "VOLUME"


def scale_hash(obj: bpy.types.Object) -> str:
    """Return a digest of the object's ratios of scale and its shear, independent of place, rotation
    and total scale.
    """
    products = scale_products(obj)
    largest = max(map(abs, products)) or 1.0
    # Rounded, because turning changes float32 matrices; 0.0 turns -0.0 into 0.0.
    rounded = [round(product / largest * 1e5) / 1e5 + 0.0 for product in products]
    return measurement.settings.digest(struct.pack("<9d", *rounded))


def scale_products(obj: bpy.types.Object) -> list[float]:
    """Return the nine scalar products of the object's axes, which depend on scale and shear
    alone.
    """
    axes = list(zip(*[row[:3] for row in obj.matrix_world[:3]]))
    return [sum([i * j for i, j in zip(a, b)]) for a in axes for b in axes]


def has_scale(obj: bpy.types.Object, key: str, products: list[float]) -> bool:
    """Return whether the object is turned or moved at most since `products` and its key were
    stored.
    """
    if has_transform(obj, key):
        return True
    now = scale_products(obj)
    return (
        _moves_along(obj)
        and key[:1] not in {"+", "-"}
        and len(products) == len(now)
        # Both axes of a product are rounded, before and now.
        and all([abs(a - b) <= 4.0 * SAME_SCALE_RTOL * max(now) for a, b in zip(now, products)])
    )


def colliders_digest(obj: bpy.types.Object) -> str:
    """Return a digest of the meshes and places of an object's colliders."""
    parts = []
    for child in obj.children:
        if COLLIDER in child:
            points = array("f", bytes(12 * len(child.data.vertices)))
            child.data.vertices.foreach_get("co", points)
            places = matrix_bytes(child.matrix_parent_inverse) + matrix_bytes(child.matrix_basis)
            parts.append(measurement.settings.digest(places + points.tobytes()))
    return measurement.settings.digest("".join(sorted(parts)).encode())


def settings_hash(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Return a digest of the settings that affect the numbers of this object."""
    return current_settings(obj, scene).digest


def current_settings(obj: bpy.types.Object, scene: bpy.types.Scene) -> Settings:
    """Return the current settings of the object, with the key of a varying density."""
    materials = str(obj.get("body_materials", "")).splitlines()
    return replace(
        settings.options.object_settings(obj, scene), varying=density_key(obj, materials, scene)
    )
